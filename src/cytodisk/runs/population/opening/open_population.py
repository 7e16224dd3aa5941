"""`open_population`: the cells of studies as a `Population`."""

from __future__ import annotations

import os
import warnings
from collections import Counter
from collections.abc import Sequence

import pandas as pd

from cytodisk.errors import PopulationError, PopulationWarning
from cytodisk.population.excluded_cells import EXCLUDED, excluded_text
from cytodisk.population.population import Population
from cytodisk.runs.population.movies.summary_names import MOVIE_SUMMARIES
from cytodisk.runs.population.movies.wave_summaries import WAVE_UNITS
from cytodisk.runs.population.opening.alike_settings import check_alike, common_scale
from cytodisk.runs.population.opening.cell_names import cell_names
from cytodisk.runs.population.opening.disk_directions import direction_units
from cytodisk.runs.population.opening.found_studies import Paths, find_studies
from cytodisk.runs.population.opening.joined_cells import joined_rows, usable_rows
from cytodisk.runs.population.opening.map_population import map_population
from cytodisk.runs.population.opening.movie_cells import rows_by_cell
from cytodisk.runs.population.opening.movie_population import movie_population
from cytodisk.runs.population.opening.noted_cells import LeftOut
from cytodisk.runs.population.opening.opened_cells import Wanted
from cytodisk.runs.population.opening.shape_population import NOTES, shape_population
from cytodisk.runs.population.opening.with_groups import with_groups

_READERS = {"map": map_population, "movie": movie_population, "shapes": shape_population}
_SHOWN = 3


def open_population(
    path: Paths,
    *,
    summary: str = "mean",
    channels: Sequence[str] | None = None,
    groups: str | os.PathLike[str] | None = None,
    scalars: Sequence[str] | None = None,
) -> Population:
    """Read the cells of a batch, or of studies, as one population.

    Cells that cannot be in it (refused, no windows, no condition where others have one) are listed with the
    reason in `pop.excluded`. Windows are read block by block, in double precision; above
    600 MB in single precision, and `pop.raw.attrs["precision"]` says so.

    Parameters
    ----------
    path : path-like, or sequence of path-like
        What `cytodisk batch`, `map`, `movie` or `shapes` wrote; a folder that holds such studies side by
        side; or several of these.
    summary : str
        For movies: what a cell contributes, one of "mean", "sd", "velocity", "peak_correlation", "lag",
        "around_events", "gain", "gain_score" and "waves"; see `cytodisk population --help`. For images their
        "mean".
    channels : sequence of str, optional
        By default all; then every study must have the same. For "gain" links, as "Rac1 → velocity"; for
        "waves" one signal, by default velocity.
    groups : path-like, optional
        Table of groups: which condition and experiment each cell is of. Its columns take the place of those
        that studies have.
    scalars : sequence of str, optional
        Columns of numbers that are compared beside the windows. By default the area; with nuclei their area
        and polarity and shares of the signal; for "waves" their numbers; of `cytodisk shapes` all features
        and the complexity.

    Returns
    -------
    Population
        The table has, beside the user's columns, the name of each cell, its study and place there, QC flags,
        areas and, where they are known, directions in the disk to align by: nucleus (from its centroid to
        the cell's), axis (of the long axis the end that reaches further out) and, of movies, motion and
        front.

    Raises
    ------
    PopulationError
        Nothing is there, or the studies do not go together: the message names what differs and where.
    ReadError
        A table is damaged.

    Warns
    -----
    PopulationWarning
        Studies differ in something that a reader should know, as how their maps are aligned; or the table of
        groups says nothing of some cells.

    See Also
    --------
    Population : Made from arrays and a table.
    population_from_tables : Made from a table of windows.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> labels = cd.simulate.label_image(cells=4, seed=1)
    >>> tifffile.imwrite("cells.tif", labels)
    >>> tifffile.imwrite("Rac1.tif", (labels * 10).astype("float32"))
    >>> _ = cd.run_map("cells.tif", "out", signal="Rac1.tif", channels=["Rac1"], layers=2, sectors=6)
    >>> pop = cd.open_population("out")
    >>> pop
    <Population: 4 cells, channels Rac1, 2 × 6 windows>
    >>> pop.values[2].mean().item()
    30.0
    """
    if summary not in MOVIE_SUMMARIES:
        raise PopulationError(f"summary must be one of {', '.join(MOVIE_SUMMARIES)}, got {summary!r}")
    studies, left_out = find_studies(path)
    notes = check_alike(studies)
    run = studies[0].run
    frames = joined_rows(studies)
    cells = rows_by_cell(frames) if run == "movie" else frames
    cells, told = with_groups(cells, groups, studies)
    notes += told
    for note in notes:
        warnings.warn(note, PopulationWarning, stacklevel=2)
    cells = usable_rows(cells, studies, left_out)
    _refuse_few(cells, left_out)
    attrs = dict(cells.attrs)
    cells.insert(0, "cell", cell_names(cells))
    found = _READERS[run](studies, cells, frames, Wanted(summary, channels, scalars, left_out))
    _refuse_few(found.cells, left_out)
    notes += found.cells.attrs.get(NOTES, [])
    scale = common_scale(studies)
    of_waves = {name: unit for name, unit in WAVE_UNITS.items() if name in found.cells}
    attrs["units"] = attrs["units"] | direction_units([str(name) for name in found.cells]) | of_waves
    found.cells.attrs = attrs | scale | {EXCLUDED: excluded_text(left_out.rows), NOTES: notes}
    if found.values is not None:
        found.values.attrs |= scale | {"summary": summary}
    return Population(found.values, found.cells, areas=found.areas, scalars=found.scalars)


def _refuse_few(cells: pd.DataFrame, left_out: LeftOut) -> None:
    """Raise PopulationError where less than two cells are left, with what became of the others."""
    if len(cells) > 1:
        return
    number = "one cell" if len(cells) else "no cell"
    reasons = Counter(str(row["reason"]) for row in left_out.rows).most_common(_SHOWN)
    gone = "; ".join(f"{count} left out: {reason}" for reason, count in reasons)
    raise PopulationError(
        f"{number} can be used{f' ({gone})' if gone else ''}: a population needs several; pass a batch, or "
        "the studies of several files"
    )

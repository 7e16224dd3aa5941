"""Cells of `cytodisk shapes` as the parts of a population: no windows, but features."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from cytodisk.errors import PopulationError
from cytodisk.runs.population.opening.chosen_scalars import chosen_scalars
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.opening.opened_cells import OpenedCells, Wanted
from cytodisk.runs.population.shape_values import joined_shapes, shape_scalars

NOTES = "notes"
_SCORES = ("complexity", "umap_1", "umap_2")


def shape_population(
    studies: Sequence[FoundStudy], cells: pd.DataFrame, frames: pd.DataFrame, wanted: Wanted
) -> OpenedCells:
    """Features of cells, and the complexity of all of them together.

    Parameters
    ----------
    studies : sequence of FoundStudy
        Of `cytodisk shapes`.
    cells, frames : DataFrame
        Usable cells; all cells.
    wanted : Wanted

    Returns
    -------
    OpenedCells

    Raises
    ------
    PopulationError
        Windows are asked for; a scalar is none.
    """
    if wanted.channels is not None or wanted.summary != "mean":
        what = "channels" if wanted.channels is not None else "summary"
        raise PopulationError(
            f"{what}: {studies[0].name} is of cytodisk shapes, without windows: leave {what} out"
        )
    parts = [frames[frames["input"] == study.name].copy() for study in studies]
    for part in parts:
        part.attrs = {"units": frames.attrs["units"]}
    joined = joined_shapes([part for part in parts if len(part)])
    places = ["input", "number"]
    scores = joined.set_index(pd.MultiIndex.from_frame(joined[places]))
    at = pd.MultiIndex.from_frame(cells[places])
    attrs = dict(cells.attrs)
    cells = cells.assign(**{name: scores[name].loc[at].to_numpy() for name in _SCORES if name in scores})
    described = cells.assign(status="ok")
    described.attrs = attrs
    found = shape_scalars(described)
    cells.attrs = attrs | {NOTES: list(found.sentences)}
    names = found.names if wanted.scalars is None else chosen_scalars(cells, (), wanted.scalars)
    return OpenedCells(None, None, cells, tuple(names))

"""`cytodisk waves` on a batch folder: each movie by itself, then all of them together."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.errors import ParameterError, PopulationError
from cytodisk.population.group_columns import CONDITION
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.pooling.batch_movies import movies_of
from cytodisk.runs.population.pooling.movie_by_movie import (
    REFUSED,
    each_movie,
    in_order,
    made_alike,
    of_input,
    pooled_settings,
    table_of_studies,
    with_groups_of,
)
from cytodisk.runs.population.pooling.pool_parameters import PoolOptions, PoolParameters
from cytodisk.runs.population.pooling.pooled_population import conditions_compared
from cytodisk.runs.population.wave_numbers.batch_waves_parameters import BatchWavesParameters
from cytodisk.runs.population.wave_numbers.pooled_wave_columns import POOLED_WAVE_TABLES
from cytodisk.runs.population.wave_numbers.pooled_wave_numbers import pool_waves, wave_numbers
from cytodisk.runs.run_options import Progress
from cytodisk.runs.waves.wave_run_parameters import WavesParameters
from cytodisk.runs.waves.waves_study import waves_study
from cytodisk.store.populations.pooled_waves import PooledWaves, open_pooled_waves
from cytodisk.store.waves.waves_store import Waves, read_waves, write_waves
from cytodisk.taking import takes

_CELLS = tuple(column.name for column in POOLED_WAVE_TABLES["cells"])


@takes(BatchWavesParameters, PoolOptions)
def run_batch_waves(
    batch: str | os.PathLike[str],
    signal: str = "velocity",
    *,
    groups: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    parameters: BatchWavesParameters | None = None,
    **settings: Any,
) -> PooledWaves:
    """Look for waves in every movie of a batch, and pool them: `cytodisk waves BATCH`.

    Each movie has its own tables, as `run_waves` writes them; the pooled ones go to BATCH/waves/SIGNAL.

    Parameters
    ----------
    batch : path-like
        Folder that `cytodisk batch` wrote. Its columns condition and experiment group the cells.
    signal : str
        "velocity", "velocity_cell_frame" or a channel of all studies.
    groups : path-like, optional
        Table of groups: which condition and experiment each cell is of. Its columns take the place of those
        of the batch.
    progress : callable, optional
        Called with (steps done, in all).
    parameters : BatchWavesParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `BatchWavesParameters` and `PoolOptions`.

    Returns
    -------
    PooledWaves
        A study or cell in which waves cannot be looked for has a row that says why.

    Raises
    ------
    PopulationError
        The movies cannot be pooled: their windows or frame intervals differ, a condition is not there, or no
        cell has a condition, an experiment and an order.
    ParameterError
        Waves could be looked for in no cell, or a parameter is out of its range.

    See Also
    --------
    run_waves : One movie.
    open_pooled_waves : Reads the tables.

    Notes
    -----
    An experiment's number is the mean of its cells', the pooled one the mean of the experiments'. Whether
    cells have waves is tested on their order, a normal quantile whose mean is 0 where there are none; signs
    of whole experiments are turned. Order, speed, direction, period and persistence are compared between
    conditions, by exchange of the experiments' labels. Speed and direction count without their sign, as
    which way round a wave runs is mostly by chance; all but the order only of cells that have a wave beyond
    chance (p up to 0.05), as without one they are any. With n experiments turned signs reach p = 2 / 2ⁿ at
    best: 6 are needed for 0.05.

    Examples
    --------
    >>> import tifffile
    >>> from pathlib import Path
    >>> import cytodisk as cd
    >>> lines = ["[study]", "kind = 'movie'", "[parameters]", "layers = 2", "frame_interval_s = 5"]
    >>> for day in range(2):
    ...     movie = cd.simulate.movie("fluctuating", frames=40, radius_px=14, seed=day)
    ...     tifffile.imwrite(f"masks{day}.tif", movie.masks.astype("uint8"), photometric="minisblack")
    ...     lines += ["[[inputs]]", f"masks = 'masks{day}.tif'"]
    ...     lines += ["condition = 'control'", f"experiment = 'day {day}'"]
    >>> _ = Path("batch.toml").write_text("\\n".join(lines))
    >>> _ = cd.run_batch("batch.toml", "all")
    >>> found = cd.run_batch_waves("all", surrogates=19, geometry=False)
    >>> found.sentences[-1]
    'control against 0: 2 experiments can give p = 0.5 at best.'
    """
    folder = Path(batch)
    options, values = PoolOptions.split(settings, BatchWavesParameters)
    chosen = BatchWavesParameters.chosen(parameters, values)
    movies = movies_of(folder, groups)
    there = [name for name in movies.groups[CONDITION].drop_duplicates() if name]
    conditions_compared(there, chosen.compare)  # before the movies, which take long
    of_each = chosen.part(WavesParameters)
    rows, done = each_movie(
        movies,
        lambda study, report: waves_study(
            study, signal, progress=report, parameters=of_each, csv=options.csv
        ),
        (lambda study: _kept(study, signal, of_each)) if options.resume else None,
        progress,
    )
    if not done:
        reasons = [row["reason"] for row in rows if row["status"] == REFUSED]
        raise ParameterError(f"waves cannot be looked for in any movie of batch {folder}: {reasons[0]}")
    table = with_groups_of(pd.concat([_cells(*one) for one in done], ignore_index=True), movies.groups)
    numbers = pd.concat([_numbers(*one) for one in done], ignore_index=True)
    joined = with_groups_of(numbers, movies.groups).rename(columns={"channel": "number"})
    pooled = pool_waves(numbers, table[table["status"] == "ok"], chosen.part(PoolParameters))
    if pooled.tables["pooled"].empty:
        why = [words for words in table["reason"] if words] or ["no layer has an order"]
        raise PopulationError(f"no cell of batch {folder} can be pooled: {why[0]}")
    tables = {"studies": table_of_studies(rows, table), "cells": table, "numbers": joined} | pooled.tables
    content = chosen.model_dump(mode="json") | pooled_settings(movies, pooled)
    content["given"] = chosen.model_dump(mode="json", exclude_defaults=True)
    columns = POOLED_WAVE_TABLES
    ordered = {name: in_order(one, columns[name]) for name, one in tables.items() if len(one)}
    write_waves(folder, signal, ordered, columns, content, chosen.name, options.csv)
    return open_pooled_waves(folder, signal, chosen.name)


def _cells(study: FoundStudy, found: Waves) -> pd.DataFrame:
    """How each cell of a study went, and its wave, with the name of the input."""
    return of_input(found.cells, tuple(name for name in _CELLS if name in found.cells), study.name)


def _numbers(study: FoundStudy, found: Waves) -> pd.DataFrame:
    """Numbers of the waves of a study's cells, with the name of the input."""
    return wave_numbers(found.cells, found.layers).assign(input=study.name)


def _kept(study: FoundStudy, signal: str, parameters: WavesParameters) -> Waves | None:
    """The waves that are there, if they were looked for with these settings."""
    found = read_waves(study.folder, signal, parameters.name)
    alike = made_alike(found.settings, parameters.model_dump(mode="json"))
    return found if alike and len(found.layers) and len(found.cells) else None

"""`cytodisk correlate` on a batch folder: each movie by itself, then all of them together."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.errors import ParameterError, PopulationError
from cytodisk.population.group_columns import CONDITION
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.correlate.correlate_study import correlate_study
from cytodisk.runs.population.correlations.batch_correlate_parameters import BatchCorrelateParameters
from cytodisk.runs.population.correlations.common_lag import common_lag
from cytodisk.runs.population.correlations.pooled_columns import POOLED_TABLES
from cytodisk.runs.population.correlations.pooled_curves import pool_curves
from cytodisk.runs.population.correlations.study_curves import cells_of, curves_of, kept
from cytodisk.runs.population.pooling.batch_movies import movies_of
from cytodisk.runs.population.pooling.movie_by_movie import (
    REFUSED,
    each_movie,
    in_order,
    pooled_settings,
    table_of_studies,
    with_groups_of,
)
from cytodisk.runs.population.pooling.pool_parameters import PoolOptions, PoolParameters
from cytodisk.runs.population.pooling.pooled_population import conditions_compared
from cytodisk.runs.run_options import Progress
from cytodisk.runs.used_series.chosen_of_study import channels_of
from cytodisk.store.correlation_store import write_correlation
from cytodisk.store.populations.pooled_correlation import PooledCorrelation, open_pooled_correlation
from cytodisk.store.study import open_study
from cytodisk.taking import takes


@takes(BatchCorrelateParameters, PoolOptions)
def run_batch_correlate(
    batch: str | os.PathLike[str],
    signal: str,
    with_: str = "velocity",
    *,
    groups: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    parameters: BatchCorrelateParameters | None = None,
    **settings: Any,
) -> PooledCorrelation:
    """Correlate every movie of a batch, and pool the curves of all cells: `cytodisk correlate BATCH`.

    Each movie has its own tables, as `run_correlate` writes them; the pooled ones go to
    BATCH/correlation/SIGNAL~WITH.

    Parameters
    ----------
    batch : path-like
        Folder that `cytodisk batch` wrote. Its columns condition and experiment group the cells.
    signal : str
        A channel of all studies.
    with_ : str
        "velocity", "velocity_cell_frame" or a channel. Positive lag: it moves after the signal.
    groups : path-like, optional
        Table of groups: which condition and experiment each cell is of. Its columns take the place of those
        of the batch.
    progress : callable, optional
        Called with (steps done, in all).
    parameters : BatchCorrelateParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `BatchCorrelateParameters` and `PoolOptions`.

    Returns
    -------
    PooledCorrelation
        A study or cell that cannot be correlated has a row that says why.

    Raises
    ------
    PopulationError
        The movies cannot be pooled: their windows or frame intervals differ, a condition is not there, or no
        cell has a condition, an experiment and a curve.
    ParameterError
        No cell could be correlated, or a parameter is out of its range.

    See Also
    --------
    run_correlate : One movie.
    open_pooled_correlation : Reads the tables.

    Notes
    -----
    Without `max_lag` the longest lag is the usual one of the movie in the middle, the same for all. A movie
    too short for the longer lags counts at the shorter ones.

    A curve is the mean over the sectors of a layer, one a cell. An experiment's curve is the mean of its
    cells' in Fisher's z, the pooled curve the mean of the experiments', so a dish with many cells counts as
    much as one with few. Against 0 the signs of whole experiments are turned; between conditions their
    labels are exchanged. With n experiments turned signs reach p = 2 / 2ⁿ at best: 6 are needed for 0.05.

    Examples
    --------
    >>> import tifffile
    >>> from pathlib import Path
    >>> import cytodisk as cd
    >>> lines = ["[study]", "kind = 'movie'", "[parameters]", "layers = 2", "channels = ['Rac1', 'RhoA']"]
    >>> for day in range(2):
    ...     movie = cd.simulate.movie("fluctuating", frames=24, radius_px=14, seed=day)
    ...     tifffile.imwrite(f"masks{day}.tif", movie.masks.astype("uint8"), photometric="minisblack")
    ...     tifffile.imwrite(f"signal{day}.ome.tif", movie.signal.to_numpy(), metadata={"axes": "TCYX"})
    ...     lines += ["[[inputs]]", f"masks = 'masks{day}.tif'", f"signal = 'signal{day}.ome.tif'"]
    ...     lines += ["condition = 'control'", f"experiment = 'day {day}'"]
    >>> _ = Path("batch.toml").write_text("\\n".join(lines))
    >>> _ = cd.run_batch("batch.toml", "all")
    >>> found = cd.run_batch_correlate("all", "Rac1", max_lag=3, surrogates=0)
    >>> found.sentences[0]
    'control against 0: 2 experiments can give p = 0.5 at best.'
    """
    folder = Path(batch)
    options, values = PoolOptions.split(settings, BatchCorrelateParameters)
    chosen = BatchCorrelateParameters.chosen(parameters, values)
    movies = movies_of(folder, groups)
    there = [name for name in movies.groups[CONDITION].drop_duplicates() if name]
    conditions_compared(there, chosen.compare)  # before the movies, which take long
    of_each = chosen.part(CorrelateParameters)
    if of_each.max_lag is None:
        of_each = of_each.changed(max_lag=common_lag(movies, of_each.min_pairs))
    names = signal, with_
    rows, done = each_movie(
        movies,
        lambda study, report: correlate_study(
            study, *names, progress=report, parameters=of_each, csv=options.csv
        ),
        (lambda study: kept(study, names, of_each)) if options.resume else None,
        progress,
    )
    if not done:
        reasons = [row["reason"] for row in rows if row["status"] == REFUSED]
        raise ParameterError(f"no movie of batch {folder} can be correlated: {reasons[0]}")
    cells = pd.concat([cells_of(study, found) for study, found in done], ignore_index=True)
    curves = pd.concat([curves_of(study, found) for study, found in done], ignore_index=True)
    table, joined = with_groups_of(cells, movies.groups), with_groups_of(curves, movies.groups)
    pooled = pool_curves(joined, table[table["status"] == "ok"], names, chosen.part(PoolParameters))
    if pooled.tables["pooled"].empty:
        why = [words for words in table["reason"] if words] or ["no lag has enough pairs of frames"]
        raise PopulationError(f"no cell of batch {folder} can be pooled: {why[0]}")
    tables = {"studies": table_of_studies(rows, table), "cells": table, "curves": joined} | pooled.tables
    tables = {name: one for name, one in tables.items() if len(one)}
    content = chosen.model_dump() | pooled_settings(movies, pooled) | {"max_lag": of_each.max_lag}
    content["given"] = chosen.model_dump(mode="json", exclude_defaults=True)
    ordered = {name: in_order(one, POOLED_TABLES[name]) for name, one in tables.items()}
    write_correlation(folder, signal, with_, ordered, POOLED_TABLES, content, chosen.name, options.csv)
    return open_pooled_correlation(folder, signal, with_, chosen.name)


def only_channel(batch: str | os.PathLike[str]) -> str:
    """The channel of a batch whose movies have one.

    Raises
    ------
    ParameterError
        They have several: the message names them.
    """
    study = movies_of(Path(batch)).studies[0]
    names = channels_of(open_study(study.folder))
    if len(names) > 1:
        raise ParameterError(f"signal is not given: pass --signal with one of {', '.join(map(repr, names))}")
    return names[0]

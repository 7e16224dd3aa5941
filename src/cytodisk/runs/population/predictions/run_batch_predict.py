"""`cytodisk predict` on a batch folder: each movie by itself, then all of them together."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.errors import ParameterError, PopulationError
from cytodisk.population.group_columns import CONDITION
from cytodisk.runs.population.movies.prediction_summaries import scores_of
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
from cytodisk.runs.population.predictions.batch_predict_parameters import BatchPredictParameters
from cytodisk.runs.population.predictions.pooled_gains import pool_gains
from cytodisk.runs.population.predictions.pooled_prediction_columns import POOLED_PREDICTION_TABLES
from cytodisk.runs.predict.predict_parameters import PredictParameters
from cytodisk.runs.predict.predict_study import predict_study
from cytodisk.runs.run_options import Progress
from cytodisk.store.populations.pooled_prediction import PooledPrediction, open_pooled_prediction
from cytodisk.store.predictions.prediction_store import Prediction, read_prediction, write_prediction
from cytodisk.taking import takes

_CELLS = ("cell", "status", "reason", "qc_flags", "frames", "surrogates", "geometry_not_tested")
_LINKS = (
    "cell",
    "source",
    "target",
    "given",
    "layer",
    "gain",
    "gain_reversed",
    "gain_excess",
    "p",
    "effect",
)
_PARTIAL = ("gain_excess_partial", "p_partial")


@takes(BatchPredictParameters, PoolOptions)
def run_batch_predict(
    batch: str | os.PathLike[str],
    source: str | None = None,
    target: str | None = None,
    *,
    groups: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    parameters: BatchPredictParameters | None = None,
    **settings: Any,
) -> PooledPrediction:
    """Test in every movie of a batch which signals predict which, and pool them: `cytodisk predict BATCH`.

    Each movie has its own tables, as `run_predict` writes them; the pooled ones go to
    BATCH/prediction/SOURCE~TARGET, or BATCH/prediction/network.

    Parameters
    ----------
    batch : path-like
        Folder that `cytodisk batch` wrote. Its columns condition and experiment group the cells.
    source, target : str, optional
        Channels of all studies, or velocity: both directions are tested. Without both, all signals are tested
        against each other.
    groups : path-like, optional
        Table of groups: which condition and experiment each cell is of. Its columns take the place of those
        of the batch.
    progress : callable, optional
        Called with (steps done, in all).
    parameters : BatchPredictParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `BatchPredictParameters` and `PoolOptions`.

    Returns
    -------
    PooledPrediction
        A study or cell that cannot be tested has a row that says why.

    Raises
    ------
    PopulationError
        The movies cannot be pooled: their windows or frame intervals differ, a condition is not there, or no
        cell has a condition, an experiment and a gain.
    ParameterError
        No cell could be tested, or a parameter is out of its range.

    See Also
    --------
    run_predict : One movie.
    open_pooled_prediction : Reads the tables.

    Notes
    -----
    A cell's gain counts less the mean gain of its shifted sources, which is 0 on average where nothing
    predicts. An experiment's is the mean of its cells', the pooled one the mean of the experiments', so a
    dish with many cells counts as much as one with few. Whether it is above 0 is tested on normal scores of
    the cells' p, whose signs can be exchanged between whole experiments; gains are lopsided, and cannot. With
    n experiments turned signs reach p = 2 / 2ⁿ at best: 6 are needed for 0.05. Between conditions labels of
    experiments are exchanged, and gains are compared.

    Examples
    --------
    >>> import tifffile
    >>> from pathlib import Path
    >>> import cytodisk as cd
    >>> lines = ["[study]", "kind = 'movie'", "[parameters]", "layers = 2", "channels = ['Rac1', 'RhoA']"]
    >>> for day in range(2):
    ...     movie = cd.simulate.movie("fluctuating", frames=40, radius_px=14, seed=day)
    ...     tifffile.imwrite(f"masks{day}.tif", movie.masks.astype("uint8"), photometric="minisblack")
    ...     tifffile.imwrite(f"signal{day}.ome.tif", movie.signal.to_numpy(), metadata={"axes": "TCYX"})
    ...     lines += ["[[inputs]]", f"masks = 'masks{day}.tif'", f"signal = 'signal{day}.ome.tif'"]
    ...     lines += ["condition = 'control'", f"experiment = 'day {day}'"]
    >>> _ = Path("batch.toml").write_text("\\n".join(lines))
    >>> _ = cd.run_batch("batch.toml", "all")
    >>> settings = dict(max_order=3, surrogates=19, geometry=False)
    >>> found = cd.run_batch_predict("all", "Rac1", "velocity", **settings)
    >>> found.sentences[-1]
    'control against 0: 2 experiments can give p = 0.5 at best.'
    """
    folder, names = Path(batch), (source, target)
    options, values = PoolOptions.split(settings, BatchPredictParameters)
    chosen = BatchPredictParameters.chosen(parameters, values)
    movies = movies_of(folder, groups)
    there = [name for name in movies.groups[CONDITION].drop_duplicates() if name]
    conditions_compared(there, chosen.compare)  # before the movies, which take long
    _refuse_without_chance(chosen)
    of_each = chosen.part(PredictParameters)
    rows, done = each_movie(
        movies,
        lambda study, report: predict_study(
            study, *names, progress=report, parameters=of_each, csv=options.csv
        ),
        (lambda study: _kept(study, names, of_each)) if options.resume else None,
        progress,
    )
    if not done:
        reasons = [row["reason"] for row in rows if row["status"] == REFUSED]
        raise ParameterError(f"no movie of batch {folder} can be tested: {reasons[0]}")
    cells = [of_input(found.cells, _CELLS, study.name) for study, found in done]
    table = with_groups_of(pd.concat(cells, ignore_index=True), movies.groups)
    links = pd.concat([_links(study, found) for study, found in done], ignore_index=True)
    joined = with_groups_of(links, movies.groups)
    pooled = pool_gains(links, table[table["status"] == "ok"], chosen.part(PoolParameters))
    if pooled.tables["pooled"].empty:
        why = [words for words in table["reason"] if words] or ["no layer could be tested"]
        raise PopulationError(f"no cell of batch {folder} can be pooled: {why[0]}")
    tables = {"studies": table_of_studies(rows, table), "cells": table, "links": joined} | pooled.tables
    content = chosen.model_dump() | pooled_settings(movies, pooled)
    content["signals"] = list(done[0][1].signals)
    content["asked"] = chosen.model_dump(mode="json", exclude_defaults=True)
    columns = POOLED_PREDICTION_TABLES
    ordered = {name: in_order(one, columns[name]) for name, one in tables.items() if len(one)}
    three = (source or "", target or "", chosen.name)
    write_prediction(folder, three, ordered, columns, content, options.csv)
    return open_pooled_prediction(folder, *three)


def _refuse_without_chance(chosen: BatchPredictParameters) -> None:
    if not chosen.surrogates:
        raise ParameterError(
            "surrogates is 0, and gains can only be pooled less what chance gives: leave it out, or pass 19 "
            "or more"
        )


def _links(study: FoundStudy, found: Prediction) -> pd.DataFrame:
    """Links of a study's cells with their scores, and the name of the input."""
    links = found.links
    partial = links.reindex(columns=["cell", *_PARTIAL]).rename(columns={"p_partial": "p"})
    own = of_input(links, (*_LINKS, "gain_excess_partial"), study.name)
    own = own.assign(gain_excess_partial=own["gain_excess_partial"].astype("float64"))
    scores = scores_of(links, found.cells), scores_of(partial, found.cells)
    return own.assign(score=scores[0].to_numpy(), score_partial=scores[1].to_numpy())


def _kept(
    study: FoundStudy, names: tuple[str | None, str | None], parameters: PredictParameters
) -> Prediction | None:
    """The prediction that is there, if it was made with these settings."""
    found = read_prediction(study.folder, names[0] or "", names[1] or "", parameters.name)
    alike = made_alike(found.settings, parameters.model_dump(mode="json"))
    return found if alike and len(found.links) and len(found.cells) else None

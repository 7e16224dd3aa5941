"""Pool gains over experiments, test their scores against 0, and compare conditions."""

from __future__ import annotations

import pandas as pd

from cytodisk.population.group_columns import CONDITION, EXPERIMENT
from cytodisk.runs.population.movies.prediction_summaries import with_link_names
from cytodisk.runs.population.pooling.number_population import KEYS, number_population
from cytodisk.runs.population.pooling.pool_parameters import PoolParameters
from cytodisk.runs.population.pooling.pooled_population import TABLES, Pool, Pooled
from cytodisk.runs.population.predictions.gain_words import difference_sentences, link_sentences
from cytodisk.runs.predict.tested_link import weaker_links

GAINS = {"raw": "gain_excess", "partial": "gain_excess_partial"}
"""Kinds of gain, and their column: as measured, and with what geometry alone would give regressed out."""

SCORES = {"raw": "score", "partial": "score_partial"}
"""Columns of the normal scores of their p."""

_PLACE = ("channel", "layer")
_NAMES = ["source", "target"]


def pool_gains(links: pd.DataFrame, cells: pd.DataFrame, options: PoolParameters) -> Pooled:
    """Mean gain of each link, layer and condition over experiments, and what chance would give.

    Parameters
    ----------
    links : DataFrame
        input, cell, source, target, layer, gain, gain_reversed and the columns of `GAINS` and `SCORES`.
    cells : DataFrame
        input, cell, condition and experiment of the cells that are pooled.
    options : PoolParameters

    Returns
    -------
    Pooled
        An experiment counts once, whatever the number of its cells. p and p_fwer against 0 are those of the
        mean score, of all links and layers together; those between conditions are of the gains.

    Raises
    ------
    PopulationError
        A condition to compare is not there.
    """
    named = with_link_names(links)
    found = Pooled()
    parts: dict[str, list[pd.DataFrame]] = {name: [] for name in TABLES}
    for kind, gain in GAINS.items():
        population = number_population(named, cells, _links(named), gain)
        if population is None:
            continue
        scores = number_population(named, cells, _links(named), SCORES[kind])
        pool = Pool(population, options.compare, options, _PLACE, "gain_excess", scores=scores).pooled()
        if kind == "raw":  # the others have the same cells, or fewer
            found.sentences += pool.sentences
        found.warnings += [warning | {"kind": kind} for warning in pool.warnings]
        for name, table in pool.tables.items():
            if len(table):
                parts[name].append(_with_names(table, named).assign(kind=kind))
    weaker = _weaker(named, cells)
    parts["pooled"] = [
        table.merge(weaker, "left").assign(weaker=lambda one: one["weaker"].eq(True) & (one["kind"] == "raw"))
        for table in parts["pooled"]
    ]
    for name, tables in parts.items():
        found.tables[name] = pd.concat(tables, ignore_index=True) if tables else pd.DataFrame()
    said = [*link_sentences(found.tables["pooled"]), *difference_sentences(found.tables["comparisons"])]
    found.sentences = [*said, *found.sentences]
    return found


def _weaker(named: pd.DataFrame, cells: pd.DataFrame) -> pd.DataFrame:
    """Which links noise of measurement alone would make, by condition and layer; experiments count once."""
    gains, keys = ["gain", "gain_reversed"], [CONDITION, *_NAMES, "layer"]
    known = named[[*KEYS, *_NAMES, "layer", *gains]].merge(cells[[*KEYS, CONDITION, EXPERIMENT]], on=KEYS)
    of_experiments = known.groupby([*keys, EXPERIMENT], sort=False)[gains].mean().astype("float64")
    means = of_experiments.groupby(keys, sort=False).mean().reset_index()
    return means[keys].assign(weaker=weaker_links(means, within=[CONDITION]))


def _links(named: pd.DataFrame) -> list[str]:
    return list(named["channel"].drop_duplicates())


def _with_names(table: pd.DataFrame, named: pd.DataFrame) -> pd.DataFrame:
    """The table with source and target in the place of the channel."""
    names = named[["channel", *_NAMES]].drop_duplicates()
    return table.merge(names, on="channel", how="left").drop(columns="channel")

"""Columns of the tables of pooled predictions, and what they mean."""

from __future__ import annotations

import pyarrow as pa

from cytodisk.runs.population.pooling.common_columns import (
    COMPARED,
    DIFFERENCE,
    N_CELLS,
    N_EXPERIMENTS,
    OF_CELL,
    SMALLEST_P,
    STATUS,
    STUDIES,
)
from cytodisk.runs.predict.prediction_columns import CELLS, LINKS
from cytodisk.store.populations.place_columns import CONDITION, EXPERIMENT
from cytodisk.store.tables import LAYER, Column, Columns

_LINKS = {column.name: column for column in LINKS}
_CELLS = {column.name: column for column in CELLS}
_KIND = Column(
    "kind",
    pa.string(),
    "",
    "raw: as measured; partial: with what geometry alone would give regressed out",
)
_NAMES: Columns = (_LINKS["source"], _LINKS["target"])
_MEAN = _LINKS["gain_excess"]._replace(
    meaning="mean over experiments of gain less the mean gain of shifted sources; 0 where nothing predicts"
)
_SCORE = Column(
    "score",
    pa.float64(),
    "1",
    "normal score of p: its mean is 0 where nothing predicts, whatever the length of a movie",
)

POOLED_PREDICTION_TABLES: dict[str, Columns] = {
    "studies": STUDIES,
    "cells": (*OF_CELL, *STATUS, _CELLS["frames"], _CELLS["surrogates"], _CELLS["geometry_not_tested"]),
    "links": (
        *OF_CELL,
        *_NAMES,
        _LINKS["given"],
        LAYER,
        _LINKS["gain"],
        _LINKS["gain_reversed"],
        _LINKS["gain_excess"],
        _SCORE,
        _LINKS["p"],
        _LINKS["effect"],
        _LINKS["gain_excess_partial"],
        _SCORE._replace(name="score_partial", meaning="normal score of p_partial"),
    ),
    "experiments": (
        CONDITION,
        EXPERIMENT,
        _KIND,
        *_NAMES,
        LAYER,
        _MEAN._replace(meaning="mean over the cells of the experiment"),
        N_CELLS,
    ),
    "pooled": (
        CONDITION,
        _KIND,
        *_NAMES,
        LAYER,
        _MEAN,
        Column("low", pa.float64(), "nat", "lower end of its 95 % interval over experiments"),
        Column("high", pa.float64(), "nat", "upper end of its 95 % interval over experiments"),
        _SCORE._replace(meaning="mean over experiments of the normal scores of p"),
        N_CELLS,
        N_EXPERIMENTS,
        Column(
            "p",
            pa.float64(),
            "1",
            "share of turned signs of whole experiments with a mean score at least as far from 0; of this "
            "link and layer alone",
        ),
        Column(
            "p_fwer",
            pa.float64(),
            "1",
            "the same for the largest of all links and layers: up to 0.05, with a score above 0, the source "
            "predicts the target",
        ),
        SMALLEST_P,
        _LINKS["weaker"]._replace(
            meaning="the other direction is stronger, and noise of measurement alone would make this one: of "
            "the means over experiments, gain is less than half of gain_reversed, and that of the other "
            "direction more than its own; of raw alone"
        ),
    ),
    "comparisons": (
        *COMPARED,
        _KIND,
        *_NAMES,
        LAYER,
        Column("difference", pa.float64(), "nat", "difference of the mean gain_excess"),
        *DIFFERENCE,
    ),
}
"""Columns of each table by its name; comparisons is there where there are two conditions."""

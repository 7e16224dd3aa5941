"""Columns of the tables of pooled waves, and what they mean."""

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
from cytodisk.runs.waves.waves_columns import WAVE_TABLES
from cytodisk.store.populations.place_columns import CONDITION, EXPERIMENT
from cytodisk.store.tables import LAYER, Column, Columns

_WAVES = {column.name: column for column in WAVE_TABLES["cells"]}
_SAME = ("kind", "way", "mode", "period_s", "speed_um_s", "direction", "persistence_s", "order", "p")
_LAYER = LAYER._replace(meaning="layer of the windows, 0 at the cell's edge; 0, too, of the edge's velocity")
_NUMBER = Column(
    "number",
    pa.string(),
    "",
    "wave_order: 0 on average where there are no waves; without their sign wave_speed_um_s and "
    "wave_direction; wave_period_s; wave_persistence_s; the last four of the chosen layer, and only of cells "
    "that have a wave, with p up to 0.05",
)
_UNIT = Column("unit", pa.string(), "", "unit of the number")
_MEAN = Column("mean", pa.float64(), "", "mean over experiments")

POOLED_WAVE_TABLES: dict[str, Columns] = {
    "studies": STUDIES,
    "cells": (
        *OF_CELL,
        *STATUS,
        _WAVES["layer"],
        *(_WAVES[name] for name in _SAME),
        _WAVES["frames"],
        _WAVES["surrogates"],
    ),
    "numbers": (*OF_CELL, _NUMBER, _LAYER, Column("value", pa.float64(), "", "the number of the cell")),
    "experiments": (
        CONDITION,
        EXPERIMENT,
        _NUMBER,
        _LAYER,
        _MEAN._replace(meaning="mean over the cells of the experiment"),
        _UNIT,
        N_CELLS,
    ),
    "pooled": (
        CONDITION,
        _NUMBER,
        _LAYER,
        _MEAN,
        Column("low", pa.float64(), "", "lower end of its 95 % interval over experiments"),
        Column("high", pa.float64(), "", "upper end of its 95 % interval over experiments"),
        _UNIT,
        N_CELLS,
        N_EXPERIMENTS,
        Column(
            "p",
            pa.float64(),
            "1",
            "of wave_order: share of turned signs of whole experiments with a mean at least as far from 0, "
            "in this layer alone; empty for other numbers",
        ),
        Column(
            "p_fwer",
            pa.float64(),
            "1",
            "the same for the largest of all layers: up to 0.05, with an order above 0, there are waves",
        ),
        SMALLEST_P,
    ),
    "comparisons": (
        *COMPARED,
        _NUMBER,
        _LAYER,
        Column("difference", pa.float64(), "", "difference of the means"),
        _UNIT,
        *DIFFERENCE,
    ),
}
"""Columns of each table by its name; comparisons is there where there are two conditions."""

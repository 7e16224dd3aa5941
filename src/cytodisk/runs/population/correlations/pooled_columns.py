"""Columns of the tables of pooled correlations, and what they mean."""

from __future__ import annotations

import pyarrow as pa

from cytodisk.runs.batch.input_columns import INPUT
from cytodisk.store.populations.place_columns import CONDITION, CONTROL, EXPERIMENT
from cytodisk.store.tables import CELL, LAYER, Column, Columns

_LAG = Column("lag", pa.int64(), "frame", "lag in frames; positive: what stands after --with comes later")
_LAG_S = Column("lag_s", pa.float64(), "s", "the lag in seconds; empty if the frame interval is unknown")
_CURVE = Column(
    "curve",
    pa.string(),
    "",
    "raw: as measured; partial: with what geometry alone would give, and other controls, regressed out",
)
_CELLS = Column("n_cells", pa.int64(), "", "number of cells with a value")
_EXPERIMENTS = Column("n_experiments", pa.int64(), "", "number of experiments with a value")
_POOLED: Columns = (
    Column("correlation", pa.float64(), "1", "mean over experiments, of Fisher's z, as a correlation"),
    Column("low", pa.float64(), "1", "lower end of its 95 % interval over experiments"),
    Column("high", pa.float64(), "1", "upper end of its 95 % interval over experiments"),
    _CELLS,
    _EXPERIMENTS,
)


def _p(alone: str, together: str) -> Columns:
    return (
        Column("p", pa.float64(), "1", f"{alone}; of this layer and lag alone"),
        Column("p_fwer", pa.float64(), "1", f"the same for the largest of all layers and lags: {together}"),
        Column("smallest_p", pa.float64(), "1", "smallest p that this number of experiments can reach"),
    )


_AGAINST_0 = _p(
    "share of turned signs of whole experiments with a curve at least as far from 0",
    "up to 0.05 the correlation is not by chance",
)
_WHERE: Columns = (CONDITION, _CURVE, LAYER, _LAG, _LAG_S)

POOLED_TABLES: dict[str, Columns] = {
    "studies": (
        INPUT,
        Column(
            "status",
            pa.string(),
            "",
            "ok: correlated now; kept: from before; refused, or left out: the reason says why",
        ),
        Column("reason", pa.string(), "", "why the study has no correlation; empty if it has one"),
        Column("cells", pa.int64(), "", "number of its cells that are pooled"),
    ),
    "cells": (
        INPUT,
        CELL,
        CONDITION,
        EXPERIMENT,
        Column("status", pa.string(), "", "ok, refused by the correlation, or left out of the pool"),
        Column("reason", pa.string(), "", "why the cell is left out; empty if it is not"),
        Column("qc_flags", pa.string(), "", "names of the QC flags of its correlation, with ; between"),
        Column("frames", pa.int64(), "", "number of frames that were used"),
        Column(
            "geometry_not_tested",
            pa.string(),
            "",
            "why geometry could not be regressed out; empty if it was, or was not to be",
        ),
    ),
    "curves": (
        INPUT,
        CELL,
        CONDITION,
        EXPERIMENT,
        LAYER,
        _LAG,
        _LAG_S,
        Column("correlation", pa.float64(), "1", "mean over the layer's sectors of the cell's correlation"),
        Column("correlation_partial", pa.float64(), "1", "the same with the controls regressed out"),
    ),
    "experiments": (
        CONDITION,
        EXPERIMENT,
        _CURVE,
        LAYER,
        _LAG,
        _LAG_S,
        Column("correlation", pa.float64(), "1", "mean over the cells of the experiment, as a correlation"),
        _CELLS,
    ),
    "pooled": (*_WHERE, *_POOLED, *_AGAINST_0),
    "peaks": (*_WHERE, *_POOLED, *_AGAINST_0),
    "comparisons": (
        CONDITION._replace(meaning="the condition that is compared with the control"),
        CONTROL,
        _CURVE,
        LAYER,
        _LAG,
        _LAG_S,
        Column("difference", pa.float64(), "1", "difference of the mean curves in Fisher's z"),
        Column("difference_low", pa.float64(), "1", "lower end of its 95 % interval"),
        Column("difference_high", pa.float64(), "1", "upper end of its 95 % interval"),
        Column("n_control", pa.int64(), "", "number of experiments of the control with a value"),
        Column("n_treated", pa.int64(), "", "number of experiments of the condition with a value"),
        *_p(
            "share of relabelled experiments with at least such a difference",
            "up to 0.05 the conditions differ",
        ),
        Column(
            "p_holm",
            pa.float64(),
            "1",
            "p_fwer corrected for the number of conditions that are compared with the control (Holm)",
        ),
        Column("comparisons", pa.int64(), "", "number of conditions that were compared with the control"),
    ),
}
"""Columns of each table by its name; comparisons is there where there are two conditions."""

"""Columns of the tables of a prediction, and what they mean."""

from __future__ import annotations

import pyarrow as pa

from cytodisk.store.tables import CELL, LAYER, Column, Columns

_SOURCE = Column("source", pa.string(), "", "the signal whose past is tested: a channel or velocity")
_TARGET = Column("target", pa.string(), "", "the signal that is predicted: a channel or velocity")
_GAIN = Column(
    "gain",
    pa.float64(),
    "nat",
    "ln(error without / error with the source's past), errors as sums of squares; 0.05 is 5 % less error",
)
_EXCESS = Column(
    "gain_excess",
    pa.float64(),
    "nat",
    "gain less the mean gain of shifted sources: 0 on average where nothing predicts",
)
_P = Column(
    "p", pa.float64(), "1", "share of shifted sources with at least this gain; the real one counts too"
)
_THRESHOLD = Column("threshold", pa.float64(), "nat", "gain that 5 % of the shifted sources exceed")
_PARTIAL = "with what geometry alone would give regressed out; empty if that could not be made"

_REVERSED = Column(
    "gain_reversed",
    pa.float64(),
    "nat",
    "gain of the same source on reversed time, where what is true turns around",
)
_WEAKER = Column(
    "weaker",
    pa.bool_(),
    "",
    "q < 0.05, but the other direction is stronger, and noise of measurement alone would make this one: "
    "it gains less than half of gain_reversed, and the other one more than its own",
)

LINKS: Columns = (
    CELL,
    _SOURCE,
    _TARGET,
    Column("given", pa.string(), "", "signals whose past was given too, with commas between; empty for none"),
    LAYER,
    _GAIN,
    _EXCESS,
    Column("likelihood_ratio", pa.float64(), "1", "twice the difference of log-likelihoods: n times gain"),
    Column("order", pa.int64(), "frame", "length of the target's own past in the model"),
    Column("source_order", pa.int64(), "frame", "length of the source's past in the model"),
    Column(
        "effect",
        pa.float64(),
        "1",
        "sum of the coefficients of the source's past, for series of standard deviation 1: its sign says "
        "whether more source is followed by more target (+) or less (-)",
    ),
    Column("n", pa.int64(), "", "number of rows of the model: frames times sectors"),
    _P,
    Column("q", pa.float64(), "1", "p, adjusted for all rows of the cell (Benjamini and Hochberg)"),
    _THRESHOLD,
    Column("gain_partial", pa.float64(), "nat", f"gain {_PARTIAL}"),
    Column("gain_excess_partial", pa.float64(), "nat", f"gain_excess {_PARTIAL}"),
    Column("p_partial", pa.float64(), "1", f"p {_PARTIAL}"),
    Column("q_partial", pa.float64(), "1", f"q {_PARTIAL}"),
    Column(
        "geometry",
        pa.bool_(),
        "",
        "q < 0.05, but not without geometry, or less than a quarter of gain_excess is left without it",
    ),
    _REVERSED,
    _WEAKER,
    Column(
        "stress",
        pa.string(),
        "",
        "what makes p of independent series too small, with commas between: common pulse, restless episode, "
        "variance change, steady oscillation, heavy tails; empty for nothing",
    ),
    Column("drifting", pa.float64(), "1", "share of series that drift, of source or target, the lesser"),
    Column("status", pa.string(), "", "ok or refused"),
    Column(
        "reason",
        pa.string(),
        "",
        "why the link could not be tested in this layer, or not without geometry; empty if it was",
    ),
)

LAGS: Columns = (
    CELL,
    _SOURCE,
    _TARGET,
    LAYER,
    Column("lag", pa.int64(), "frame", "how many frames the source comes before the target"),
    Column("lag_s", pa.float64(), "s", "the lag in seconds; empty if the frame interval is unknown"),
    Column(
        "coefficient",
        pa.float64(),
        "1",
        "coefficient of the source at this lag, for series of standard deviation 1",
    ),
    Column("low", pa.float64(), "1", "lower end of its 95 % confidence interval"),
    Column("high", pa.float64(), "1", "upper end of its 95 % confidence interval"),
)

POOLED: Columns = (
    _SOURCE,
    _TARGET,
    Column("given", pa.string(), "", "signals whose past was given too, with commas between; empty for none"),
    LAYER,
    Column("cells", pa.int64(), "", "number of cells in which the link was tested"),
    _GAIN._replace(meaning="mean gain of the cells, each weighted by its rows"),
    _EXCESS._replace(meaning="mean gain_excess of the cells, each weighted by its rows"),
    _P._replace(meaning="share of sums over cells of shifted sources with at least this sum of gains"),
    Column("q", pa.float64(), "1", "p, adjusted for all rows of the table (Benjamini and Hochberg)"),
    _THRESHOLD._replace(meaning="mean gain that 5 % of the sums of shifted sources exceed"),
    _REVERSED._replace(meaning="mean gain_reversed of the cells, each weighted by its rows"),
    _WEAKER,
)

CELLS: Columns = (
    CELL,
    Column("status", pa.string(), "", "ok or refused"),
    Column("reason", pa.string(), "", "why the cell is left out; empty if it is not"),
    Column(
        "qc_flags",
        pa.string(),
        "",
        "names of the QC flags of this prediction that the cell has, with ; between, as jitter",
    ),
    Column("frames", pa.int64(), "", "number of frames that were used"),
    Column("gaps", pa.int64(), "", "frames among them without a value of any window, or of velocity"),
    Column("surrogates", pa.int64(), "", "number of shifted sources, of the link with fewest"),
    Column(
        "jitter",
        pa.float64(),
        "1",
        "step of the correlation with velocity between lags -1 and 0, as jitter of the masks makes it; 0 for "
        "none; empty if unknown",
    ),
    Column(
        "velocity_jitter",
        pa.float64(),
        "1",
        "share of velocity's variance that jitter of the masks makes; empty without velocity, or few frames",
    ),
    Column(
        "partial_frames",
        pa.float64(),
        "",
        "frames in which a window's signal and controls have values, median over windows, of the signal with "
        "fewest",
    ),
    Column(
        "geometry_not_tested",
        pa.string(),
        "",
        "why geometry could not be regressed out; empty if it was, or was not to be",
    ),
    Column("restarts", pa.int64(), "", "number of frames in which tracking started anew"),
    Column("drifting", pa.float64(), "1", "largest drifting of a link"),
    Column("not_given", pa.string(), "", "signals of the study that were neither tested nor given"),
)

PREDICTION_TABLES: dict[str, Columns] = {"links": LINKS, "lags": LAGS, "pooled": POOLED, "cells": CELLS}
"""Columns of each table by its name."""

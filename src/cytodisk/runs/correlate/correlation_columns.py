"""Columns of the tables of a correlation, and what they mean."""

from __future__ import annotations

import pyarrow as pa

from cytodisk.runs.correlate.stress_columns import STRESS_COLUMNS
from cytodisk.store.tables import CELL, LAYER, SECTOR, Column, Columns

_LAG = Column("lag", pa.int64(), "frame", "lag in frames; positive: what stands after --with comes later")
_LAG_S = Column("lag_s", pa.float64(), "s", "the lag in seconds; empty if the frame interval is unknown")
_N = Column("n", pa.int64(), "", "number of frame pairs at this lag")
_N_EFFECTIVE = Column(
    "n_effective", pa.float64(), "", "effective number of independent frame pairs, after autocorrelation"
)
_LOW, _HIGH = (
    Column(name, pa.float64(), "1", f"{side} end of the 95 % confidence interval of a lag chosen beforehand")
    for name, side in (("low", "lower"), ("high", "upper"))
)
_P = Column(
    "p",
    pa.float64(),
    "1",
    "share of surrogates with a correlation of at least this size at any lag; small means: not by chance",
)
_Q = Column("q", pa.float64(), "1", "p, adjusted for the number of rows of the cell (Benjamini and Hochberg)")
_THRESHOLD = Column("threshold", pa.float64(), "1", "size of correlation that 5 % of the surrogates exceed")
_CORRELATION = Column("correlation", pa.float64(), "1", "correlation at the peak")
_AT_LAG = Column("correlation", pa.float64(), "1", "correlation at this lag")
_WITHOUT = "once the controls are regressed out; empty if they could not be made"
_PARTIAL: Columns = (
    Column("correlation_partial", pa.float64(), "1", f"correlation at its own peak, {_WITHOUT}"),
    Column("lag_partial", pa.int64(), "frame", "lag of correlation_partial"),
    Column("p_partial", pa.float64(), "1", "p of correlation_partial"),
    Column("q_partial", pa.float64(), "1", "q of correlation_partial"),
    Column(
        "geometry",
        pa.bool_(),
        "",
        "q < 0.05, but not without the controls, or they leave less than half of the correlation at its lag",
    ),
)
_PARTIAL_AT_LAG = Column("correlation_partial", pa.float64(), "1", f"correlation at this lag, {_WITHOUT}")


def _quartiles(over: str) -> Columns:
    return tuple(
        Column(f"{side}_quartile", pa.float64(), "1", f"{side} quartile of the correlation over {over}")
        for side in ("lower", "upper")
    )


CORRELATION_TABLES: dict[str, Columns] = {
    "windows": (
        CELL,
        LAYER,
        SECTOR,
        _CORRELATION,
        _LAG,
        _LAG_S,
        _N,
        _N_EFFECTIVE,
        _LOW,
        _HIGH,
        _P,
        _Q,
        _THRESHOLD,
        *_PARTIAL,
        Column(
            "cluster",
            pa.int64(),
            "",
            "number of the cluster the window is in, of several that of the largest mass; 0 for none",
        ),
    ),
    "clusters": (
        CELL,
        Column("cluster", pa.int64(), "", "number of the cluster, from 1, the largest mass first"),
        _LAG,
        _LAG_S,
        Column("sign", pa.int64(), "", "1 where the correlation is positive, -1 where it is negative"),
        _AT_LAG._replace(meaning="mean correlation of its windows at this lag"),
        Column("windows", pa.int64(), "", "number of windows"),
        Column(
            "mass", pa.float64(), "1", "sum over its windows of what their scores exceed the threshold by"
        ),
        _P._replace(meaning="share of surrogates with a cluster of at least this mass anywhere, at any lag"),
        Column("layers", pa.string(), "", "its layers, such as 0–2"),
        Column("sectors", pa.string(), "", "its sectors, such as 12–25; 50–5 goes on over the last"),
        Column(
            "p_partial",
            pa.float64(),
            "1",
            "p of the cluster there, at its lag, with controls regressed out; 1 if there is none",
        ),
    ),
    "layers": (
        CELL,
        LAYER,
        _CORRELATION._replace(meaning="mean over the layer's sectors of the correlation, at its peak"),
        _LAG,
        _LAG_S,
        _P,
        _Q,
        _THRESHOLD,
        *_PARTIAL,
    ),
    "curves": (CELL, LAYER, SECTOR, _LAG, _LAG_S, _AT_LAG, _N, _N_EFFECTIVE, _LOW, _HIGH, _PARTIAL_AT_LAG),
    "layer_curves": (
        CELL,
        LAYER,
        _LAG,
        _LAG_S,
        _AT_LAG._replace(meaning="mean over the layer's sectors of the correlation at this lag"),
        *_quartiles("the layer's sectors"),
        _THRESHOLD,
        _PARTIAL_AT_LAG,
    ),
    "pairs": (
        CELL,
        Column(
            "along",
            pa.string(),
            "",
            "straight; interior: the way inside the cell; edge: along the edge",
        ),
        Column("distance", pa.float64(), "length", "distance of the two windows, middle of its bin"),
        _LAG,
        _LAG_S,
        _AT_LAG._replace(meaning="mean correlation of the pairs of windows at this distance and lag"),
        Column("sd", pa.float64(), "1", "standard deviation of the correlation over those pairs"),
        *_quartiles("those pairs"),
        Column("n", pa.int64(), "", "number of pairs of windows"),
        Column("null_low", pa.float64(), "1", "95 % of the surrogates lie between null_low"),
        Column("null_high", pa.float64(), "1", "and null_high"),
        _THRESHOLD,
    ),
    "events": (
        CELL,
        SECTOR,
        Column("kind", pa.string(), "", "protrusion or retraction"),
        Column("onset", pa.int64(), "frame", "frame in which the motion starts"),
        Column("end", pa.int64(), "frame", "frame in which the motion has stopped or turned"),
        Column("peak", pa.int64(), "frame", "frame of the fastest step"),
        Column("onset_s", pa.float64(), "s", "time of the onset"),
        Column("end_s", pa.float64(), "s", "time of the end"),
        Column("peak_s", pa.float64(), "s", "time of the peak"),
        Column("duration", pa.float64(), "s", "time from onset to end; in frames if the interval is unknown"),
        Column(
            "peak_velocity",
            pa.float64(),
            "velocity",
            "velocity of the fastest step; negative for retraction",
        ),
        Column("mean_velocity", pa.float64(), "velocity", "mean velocity of the event"),
        Column("area", pa.float64(), "length²", "area won (positive) or lost (negative) in the event"),
        Column("onset_known", pa.bool_(), "", "whether the movie shows the onset"),
        Column("end_known", pa.bool_(), "", "whether the movie shows the end"),
        Column("complete", pa.bool_(), "", "whether the movie shows both"),
        Column("patch", pa.int64(), "", "number of the patch: events side by side at the same time"),
    ),
    "event_averages": (
        CELL,
        Column("kind", pa.string(), "", "protrusion or retraction"),
        LAYER,
        Column("delay", pa.int64(), "frame", "frames after the onset; negative: before it"),
        Column("delay_s", pa.float64(), "s", "the delay in seconds"),
        Column("mean", pa.float64(), "a.u.", "mean of the signal over events, each without its own mean"),
        Column("lower", pa.float64(), "a.u.", "lower end of the 95 % band; empty with fewer than 5 patches"),
        Column("upper", pa.float64(), "a.u.", "upper end of the 95 % band"),
        Column("n", pa.int64(), "", "number of events"),
        Column("n_patches", pa.int64(), "", "number of patches"),
    ),
    "cells": (
        CELL,
        Column("status", pa.string(), "", "ok or refused"),
        Column("reason", pa.string(), "", "why the cell is left out; empty if it is not"),
        Column(
            "qc_flags",
            pa.string(),
            "",
            "names of the QC flags of this correlation that the cell has, with ; between, as jitter",
        ),
        Column("statistic", pa.string(), "", "pearson: of values; spearman: of ranks"),
        Column("frames", pa.int64(), "", "number of frames that were used"),
        Column(
            "jitter",
            pa.float64(),
            "1",
            "step of the correlation between lags -1 and 0, as jitter of the masks makes it; 0 for none",
        ),
        Column(
            "velocity_jitter",
            pa.float64(),
            "1",
            "share of velocity's variance that jitter of the masks makes; empty for signals, or few frames",
        ),
        Column("surrogates", pa.int64(), "", "number of surrogates of the windows and layers"),
        Column(
            "cluster_surrogates", pa.int64(), "", "number of surrogates of the clusters; 0 for no clusters"
        ),
        Column("pair_surrogates", pa.int64(), "", "number of surrogates of the pairs"),
        Column(
            "partial_frames",
            pa.float64(),
            "",
            "frames in which a window's signal and controls have values, median over windows",
        ),
        Column(
            "geometry_not_tested",
            pa.string(),
            "",
            "why geometry could not be regressed out; empty if it was, or was not to be",
        ),
        Column("restarts", pa.int64(), "", "number of frames in which tracking started anew"),
        Column("drifting_signal", pa.float64(), "1", "share of the signal's series that drift"),
        Column("drifting_with", pa.float64(), "1", "share of the other series that drift"),
        *STRESS_COLUMNS,
        Column("no_events_because", pa.string(), "", "why there are no events; empty if there are"),
        Column("event_threshold", pa.float64(), "velocity", "smallest peak velocity of an event"),
        Column("event_noise", pa.float64(), "velocity", "standard deviation of the velocity's noise"),
    ),
}
"""Columns of each table by its name; tables hold those that were asked for and are known."""

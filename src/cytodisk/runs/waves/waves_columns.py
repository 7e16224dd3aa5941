"""Columns of the tables of waves, and what they mean."""

from __future__ import annotations

import pyarrow as pa

from cytodisk.store.tables import ALL_QC_FLAGS, CELL, FRAME, LAYER, SECTOR, TIME_S, Column, Columns

_LAYER = LAYER._replace(
    meaning="layer of the windows, 0 at the cell's edge; empty where the edge's velocity was looked at"
)
_CLOCKWISE = "positive towards higher sectors, which is clockwise in the cell's image"
_MODE = Column("mode", pa.int64(), "", "number of waves around the cell; 0: the whole edge at once")

WAVE_COLUMNS: Columns = (
    Column(
        "kind",
        pa.string(),
        "",
        "rotating, standing, oscillating (the whole edge at once), or none (p is above 0.05)",
    ),
    Column("way", pa.string(), "", "clockwise or anticlockwise as seen in the image; empty if neither"),
    _MODE,
    Column("period", pa.float64(), "frame", "time from crest to crest at one place of the edge, in frames"),
    Column("period_s", pa.float64(), "s", "the same in seconds; empty if the frame interval is unknown"),
    Column("shortest_period", pa.float64(), "frame", "shortest period that was looked for"),
    Column("longest_period", pa.float64(), "frame", "longest period that was looked for"),
    Column(
        "speed",
        pa.float64(),
        "1/s",
        f"turns around the cell in a second, {_CLOCKWISE}; empty if the frame interval is unknown",
    ),
    Column(
        "edge_speed",
        pa.float64(),
        "velocity",
        f"speed along the edge, {_CLOCKWISE}; empty for mode 0, and for layers of which every frame has an "
        "empty window",
    ),
    Column(
        "speed_um_s",
        pa.float64(),
        "µm/s",
        "the same in µm/s; empty if the pixel size or the frame interval is unknown",
    ),
    Column(
        "direction",
        pa.float64(),
        "1",
        "1: all waves run towards higher sectors (clockwise), -1: all the other way, 0: standing",
    ),
    Column("persistence_s", pa.float64(), "s", "time over which the wave keeps its course"),
    Column(
        "order",
        pa.float64(),
        "1",
        "order score: how far the wave is beyond surrogates; 0 ± 1 without waves, in movies of any length",
    ),
    Column(
        "p",
        pa.float64(),
        "1",
        "share of surrogates, which keep the spectrum of each sector, with at least this order",
    ),
    Column("q", pa.float64(), "1", "p, adjusted for the layers of the cell (Benjamini and Hochberg)"),
    Column(
        "order_partial",
        pa.float64(),
        "1",
        "order score of what the motion of the cell alone does not give; empty without a wave, where it was "
        "not asked, or for velocity with one wave around, which is a motion of the whole cell",
    ),
    Column("p_partial", pa.float64(), "1", "p of order_partial"),
)
"""What a wave is; both in the table of layers and, of the chosen layer, in that of cells."""

_STATUS: Columns = (
    Column("status", pa.string(), "", "ok, or refused"),
    Column("reason", pa.string(), "", "why it was left out; empty if it was not"),
)

_INWARD = Column("inward_speed", pa.float64(), "velocity", "speed towards the inside; negative: outwards")
_AROUND = Column("around_speed", pa.float64(), "velocity", f"speed around the cell, {_CLOCKWISE}")

_INSIDE: Columns = (
    Column(
        "inside",
        pa.string(),
        "",
        "what the wave through all layers does: inwards, outwards, around, spiral (around, and in or out), "
        "standing or none; empty for velocity",
    ),
    Column(
        "inside_way", pa.string(), "", "clockwise or anticlockwise as seen in the image; empty if neither"
    ),
    Column("inside_mode", pa.int64(), "", "number of its waves around the cell"),
    Column("inside_period", pa.float64(), "frame", "its time from crest to crest, in frames"),
    _INWARD._replace(meaning="its speed towards the inside, negative outwards; empty if it runs neither way"),
    _AROUND._replace(meaning=f"its speed along the edge, {_CLOCKWISE}; empty if it does not run around"),
    Column("inside_order", pa.float64(), "1", "order score of the wave through all layers"),
    Column("p_inside", pa.float64(), "1", "its p"),
    Column("p_inside_partial", pa.float64(), "1", "its p without what the motion of the cell alone gives"),
    Column("no_inside_because", pa.string(), "", "why it could not be looked for; empty if it was"),
)
"""The wave through all layers of a signal at once."""

WAVE_TABLES: dict[str, Columns] = {
    "cells": (
        CELL,
        *_STATUS,
        ALL_QC_FLAGS._replace(meaning="names of the QC flags of the cell's waves, with ; between"),
        _LAYER._replace(meaning="layer that the numbers are of; empty for the edge's velocity"),
        *WAVE_COLUMNS,
        *_INSIDE,
        Column("frames", pa.int64(), "", "frames that were used"),
        Column("periods", pa.float64(), "1", "how many periods the movie holds"),
        Column("edge_length", pa.float64(), "length", "length of the edge, median over frames"),
        Column("surrogates", pa.int64(), "", "number of surrogates that p comes from"),
        Column("drifting", pa.float64(), "1", "share of the series of the chosen layer whose level drifts"),
        Column(
            "jitter",
            pa.float64(),
            "1",
            "share of velocity's variance that masks that jitter make; empty for signals, or too few frames",
        ),
        Column("restarts", pa.int64(), "", "how often tracking started anew within the frames"),
        Column(
            "geometry_not_tested",
            pa.string(),
            "",
            "why it is not known what the motion of the cell alone gives; empty if it is, or was not asked",
        ),
    ),
    "layers": (CELL, _LAYER, *WAVE_COLUMNS, *_STATUS),
    "modes": (
        CELL,
        _LAYER,
        _MODE,
        Column(
            "power", pa.float64(), "1", "share of the variance that is in this mode, at periods looked for"
        ),
        Column("threshold", pa.float64(), "1", "share that 5 % of the surrogates exceed"),
    ),
    "spectrum": (
        CELL,
        _LAYER,
        _MODE._replace(meaning=f"number of waves around the cell, {_CLOCKWISE}; 0: the whole edge at once"),
        Column("frequency", pa.float64(), "1/frame", "frequency in periods a frame"),
        Column("frequency_hz", pa.float64(), "1/s", "the same a second; empty if the interval is unknown"),
        Column("power", pa.float64(), "1", "share of the layer's variance"),
    ),
    "phase": (
        CELL,
        _LAYER,
        FRAME,
        TIME_S,
        SECTOR,
        Column(
            "phase",
            pa.float64(),
            "rad",
            "phase of the wave that was found: 0 at a crest, π where it is lowest",
        ),
        Column(
            "amplitude", pa.float64(), "", "half the way from its lowest to its crest, in the signal's unit"
        ),
        Column(
            "phase_inside",
            pa.float64(),
            "rad",
            "phase of the wave through all layers at once; empty for velocity",
        ),
        Column("amplitude_inside", pa.float64(), "", "its amplitude there, in the signal's unit"),
    ),
    "depths": (
        CELL,
        LAYER,
        Column("depth", pa.float64(), "length", "median depth of the layer's windows below the edge"),
        Column("lag", pa.float64(), "frame", "by how much the wave is later than in the first layer"),
        Column("lag_s", pa.float64(), "s", "the lag in seconds; empty if the frame interval is unknown"),
        _INWARD._replace(
            meaning="speed of the wave from layer to layer, positive inwards; empty if it runs neither way"
        ),
        _AROUND._replace(
            meaning=f"speed along the layer, {_CLOCKWISE}; empty if the wave does not run around"
        ),
        Column("direction", pa.float64(), "1", "as in layers.parquet, of the wave through all layers"),
        Column("power", pa.float64(), "1", "share of the wave's variance that is in this layer"),
    ),
}

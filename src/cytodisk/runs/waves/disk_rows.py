"""The wave through all layers of a cell as rows of tables: inwards, around or both, and how fast by depth."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.analysis.waves.disk_waves import disk_waves
from cytodisk.analysis.waves.waves_parameters import WaveSearchParameters
from cytodisk.arrays import FloatArray
from cytodisk.runs.run_options import Progress
from cytodisk.runs.waves.cell_wave_series import WaveSeries
from cytodisk.runs.waves.layer_waves import LayerWaves

_IN_DEPTH, _AROUND = ("inwards", "outwards", "spiral"), ("around", "spiral")

NOT_INSIDE: dict[str, Any] = {
    "inside": "",
    "inside_way": "",
    "inside_mode": None,
    **dict.fromkeys(
        (
            "inside_period",
            "inward_speed",
            "around_speed",
            "inside_order",
            "p_inside",
            "p_inside_partial",
        ),
        math.nan,
    ),
    "no_inside_because": "",
}
"""Of what has no layers, as the edge's velocity."""


def disk_wave(
    series: WaveSeries, values: xr.DataArray, looking: LayerWaves, progress: Progress | None = None
) -> xr.Dataset:
    """The wave through all layers.

    Parameters
    ----------
    series : WaveSeries
    values : DataArray with dims (time, layer, sector)
        Its own, or what is left of them.
    looking : LayerWaves
    progress : callable, optional

    Raises
    ------
    ParameterError
        As for `disk_waves`.
    """
    way = series.way(None)
    return disk_waves(
        values,
        frame_interval_s=looking.step,
        edge_length_um=way if np.isfinite(way).any() else None,
        depth_um=_depths(series),
        progress=progress,
        **dict(looking.options.part(WaveSearchParameters)),
    )


def inside_row(found: xr.Dataset, looking: LayerWaves) -> dict[str, Any]:
    """Its numbers, as in `NOT_INSIDE`, in the units of the study."""
    mode = int(found["mode"])
    kind = str(found["kind"].item())
    turns = kind in _AROUND
    return NOT_INSIDE | {
        "inside": kind,
        "inside_way": ("clockwise" if found["direction"] > 0 else "anticlockwise") if turns else "",
        "inside_mode": mode,
        "inside_period": float(found["period_s"]) / looking.step,
        "inward_speed": float(found["inward_speed_um_s"]) if kind in _IN_DEPTH else math.nan,
        "around_speed": float(found["speed_um_s"]) if turns else math.nan,
        "inside_order": float(found["order"]),
        "p_inside": float(found["p"]),
    }


def depth_table(found: xr.Dataset, series: WaveSeries, looking: LayerWaves) -> pd.DataFrame:
    """A row for each layer: its depth, and how the wave runs there."""
    kind, count = str(found["kind"].item()), len(series.layers)
    unknown = np.full(count, np.nan)
    turns = found["layer_speed"].to_numpy() * [_around(series, layer) for layer in series.layers]
    inward = found["layer_inward_speed_um_s"].to_numpy()
    lag = found["layer_lag_s"].to_numpy()
    seconds = 1.0 if looking.scale.frame_interval_s is not None else math.nan
    depth = _depths(series)
    return pd.DataFrame(
        {
            "layer": series.layers,
            "depth": unknown if depth is None else depth,
            "lag": lag / looking.step,
            "lag_s": lag * seconds,
            "inward_speed": inward if kind in _IN_DEPTH else unknown,
            "around_speed": turns if kind in _AROUND else unknown,
            "direction": found["layer_direction"].to_numpy(),
            "power": found["layer_power"].to_numpy(),
        }
    )


def _depths(series: WaveSeries) -> FloatArray | None:
    """Median depth of each layer, shape (L,); None in a study of windows without depths."""
    if "depth" not in series.activity:
        return None
    depth = series.activity["depth"].transpose("layer", "time", "sector").to_numpy()
    return np.asarray(np.nanmedian(depth.reshape(len(depth), -1), axis=1), dtype=np.float64)


def _around(series: WaveSeries, layer: int | None) -> float:
    """Length of the way around in a layer, median over frames."""
    whole = series.way(layer).sum(axis=1)
    return float(np.nanmedian(whole)) if np.isfinite(whole).any() else math.nan

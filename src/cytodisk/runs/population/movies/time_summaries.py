"""Mean, spread and edge velocity of a movie's cell over time."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.errors import NoValuesError

LEAST_FRAMES = {"mean": 5, "sd": 10, "velocity": 5}
"""Fewest frames with values that each summary is made from."""

_LEAST_SHARE = 0.5  # of the frames used, in which a window must have a value
EDGE = "edge"


def over_time(activity: xr.Dataset, summary: str, channels: list[str]) -> xr.DataArray:
    """Mean or standard deviation over frames of each window, NaN where it seldom has a value.

    Parameters
    ----------
    activity : Dataset
        Of one cell of a study.
    summary : {"mean", "sd"}
        The standard deviation is that of the sample (n − 1). It holds what drifts, too, such as bleaching.
    channels : list of str

    Returns
    -------
    DataArray with dims (channel, layer, sector)

    Raises
    ------
    NoValuesError
        Too few frames have values.
    """
    used = frames_used(activity, summary)
    signal = activity["mean"].sel(channel=channels).isel(time=used)
    values = _of_time(signal.transpose("time", "channel", "layer", "sector").to_numpy(), summary)
    coords = {name: activity[name] for name in ("layer", "sector") if name in activity.coords}
    found = xr.DataArray(
        values, dims=("channel", "layer", "sector"), coords=coords | {"channel": channels}, name=summary
    )
    if "compartment" in activity:
        found = found.assign_coords(compartment=("layer", activity["compartment"].to_numpy().astype(object)))
    return _told(found, activity, used, str(activity["mean"].attrs.get("units", "a.u.")))


def mean_velocity(activity: xr.Dataset) -> xr.DataArray:
    """Mean velocity of the edge by sector; its one layer is the edge.

    Parameters
    ----------
    activity : Dataset
        Of one cell of a study.

    Returns
    -------
    DataArray with dims (channel, layer, sector)
        The channel is "velocity", the layer 0 of compartment "edge".

    Raises
    ------
    NoValuesError
        Too few steps between frames have a velocity.
    """
    velocity = activity["velocity"]
    used = frames_used(activity, "velocity")
    values = _of_time(velocity.isel(time=used).transpose("time", "sector").to_numpy(), "velocity")
    found = xr.DataArray(
        values[None, None],
        dims=("channel", "layer", "sector"),
        coords={
            "channel": ["velocity"],
            "layer": [0],
            "sector": activity["sector"].to_numpy(),
            "compartment": ("layer", np.array([EDGE], dtype=object)),
        },
        name="velocity",
    )
    return _told(found, activity, used, str(velocity.attrs.get("units", "px/frame")))


def frames_used(activity: xr.Dataset, summary: str) -> Any:
    """Which frames have a map, and values of what is summarised; shape (time,).

    Raises
    ------
    NoValuesError
        They are too few.
    """
    measured = activity["velocity" if summary == "velocity" else "mean"]
    values = measured.transpose("time", ...).to_numpy().reshape(measured.sizes["time"], -1)
    used = (activity["status"].to_numpy() == "ok") & np.isfinite(values).any(axis=1)
    if (number := int(used.sum())) < LEAST_FRAMES[summary]:
        what = "steps of the edge" if summary == "velocity" else "frames"
        raise NoValuesError(
            f"{number} of {len(used)} {what} have values, the {summary} over time needs at least "
            f"{LEAST_FRAMES[summary]}"
        )
    return used


def _of_time(values: FloatArray, summary: str) -> FloatArray:
    """Mean or standard deviation over the first axis; NaN where fewer than half of it are known."""
    known = np.isfinite(values)
    count = known.sum(axis=0)
    enough = count >= max(2, _LEAST_SHARE * len(values))
    mean = np.where(known, values, 0.0).sum(axis=0) / np.maximum(count, 1)
    if summary == "sd":
        squares = np.where(known, values - mean, 0.0) ** 2
        return np.asarray(np.where(enough, np.sqrt(squares.sum(axis=0) / np.maximum(count - 1, 1)), np.nan))
    return np.asarray(np.where(enough, mean, np.nan))


def _told(found: xr.DataArray, activity: xr.Dataset, used: Any, units: str) -> xr.DataArray:
    """The values with the areas of their windows, their unit, and how many frames they are from."""
    if found.sizes["layer"] == activity.sizes["layer"] and EDGE not in _compartments(found):
        area = activity["area"].isel(time=used).mean("time").transpose("layer", "sector")
        found = found.assign_coords(area=(("layer", "sector"), area.to_numpy(), activity["area"].attrs))
    return found.assign_attrs(units=units, frames=int(used.sum()), of_frames=len(used))


def _compartments(found: xr.DataArray) -> list[str]:
    return found["compartment"].to_numpy().tolist() if "compartment" in found.coords else []

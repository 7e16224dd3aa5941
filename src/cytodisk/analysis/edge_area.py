"""Area that each sector of the edge wins or loses in each step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.time_steps import frame_seconds
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError

_SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0}


@dataclass(frozen=True, eq=False)
class StepAreas:
    """Area won, positive, or lost, negative, in each step.

    Attributes
    ----------
    values : ndarray of shape (T, S) and dtype float
        NaN where it is not known.
    unit : str
        Empty when no area is known.
    """

    values: FloatArray
    unit: str


def area_by_step(
    velocity: xr.DataArray,
    edge_length: xr.DataArray | None,
    protruded_area: xr.DataArray | None,
    retracted_area: xr.DataArray | None,
) -> StepAreas:
    """Area from counted pixels where they are passed, else from velocity and length of edge.

    Parameters
    ----------
    velocity, edge_length, protruded_area, retracted_area : DataArray with dims time and sector
        As in `edge_events`; the others have the frames and sectors of the velocity and say their unit.

    Returns
    -------
    StepAreas

    Raises
    ------
    ParameterError
        They do not fit each other, one of the two areas is missing, or the units make no area.
    """
    if (protruded_area is None) != (retracted_area is None):
        raise ParameterError("protruded_area and retracted_area go together: pass both or none")
    if protruded_area is not None:
        won, won_unit = _fitting(protruded_area, "protruded_area", velocity)
        lost, lost_unit = _fitting(retracted_area, "retracted_area", velocity)
        if won_unit != lost_unit:
            raise ParameterError(
                f"protruded_area is in {won_unit}, retracted_area in {lost_unit}: pass one unit"
            )
        return StepAreas(won - lost, won_unit)
    if edge_length is None:
        return StepAreas(np.full((velocity.sizes["time"], velocity.sizes["sector"]), np.nan), "")
    length, unit = _fitting(edge_length, "edge_length", velocity)
    speed = velocity.transpose("time", "sector").to_numpy()
    return StepAreas(speed * length * _durations(velocity, unit)[:, None], f"{unit}²")


def _fitting(array: Any, name: str, velocity: xr.DataArray) -> tuple[FloatArray, str]:
    if not isinstance(array, xr.DataArray) or dict(array.sizes) != dict(velocity.sizes):
        came = dict(array.sizes) if isinstance(array, xr.DataArray) else type(array).__name__
        raise ParameterError(
            f"{name} must be a DataArray of the frames and sectors of velocity, {dict(velocity.sizes)}, "
            f"got {came}"
        )
    for what in ("frame", "time", "sector"):
        both = what in array.coords and what in velocity.coords
        if both and not np.array_equal(array[what].to_numpy(), velocity[what].to_numpy()):
            raise ParameterError(f"{name} and velocity differ in the numbers of their {what}s: pass the same")
    if not array.attrs.get("units"):
        raise ParameterError(f"{name}.attrs has no 'units': set it, as in {name}.assign_attrs(units='µm')")
    return array.transpose("time", "sector").to_numpy().astype(np.float64), str(array.attrs["units"])


def _durations(velocity: xr.DataArray, length_unit: str) -> FloatArray:
    """Length of each step in the unit of time of the velocity, shape (T,)."""
    units = str(velocity.attrs["units"])
    length, _, per = units.partition("/")
    if length != length_unit or per not in (*_SECONDS, "frame"):
        raise ParameterError(
            f"velocity is in {units}, edge_length in {length_unit}: pass both in µm, or both in px, and the "
            f"velocity per frame, {', '.join(_SECONDS)}"
        )
    if per == "frame":
        return np.ones(velocity.sizes["time"])
    seconds = frame_seconds(velocity)
    if not np.isfinite(seconds).all():
        raise ParameterError(
            f"velocity is in {units} but has no seconds: give it the coordinate time_s, "
            "or leave edge_length out"
        )
    return np.asarray(np.diff(seconds) / _SECONDS[per])

"""Two sets of series side by side: parsed, named, and laid out for correlation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.time_steps import frame_coordinate, has_times
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.scale import Scale

_DIMS = ("time", "channel", "layer", "sector")
_NAMELESS = {1: ("time",), 2: ("time", "sector"), 3: ("time", "layer", "sector"), 4: _DIMS}


@dataclass(frozen=True, eq=False)
class Pair:
    """Series of `a` and `b` on common axes.

    Attributes
    ----------
    a : ndarray of shape (T, *B, *H)
    b : ndarray of shape (T, *B)
        What each series of `a` along H is compared with.
    own, others : tuple of str
        Dims of B, of H.
    coords : dict
        Of these dims, where there are any.
    """

    a: FloatArray
    b: FloatArray
    own: tuple[str, ...]
    others: tuple[str, ...]
    coords: dict[str, Any]

    @property
    def dims(self) -> tuple[str, ...]:
        """Dims of a window."""
        return self.own + self.others


def named_series(a: Any, b: Any) -> tuple[xr.DataArray, xr.DataArray, Scale]:
    """Two sets of series with names and the same frames, and their scale in time.

    Parameters
    ----------
    a, b : DataArray or array_like
        See `cross_correlate`.

    Returns
    -------
    a, b : DataArray with dims (time, …)
        Without coordinates that are not dims.
    scale : Scale
        Of time alone, from the coordinate time_s, where one of both has it.

    Raises
    ------
    ParameterError
        They are not numbers by time, have different frames or windows, or frames that are not evenly
        spaced.
    """
    (first, second), scale = aligned_series({"a": a, "b": b})
    return first, second, scale


def aligned_series(signals: Mapping[str, Any]) -> tuple[list[xr.DataArray], Scale]:
    """Sets of series with names and the same frames and windows, and their scale in time.

    Parameters
    ----------
    signals : mapping of str to DataArray or array_like
        As for `cross_correlate`, by their names in messages.

    Returns
    -------
    list of DataArray with dims (time, …)
        Without coordinates that are not dims.
    scale : Scale
        Of time alone, from the coordinate time_s, where one of them has it.

    Raises
    ------
    ParameterError
        As for `named_series`.
    """
    series = {name: _named(values, name) for name, values in signals.items()}
    steps = {name: _interval(values, name) for name, values in series.items()}
    known = [name for name, step in steps.items() if step is not None]
    for name in known[1:]:
        if steps[name] != steps[known[0]]:
            both = sorted({float(steps[one] or 0.0) for one in (known[0], name)})
            raise ParameterError(f"{known[0]} and {name} have other seconds between frames: {both}")
    for name_a, name_b in combinations(series, 2):  # dims that the first has not may differ between others
        _check_fit(name_a, series[name_a], name_b, series[name_b])
    plain = [values.reset_coords(drop=True) for values in series.values()]
    return plain, Scale(frame_interval_s=steps[known[0]] if known else None)


def _check_fit(name_a: str, a: xr.DataArray, name_b: str, b: xr.DataArray) -> None:
    """Refuse series of other frames or windows."""
    if a.sizes["time"] != b.sizes["time"]:
        raise ParameterError(
            f"{name_a} has {a.sizes['time']} frames, {name_b} {b.sizes['time']}: pass the same frames of both"
        )
    _check_same_frames(name_a, a, name_b, b)
    try:
        xr.align(a.reset_coords(drop=True), b.reset_coords(drop=True), join="exact")
    except (xr.AlignmentError, ValueError) as error:
        raise ParameterError(
            f"{name_a} and {name_b} do not have the same frames and windows: {error}"
        ) from error


def paired(a: xr.DataArray, b: xr.DataArray) -> Pair:
    """Lay out series so that those of `a` which share one of `b` lie side by side.

    Parameters
    ----------
    a, b : DataArray
        Of `named_series`.

    Returns
    -------
    Pair
        Its `own` dims always hold the sector, where there is one.
    """
    own = [str(dim) for dim in b.dims if dim != "time"]
    if "sector" in a.dims and "sector" not in own:
        own.append("sector")
    others = [str(dim) for dim in a.dims if dim not in ("time", *own)]
    sizes = dict(a.sizes) | dict(b.sizes)
    series_a = a.expand_dims({dim: sizes[dim] for dim in own if dim not in a.dims})
    series_b = b.expand_dims({dim: sizes[dim] for dim in own if dim not in b.dims})
    coords = {
        str(name): values for name, values in (a.coords | b.coords).items() if "time" not in values.dims
    }
    return Pair(
        series_a.transpose("time", *own, *others).to_numpy(),
        series_b.transpose("time", *own).to_numpy(),
        tuple(own),
        tuple(others),
        coords,
    )


def _named(values: Any, name: str) -> xr.DataArray:
    if isinstance(values, xr.Dataset):
        raise ParameterError(
            f"{name} is a Dataset: pass one of its variables, such as {name}['mean'].sel(channel=…)"
        )
    if not isinstance(values, xr.DataArray):
        array = np.asarray(values)
        if array.ndim not in _NAMELESS:
            raise ParameterError(
                f"{name} must have time first and up to three more axes, got shape {array.shape}"
            )
        values = xr.DataArray(array, dims=_NAMELESS[array.ndim])
    if "time" not in values.dims:
        raise ParameterError(f"{name} has the dims {list(values.dims)}: one must be time")
    if "lag" in values.dims or "surrogate" in values.dims:
        raise ParameterError(f"{name} has the dims {list(values.dims)}: pass series in time")
    if values.dtype.kind not in "biuf":
        raise ParameterError(f"{name} must hold numbers, got dtype {values.dtype}")
    if np.isinf(values).any():
        raise ParameterError(f"{name} holds infinite numbers: put NaN where there is no value")
    if not values.size:
        raise ParameterError(f"{name} is empty, shape {values.shape}: pass at least one frame and window")
    series: xr.DataArray = values.transpose("time", ...).astype(np.float64)
    return series


def _check_same_frames(name_a: str, a: xr.DataArray, name_b: str, b: xr.DataArray) -> None:
    """Refuse series that number their frames otherwise, one of them perhaps by frame, the other by time."""
    known_a, known_b = frame_coordinate(a), frame_coordinate(b)
    if known_a is None or known_b is None:
        return
    frames_a, frames_b = a[known_a].to_numpy(), b[known_b].to_numpy()
    if not np.array_equal(frames_a, frames_b):
        raise ParameterError(
            f"{name_a} and {name_b} do not have the same frames and windows: {known_a} of {name_a} begins "
            f"with {frames_a[0]}, {known_b} of {name_b} with {frames_b[0]}"
        )


def _interval(series: xr.DataArray, name: str) -> float | None:
    """Seconds between frames; the frames must be evenly spaced."""
    for coordinate in ("frame", "time", "time_s"):
        if has_times(series, coordinate) and series.sizes["time"] > 2:
            steps = np.diff(series[coordinate].to_numpy().astype(np.float64))
            if steps.min() <= 0.0:
                raise ParameterError(f"{name} goes back in {coordinate}, or stands still: sort it by time")
            if not np.allclose(steps, steps[0], rtol=1e-6, atol=0.0):
                raise ParameterError(
                    f"{name} has frames {steps.min():g} to {steps.max():g} apart in {coordinate}: lags need "
                    "even steps, so put NaN where a frame is missing"
                )
    if not has_times(series, "time_s") or series.sizes["time"] < 2:
        return None
    return round(float(np.diff(series["time_s"].to_numpy()).mean()), 9)

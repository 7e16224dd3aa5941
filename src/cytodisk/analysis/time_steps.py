"""Frame numbers and seconds of arrays through time."""

from __future__ import annotations

import numpy as np
import xarray as xr

from cytodisk.arrays import AnyArray, FloatArray, IntArray
from cytodisk.errors import ParameterError

_EVEN = 1e-6  # of a step: what seconds that come from a file's metadata may be off


def frame_numbers(array: xr.DataArray, name: str) -> IntArray:
    """Number of each frame of an array: its coordinate frame (or time), or 0, 1, … without one.

    Parameters
    ----------
    array : DataArray with the dim time
    name : str
        Name of the argument, for the error.

    Returns
    -------
    ndarray of shape (T,) and dtype int

    Raises
    ------
    ParameterError
        The numbers do not follow each other without a gap.
    """
    known = frame_coordinate(array)
    if known is None:
        return np.arange(array.sizes["time"])
    numbers = array[known].to_numpy()
    if numbers.dtype.kind not in "biuf" or (np.diff(numbers) != 1).any() or (numbers % 1 != 0).any():
        raise ParameterError(
            f"{name} must hold frames that follow each other, its {known} is {_shortened(numbers)}: "
            "reindex it to all frames, NaN where one is not there"
        )
    return np.asarray(numbers.astype(np.int64))


def frame_coordinate(array: xr.DataArray) -> str | None:
    """The coordinate that numbers the frames of an array: frame, or else time."""
    return next((name for name in ("frame", "time") if has_times(array, name)), None)


def has_times(array: xr.DataArray, coordinate: str) -> bool:
    """Whether an array has a coordinate with a value for each frame."""
    return coordinate in array.coords and array[coordinate].dims == ("time",)


def frame_seconds(array: xr.DataArray) -> FloatArray:
    """Time of each frame and of the end of the last, in seconds, shape (T + 1,); NaN when it is not known.

    Parameters
    ----------
    array : DataArray with the dim time
        Its coordinate time_s is read; the last frame lasts as long as the one before it.
    """
    frames = array.sizes["time"]
    if not has_times(array, "time_s") or frames < 2:
        return np.full(frames + 1, np.nan)
    seconds = array["time_s"].to_numpy().astype(np.float64)
    return np.append(seconds, 2.0 * seconds[-1] - seconds[-2])


def frame_interval(array: xr.DataArray) -> float | None:
    """Seconds between frames that are evenly spaced, else None.

    Parameters
    ----------
    array : DataArray with the dim time
    """
    steps = np.diff(frame_seconds(array))
    if not steps.size or not np.isfinite(steps).all() or not steps[0] > 0:
        return None
    even = np.allclose(steps, steps.mean(), rtol=_EVEN, atol=0.0)
    return float(steps.mean()) if even else None


def _shortened(numbers: AnyArray) -> str:
    shown = ", ".join(str(number) for number in numbers[:5])
    return f"{shown}, …" if len(numbers) > 5 else shown

"""Values along the edge as waves need them: checked, with the seconds of frames and the places of sectors."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.time_steps import has_times
from cytodisk.analysis.waves.waves_parameters import WaveSearchParameters
from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.checks import SMALLEST_SCALE, is_number, number_between
from cytodisk.errors import ParameterError

_NAMELESS = {1: ("time",), 2: ("time", "sector"), 3: ("time", "layer", "sector")}
_FEWEST_SHARE = 0.5  # of the sectors of a frame that must have a value
_ROUNDING = 64.0 * np.finfo(np.float64).eps
_AGREE = 1e-3  # of a step: how much seconds of frames and the interval that is passed may differ


@dataclass(frozen=True, eq=False)
class EdgeSeries:
    """One layer of values around the cell.

    Attributes
    ----------
    values : ndarray of shape (T, S) and dtype float
        NaN where there is none.
    seconds : ndarray of shape (T,) and dtype float
        They increase.
    lengths : ndarray of shape (T, S) and dtype float
        Of the sectors along the edge, as shares of it.
    edge_um : ndarray of shape (T,) and dtype float
        Length of the edge; NaN where it is not known.
    """

    values: FloatArray
    seconds: FloatArray
    lengths: FloatArray
    edge_um: FloatArray

    @property
    def interval(self) -> float:
        """Seconds between frames, their median."""
        return float(np.median(np.diff(self.seconds)))

    @property
    def used(self) -> BoolArray:
        """Frames in which at least half of the sectors that ever have a value have one, shape (T,)."""
        known = np.isfinite(self.values)
        ever = int(known.any(axis=0).sum())
        return np.asarray(known.sum(axis=1) >= max(_FEWEST_SHARE * ever, 1.0))

    @property
    def duration(self) -> float:
        """Seconds from the first frame that is used to the end of the last."""
        seconds = self.seconds[self.used]
        return float(seconds[-1] - seconds[0] + self.interval)

    def from_sector(self, start: int) -> EdgeSeries:
        """The same cell, counted from another sector."""
        return replace(
            self,
            values=np.roll(self.values, -start, axis=1),
            lengths=np.roll(self.lengths, -start, axis=1),
        )


def named_values(values: Any, dims: tuple[str, ...]) -> xr.DataArray:
    """Values with their dims by name, time first.

    Parameters
    ----------
    values : DataArray or array_like
    dims : tuple of str
        What they must have: ("time", "sector") or ("time", "layer", "sector").

    Raises
    ------
    ParameterError
        They are no numbers, or have other dims.
    """
    words = f"values must have the dims ({', '.join(dims)})"
    if isinstance(values, xr.Dataset):
        raise ParameterError(f"{words}, got a Dataset: pass one of its variables, such as values['mean']")
    if not isinstance(values, xr.DataArray):
        try:
            plain = np.asarray(values, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise ParameterError(f"values must be numbers: {error}") from error
        if plain.ndim != len(dims):
            raise ParameterError(f"{words}, got an array of shape {plain.shape}: pass one signal")
        values = xr.DataArray(plain, dims=dims)
    if set(values.dims) != set(dims):
        more = [str(dim) for dim in values.dims if dim not in dims]
        hint = f": choose one of {more[0]}, as values.isel({more[0]}=0)" if more else ""
        raise ParameterError(f"{words}, got ({', '.join(map(str, values.dims))}){hint}")
    if values.dtype.kind not in "biuf" or not values.size:
        raise ParameterError(f"{words} and hold numbers, got {values.dtype} of shape {values.shape}")
    _check_sectors(values)
    ordered: xr.DataArray = values.transpose(*dims)
    return ordered


def _check_sectors(values: xr.DataArray) -> None:
    """Sectors are taken as they follow each other around the cell: their numbers must say the same."""
    if "sector" not in values.coords or values["sector"].dtype.kind not in "iuf":
        return
    numbers = values["sector"].to_numpy().astype(np.float64)
    steps = np.diff(numbers)
    if (steps <= 0).any():
        raise ParameterError("the sectors of values must increase, none twice: pass values.sortby('sector')")
    if steps.size and steps.max() > 1.5 * steps.min():
        raise ParameterError(
            f"sectors of values are missing between {numbers[0]:g} and {numbers[-1]:g}: put NaN there, as "
            "values.reindex(sector=range(24)) does with 24 sectors"
        )


def numbers_along(values: xr.DataArray, dim: str) -> np.ndarray[Any, Any]:
    """Numbers of layers or sectors; from 0 where they have none."""
    return values[dim].to_numpy() if dim in values.coords else np.arange(values.sizes[dim])


def frame_times(values: xr.DataArray, frame_interval_s: float | None) -> FloatArray:
    """Seconds of the frames, from the coordinate time_s or the interval.

    Raises
    ------
    ParameterError
        Neither is known, both are and differ, or seconds do not increase.
    """
    frames = values.sizes["time"]
    interval = None
    if frame_interval_s is not None:
        interval = number_between("frame_interval_s", frame_interval_s, SMALLEST_SCALE)
    if has_times(values, "time_s") and np.isfinite(values["time_s"].to_numpy()).all():
        seconds = values["time_s"].to_numpy().astype(np.float64)
        steps = np.diff(seconds)
        if (steps <= 0).any():
            raise ParameterError("time_s of values must increase from frame to frame: sort them by time")
        if interval and steps.size and abs(np.median(steps) - interval) > _AGREE * interval:
            raise ParameterError(
                f"frame_interval_s is {interval:g}, but time_s of values says {np.median(steps):g} s: "
                "leave frame_interval_s out, or drop time_s"
            )
        return seconds
    if interval is None:
        raise ParameterError(
            "frame_interval_s is not known: pass the seconds between frames, or values with time_s"
        )
    number = values["frame"].to_numpy() if has_times(values, "frame") else np.arange(frames)
    if (np.diff(number) <= 0).any():
        raise ParameterError("frame of values must increase: sort them by frame")
    return np.asarray(number * interval, dtype=np.float64)


def sector_lengths(
    edge_length_um: Any, shape: tuple[int, ...], name: str = "edge_length_um"
) -> tuple[FloatArray, FloatArray]:
    """Share of the edge that each sector takes, (T, S), and the length of the whole edge in µm, (T,).

    Raises
    ------
    ParameterError
        It is not a number, one by time, or one by (time, sector), all above 0. Frames without one are NaN.
    """
    frames, sectors = shape
    equal = np.full(shape, 1.0 / sectors)
    if edge_length_um is None:
        return equal, np.full(frames, np.nan)
    if is_number(edge_length_um):
        return equal, np.full(frames, number_between(name, edge_length_um, SMALLEST_SCALE))
    if isinstance(edge_length_um, xr.DataArray) and {"time", "sector"} == set(edge_length_um.dims):
        edge_length_um = edge_length_um.transpose("time", "sector")
    try:
        given = np.asarray(edge_length_um, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ParameterError(f"{name} must be numbers: {error}") from error
    if given.shape not in ((frames,), (frames, sectors)):
        raise ParameterError(
            f"{name} must be a number, one by time ({frames},), or by (time, sector) {shape}, "
            f"got shape {given.shape}"
        )
    if (given <= 0).any() or np.isinf(given).any() or not np.isfinite(given).any():
        raise ParameterError(
            f"{name} must be above 0, and known in some frame, got {_smallest(given)}: leave it out where it "
            "is not known"
        )
    if given.ndim == 1:
        return equal, given
    known = np.isfinite(given).all(axis=1)
    if not known.any():
        raise ParameterError(f"{name} has no frame with the lengths of all sectors: pass one by time")
    nearest = _nearest(np.flatnonzero(known), frames)
    whole = np.where(known, given.sum(axis=1), np.nan)
    return given[nearest] / given[nearest].sum(axis=1, keepdims=True), whole


def check_shown(series: EdgeSeries, how: WaveSearchParameters) -> tuple[float, float]:
    """Shortest and longest period that a movie can show, in seconds.

    Raises
    ------
    ParameterError
        There are none, as in a short movie, or the values are constant or empty.
    """
    values = series.values
    known = np.isfinite(values)
    if np.isinf(values).any():
        raise ParameterError("values must be finite, or NaN where there are none")
    if len(values) < 2 or not known.any():
        raise ParameterError(f"values has {int(known.any(axis=1).sum())} frames with values: pass more")
    if not series.used.any():
        raise ParameterError(
            f"values has no frame in which half of the {int(known.any(axis=0).sum())} sectors have one: fill "
            "in what is missing, or pass fewer sectors"
        )
    used = values[series.used]
    spread = np.nanmax(used) - np.nanmin(used)
    changes = np.nanmax(used, axis=0, initial=-np.inf) - np.nanmin(used, axis=0, initial=np.inf)
    if not np.max(changes) > _ROUNDING * max(np.nanmax(np.abs(used)), spread):
        raise ParameterError("values are constant through time: there is no wave to look for")
    shortest, longest = how.frames_per_period * series.interval, series.duration / how.periods
    needed = int(np.ceil(how.frames_per_period * how.periods))
    if shortest > longest * (1.0 + _ROUNDING) or series.used.sum() < needed:
        raise ParameterError(
            f"values has {int(series.used.sum())} frames with values over {series.duration:g} s, which show "
            f"no period: the shortest is {how.frames_per_period:g} frames, {shortest:g} s, the longest the "
            f"duration / {how.periods:g}, {longest:g} s: pass at least {needed} frames"
        )
    return shortest, longest


def check_around(series: EdgeSeries) -> None:
    """Refuses values in so few sectors that what goes around the cell is not seen.

    Raises
    ------
    ParameterError
        Fewer than half of the sectors have values.
    """
    sectors, ever = series.values.shape[1], int(np.isfinite(series.values).any(axis=0).sum())
    if 2 * ever < sectors:
        raise ParameterError(
            f"values are there in {ever} of {sectors} sectors: what goes around the cell is not "
            "seen in less than half of it; pass a movie with more of the edge"
        )


def _smallest(given: FloatArray) -> str:
    """The smallest of what was given in words, or inf where that is among it."""
    known = given[~np.isnan(given)]
    if not known.size:
        return "NaN alone"
    return "inf" if np.isinf(known).any() else f"{known.min():g}"


def _nearest(present: IntArray, count: int) -> IntArray:
    """Of all numbers up to a count, the nearest that is present."""
    right = np.searchsorted(present, np.arange(count)).clip(0, len(present) - 1)
    left = (right - 1).clip(0)
    number = np.arange(count)
    closer = np.abs(present[left] - number) < np.abs(present[right] - number)
    return np.asarray(np.where(closer, present[left], present[right]))

"""Time on the axes of a movie's figures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from cytodisk.analysis.time_steps import frame_interval
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.units import scale_for
from cytodisk.scale import Scale, ShownUnit

TICK_STEPS = [1, 2, 2.5, 5, 10]


@dataclass(frozen=True)
class FrameTimes:
    """Frames of a movie at even steps, and where they lie on an axis.

    Attributes
    ----------
    first, count : int
        Number of the first frame, and how many there are.
    interval_s : float or None
        Seconds from a frame number to the next; None when unknown, and then the axis is in frames.
    stride : int
        From one of the frames to the next, 1 where none is left out.
    """

    first: int
    count: int
    interval_s: float | None = None
    stride: int = 1

    @classmethod
    def of(cls, values: Any, name: str, scale: Scale | None = None) -> FrameTimes:
        """Frames of an array.

        Parameters
        ----------
        values : array_like or DataArray
            Time comes first, or is the dim `time`; the coordinates `frame` and `time_s` are read.
        name : str
            Name of the argument, for the error.
        scale : Scale, optional
            Of an array that does not hold its times.

        Raises
        ------
        ParameterError
            The frames are not at even steps.
        """
        if not isinstance(values, xr.DataArray) or "time" not in values.dims:
            return cls(0, len(values), scale_for(values, scale).frame_interval_s)
        count = values.sizes["time"]
        numbers = values["frame"].to_numpy() if "frame" in values.coords else np.arange(count)
        stride = int(numbers[1] - numbers[0]) if count > 1 else 1
        if stride < 1 or (np.diff(numbers) != stride).any():
            raise ParameterError(
                f"{name} must hold frames at even steps, its coordinate frame is {numbers.tolist()}: "
                "reindex it to all frames, NaN where one is not there"
            )
        interval = scale_for(values, scale).frame_interval_s
        if "time_s" in values.coords and count > 1:
            step = frame_interval(values)
            interval = None if step is None else step / stride
        return cls(int(numbers[0]), count, interval, stride)

    @property
    def unit(self) -> ShownUnit:
        """Unit of the axis: a long movie is in minutes or hours."""
        return Scale(None, self.interval_s).shown_time(self.first + self.count * self.stride)

    @property
    def per_frame(self) -> float:
        """From a frame number to the next on the axis."""
        return 1.0 if self.interval_s is None else self.interval_s * self.unit.factor

    @property
    def label(self) -> str:
        """Of the axis, as "time (min)"; "frame" where seconds are not known."""
        return "frame" if self.interval_s is None else f"time ({self.unit.name})"

    @property
    def at(self) -> FloatArray:
        """Place of each frame on the axis, shape (count,)."""
        return self.per_frame * (self.first + self.stride * np.arange(self.count, dtype=np.float64))

    def set_axis(self, ax: Axes) -> FloatArray:
        """Set x to time, from half a step before the first frame to half a step after the last.

        Parameters
        ----------
        ax : Axes

        Returns
        -------
        ndarray of shape (count,) and dtype float
            Place of each frame on the axis.
        """
        half = 0.5 * self.stride * self.per_frame
        ax.set(xlim=(self.at[0] - half, self.at[-1] + half), xlabel=self.label)
        ax.xaxis.set_major_locator(MaxNLocator(6, steps=TICK_STEPS, integer=self.interval_s is None))
        return self.at


def time_stamp(frame: int, scale: Scale) -> str:
    """A frame's time for a title: in seconds, in minutes if frames are a minute or more apart, or its number.

    Parameters
    ----------
    frame : int
        From 0.
    scale : Scale

    Returns
    -------
    str
    """
    seconds, interval = scale.seconds(frame), scale.frame_interval_s
    if seconds is None or interval is None:
        return f"frame {frame}"
    unit, size = ("s", 1.0) if interval < 60.0 else ("min", 60.0)
    return f"{round(seconds / size, 2):g} {unit}"


def stands_alone(values: FloatArray) -> BoolArray:
    """Which values have no neighbour in time, so that a line does not show them.

    Parameters
    ----------
    values : ndarray of shape (T,) and dtype float

    Returns
    -------
    ndarray of shape (T,) and dtype bool
    """
    known = np.pad(np.isfinite(values), 1)
    return np.asarray(known[1:-1] & ~known[:-2] & ~known[2:])

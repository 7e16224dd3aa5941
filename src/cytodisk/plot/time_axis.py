"""Time on the axes of a movie's figures."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import ParameterError

TICK_STEPS = [1, 2, 2.5, 5, 10]

_LONGEST_IN = (("s", 1.0, 300.0), ("min", 60.0, 36000.0), ("h", 3600.0, np.inf))  # unit, seconds, up to


def time_scale(frames: int, frame_interval_s: float | None) -> tuple[float, str]:
    """Length of a frame on a time axis and the axis' label.

    Parameters
    ----------
    frames : int
        Number of frames of the whole movie: a long one is in minutes or hours.
    frame_interval_s : float or None

    Returns
    -------
    (float, str)
        1 and "frame" when the interval is not known.

    Raises
    ------
    ParameterError
        The interval is not a positive number.
    """
    if frame_interval_s is None:
        return 1.0, "frame"
    if not 0 < frame_interval_s < np.inf:
        raise ParameterError(
            f"frame_interval_s must be a positive number, got {frame_interval_s!r}: "
            "pass None when it is not known"
        )
    whole = frames * frame_interval_s
    unit, seconds = next((unit, seconds) for unit, seconds, most in _LONGEST_IN if whole <= most)
    return frame_interval_s / seconds, f"time ({unit})"


def time_axis(ax: Axes, frames: int, frame_interval_s: float | None, first_frame: int = 0) -> FloatArray:
    """Set x to time, from half a frame before the first to half a frame after the last.

    Parameters
    ----------
    ax : Axes
    frames : int
    frame_interval_s : float or None
    first_frame : int
        Number of the first frame.

    Returns
    -------
    ndarray of shape (frames,) and dtype float
        Time of each frame on the axis.

    Raises
    ------
    ParameterError
        The interval is not a positive number.
    """
    step, label = time_scale(first_frame + frames, frame_interval_s)
    ax.set(xlim=((first_frame - 0.5) * step, (first_frame + frames - 0.5) * step), xlabel=label)
    ax.xaxis.set_major_locator(MaxNLocator(6, steps=TICK_STEPS, integer=frame_interval_s is None))
    return step * (first_frame + np.arange(frames, dtype=np.float64))


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

"""Time on the axes of a movie's figures."""

import numpy as np

from cytodisk.errors import ParameterError

_LONGEST_IN = (("s", 1.0, 300.0), ("min", 60.0, 36000.0), ("h", 3600.0, np.inf))  # unit, seconds, up to


def time_scale(frames: int, frame_interval_s: float | None) -> tuple[float, str]:
    """Length of a frame on a time axis and the axis' label.

    Parameters
    ----------
    frames : int
        Of the whole movie: a long one is in minutes or hours.
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

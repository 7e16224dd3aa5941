"""A lag in words."""

from __future__ import annotations

import math


def lag_words(lag: float, lag_s: float) -> str:
    """A lag in seconds where they are known, else in frames.

    Parameters
    ----------
    lag : float
        In frames.
    lag_s : float
        In seconds; NaN if the frame interval is unknown.

    Returns
    -------
    str
        As "lag −20 s", "lag +1 frame" or "lag 0".
    """
    if not lag:
        return "lag 0"
    unit = "frame" if abs(lag) == 1 else "frames"
    words = f"{lag_s:+.4g} s" if math.isfinite(lag_s) else f"{lag:+.0f} {unit}"
    return f"lag {words}".replace("-", "−")

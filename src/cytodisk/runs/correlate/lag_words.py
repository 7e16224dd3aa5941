"""A lag in words."""

from __future__ import annotations

import math

from cytodisk.scale import ShownUnit, suited_lag


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
        As "lag −20 s", "lag +1.5 min", "lag +1 frame" or "lag 0".
    """
    return f"lag {_amount(lag, lag_s, sign=True)}" if lag else "lag 0"


def time_apart(lag: float, lag_s: float) -> str:
    """How far two things lie apart in time, without a sign.

    Parameters
    ----------
    lag : float
        In frames, not 0.
    lag_s : float
        In seconds; NaN if the frame interval is unknown.

    Returns
    -------
    str
        As "20 s", "1.5 min" or "1 frame".
    """
    return _amount(abs(lag), abs(lag_s), sign=False)


def _amount(lag: float, lag_s: float, *, sign: bool) -> str:
    if math.isfinite(lag_s):
        return suited_lag(abs(lag_s / lag)).words(lag_s, 4, sign=sign)
    return ShownUnit("frame").words(lag, sign=sign)

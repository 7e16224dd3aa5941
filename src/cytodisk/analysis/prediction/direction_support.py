"""Whether a direction that predicts less than the other one may be noise of measurement alone."""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray

MOST_BY_NOISE = 0.5
"""Share of the gain on reversed time that noise of measurement reaches; benchmarks print what it does."""


def weaker_direction(gain: Any, gain_back: Any, gain_reversed: Any, gain_back_reversed: Any) -> BoolArray:
    """Where a source predicts a target, but no better than noise of measurement would make it seem.

    Parameters
    ----------
    gain, gain_back : array_like of float
        Gain of source → target, and of target → source, in nats, as of `predict`.
    gain_reversed, gain_back_reversed : array_like of float
        Both on reversed time, `gain_reversed` of `predict`.

    Returns
    -------
    ndarray of dtype bool
        True where source → target gains less than half of what it gains on reversed time, while the other
        direction gains less there. False where a gain is not known.

    See Also
    --------
    predict : Makes the gains.

    Notes
    -----
    If only the target predicts the source, and is measured with noise, then the source holds a cleaner copy
    of the target's past, and predicts it a little. On reversed time what is true turns around: the true
    direction loses, the other one gains. Where both directions are true they gain about as much on reversed
    time; but if one is more than twice as strong as the other, the weak one is marked, too: it looks the
    same.

    References
    ----------
    Haufe et al. (2013), doi:10.1016/j.neuroimage.2012.09.036; Winkler et al. (2016),
    doi:10.1109/TSP.2016.2531628.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cd.weaker_direction([0.002, 0.1], [0.05, 0.1], [0.05, 0.08], [0.001, 0.09])
    array([ True, False])
    """
    forth, back, forth_reversed, back_reversed = (
        np.asarray(one, dtype=np.float64) for one in (gain, gain_back, gain_reversed, gain_back_reversed)
    )
    return np.asarray((forth < MOST_BY_NOISE * forth_reversed) & (back > back_reversed))

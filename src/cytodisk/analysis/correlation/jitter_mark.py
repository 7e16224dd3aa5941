"""The mark that jitter of the masks leaves in a correlation of a signal with edge velocity."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.motion.velocity_error import jitter_variance

_BEFORE = np.array([-3.0, 10.0, 5.0, -2.0]) / 10.0  # cubic through four values at -3, -2, 1, 2: at -1
_AFTER = np.array([-2.0, 5.0, 10.0, -3.0]) / 10.0  # and at 0
_NORMAL = 1.4826  # of the median absolute deviation
_SURE, _WORTH_SAYING = 5.0, 0.03
_SURE_OF_STEP, _WORTH_IF_JITTERING = 4.0, 0.02  # of half the step between both, where velocity jitters
JITTERING_SHARE = 0.1
"""Share of velocity's variance from which the edge jitters; in clean movies it is next to nothing."""
_FEWEST_STEPS = 20
JITTERED_LAGS = (-1, 0)
JITTERED_DIFFERENCES = (-2, -1, 0, 1)
"""Lags at which jitter correlates once first differences are taken."""


def velocity_jitter(velocity: Any) -> float:
    """Share of the variance of edge velocity that jitter of the masks makes.

    Parameters
    ----------
    velocity : DataArray or array_like with dims (time, sector)
        Of `edge_velocity`.

    Returns
    -------
    float
        From 0 to 1. NaN in fewer than 20 frames, and where velocity does not vary.

    See Also
    --------
    jitter_step : What it makes of a correlation.

    Notes
    -----
    An outline that lies too far out in one frame makes velocity too high before and too low after it: its
    autocovariance is lower at lag 1 than a smooth curve through the other lags. It is told from velocity that
    lasts as in `edge_changes`, for the error.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> _, velocity = cd.simulate.independent_series("smooth", 0, 100, 1, 12)
    >>> jitter = np.diff(np.random.default_rng(0).normal(size=(101, 12)), axis=0)
    >>> bool(cd.velocity_jitter(velocity) < 0.01), bool(cd.velocity_jitter(velocity + 0.5 * jitter) > 0.2)
    (True, True)
    """
    table = np.asarray(velocity, dtype=np.float64)
    table = table.reshape(len(table), -1)
    known = np.isfinite(table)
    variance = float(np.var(table[known])) if known.any() else 0.0
    if known.any(axis=1).sum() < _FEWEST_STEPS or not variance > 0.0:
        return float("nan")
    return min(jitter_variance(table) / variance, 1.0)


def jitter_step(by_layer: xr.Dataset, *, velocity_share: float = 0.0) -> xr.DataArray:
    """How much of a correlation at lag 0, and with the other sign at lag -1, jitter of the masks made.

    Parameters
    ----------
    by_layer : Dataset
        Of `correlation_by_layer`, of a signal with edge velocity.
    velocity_share : float
        Of `velocity_jitter`, if it is known.

    Returns
    -------
    DataArray with the dims of the windows but sector
        The smaller of the two distances from a smooth curve through the lags beside them; 0 where they lie
        to the same side, not five times as far as usual between other lags, or nearer than 0.03. Where
        velocity itself jitters, with a share of 0.1, it is enough that the step between both is four times
        that usual between other lags, and 0.02.

    Raises
    ------
    ParameterError
        There are fewer than six lags to both sides.

    See Also
    --------
    velocity_jitter : How much of velocity is jitter.
    cross_correlate : Its `skip_lags` leaves out the lags that jitter makes.

    Notes
    -----
    Where the outline of frame t lies too far in by ε, velocity is too high by ε from t to t + 1 and too low
    from t - 1 to t; and the windows of frame t, which follow the outline, lie too far in, where the signal
    differs. So jitter of masks correlates with itself: by as much at lag 0 as at lag -1 with the other sign,
    and at no other lag. No surrogate knows of that. `benchmarks/correlation.py` prints how large it is.

    Examples
    --------
    >>> import cytodisk as cd
    >>> signal, velocity = cd.simulate.independent_series("smooth", 0, 60, 2, 6)
    >>> correlations = cd.cross_correlate(signal, velocity, max_lag=8)
    >>> cd.jitter_step(cd.correlation_by_layer(correlations)).to_numpy()  # no mark of jitter
    array([0., 0.])
    """
    curve = by_layer["correlation"].transpose("lag", ...)
    lags = curve["lag"].to_numpy()
    if lags.min() > -6 or lags.max() < 6:
        raise ParameterError(
            f"jitter shows among six lags to both sides at least, got {lags.min()} to {lags.max()}"
        )
    below, above = _beside_smooth(curve.to_numpy())
    here = int(np.flatnonzero(lags == -1)[0]) - 2
    away = np.abs(np.arange(len(above)) - here) > 2
    jitters = velocity_share >= JITTERING_SHARE
    judged = 0.5 * (above - below) if jitters else above
    sure, worth = (_SURE_OF_STEP, _WORTH_IF_JITTERING) if jitters else (_SURE, _WORTH_SAYING)
    with warnings.catch_warnings(), np.errstate(invalid="ignore"):
        warnings.simplefilter("ignore", RuntimeWarning)  # a layer without a correlation has no median
        usual = sure * _NORMAL * np.nanmedian(np.abs(judged[away]), axis=0)
        smaller = np.minimum(np.abs(below), np.abs(above))[here]
        opposite = (below * above)[here] < 0
        beyond = np.abs(judged[here]) > usual if jitters else smaller > usual
        marked = opposite & beyond & (smaller > worth)
    step = np.where(marked, np.sign(above[here]) * smaller, 0.0)
    coords = {name: values for name, values in curve.coords.items() if "lag" not in values.dims}
    return xr.DataArray(step, coords, curve.dims[1:])


def _beside_smooth(curve: FloatArray) -> tuple[FloatArray, FloatArray]:
    """How far neighbouring values lie off the cubic through two before and two after, for all such pairs."""
    around = np.stack([curve[:-5], curve[1:-4], curve[4:-1], curve[5:]])
    before, after = (np.einsum("k,k...", weights, around) for weights in (_BEFORE, _AFTER))
    return curve[2:-3] - before, curve[3:-2] - after

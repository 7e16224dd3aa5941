"""The mark that jitter of the masks leaves in a correlation of a signal with edge velocity."""

from __future__ import annotations

import warnings

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError

_BEFORE = np.array([-3.0, 10.0, 5.0, -2.0]) / 10.0  # cubic through four values at -3, -2, 1, 2: at -1
_AFTER = np.array([-2.0, 5.0, 10.0, -3.0]) / 10.0  # and at 0
_NORMAL = 1.4826  # of the median absolute deviation
_SURE, _WORTH_SAYING = 5.0, 0.03
JITTERED_LAGS = (-1, 0)
JITTERED_DIFFERENCES = (-2, -1, 0, 1)
"""Lags at which jitter correlates once first differences are taken."""


def jitter_step(by_layer: xr.Dataset) -> xr.DataArray:
    """How much of a correlation at lag 0, and with the other sign at lag -1, jitter of the masks made.

    Parameters
    ----------
    by_layer : Dataset
        Of `correlation_by_layer`, of a signal with edge velocity.

    Returns
    -------
    DataArray with the dims of the windows but sector
        The smaller of the two distances from a smooth curve through the lags beside them; 0 where they lie
        to the same side, not five times as far as usual between other lags, or nearer than 0.03.

    Raises
    ------
    ParameterError
        There are fewer than six lags to both sides.

    See Also
    --------
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
    with warnings.catch_warnings(), np.errstate(invalid="ignore"):
        warnings.simplefilter("ignore", RuntimeWarning)  # a layer without a correlation has no median
        usual = _NORMAL * np.nanmedian(np.abs(above[away]), axis=0)
        step = np.where(below * above < 0, np.sign(above) * np.minimum(np.abs(below), np.abs(above)), 0.0)[
            here
        ]
        marked = (np.abs(step) > _SURE * usual) & (np.abs(step) > _WORTH_SAYING)
    coords = {name: values for name, values in curve.coords.items() if "lag" not in values.dims}
    return xr.DataArray(np.where(marked, step, 0.0), coords, curve.dims[1:])


def _beside_smooth(curve: FloatArray) -> tuple[FloatArray, FloatArray]:
    """How far neighbouring values lie off the cubic through two before and two after, for all such pairs."""
    around = np.stack([curve[:-5], curve[1:-4], curve[4:-1], curve[5:]])
    before, after = (np.einsum("k,k...", weights, around) for weights in (_BEFORE, _AFTER))
    return curve[2:-3] - before, curve[3:-2] - after

"""Ranks of series in place of their values, so that no frame counts for much more than the others."""

from __future__ import annotations

import numpy as np
from scipy.stats import rankdata

from cytodisk.analysis.correlation.correlation_parameters import Statistic
from cytodisk.analysis.correlation.prepared_series import standardised
from cytodisk.arrays import FloatArray


def scored(series: FloatArray, statistic: Statistic) -> FloatArray:
    """Series as they enter a Pearson correlation: their values, or their ranks through time.

    Parameters
    ----------
    series : ndarray of shape (T, …) and dtype float
        NaN stays NaN.
    statistic : {"pearson", "spearman"}

    Returns
    -------
    ndarray of shape (T, …) and dtype float
        Ranks run from 1 to the number of values of a series; equal values share their mean rank, and a
        constant, up to rounding, stays one.

    Notes
    -----
    A series is ranked once, over all of its frames, and not anew over the pairs of each lag: surrogates are
    then made of the ranks as they are of values, at the same cost, and a frame has the same weight at all
    lags. At lag 0 without gaps it is Spearman's coefficient; at other lags it differs from it by about one
    over the number of pairs.

    References
    ----------
    Spearman (1904), doi:10.2307/1412159.
    """
    if statistic == "pearson":
        return series
    columns = standardised(series.reshape(len(series), -1))
    ranks = rankdata(columns, axis=0, nan_policy="omit")
    return np.asarray(ranks, dtype=np.float64).reshape(series.shape)

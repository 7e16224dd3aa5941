"""What a p says, as a number that has a mean of 0 where there is nothing to find."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.stats import norm

from cytodisk.arrays import FloatArray


def normal_score(p: Any, surrogates: Any) -> FloatArray:
    """Normal scores of probabilities: the higher, the less by chance.

    Parameters
    ----------
    p : array_like of float
        (1 + surrogates that reach the value) / (1 + surrogates); NaN for none.
    surrogates : array_like of int
        Their number.

    Returns
    -------
    ndarray and dtype float64
        The quantile of the normal distribution at the middle of the step that p stands for. Without an effect
        it is spread evenly about 0, whatever the length of a movie, which a gain is not: most gains by chance
        are a little below their mean, and few far above. So signs of experiments can be exchanged.

    Examples
    --------
    >>> from cytodisk.runs.population.movies.normal_score import normal_score
    >>> normal_score([0.01, 0.505, 1.0], 99).round(2).tolist()
    [2.58, 0.0, -2.58]
    """
    p = np.asarray(p, dtype=np.float64)
    half = 0.5 / (1.0 + np.asarray(surrogates, dtype=np.float64))
    return np.asarray(norm.isf(np.maximum(p - half, p / 2.0)))

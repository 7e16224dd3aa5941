"""How far a movie is from what chance gives, on the scale of a normal distribution."""

from __future__ import annotations

import numpy as np
from scipy.stats import norm, rankdata

from cytodisk.arrays import FloatArray

_TAIL = 0.95  # quantile of surrogates that sets the scale beyond all of them


def p_value(score: float, null: FloatArray) -> float:
    """Share of surrogates, and the movie itself, with at least the score."""
    return float((np.sum(null >= score) + 1) / (len(null) + 1))


def order_score(score: float, null: FloatArray) -> float:
    """Normal quantile of a score among surrogates; beyond all of them in their own spread.

    Without waves it has mean 0 and standard deviation 1, in movies of any length.
    """
    above = float(np.sum(null > score) + 0.5 * np.sum(null == score))
    share = (above + 0.5) / (len(null) + 1)
    order = float(norm.isf(share))
    largest = float(null.max())
    if score > largest:
        spread = (float(np.quantile(null, _TAIL)) - float(np.median(null))) / norm.ppf(_TAIL)
        order += (score - largest) / spread if spread > 0 else 0.0
    return order


def null_orders(null: FloatArray) -> FloatArray:
    """Scores of the surrogates on the same scale."""
    return np.asarray(norm.ppf((rankdata(null) - 0.5) / len(null)))

"""A warning where experiments of one condition vary more than those of the other."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.population.conditions.experiment_units import Units
from cytodisk.population.exchange.column_moments import column_moments
from cytodisk.population.exchange.exchanges import LabelExchanges
from cytodisk.population.named_warning import NamedWarning
from cytodisk.population.significance import LEVEL

_UNEQUAL, _UNEQUAL_FEW = 2.0, 1.5  # ratio of variances; where the smaller group varies more
_AT_ONCE, _MOST_UNITS = 50, 1000  # of more units, which are cells, the spread is not looked at
_EXCHANGES = 999


def spread_warning(values: FloatArray, units: Units, conditions: tuple[str, str]) -> Iterator[NamedWarning]:
    """Labels of experiments that differ in spread are not alike, so that the level of the test does not hold.

    Pairs are compared with themselves, so that it holds for them.

    Parameters
    ----------
    values : ndarray of shape (units, windows) and dtype float64
    units : Units
    conditions : (str, str)
        Names of the control and of the other one.

    Yields
    ------
    NamedWarning
    """
    if units.paired or min(units.sizes) < 2 or units.count > _MOST_UNITS:
        return
    squares = np.zeros(values.shape)
    for group in (~units.treated, units.treated):
        squares[group] = (values[group] - column_moments(values, group).mean) ** 2
    squares = squares[:, np.isfinite(squares).all(axis=0) & (squares.max(axis=0) > 0)]
    if not squares.size:
        return
    exchanges = LabelExchanges(units.treated, _EXCHANGES, 0)
    ratios = np.concatenate([_log_ratios(squares, labels) for labels in exchanges.chunks(_AT_ONCE)])
    if (np.abs(ratios) >= np.abs(ratios[0]) - 1e-9).mean() > LEVEL:
        return
    ratio = float(np.exp(ratios[0]))
    wide, narrow = conditions[::-1] if ratio > 1 else conditions
    n_wide, n_narrow = units.sizes[::-1] if ratio > 1 else units.sizes
    ratio = max(ratio, 1.0 / ratio)
    if n_wide <= n_narrow and ratio >= (_UNEQUAL_FEW if n_wide < n_narrow else _UNEQUAL):
        few = f", and {wide} has fewer of them ({n_wide} against {n_narrow})" if n_wide < n_narrow else ""
        yield NamedWarning(
            "unequal spread",
            f"Experiments of {wide} vary {np.sqrt(ratio):.2g} × as much as those of {narrow}{few}.",
            "The test then finds a difference in spread as one in the mean: more than one null study in "
            "twenty is called different, and many more where the condition with the larger spread has fewer "
            "experiments.",
            f"Do at least as many experiments of {wide} as of {narrow}, or pair conditions within "
            "experiments.",
        )


def _log_ratios(squares: FloatArray, treated: BoolArray) -> FloatArray:
    """Logarithm of the ratio of variances, its median over the windows, for each way (ways,)."""
    labels = treated.astype(np.float64)
    inside = labels @ squares
    count = labels.sum(axis=1, keepdims=True)
    outside = squares.sum(axis=0) - inside
    least = 1e-12 * squares.sum(axis=0)
    variance = np.maximum(inside, least) / (count - 1)
    other = np.maximum(outside, least) / (len(squares) - count - 1)
    return np.asarray(np.median(np.log(variance / other), axis=1))

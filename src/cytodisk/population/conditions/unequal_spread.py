"""A warning where experiments of one condition vary more than those of the other."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.population.conditions.experiment_units import Units
from cytodisk.population.exchange.column_moments import column_moments
from cytodisk.population.named_warning import NamedWarning

_UNEQUAL, _UNEQUAL_FEW = 4.0, 2.5  # ratio of variances; where the smaller group varies more


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
    if units.paired or min(units.sizes) < 2 or not values.shape[1]:
        return
    control, treated = (column_moments(values, group).variance for group in (~units.treated, units.treated))
    usable = (control > 0) & (treated > 0)
    if not usable.any():
        return
    ratio = float(np.exp(np.median(np.log(treated[usable] / control[usable]))))
    wide, narrow = conditions[::-1] if ratio > 1 else conditions
    n_wide, n_narrow = units.sizes[::-1] if ratio > 1 else units.sizes
    ratio = max(ratio, 1.0 / ratio)
    if ratio >= (_UNEQUAL_FEW if n_wide < n_narrow else _UNEQUAL):
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

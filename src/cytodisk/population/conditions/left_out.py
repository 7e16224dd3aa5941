"""Results without one experiment at a time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.population.conditions.experiment_units import Units
from cytodisk.population.exchange.exchange_test import exchange_test
from cytodisk.population.exchange.exchanges import LabelExchanges, SignExchanges
from cytodisk.population.exchange.studentised import GroupDifference, PairDifference
from cytodisk.population.ratios import known_mean

_MOST = 999  # permutations: these p-values compare experiments and correct nothing
COLUMNS = ("result", "experiment", "difference_of_all", "difference", "p")


def left_out_table(results: Mapping[str, FloatArray], units: Units, seed: int) -> pd.DataFrame:
    """Difference and p of each result without each experiment.

    Parameters
    ----------
    results : dict of str to ndarray of shape (units,)
        The number that a result is about, such as the mean of a cluster's windows, for each unit.
    units : Units
    seed : int

    Returns
    -------
    DataFrame
        Columns result, experiment, difference_of_all, difference, p (of this number alone, not corrected).
    """
    if not results:
        return pd.DataFrame(columns=list(COLUMNS))
    names = list(dict.fromkeys(units.names))
    values = np.stack(list(results.values()), axis=1)
    whole = _difference(values, units.treated, units.paired)
    rows = []
    for name in names:
        kept = np.array([other != name for other in units.names])
        if not (units.treated[kept].any() and (~units.treated[kept]).any()):
            continue
        difference = _difference(values[kept], units.treated[kept], units.paired)
        p = _p(values[kept], units.treated[kept], units.paired, seed)
        rows += [(result, name, whole[k], difference[k], p[k]) for k, result in enumerate(results)]
    order = {result: k for k, result in enumerate(results)}
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    return table.sort_values("result", key=lambda column: column.map(order), kind="stable", ignore_index=True)


def _difference(values: FloatArray, treated: np.ndarray, paired: bool) -> FloatArray:
    first, second = values[~treated], values[treated]
    if paired:
        return known_mean(second - first, 0)
    return known_mean(second, 0) - known_mean(first, 0)


def _p(values: FloatArray, treated: np.ndarray, paired: bool, seed: int) -> FloatArray:
    if paired:
        differences = values[treated] - values[~treated]
        return exchange_test(PairDifference(differences), SignExchanges(len(differences), _MOST, seed)).p
    return exchange_test(GroupDifference(values, treated), LabelExchanges(treated, _MOST, seed)).p

"""Other ways to ask whether what a source adds is more than chance, for `prediction_calibration.py`.

* rest shifted: as `predict` does it, with the source's order chosen anew in every surrogate.
* order kept: the same with the order that the criterion chose for the source itself.
* source shifted: the source as it is, with what target and given signals say of it.
* phases: random phases of the rest, the same in all sectors.
* chi2: the likelihood ratio as if all rows were independent.
* by frame: Wald's test with a variance that is robust to sectors that move together in a frame.
"""

from unittest.mock import patch

import numpy as np
from scipy.stats import chi2
from scipy.stats import f as fisher

from cytodisk.analysis.prediction import chance_gains as chance
from cytodisk.analysis.prediction.lagged_design import rows_with_past
from cytodisk.analysis.prediction.layer_series import LayerSeries
from cytodisk.analysis.prediction.layer_series import Signals as Parsed
from cytodisk.analysis.prediction.pooled_autoregression import (
    Held,
    best_gain,
    explained,
    source_columns,
    without,
)
from cytodisk.analysis.prediction.prediction_orders import Orders, choose_orders, penalty
from cytodisk.analysis.prediction.prediction_parameters import PredictionParameters
from cytodisk.arrays import FloatArray
from prediction_cases import Signals

WAYS = ("rest shifted", "order kept", "source shifted", "phases", "chi2", "by frame")
_PAST = 8


def p_values(signals: Signals, seed: int, surrogates: int, criterion: str) -> dict[str, float]:
    """p of one pair by each way."""
    how = PredictionParameters.of(criterion=criterion, max_order=_PAST)
    series = Parsed.of(signals.source, signals.target, signals.given).layer(0, True, None)
    rows = rows_with_past(series, _PAST)
    orders = choose_orders(series, rows, how)
    held = Held.of(series, rows, orders)
    price = penalty(how.criterion, rows.size)
    columns = source_columns(held, series, _PAST)
    squares = explained((columns.T @ columns)[None], (columns.T @ held.left)[None])
    gains, chosen = best_gain(held, squares, price)
    gain, order = float(gains[0]), int(chosen[0])

    def of(null: FloatArray) -> float:
        return (1 + np.count_nonzero(null >= gain)) / (1 + null.size)

    drawn = {"count": surrogates, "seed": seed}
    found = {
        "rest shifted": of(chance.chance_gains(held, series, orders, _PAST, price, **drawn)),
        "order kept": of(chance.chance_gains(held, series, orders, order, None, **drawn)),
        "phases": of(_with_phases(held, series, orders, price, surrogates, seed)),
        "chi2": float(chi2.sf(rows.size * gain, order)),
        "by frame": _wald(held, columns[:, :order]),
    }
    with patch.object(chance, "split_source", _unsplit):
        found["source shifted"] = of(chance.chance_gains(held, series, orders, _PAST, price, **drawn))
    return found


def _unsplit(series: LayerSeries, _: Orders, __: int) -> tuple[FloatArray, FloatArray]:
    return np.zeros(series.source.shape), series.source - series.source.mean(axis=0)


def _with_phases(
    held: Held, series: LayerSeries, orders: Orders, price: float, count: int, seed: int
) -> FloatArray:
    """Gains of surrogates with random phases."""
    random = np.random.default_rng(seed)
    followed, rest = chance.split_source(series, orders, _PAST)
    spectrum = np.fft.rfft(rest, axis=0)
    gains = np.zeros(count)
    for place in range(count):
        turn = np.exp(2j * np.pi * random.random((len(spectrum), 1)))
        made = followed + np.fft.irfft(spectrum * turn, n=len(rest), axis=0)
        columns = without(np.column_stack(held.rows.lagged(made, range(1, _PAST + 1))), held.basis)
        squares = explained((columns.T @ columns)[None], (columns.T @ held.left)[None])
        gains[place] = best_gain(held, squares, price)[0][0]
    return gains


def _wald(held: Held, columns: FloatArray) -> float:
    square = columns.T @ columns
    coefficient = np.linalg.solve(square, columns.T @ held.left)
    error = held.left - columns @ coefficient
    frames, place = np.unique(held.rows.frame, return_inverse=True)
    scores = np.zeros((len(frames), columns.shape[1]))
    np.add.at(scores, place, columns * error[:, None])
    size, used = held.rows.size, held.basis.shape[1] + columns.shape[1] + held.rows.sectors
    factor = len(frames) / (len(frames) - 1.0) * (size - 1.0) / (size - used)
    moved = square @ coefficient
    wald = moved @ np.linalg.solve(factor * (scores.T @ scores), moved) / columns.shape[1]
    return float(fisher.sf(wald, columns.shape[1], len(frames) - 1))

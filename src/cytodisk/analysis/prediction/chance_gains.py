"""Gains that sources have by chance: what is left of the source is shifted, what predicts it stays."""

from __future__ import annotations

import numpy as np

from cytodisk.analysis.prediction.lagged_design import Rows, orthonormal
from cytodisk.analysis.prediction.layer_series import LayerSeries
from cytodisk.analysis.prediction.pooled_autoregression import Held, best_gain, explained, without
from cytodisk.analysis.prediction.prediction_orders import Orders
from cytodisk.analysis.prediction.source_shifts import ShiftedSource, Shifts
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import ParameterError

FEWEST_SHIFTS = 19
"""With fewer, no p-value is as small as 0.05."""

_MEMORY = np.exp(-1.0)  # autocorrelation from which on a series has forgotten


def chance_gains(
    held: Held,
    series: LayerSeries,
    orders: Orders,
    past: int,
    price: float | None,
    *,
    count: int,
    seed: int,
) -> FloatArray:
    """Gain of each surrogate.

    Parameters
    ----------
    held : Held
    series : LayerSeries
    orders : Orders
    past : int
        Longest past of the source that is tried.
    price : float or None
        See `best_gain`.
    count, seed : int
        Of the surrogates.

    Returns
    -------
    ndarray of shape (R,) and dtype float
        R is at most `count`, and not more than there are shifts.

    Raises
    ------
    ParameterError
        There are too few shifts.

    Notes
    -----
    The source x is split into its regression on target, neighbours and given signals, of the same frame and
    before, and the rest. Only the rest is shifted, in time and around the cell: the surrogate hangs together
    with all of these as the source does, and its rest keeps its correlations in time and between sectors.
    """
    used = held.rows.table(np.ones(held.rows.size), len(series.target)).astype(bool)
    kept = held.rows.count > 0
    followed, rest = split_source(series, orders)
    circle = len(rest) + past
    least = min(past + memory(rest[:, kept]), circle // 4)
    shifts = Shifts.drawn(circle, int(kept.sum()) if series.turns else 1, least, count, seed)
    if len(shifts.frames) < min(FEWEST_SHIFTS, count):
        raise ParameterError(
            f"{len(rest)} frames can be shifted in {len(shifts.frames)} ways only, beyond {least} frames to "
            f"either side, too few for a p-value: pass at least {4 * (past + FEWEST_SHIFTS)} frames, a "
            "smaller max_order, or surrogates=0"
        )
    shifted = ShiftedSource(rest[:, kept], used[:, kept], past, shifts)
    fixed = _lags(held, followed, past)
    columns = np.column_stack([held.basis, fixed, held.left])
    products = shifted.with_columns(held.rows.table(columns, len(rest))[:, kept])
    size = held.basis.shape[1]
    along, across, with_target = products[..., :size], products[..., size:-1], products[..., -1]
    square = shifted.with_itself() - along @ along.transpose(0, 2, 1)
    square += across + across.transpose(0, 2, 1) + fixed.T @ fixed
    return best_gain(held, explained(square, with_target + fixed.T @ held.left), price)[0]


def split_source(series: LayerSeries, orders: Orders) -> tuple[FloatArray, FloatArray]:
    """The source's regression on all others, now and before, and the rest, as tables (T, S).

    The rest has mean 0 in each sector; both are 0 where they are not known.
    """
    known = np.isfinite(series.source)
    rows = Rows.of(known)
    source = rows.table(rows.lagged(series.source, range(1))[0], len(known))
    blocks = [(one, orders.own) for one in (series.target, *series.beside)]
    blocks += [(one, orders.given) for one in series.given]
    longest = max(order for _, order in blocks)
    complete = known & _has_past(blocks)
    complete[:longest] = False
    rows = Rows.of(complete)
    columns = [column for one, order in blocks for column in rows.lagged(one, range(order + 1))]
    basis = orthonormal(columns, rows.size)
    values = rows.centred(source[rows.frame, rows.sector])
    followed = rows.table(basis @ (basis.T @ values), len(known))
    return followed, np.where(known, source - followed, 0.0)


def memory(series: FloatArray) -> int:
    """Frames after which series (T, S) have forgotten what they were: autocorrelation below 1/e."""
    spectrum = np.abs(np.fft.rfft(series, n=2 * len(series), axis=0)) ** 2
    products = np.fft.irfft(spectrum.sum(axis=1))[: len(series)]
    below = np.nonzero(products < _MEMORY * products[0])[0]
    return int(below[0]) if below.size else len(series)


def _has_past(blocks: list[tuple[FloatArray, int]]) -> BoolArray:
    known = np.ones(blocks[0][0].shape, dtype=bool)
    for one, order in blocks:
        finite = np.isfinite(one)
        for lag in range(order + 1):
            known[lag:] &= finite[: len(finite) - lag]
    return known


def _lags(held: Held, followed: FloatArray, past: int) -> FloatArray:
    """What the held columns leave of lags of the part that is not shifted, shape (N, past)."""
    return without(np.column_stack(held.rows.lagged(followed, range(1, past + 1))), held.basis)

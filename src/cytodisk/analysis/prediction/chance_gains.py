"""Gains that sources have by chance: what is left of the source is shifted, what predicts it stays."""

from __future__ import annotations

from itertools import product

import numpy as np

from cytodisk.analysis.correlation.correlation_parameters import FEWEST_SURROGATES
from cytodisk.analysis.prediction.lagged_design import Rows
from cytodisk.analysis.prediction.layer_series import LayerSeries
from cytodisk.analysis.prediction.pooled_autoregression import Held, best_gain, explained, without
from cytodisk.analysis.prediction.prediction_orders import Orders, penalty
from cytodisk.analysis.prediction.source_scales import Scales
from cytodisk.analysis.prediction.source_shifts import ShiftedSource, Shifts, circle_of
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import ParameterError


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
        There are too few shifts, or gaps leave too few rows.

    Notes
    -----
    The source is split into what target, neighbours and given signals say of it, of the same frame and
    before, and the rest. Only the rest is shifted, in time and around the cell: the surrogate hangs together
    with all of these as the source does, and its rest keeps its correlations in time and between sectors.
    How much the rest varies in each sector, and around each frame, stays in its place: where both signals
    vary more at the front, or in the same minutes, their products scatter more than those of a source that is
    shifted as a whole.
    Shifts by less than the past that is tried, to either side, are left out: what is true comes back in them.
    More are not: where few are left, which hang together with each other but not with the source, the source
    is beyond all of them too often. A series that cannot be turned has so few that half of the surrogates
    are shifts of its rest on reversed time, which keeps its correlations, too.
    """
    used = held.rows.table(np.ones(held.rows.size), len(series.target)).astype(bool)
    kept = held.rows.count > 0
    followed, rest = split_source(series, orders, past)
    circle = circle_of(len(rest))
    around = int(kept.sum()) if series.turns else 1
    shifts = Shifts.drawn(circle, around, past, count, seed)
    if len(shifts.frames) < min(FEWEST_SURROGATES, count):
        raise ParameterError(
            f"{len(rest)} frames can be shifted in {len(shifts.frames)} ways only, beyond {past} frames to "
            f"either side, too few for a p-value: pass at least {2 * past + FEWEST_SURROGATES} frames, a "
            "smaller max_order, or surrogates=0"
        )
    scales = Scales.of(rest[:, kept], rest[:, kept] != 0.0, 0.5 * past)
    fixed = _lags(held, followed, past)
    tables = held.rows.table(np.column_stack([held.basis, fixed, held.left]), len(rest))[:, kept]
    ways = [(rest[:, kept], shifts)]
    if around == 1:
        ways = _also_reversed(rest[:, kept], scales, shifts, count, seed)
    found = [ShiftedSource(one, used[:, kept], past, by, scales).products(tables) for one, by in ways]
    products, square = (np.concatenate(some) for some in zip(*found, strict=True))
    size = held.basis.shape[1]
    along, across, with_target = products[..., :size], products[..., size:-1], products[..., -1]
    square += fixed.T @ fixed - along @ along.transpose(0, 2, 1)
    square += across + across.transpose(0, 2, 1)
    return best_gain(held, explained(square, with_target + fixed.T @ held.left), price)[0]


def _also_reversed(
    rest: FloatArray, scales: Scales, shifts: Shifts, count: int, seed: int
) -> list[tuple[FloatArray, Shifts]]:
    """Shifts of the rest, and of the rest on reversed time, half of each where there are enough."""
    back = Shifts.drawn(circle_of(len(rest)), 1, 1, count // 2, seed + 1)
    forth = count - len(back.frames)
    return [
        (rest, Shifts(shifts.frames[:forth], shifts.sectors[:forth])),
        ((rest / scales.table)[::-1] * scales.table, back),
    ]


def split_source(series: LayerSeries, orders: Orders, past: int) -> tuple[FloatArray, FloatArray]:
    """What all others, now and before, say of the source, and the rest, as tables (T, S).

    Both are 0 where they are not known; the rest has mean 0 in each sector.

    Raises
    ------
    ParameterError
        Gaps leave fewer rows than twice the coefficients.

    Notes
    -----
    Slow series seem to hang together where they do not (Granger and Newbold 1974,
    doi:10.1016/0304-4076(74)90034-7): the coefficients are those of series that the source's own
    autoregression has made white (Cochrane and Orcutt 1949, doi:10.1080/01621459.1949.10483290). BIC chooses
    how many there are, often none: what fits by chance would be taken out of the rest, and the rest would
    then hang together with the target less than chance has it, at every shift.
    """
    known = np.isfinite(series.source)
    rows = Rows.of(known)
    source = rows.table(rows.lagged(series.source, range(1))[0], len(known))
    blocks = [(one, orders.own) for one in (series.target, *series.beside)]
    blocks += [(one, orders.given) for one in series.given]
    memory = _own_memory(series.source, past)
    white = [(_filtered(one, memory), order) for one, order in blocks]
    target = _filtered(series.source, memory)
    rows = Rows.of(np.isfinite(target) & _has_past(white))
    columns, wanted = _columns(rows, white), rows.lagged(target, range(1))[0]
    if rows.size - rows.sectors < 2 * columns.shape[1]:
        raise ParameterError(
            f"gaps leave {rows.size} rows (frames times sectors) with the {past} frames before that "
            f"surrogates need, too few for {columns.shape[1]} coefficients: fill in short gaps, or pass a "
            "smaller max_order, or surrogates=0"
        )
    counts, chosen = _telling(columns, wanted, [order + 1 for _, order in blocks], 1 + len(series.beside))
    if not chosen:
        return np.zeros(known.shape), source
    says = np.linalg.lstsq(columns[:, chosen], wanted, rcond=None)[0]
    blocks = [(one, count - 1) for (one, _), count in zip(blocks, counts, strict=True) if count]
    rows = Rows.of(known & _has_past(blocks))
    followed = rows.table(_columns(rows, blocks) @ says, len(known))
    rest = Rows.of(known)
    left = rest.lagged(source - followed, range(1))[0]
    return followed, rest.table(left, len(known))


def _telling(
    columns: FloatArray, wanted: FloatArray, most: list[int], own: int
) -> tuple[list[int], list[int]]:
    """How many columns of each series have the smallest BIC, and which; none if they say nothing.

    The first `own` series have as many columns as each other, and so have those that are given.
    """
    triangle = _triangle(np.column_stack([columns, wanted]))
    starts = np.cumsum([0, *most])
    price = penalty("bic", len(wanted))
    best: tuple[float, list[int], list[int]] = (np.inf, [], [])
    for target, given in product(range(most[0] + 1), range(most[-1] + 1 if len(most) > own else 1)):
        counts = [target] * own + [given] * (len(most) - own)
        chosen = [start + k for start, count in zip(starts, counts, strict=False) for k in range(count)]
        along = _triangle(triangle[:, [*chosen, -1]])[len(chosen) :, -1]
        left = max(float(along @ along), float(np.finfo(np.float64).tiny))
        value = len(wanted) * np.log(left) + price * len(chosen)
        if value < best[0]:
            best = (value, counts, chosen)
    return best[1:]


def _triangle(columns: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.qr(columns, mode="r"), dtype=np.float64)


def _own_memory(series: FloatArray, past: int) -> FloatArray:
    """Coefficients of lags 1 to `past` in an autoregression of series (T, S)."""
    rows = Rows.of(_has_past([(series, past)]))
    columns = np.column_stack(rows.lagged(series, range(1, past + 1)))
    wanted = rows.lagged(series, range(1))[0]
    return np.asarray(np.linalg.lstsq(columns, wanted, rcond=None)[0])


def _filtered(series: FloatArray, memory: FloatArray) -> FloatArray:
    """Series (T, S) less what a memory says of them; NaN where that is not known."""
    frames, past = len(series), len(memory)
    white = np.full(series.shape, np.nan)
    white[past:] = series[past:]
    for lag, coefficient in enumerate(memory, 1):
        white[past:] -= coefficient * series[past - lag : frames - lag]
    return white


def _columns(rows: Rows, blocks: list[tuple[FloatArray, int]]) -> FloatArray:
    """Lags 0, 1, … of each of a few series, as far back as its order."""
    return np.column_stack([one for series, order in blocks for one in rows.lagged(series, range(order + 1))])


def _has_past(blocks: list[tuple[FloatArray, int]]) -> BoolArray:
    known = np.ones(blocks[0][0].shape, dtype=bool)
    for one, order in blocks:
        finite = np.isfinite(one)
        for lag in range(order + 1):
            known[:lag] = False
            known[lag:] &= finite[: len(finite) - lag]
    return known


def _lags(held: Held, followed: FloatArray, past: int) -> FloatArray:
    """What the held columns leave of lags of the part that is not shifted, shape (N, past)."""
    return without(np.column_stack(held.rows.lagged(followed, range(1, past + 1))), held.basis)

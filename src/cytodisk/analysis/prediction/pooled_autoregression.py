"""One autoregression for a layer: what the source adds to it, and what shifted sources add."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

from cytodisk.analysis.prediction.lagged_design import DEPENDENT, Rows, orthonormal
from cytodisk.analysis.prediction.layer_series import LayerSeries
from cytodisk.analysis.prediction.prediction_orders import Orders
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError

_LEVEL = 0.95


@dataclass(frozen=True, eq=False)
class Held:
    """What is held against the source: the past of target, neighbours and given signals.

    Attributes
    ----------
    rows : Rows
    basis : ndarray of shape (N, K) and dtype float
        Orthonormal columns that span that past, centred by sector.
    left : ndarray of shape (N,) and dtype float
        What they leave of the target.
    own_variance : float
        Of the target, within sectors.
    """

    rows: Rows
    basis: FloatArray
    left: FloatArray
    own_variance: float

    @classmethod
    def of(cls, series: LayerSeries, rows: Rows, orders: Orders) -> Held:
        """Held columns at chosen orders."""
        blocks = [(one, orders.own) for one in (series.target, *series.beside)]
        blocks += [(one, orders.given) for one in series.given]
        columns = [column for one, order in blocks for column in rows.lagged(one, range(1, order + 1))]
        basis = orthonormal(columns)
        target = rows.lagged(series.target, range(1))[0]
        left = without(target, basis)
        if left @ left <= DEPENDENT**2 * (target @ target):
            raise ParameterError(
                "the target is a linear function of its own past and the given signals' to the last digit: "
                "nothing is left to predict"
            )
        return cls(rows, basis, left, float(target @ target) / rows.size)

    @property
    def residual(self) -> float:
        """Sum of squares that is left without the source."""
        return float(self.left @ self.left)


@dataclass(frozen=True, eq=False)
class SourceFit:
    """The source's past in the full model.

    Attributes
    ----------
    coefficient, low, high : ndarray of shape (q,) and dtype float
        Of lags 1 to q, with 95 % intervals that are robust to sectors that move together in a frame.
    spread_ratio : float
        Standard deviation of the source over that of the target, within sectors.
    """

    coefficient: FloatArray
    low: FloatArray
    high: FloatArray
    spread_ratio: float

    @property
    def effect(self) -> float:
        """Sum of the coefficients, in standard deviations of the target for one of the source."""
        return float(self.coefficient.sum() * self.spread_ratio)


def without(columns: FloatArray, basis: FloatArray) -> FloatArray:
    """Columns without their part in the span of a basis; twice, for the last digits."""
    for _ in range(2):
        columns = columns - basis @ (basis.T @ columns)
    return columns


def source_columns(held: Held, series: LayerSeries, past: int) -> FloatArray:
    """What the held columns leave of lags 1 to `past` of the source, shape (N, past).

    Raises
    ------
    ParameterError
        Nothing: the source says what others say already.
    """
    columns = np.column_stack(held.rows.lagged(series.source, range(1, past + 1)))
    left = without(columns, held.basis)
    if np.linalg.norm(left[:, 0]) <= DEPENDENT * np.linalg.norm(columns[:, 0]):
        raise ParameterError(
            "the past of the source is a linear function of the target's past and the given signals': pass "
            "another source, or do not give it"
        )
    return left


def explained(square: FloatArray, with_target: FloatArray) -> FloatArray:
    """Sum of squares that the first 1, 2, … columns explain, by Cholesky steps for all surrogates at once.

    Parameters
    ----------
    square : ndarray of shape (R, Q, Q) and dtype float
        Products of the columns.
    with_target : ndarray of shape (R, Q) and dtype float

    Returns
    -------
    ndarray of shape (R, Q) and dtype float
        A column that those before it span adds nothing.
    """
    left, along = square.copy(), with_target.copy()
    diagonal = np.einsum("rqq->rq", square)
    total = np.zeros(with_target.shape)
    for k in range(square.shape[1]):
        pivot = left[:, k, k]
        adds = pivot > DEPENDENT * np.maximum(diagonal[:, k], np.finfo(np.float64).tiny)
        inverse = np.where(adds, 1.0 / np.where(adds, pivot, 1.0), 0.0)
        total[:, k] = along[:, k] ** 2 * inverse
        factor = left[:, :, k] * inverse[:, None]
        along = along - factor * along[:, k, None]
        left = left - factor[:, :, None] * left[:, k, None, :]
    return np.asarray(np.cumsum(total, axis=1))


def best_gain(
    held: Held, explained_squares: FloatArray, price: float | None
) -> tuple[FloatArray, FloatArray]:
    """Gain at the order that the criterion chooses, or at the last one without a price.

    Parameters
    ----------
    held : Held
    explained_squares : ndarray of shape (R, Q) and dtype float
    price : float or None
        Of a coefficient.

    Returns
    -------
    gain : ndarray of shape (R,) and dtype float
        ln(sum of squares without the source / with it), in nats.
    order : ndarray of shape (R,) and dtype int
    """
    most = held.residual * (1.0 - np.finfo(np.float64).eps)
    gains = -np.log1p(-np.minimum(explained_squares, most) / held.residual)
    orders = np.arange(1, gains.shape[1] + 1)
    if price is None:
        chosen = np.full(len(gains), orders[-1])
    else:
        chosen = orders[np.argmax(held.rows.size * gains - price * orders, axis=1)]
    return np.take_along_axis(gains, chosen[:, None] - 1, axis=1)[:, 0], chosen


def fit_source(held: Held, columns: FloatArray, source_variance: float) -> SourceFit:
    """Coefficients of the source's columns (N, q), of `source_columns`, with intervals by frame.

    Notes
    -----
    By the theorem of Frisch, Waugh and Lovell these are the coefficients of the full model. Rows of one frame
    may depend on each other; the variance is the sandwich of clusters, with Stata's factor for few of them.
    """
    basis, triangle = np.linalg.qr(columns)
    coefficient = np.linalg.lstsq(triangle, basis.T @ held.left, rcond=None)[0]
    error = held.left - columns @ coefficient
    bread = np.linalg.pinv(triangle)
    frames, place = np.unique(held.rows.frame, return_inverse=True)
    scores = np.zeros((len(frames), columns.shape[1]))
    np.add.at(scores, place, basis * error[:, None])
    size, used = held.rows.size, held.basis.shape[1] + columns.shape[1] + held.rows.sectors
    factor = len(frames) / (len(frames) - 1.0) * (size - 1.0) / (size - used)
    variance = factor * bread @ (scores.T @ scores) @ bread.T
    reach = student.ppf(0.5 + 0.5 * _LEVEL, len(frames) - 1) * np.sqrt(np.diag(variance))
    ratio = float(np.sqrt(source_variance / held.own_variance))
    return SourceFit(coefficient, coefficient - reach, coefficient + reach, ratio)

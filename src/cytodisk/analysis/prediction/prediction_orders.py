"""How much of the past a model holds: orders by a criterion, on the same rows for all of them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from cytodisk.analysis.prediction.lagged_design import Rows
from cytodisk.analysis.prediction.layer_series import LayerSeries
from cytodisk.analysis.prediction.prediction_parameters import Criterion, OrderParameters
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError


@dataclass(frozen=True)
class Orders:
    """Frames of past in a model.

    Attributes
    ----------
    own : int
        Of the target, and of its neighbours.
    given : int
        Of each signal that is given; 0 where none is.
    source : int
    """

    own: int
    given: int
    source: int


def longest_past(how: OrderParameters, given: bool) -> int:
    """Frames of past of the longest model that is tried: so many rows are lost at the start."""
    asked = [how.order, how.source_order, how.given_order if given else 0]
    return max(how.max_order if order is None else order for order in asked)


def penalty(criterion: Criterion, rows: int) -> float:
    """What a coefficient must add to the log-likelihood ratio."""
    return 2.0 if criterion == "aic" else float(np.log(rows))


def choose_orders(series: LayerSeries, rows: Rows, how: OrderParameters) -> Orders:
    """Orders at which the full model, with the source, has the smallest criterion.

    Parameters
    ----------
    series : LayerSeries
    rows : Rows
        Whose past is known as far back as any order reaches.
    how : OrderParameters

    Raises
    ------
    ParameterError
        There are too few rows for the longest model.
    """
    own, source = _tried(how.order, how.max_order), _tried(how.source_order, how.max_order)
    given = _tried(how.given_order, how.max_order) if series.given else range(1)
    blocks = [(series.target, own[-1]), *((one, own[-1]) for one in series.beside)]
    blocks += [(one, given[-1]) for one in series.given]
    _check_rows(rows, sum(order for _, order in blocks) + source[-1], how.max_order)
    columns = [column for one, order in blocks for column in rows.lagged(one, range(1, order + 1))]
    columns += rows.lagged(series.source, range(1, source[-1] + 1)) + rows.lagged(series.target, range(1))
    triangle = _triangle(np.column_stack(columns))
    price = penalty(how.criterion, rows.size)
    starts = np.cumsum([0, *(order for _, order in blocks)])
    best = (np.inf, Orders(own[0], given[0], source[0]))
    for p, m in product(own, given):
        orders = [p] * (1 + len(series.beside)) + [m] * len(series.given)
        held = [start + k for start, order in zip(starts, orders, strict=False) for k in range(order)]
        left = _left(triangle[:, [*held, *range(starts[-1], triangle.shape[1])]], len(held))
        for q in source:
            value = rows.size * np.log(left[q]) + price * (len(held) + q)
            if value < best[0]:
                best = (value, Orders(p, m, q))
    return best[1]


def _tried(order: int | None, most: int) -> range:
    return range(1, most + 1) if order is None else range(order, order + 1)


def _triangle(columns: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.qr(columns, mode="r"), dtype=np.float64)


def _left(triangle: FloatArray, held: int) -> FloatArray:
    """Sum of squares that each number of the last columns leaves of the very last one."""
    along = _triangle(triangle)[:, -1]
    from_end = np.cumsum((along**2)[::-1])[::-1]
    return np.asarray(np.maximum(from_end[held:], np.finfo(np.float64).tiny))


def _check_rows(rows: Rows, columns: int, max_order: int) -> None:
    free = rows.size - rows.sectors
    if free < 2 * columns:
        raise ParameterError(
            f"{rows.size} rows (frames times sectors) with a full past, in {rows.sectors} sectors, are too "
            f"few for {columns} coefficients: pass a smaller max_order than {max_order}, fewer given "
            "signals, or a longer movie"
        )

"""`medoid_cell`: the cell whose shape is most like those of all others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from cytodisk.analysis.shape.features import SCALE_FREE
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError

_MOST_OTHERS = 2000  # cells that each is compared with
_FARTHEST = 5.0  # spreads from the median beyond which a feature counts no more


def medoid_cell(features: pd.DataFrame, *, columns: Sequence[str] | None = None) -> int:
    """The cell with the smallest mean distance to all others in its shape.

    Parameters
    ----------
    features : DataFrame
        As `shape_features` returns it: a row a cell. Rows without any of the columns are left out.
    columns : sequence of str, optional
        What counts; by default the scale-free features and the area, those of them that are there.

    Returns
    -------
    int
        Position of its row, from 0.

    Raises
    ------
    ParameterError
        There is no such column, or no row with a number.

    See Also
    --------
    shape_features : Measures the shape of cells.

    Notes
    -----
    Shapes are compared by features, each over the distance of its quartiles: windows of equal areas have
    the same areas in all cells, so that they say nothing of the shape. The mean of cells is no cell; the
    medoid is one.

    Examples
    --------
    >>> import cytodisk as cd
    >>> masks = [cd.simulate.ellipse((20, long)) for long in (20, 26, 30, 60)]
    >>> cd.medoid_cell(cd.shape_features(masks))
    2
    """
    names = [name for name in (columns or (*SCALE_FREE, "area")) if name in features]
    missing = [name for name in columns or () if name not in features]
    if missing or not names:
        what = f"has no column {missing[0]!r}" if missing else "has no feature of shape"
        raise ParameterError(f"features {what}: pass the table of shape_features")
    table = features[names].to_numpy(dtype=np.float64, na_value=np.nan)
    rows = np.flatnonzero(np.isfinite(table).any(axis=1))
    if not len(rows):
        raise ParameterError("features has no row with a number: pass a table of at least one mapped cell")
    scaled = _scaled(table[rows])
    others = scaled[np.unique(np.linspace(0, len(rows) - 1, min(len(rows), _MOST_OTHERS)).astype(np.int64))]
    distance = np.zeros(len(rows))
    for other in others:
        distance += np.sqrt(np.square(scaled - other).sum(axis=1))
    return int(rows[np.argmin(distance)])


def _scaled(table: FloatArray) -> FloatArray:
    """Features from their medians in distances of quartiles; 0 where one is unknown or never differs."""
    columns = []
    for column in table.T:
        known = column[np.isfinite(column)]
        if not len(known):
            continue
        low, middle, high = np.percentile(known, (25.0, 50.0, 75.0))
        spread = high - low or float(np.ptp(known))
        if spread > 0.0:
            away = np.clip((column - middle) / spread, -_FARTHEST, _FARTHEST)
            columns.append(np.where(np.isfinite(column), away, 0.0))
    return np.column_stack(columns) if columns else np.zeros((len(table), 1))

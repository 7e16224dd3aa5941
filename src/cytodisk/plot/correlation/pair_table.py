"""Correlation of all pairs of windows of a cell, by distance and lag, as arrays to draw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.correlation.lag_axis import LagUnit, rows_of_cell

_FEWEST = 0.5  # pairs in a bin that is drawn, over the windows: fewer are noise, mostly the farthest
_COLUMNS = {"cell", "along", "distance", "lag", "correlation", "lower_quartile", "upper_quartile", "n"}
_KINDS = {
    "straight": "straight distance",
    "interior": "distance inside the cell",
    "edge": "distance along the edge",
}


@dataclass(frozen=True, eq=False)
class PairTable:
    """Correlation of pairs for one kind of distance.

    Attributes
    ----------
    along : str
        Kind of distance.
    distance : ndarray of shape (D,) and dtype float
        Middles of equally wide bins, up to the last that holds enough pairs; the first may be 0, of windows
        paired with themselves.
    lag : ndarray of shape (K,) and dtype float
    correlation, lower, upper : ndarray of shape (D, K) and dtype float
        Mean over pairs, and quartiles; NaN in bins with too few.
    threshold : float
        NaN when it was not tested.
    lag_unit : LagUnit
    distance_unit : str
    fewest : int
        Pairs that a bin must hold, half as many as there are windows.
    """

    along: str
    distance: FloatArray
    lag: FloatArray
    correlation: FloatArray
    lower: FloatArray
    upper: FloatArray
    threshold: float
    lag_unit: LagUnit
    distance_unit: str
    fewest: int

    @classmethod
    def of(cls, pairs: pd.DataFrame, *, along: str = "straight", cell: int = 0) -> PairTable:
        """Bins with enough pairs of one cell and kind of distance.

        Parameters
        ----------
        pairs : DataFrame
            `pairs` of a study's correlation, with the unit of distances in `attrs["units"]`.
        along : str
        cell : int

        Raises
        ------
        ParameterError
            The table lacks columns, the cell or the kind of distance, or bins with enough pairs.
        """
        rows = rows_of_cell(pairs, cell, _COLUMNS, "pairs")
        if along not in set(rows["along"]):
            raise ParameterError(f"along must be one of {sorted(set(rows['along']))}, got {along!r}")
        rows = rows[rows["along"] == along]
        unit, fewest = LagUnit.of(rows), _fewest(rows)
        rows = unit.shown(rows)
        names = ("correlation", "lower_quartile", "upper_quartile", "n")
        wide = [rows.pivot(index="distance", columns=unit.column, values=name) for name in names]
        mean, low, high, n = (table.to_numpy(dtype=np.float64) for table in wide)
        distance = wide[0].index.to_numpy(dtype=np.float64)
        enough = (n >= fewest) & np.isfinite(mean)
        held = enough.any(axis=1)
        if not (held & (distance > 0)).any():
            raise ParameterError(
                f"pairs has no correlation of different windows of cell {cell} along {along!r}"
            )
        until = slice(int(np.flatnonzero(held)[-1]) + 1)
        mean, low, high = (np.where(enough, table, np.nan)[until] for table in (mean, low, high))
        return cls(
            along=along,
            distance=distance[until],
            lag=wide[0].columns.to_numpy(dtype=np.float64),
            correlation=mean,
            lower=low,
            upper=high,
            threshold=float(rows["threshold"].iloc[0]) if "threshold" in rows else np.nan,
            lag_unit=unit,
            distance_unit=str(pairs.attrs.get("units", {}).get("distance", "")),
            fewest=fewest,
        )

    @property
    def title(self) -> str:
        """What the distance is."""
        return _KINDS.get(self.along, f"distance ({self.along})")

    @property
    def label(self) -> str:
        """Label of the axis of distance."""
        return f"{self.title} ({self.distance_unit})" if self.distance_unit else self.title

    @property
    def peak(self) -> int:
        """Index of the lag at which the mean's magnitude is largest, of all distances."""
        place = int(np.nanargmax(np.abs(self.correlation)))
        return place % len(self.lag)

    @property
    def width(self) -> float:
        """Width of a bin: the middle of the first above 0 is half of it."""
        return 2.0 * float(self.distance[self.distance > 0][0])

    @property
    def longest(self) -> float:
        """End of the last bin."""
        return float(self.distance[-1]) + 0.5 * self.width


def drawn_kinds(pairs: pd.DataFrame, cell: int) -> list[str]:
    """Kinds of distance that a cell has enough pairs of different windows for, in the order to draw them.

    Parameters
    ----------
    pairs : DataFrame
        `pairs` of a study's correlation.
    cell : int

    Returns
    -------
    list of str
    """
    found = []
    for along in _KINDS:
        rows = pairs[(pairs["cell"] == cell) & (pairs["along"] == along) & (pairs["distance"] > 0)]
        if ((rows["n"] >= _fewest(rows)) & rows["correlation"].notna()).any():
            found.append(along)
    return found


def _fewest(rows: pd.DataFrame) -> int:
    """Half as many pairs as there are windows, whose square all pairs are."""
    every = rows.groupby("distance")["n"].max().sum()
    return max(1, int(np.ceil(_FEWEST * np.sqrt(float(every)))))

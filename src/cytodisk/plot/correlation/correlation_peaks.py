"""Peaks of a cell's correlations by window, as arrays to draw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np
import pandas as pd
from matplotlib.colors import Colormap

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.checks import one_of, positive_number
from cytodisk.errors import ParameterError
from cytodisk.plot.correlation.lag_axis import LagUnit, rows_of_cell
from cytodisk.plot.style import DIVERGING_COLOURS, colour_map
from cytodisk.windows.polar_windows import PolarGrid

LAG_COLOURS = "PuOr"
"""Diverging as those of correlations, for colour-blind eyes too, and not taken for them."""

Shown: TypeAlias = Literal["correlation", "lag"]

_PERCENTILE, _STEP = 99.0, 0.1  # limits of correlations: what 99 % stay within, rounded up
_COLUMNS = {"cell", "layer", "sector", "correlation", "lag"}


@dataclass(frozen=True, eq=False)
class PeakMap:
    """Peaks of one cell's windows.

    Attributes
    ----------
    correlation, lag : ndarray of shape (layers, sectors) and dtype float
        NaN where a window has no correlation.
    significant : ndarray of shape (layers, sectors) and dtype bool, or None
        Where q is below `alpha`; None when it was not tested.
    lag_unit : LagUnit
    alpha : float
    cluster : ndarray of shape (layers, sectors) and dtype int, or None
        Number of each window's cluster, 0 for none; None when there are no clusters in the table.
    lost : tuple of int
        Numbers of the clusters that do not survive once the controls are regressed out.

    Examples
    --------
    >>> import cytodisk as cd
    >>> signal, velocity = cd.simulate.independent_series("ar1", 0, 60, 3, 8)
    >>> peaks = cd.peak_correlation(cd.cross_correlate(signal, velocity, max_lag=5))
    >>> table = peaks.to_dataframe().reset_index().assign(cell=0)
    >>> cd.plot.PeakMap.of(table, cd.polar_windows(layers=3, sectors=8)).correlation.shape
    (3, 8)
    """

    correlation: FloatArray
    lag: FloatArray
    significant: BoolArray | None
    lag_unit: LagUnit
    alpha: float
    cluster: IntArray | None = None
    lost: tuple[int, ...] = ()

    @classmethod
    def of(
        cls,
        windows: pd.DataFrame,
        grid: PolarGrid,
        *,
        cell: int = 0,
        alpha: float = 0.05,
        lost: Sequence[int] = (),
    ) -> PeakMap:
        """Peaks as tables by layer and sector.

        Parameters
        ----------
        windows : DataFrame
            `windows` of a study's correlation: cell, layer, sector, correlation, lag; lag_s, q and cluster
            where they are known.
        grid : PolarGrid
        cell : int
        alpha : float
            Share of false discoveries that is accepted.
        lost : sequence of int
            Clusters that do not survive once the controls are regressed out.

        Raises
        ------
        ParameterError
            The table lacks columns or the cell, has windows beyond the grid, or alpha is not in (0, 1).
        """
        if not 0.0 < alpha < 1.0:
            raise ParameterError(f"alpha must be between 0 and 1, got {alpha!r}: 0.05 is the default")
        rows = rows_of_cell(windows, cell, _COLUMNS, "windows")
        layer, sector = (rows[name].to_numpy(dtype=np.int64) for name in ("layer", "sector"))
        if layer.max() >= grid.layers or sector.max() >= grid.sectors:
            raise ParameterError(
                f"windows has layer {layer.max()} and sector {sector.max()}, the grid {grid.layers} layers "
                f"and {grid.sectors} sectors: pass the grid of the study"
            )
        unit = LagUnit.of(rows)
        rows, tables = unit.shown(rows), {}
        for name in ("correlation", unit.column, "q"):
            tables[name] = np.full((grid.layers, grid.sectors), np.nan)
            if name in rows:
                tables[name][layer, sector] = rows[name].to_numpy(dtype=np.float64)
        tested = bool(np.isfinite(tables["q"]).any())
        significant = tables["q"] < alpha if tested else None
        cluster = None
        if "cluster" in rows:
            cluster = np.zeros((grid.layers, grid.sectors), dtype=np.int64)
            cluster[layer, sector] = rows["cluster"].to_numpy(dtype=np.int64)
        return cls(tables["correlation"], tables[unit.column], significant, unit, alpha, cluster, tuple(lost))

    @property
    def pale(self) -> BoolArray:
        """Windows with a correlation that is not significant, shape (layers, sectors)."""
        if self.significant is None:
            return np.zeros(self.correlation.shape, dtype=bool)
        return np.isfinite(self.correlation) & ~self.significant

    def limit(self, shown: Shown) -> float:
        """End of symmetric colours: percentile 99 of |correlation|, up to 1; the largest |lag|."""
        size = np.abs(self._values(shown))
        size = size[np.isfinite(size)]
        if not size.size:
            return 1.0
        if shown == "lag":
            return float(size.max()) or 1.0
        steps = np.ceil(np.round(float(np.percentile(size, _PERCENTILE)) / _STEP, 6))
        return float(np.clip(steps * _STEP, _STEP, 1.0))

    def _values(self, shown: Shown) -> FloatArray:
        return self.correlation if one_of("shown", shown, get_args(Shown)) == "correlation" else self.lag

    def picture(self, shown: Shown, limit: float | None) -> tuple[FloatArray, Colormap, tuple[float, float]]:
        """Values, colours and limits of a map."""
        values = self._values(shown)
        top = self.limit(shown) if limit is None else positive_number("limit", limit)
        return values, colour_map(LAG_COLOURS if shown == "lag" else DIVERGING_COLOURS), (-top, top)

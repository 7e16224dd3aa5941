"""Peaks of a correlation by window, as the figures show them."""

from __future__ import annotations

from cytodisk.plot.correlation.correlation_peaks import PeakMap
from cytodisk.store.correlation_store import Correlation
from cytodisk.windows.polar_windows import PolarGrid


def window_peaks(found: Correlation, cell: int, grid: PolarGrid) -> PeakMap | None:
    """Peaks of the windows of a cell; None for one that could not be correlated.

    Parameters
    ----------
    found : Correlation
    cell : int
    grid : PolarGrid
        Of the study.
    """
    if not (found.windows["cell"] == cell).any():
        return None
    return PeakMap.of(found.windows, grid, cell=cell)

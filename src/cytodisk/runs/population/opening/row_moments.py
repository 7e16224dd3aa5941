"""Where the windows of each cell lie in the image, summed up while they are read."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.runs.population.opening.streamed_windows import WindowBlock

_ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3))


@dataclass(frozen=True, eq=False)
class RowMoments:
    """Moments of the centroids of windows, weighted by area, and how the edge is turned against the disk.

    Attributes
    ----------
    centroid : ndarray of shape (rows, 2) and dtype float64
        (y, x) in the image of each cell, or frame of a cell.
    sectors : int
    sums : ndarray of shape (10, rows) and dtype float64
        Of x and y from the centroid, by `_ORDERS`.
    edge : ndarray of shape (rows,) and dtype complex128
        Sum over layer 0 of x + iy from the centroid, each turned back by its sector's angle.
    """

    centroid: FloatArray
    sectors: int
    sums: FloatArray = field(init=False)
    edge: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "sums", np.zeros((len(_ORDERS), len(self.centroid))))
        object.__setattr__(self, "edge", np.zeros(len(self.centroid), dtype=np.complex128))

    def add(self, block: WindowBlock) -> None:
        """Take windows into account, those of one channel."""
        y, x = block.numbers["centroid_y"], block.numbers["centroid_x"]
        weight = block.numbers["area"]
        known = np.isfinite(y) & np.isfinite(x) & (weight > 0)
        row = block.row[known]
        if not len(row):
            return
        y, x = y[known] - self.centroid[row, 0], x[known] - self.centroid[row, 1]
        few = _FewRows(row)
        powers: dict[tuple[int, int], FloatArray] = {(0, 0): weight[known]}
        for sums, (in_x, in_y) in zip(self.sums, _ORDERS, strict=True):
            if in_x:
                powers[in_x, in_y] = powers[in_x - 1, in_y] * x
            elif in_y:
                powers[in_x, in_y] = powers[in_x, in_y - 1] * y
            few.add(sums, powers[in_x, in_y])
        rim = block.layer[known] == 0
        angle = 2.0 * np.pi * (block.sector[known][rim] + 0.5) / self.sectors
        turned = np.zeros(len(row), dtype=np.complex128)
        turned[rim] = (x[rim] + 1j * y[rim]) * np.exp(-1j * angle)
        few.add(self.edge.real, turned.real)
        few.add(self.edge.imag, turned.imag)

    @property
    def turn(self) -> FloatArray:
        """Degrees that a direction in the disk is turned by in the image; NaN where no window is known."""
        with np.errstate(invalid="ignore"):
            return np.where(np.abs(self.edge) > 0, np.degrees(np.angle(self.edge)), np.nan)

    def long_axis(self) -> tuple[FloatArray, FloatArray]:
        """Direction of the long axis in the image, and how long it is.

        Returns
        -------
        direction : ndarray of shape (rows,) and dtype float64
            Degrees from +x towards +y. Of the two ends the one that reaches further out, as the thin end of a
            drop does: that at which the third moment is positive.
        strength : ndarray of shape (rows,) and dtype float64
            (a - b) / (a + b) of the ellipse with the same second moments: 0 for a circle.
        """
        with np.errstate(invalid="ignore", divide="ignore"):
            _, mx, my, xx, xy, yy, xxx, xxy, xyy, yyy = self.sums / self.sums[0]
            xxx, xxy = xxx - 3 * mx * xx + 2 * mx**3, xxy - 2 * mx * xy - my * xx + 2 * mx**2 * my
            xyy, yyy = xyy - 2 * my * xy - mx * yy + 2 * my**2 * mx, yyy - 3 * my * yy + 2 * my**3
            xx, xy, yy = xx - mx**2, xy - mx * my, yy - my**2
            angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
            c, s = np.cos(angle), np.sin(angle)
            skew = c**3 * xxx + 3 * c**2 * s * xxy + 3 * c * s**2 * xyy + s**3 * yyy
            middle, half = (xx + yy) / 2.0, np.hypot((xx - yy) / 2.0, xy)
            long, short = np.sqrt(middle + half), np.sqrt(np.maximum(middle - half, 0.0))
            direction = np.degrees(angle) + np.where(skew < 0.0, 180.0, 0.0)
            return direction % 360.0, (long - short) / (long + short)


class _FewRows:
    """The rows of a table that a block is about, which mostly are few and beside each other."""

    def __init__(self, row: IntArray) -> None:
        first = int(row.min())
        self._there = slice(first, int(row.max()) + 1)
        self._row = row - first

    def add(self, total: FloatArray, values: FloatArray) -> None:
        """Add values to the sums of their rows."""
        there = total[self._there]
        there += np.bincount(self._row, values, len(there))

"""How far a map is from keeping areas and angles."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.geometry.mesh import triangle_areas

PERCENTILES = (1, 5, 25, 50, 75, 95, 99)
LEAST_AREA, _LARGEST_STRETCH = 1e-200, 1e12  # so that a triangle without area has finite distortion


@dataclass(frozen=True)
class Distortion:
    """Distortion of a map, by triangle and in sum.

    Attributes
    ----------
    triangle_area_ratio : ndarray of shape (F,) and dtype float
        λ, a triangle's share of the disk's area over its share of the cell's; 1 is perfect. A triangle that
        is turned over counts by its size: the certificate tells that it is turned.
    triangle_stretch : ndarray of shape (F,) and dtype float
        K = σ₁ / σ₂, the ratio of the singular values of the map's Jacobian; 1 keeps angles. At most 1e12.
    area_share : ndarray of shape (F,) and dtype float
        Share of each triangle in the cell's area.

    Examples
    --------
    >>> import cytodisk as cd
    >>> distortion = cd.map_to_disk(cd.simulate.disk(20)).distortion
    >>> distortion.area < 0.05, distortion.angle < 1.1
    (True, True)
    """

    triangle_area_ratio: FloatArray
    triangle_stretch: FloatArray
    area_share: FloatArray

    @property
    def area(self) -> float:
        """Mean of |log λ| over the cell's area; 0 is perfect, 0.1 is about 10 % off."""
        return float((self.area_share * np.abs(np.log(self.triangle_area_ratio))).sum())

    @property
    def angle(self) -> float:
        """Median of K over the cell's area; 1 is conformal."""
        return self.angle_percentiles[50]

    @cached_property
    def area_percentiles(self) -> dict[int, float]:
        """Percentiles of λ over the cell's area."""
        return self._percentiles(self.triangle_area_ratio)

    @cached_property
    def angle_percentiles(self) -> dict[int, float]:
        """Percentiles of K over the cell's area."""
        return self._percentiles(self.triangle_stretch)

    def _percentiles(self, values: FloatArray) -> dict[int, float]:
        order = np.argsort(values)
        below = np.cumsum(self.area_share[order])
        at = np.searchsorted(below, np.array(PERCENTILES) / 100.0 * below[-1])
        return dict(zip(PERCENTILES, values[order[at]].tolist(), strict=True))


def distortion_of(vertices_yx: FloatArray, vertices_uv: FloatArray, triangles: IntArray) -> Distortion:
    """Distortion of a piecewise linear map from cell to disk.

    Parameters
    ----------
    vertices_yx, vertices_uv : ndarray of shape (V, 2) and dtype float
    triangles : ndarray of shape (F, 3) and dtype int

    Returns
    -------
    Distortion
    """
    cell = np.abs(triangle_areas(vertices_yx, triangles))  # turned ones, of a damaged file, count as well
    disk = triangle_areas(vertices_uv[:, ::-1], triangles)
    share = cell / cell.sum()
    sizes = np.maximum(np.abs(disk), LEAST_AREA)
    wide = _largest_stretches(
        np.ascontiguousarray(vertices_yx), np.ascontiguousarray(vertices_uv), np.ascontiguousarray(triangles)
    )
    wide = np.maximum(wide, LEAST_AREA)
    narrow = np.maximum(np.abs(disk) / cell / wide, wide / _LARGEST_STRETCH)
    return Distortion(sizes / disk.sum() / share, np.maximum(wide / narrow, 1.0), share)


@njit(cache=True)
def _largest_stretches(vertices_yx: FloatArray, vertices_uv: FloatArray, triangles: IntArray) -> FloatArray:
    """Largest singular value of each triangle's Jacobian, from its parts that keep and that turn angles."""
    stretches = np.empty(len(triangles))
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        y1, x1 = vertices_yx[b, 0] - vertices_yx[a, 0], vertices_yx[b, 1] - vertices_yx[a, 1]
        y2, x2 = vertices_yx[c, 0] - vertices_yx[a, 0], vertices_yx[c, 1] - vertices_yx[a, 1]
        u1, v1 = vertices_uv[b, 0] - vertices_uv[a, 0], vertices_uv[b, 1] - vertices_uv[a, 1]
        u2, v2 = vertices_uv[c, 0] - vertices_uv[a, 0], vertices_uv[c, 1] - vertices_uv[a, 1]
        u_x, u_y = u1 * y2 - u2 * y1, u2 * x1 - u1 * x2
        v_x, v_y = v1 * y2 - v2 * y1, v2 * x1 - v1 * x2
        kept, mirrored = math.hypot(u_x + v_y, v_x - u_y), math.hypot(u_x - v_y, v_x + u_y)
        stretches[t] = 0.5 * (kept + mirrored) / (x1 * y2 - x2 * y1)
    return stretches

import numpy as np
import pytest
from scipy import ndimage
from scipy.spatial import cKDTree

from cytodisk import simulate
from cytodisk.geometry.lattice import graded_lattice


def test_points_lie_inside_and_apart_and_get_sparser_with_depth() -> None:
    mask = simulate.disk(60.0)
    points = graded_lattice(mask, 1.0, 0.5)
    depth = 60.0 - np.hypot(*(points - 68.0).T)
    assert depth.min() > 0.0
    apart = cKDTree(points).query(points, k=2)[0][:, 1]
    assert apart.min() >= 1.0 - 1e-9
    assert np.median(apart[depth < 3.0]) < 2.0
    assert np.median(apart[depth > 40.0]) > 8.0


def test_no_growth_gives_the_whole_lattice() -> None:
    mask = np.ones((40, 40), dtype=bool)
    points = graded_lattice(mask, 2.0, 0.0)
    density = len(points) / (40.0 - 2.8) ** 2  # the clearance keeps points 1.4 px off each side
    np.testing.assert_allclose(density, 1.0 / (2.0**2 * np.sqrt(0.75)), rtol=0.06)


def test_a_thin_cell_has_no_interior_points() -> None:
    assert graded_lattice(np.ones((1, 30), dtype=bool), 1.0, 0.5).shape == (0, 2)


def plain_lattice(mask: np.ndarray, spacing: float, growth: float) -> np.ndarray:
    """The kernel's twin: every point of the lattice, its level and its depth, then what is kept."""
    pixels = np.argwhere(mask)
    centre = pixels.mean(axis=0)
    y, x = (pixels - centre).T
    angle = 0.5 * np.arctan2(2.0 * (x * y).sum(), (x * x).sum() - (y * y).sum())
    reach = 3 * int(np.hypot(*mask.shape) / spacing)
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(-reach, reach), np.arange(-reach, reach)))
    along, across = spacing * (i + 0.5 * j), spacing * np.sqrt(0.75) * j
    turn = np.array([[np.sin(angle), np.cos(angle)], [np.cos(angle), -np.sin(angle)]])
    points = centre + np.column_stack([along, across]) @ turn.T
    level, still = np.zeros(i.shape, dtype=int), np.ones(i.shape, dtype=bool)
    for _ in range(16):
        still &= (i - j) % 3 == 0
        level += still
        i, j = np.where(still, (2 * i + j) // 3, i), np.where(still, (j - i) // 3, j)
    depth = ndimage.map_coordinates(
        ndimage.distance_transform_edt(np.pad(mask, 1)) - 0.5, points.T + 1, order=1, cval=-1.0
    )
    coarser = np.floor(np.log1p(growth * np.maximum(depth, 0.0) / spacing) / np.log(np.sqrt(3.0)))
    return points[(level >= coarser) & (depth >= 0.75 * spacing)]


@pytest.mark.parametrize(("spacing", "growth"), [(0.9, 0.5), (1.5, 0.35), (2.0, 0.0)])
def test_the_kernel_agrees_with_its_plain_twin(spacing: float, growth: float) -> None:
    mask = simulate.random_smooth(3)[20:90, 20:90]
    fast, plain = graded_lattice(mask, spacing, growth), plain_lattice(mask, spacing, growth)
    assert len(fast) == len(plain) > 100
    assert cKDTree(plain).query(fast)[0].max() < 1e-9

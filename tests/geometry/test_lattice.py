import numpy as np
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

import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.mapping import map_to_disk
from cytodisk.geometry.locate import TriangleLocator, nearest_on_outline, weighted_corners


def locate_one_by_one(
    queries: np.ndarray, points: np.ndarray, triangles: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Plain twin of the kernel: the smallest barycentric coordinate of every query in every triangle."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    inverse = np.linalg.inv(np.stack([a - c, b - c], axis=-1))
    first_two = np.einsum("tij,qtj->qti", inverse, queries[:, None] - c)
    weights = np.concatenate([first_two, 1.0 - first_two.sum(axis=-1, keepdims=True)], axis=-1)
    smallest = weights.min(axis=-1)
    return smallest.max(axis=1), smallest


@pytest.mark.parametrize("frame", ["vertices_yx", "vertices_uv"])
@pytest.mark.parametrize("kind", ["smooth", "percolation", "spiral_thick"])
def test_the_kernel_agrees_with_a_plain_search(kind: str, frame: str) -> None:
    disk = map_to_disk(simulate.random_mask(kind, 7))
    points, triangles = getattr(disk, frame), disk.triangles
    low, high = points.min(axis=0), points.max(axis=0)
    queries = np.random.default_rng(0).uniform(low - 0.1, high + 0.1, size=(300, 2))
    triangle, weights = TriangleLocator(points, triangles)(queries)
    best, smallest = locate_one_by_one(queries, points, triangles)
    sure = np.abs(best) > 1e-6
    np.testing.assert_array_equal((triangle >= 0)[sure], (best > 0)[sure])
    found = np.flatnonzero(triangle >= 0)
    assert found.size > 20
    assert smallest[found, triangle[found]].min() > -1e-6
    rebuilt = (weights[found, :, None] * points[triangles[triangle[found]]]).sum(axis=1)
    np.testing.assert_allclose(rebuilt, queries[found], atol=1e-12 * np.ptp(points))
    np.testing.assert_allclose(weights[found].sum(axis=1), 1.0)


def test_vertices_and_edge_middles_are_inside() -> None:
    disk = map_to_disk(simulate.random_mask("comb", 3))
    for points in (disk.vertices_yx, disk.vertices_uv):
        locate = TriangleLocator(points, disk.triangles)
        loop = points[disk.boundary]
        middles = 0.5 * (loop + np.roll(loop, -1, axis=0))
        assert (locate(points)[0] >= 0).all()
        assert (locate(middles)[0] >= 0).all()


def test_outside_and_nan_are_nowhere() -> None:
    locate = TriangleLocator(np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]), np.array([[0, 1, 2]]))
    triangle, weights = locate(np.array([[0.6, 0.6], [np.nan, 0.1], [1e9, -1e9], [0.2, 0.2]]))
    np.testing.assert_array_equal(triangle, [-1, -1, -1, 0])
    assert np.isnan(weights[:3]).all()
    np.testing.assert_allclose(weights[3], [0.6, 0.2, 0.2])


def test_nearest_on_outline_agrees_with_a_search_over_all_edges() -> None:
    disk = map_to_disk(simulate.random_mask("spiky", 2))
    outline = disk.outline_yx
    points = np.random.default_rng(1).uniform(-5.0, np.array(disk.mask.shape) + 5.0, size=(200, 2))
    edge, fraction = nearest_on_outline(points, outline)
    following = np.roll(outline, -1, axis=0)
    nearest = outline[edge] + fraction[:, None] * (following - outline)[edge]
    along = following - outline
    share = np.clip(((points[:, None] - outline) * along).sum(-1) / (along**2).sum(-1), 0.0, 1.0)
    best = np.linalg.norm(points[:, None] - outline - share[..., None] * along, axis=-1).min(axis=1)
    np.testing.assert_allclose(np.linalg.norm(points - nearest, axis=1), best, atol=1e-9)


def test_weighted_corners_agree_with_numpy() -> None:
    random = np.random.default_rng(0)
    values, triangles = random.normal(size=(30, 2)), random.integers(0, 30, (20, 3))
    triangle = random.integers(-1, 20, 200)
    weights = random.dirichlet(np.ones(3), 200)
    found = weighted_corners(values, triangles, triangle, weights)
    nowhere = triangle < 0
    assert 0 < nowhere.sum() < 200
    assert np.isnan(found[nowhere]).all()
    expected = np.einsum("nk,nkd->nd", weights, values[triangles[triangle]])
    np.testing.assert_allclose(found[~nowhere], expected[~nowhere], rtol=1e-13, atol=1e-15)


def test_weighted_corners_of_no_points() -> None:
    nowhere = np.empty(0, dtype=np.int64)
    none = weighted_corners(np.ones((3, 2)), np.array([[0, 1, 2]]), nowhere, np.empty((0, 3)))
    assert none.shape == (0, 2)

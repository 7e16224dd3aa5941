from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial import cKDTree

from cytodisk import simulate
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import MeshError
from cytodisk.geometry import mesh as mesh_module
from cytodisk.geometry.even_mesh import even_out, join_circles
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mesh import Mesh, mesh_inside, triangle_areas
from cytodisk.geometry.outline import trace_outline

MOVES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "mirrored": lambda mask: mask[:, ::-1],
    "turned by 90 degrees": np.rot90,
    "turned by 180 degrees": lambda mask: mask[::-1, ::-1],
    "transposed": np.transpose,
}
LATTICE = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]])  # a square: four points on a circle


def mesh_of(mask: np.ndarray) -> Mesh:
    return mesh_inside(trace_outline(mask), mask, edge_length=0.9)


def where_it_goes(move: Callable[[np.ndarray], np.ndarray], shape: tuple[int, ...]) -> np.ndarray:
    """Row and column before the move of each pixel of the moved image, shape (H, W, 2)."""
    rows, columns = np.indices(shape)
    return np.stack([move(rows), move(columns)], axis=-1).astype(np.float64)


@pytest.mark.parametrize("move", MOVES.values(), ids=MOVES.keys())
@pytest.mark.parametrize("kind", ["smooth", "spiky", "comb"])
def test_a_moved_mask_gets_the_moved_mesh(kind: str, move: Callable[[np.ndarray], np.ndarray]) -> None:
    mask = clean_mask(simulate.random_mask(kind, 3))[0]
    here, there = mesh_of(mask), mesh_of(np.ascontiguousarray(move(mask)))
    before = where_it_goes(move, mask.shape)
    origin, down, right = before[0, 0], before[1, 0] - before[0, 0], before[0, 1] - before[0, 0]
    back = origin + there.vertices_yx[:, :1] * down + there.vertices_yx[:, 1:] * right
    away, same = cKDTree(here.vertices_yx).query(back)
    assert away.max() < 1e-9
    assert as_sets(same[there.triangles]) == as_sets(here.triangles)


def as_sets(triangles: IntArray) -> set[frozenset[int]]:
    return {frozenset(triangle) for triangle in triangles.tolist()}


@pytest.mark.parametrize("nearest", range(4))
@pytest.mark.parametrize("triangles", [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]])
def test_a_square_is_cut_from_its_corner_nearest_to_the_far_outline(
    nearest: int, triangles: list[list[int]]
) -> None:
    away = 40.0 * (LATTICE[nearest] - 0.5)
    outline = np.array([[3.0, 0.0], [0.0, 3.0], [-3.0, 0.0], [0.0, -3.0]]) + 0.5
    points = np.concatenate([outline, away[None] + 0.1, LATTICE])
    joined = join_circles(points, np.array(triangles) + 5, 5)
    shared = set(joined[0].tolist()) & set(joined[1].tolist())
    assert nearest + 5 in shared
    assert len(shared) == 2


def test_points_apart_from_circles_stay_as_they_are() -> None:
    points = np.concatenate([LATTICE, LATTICE + 0.01 * np.eye(4, 2)])
    triangles = np.array([[4, 5, 6], [4, 6, 7]])
    np.testing.assert_array_equal(join_circles(points, triangles, 4), triangles)


@pytest.mark.parametrize("kind", simulate.KINDS)
def test_vertices_even_out_and_no_triangle_turns_over(kind: str) -> None:
    mesh = mesh_of(clean_mask(simulate.random_mask(kind, 5))[0])
    points = np.asarray(even_out(mesh.vertices_yx, mesh.triangles, mesh.n_boundary))
    before, after = (triangle_areas(place, mesh.triangles) for place in (mesh.vertices_yx, points))
    assert (after > 1e-3 * before * (1.0 - 1e-9)).all()  # a tenth is left in each of three passes
    assert after.sum() == pytest.approx(before.sum(), rel=1e-9)
    np.testing.assert_array_equal(points[mesh.boundary], mesh.vertices_yx[mesh.boundary])


def test_a_vertex_among_others_comes_to_their_middle() -> None:
    angles = np.radians(np.arange(0.0, 360.0, 60.0))
    ring: FloatArray = np.column_stack([np.sin(angles), np.cos(angles)])
    triangles = np.column_stack([np.arange(6), np.roll(np.arange(6), -1), np.full(6, 6)])
    points = even_out(np.concatenate([ring, [[0.3, -0.2]]]), triangles, 6)
    np.testing.assert_allclose(points[:6], ring)
    assert np.hypot(*points[6]) < 0.05


def test_a_triangle_without_area_is_refused_as_such() -> None:
    outline = np.array([[0.0, 0.0], [0.0, 1.0], [0.0, 2.0], [3.0, 1.0]])
    triangles = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    flat = even_out(np.concatenate([outline, [[0.0, 1.0]]]), triangles[:2], 4)  # all of its triangles are
    assert np.isnan(flat[4]).all()
    with pytest.raises(MeshError, match="4 triangles have no area"):
        mesh_module.check_mesh(Mesh(flat, triangles, 4), outline)

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cytodisk import simulate
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.geometry.flips import flip_to_delaunay, triangle_neighbours
from cytodisk.geometry.half_edges import half_edges, triangle_edges
from cytodisk.geometry.mesh import triangle_areas


def plain_neighbours(triangles: IntArray) -> IntArray:
    sides = {(int(t[k]), int(t[(k + 1) % 3])): n for n, t in enumerate(triangles) for k in range(3)}
    return np.array([[sides.get((int(t[(k + 1) % 3]), int(t[k])), -1) for k in range(3)] for t in triangles])


def opposite_angle_sums(uv: FloatArray, triangles: IntArray, n_boundary: int) -> FloatArray:
    """Sum of the two angles opposite to each interior edge that may be flipped."""
    angle = {}
    for t in triangles.tolist():
        for k in range(3):
            a, b, c = t[k], t[(k + 1) % 3], t[(k + 2) % 3]
            p, q = uv[a] - uv[c], uv[b] - uv[c]
            angle[a, b] = np.arccos(np.clip(p @ q / (np.hypot(*p) * np.hypot(*q)), -1, 1)), c
    both = [(angle[a, b], angle[b, a]) for a, b in angle if a < b and (b, a) in angle]
    return np.array([one[0] + two[0] for one, two in both if max(one[1], two[1]) >= n_boundary])


def flipped(uv: FloatArray, xy: FloatArray, triangles: IntArray, n_boundary: int) -> tuple[IntArray, int]:
    out = triangles.copy()
    neighbours = triangle_neighbours(out)
    count = flip_to_delaunay(uv, np.ascontiguousarray(xy), out, neighbours, n_boundary, 1e-6)
    np.testing.assert_array_equal(neighbours, plain_neighbours(out))
    return out, count


RHOMBUS = np.array([[0.0, -1.0], [3.0, 0.0], [0.0, 1.0], [-3.0, 0.0]])
LONG_DIAGONAL = np.array([[0, 1, 3], [1, 2, 3]])


def test_a_rhombus_gets_its_shorter_diagonal() -> None:
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    after, count = flipped(RHOMBUS, square, LONG_DIAGONAL, 0)
    assert count == 1
    edges = {frozenset(edge) for edge in triangle_edges(after).tolist()}
    assert frozenset((0, 2)) in edges
    assert frozenset((1, 3)) not in edges


def test_an_edge_stays_that_would_leave_no_area_in_the_cell() -> None:
    cell = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 1.0]])  # 0, 2 and 3 are in line
    assert flipped(RHOMBUS, cell, LONG_DIAGONAL, 0)[1] == 0


def test_no_new_edge_joins_two_boundary_vertices() -> None:
    assert flipped(RHOMBUS, RHOMBUS, LONG_DIAGONAL, 0)[1] == 1
    assert flipped(RHOMBUS, RHOMBUS, LONG_DIAGONAL, 4)[1] == 0


def test_a_flip_turns_a_triangle_back() -> None:
    cell = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    triangles = np.array([[0, 1, 3], [1, 2, 3]])
    disk = cell.copy()
    disk[0] = [1.5, 1.2]  # over the diagonal 1–3
    assert triangle_areas(disk[:, ::-1], triangles).min() < 0
    after, _ = flipped(disk, cell, triangles, 0)
    assert triangle_areas(disk[:, ::-1], after).min() > 0


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 999), shear=st.floats(0.0, 3.0), noise=st.floats(0.0, 0.3))
def test_flips_keep_a_triangulation_and_end_delaunay(seed: int, shear: float, noise: float) -> None:
    mesh = mesh_cell(simulate.disk(9.0), MappingParameters(edge_length=1.2, method="advection")).mesh
    xy, n = np.ascontiguousarray(mesh.vertices_yx[:, ::-1]), mesh.n_boundary
    uv = xy @ np.array([[1.0, 0.0], [shear, 1.0]])
    moved = uv + noise * np.random.default_rng(seed).standard_normal(uv.shape)
    for disk in (uv, moved):
        after, _ = flipped(disk, xy, mesh.triangles, n)
        areas = triangle_areas(mesh.vertices_yx, after)
        assert areas.min() > 1e-6
        np.testing.assert_allclose(areas.sum(), triangle_areas(mesh.vertices_yx, mesh.triangles).sum())
        assert half_edges(after, len(xy)).euler_characteristic == 1
        assert len(np.unique(after)) == len(xy)
        before = (triangle_areas(disk[:, ::-1], mesh.triangles) <= 0).sum()
        assert (triangle_areas(disk[:, ::-1], after) <= 0).sum() <= before
    after, _ = flipped(xy, xy, mesh.triangles, n)  # the cell itself: nothing stands in the way
    assert opposite_angle_sums(xy, after, n).max() < np.pi + 1e-6


@pytest.mark.parametrize("kind", ["spiky", "smooth"])
def test_neighbours_agree_with_their_plain_twin(kind: str) -> None:
    triangles = mesh_cell(simulate.random_mask(kind, 3), MappingParameters(edge_length=2.0)).mesh.triangles
    np.testing.assert_array_equal(triangle_neighbours(triangles), plain_neighbours(triangles))

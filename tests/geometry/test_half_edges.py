import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.geometry.half_edges import half_edges, triangle_edges
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mesh import mesh_inside
from cytodisk.geometry.outline import trace_outline

AROUND = np.arange(3)
ONWARDS = (AROUND + 1) % 3
ANNULUS = np.concatenate(
    [np.column_stack([AROUND, ONWARDS, ONWARDS + 3]), np.column_stack([AROUND, ONWARDS + 3, AROUND + 3])]
)


@pytest.mark.parametrize(
    "triangles", [ANNULUS, np.array([[0, 1, 2], [2, 1, 3], [2, 1, 4]]), np.array([[0, 1, 2], [0, 1, 2]])]
)
def test_edges_are_those_of_the_triangles_also_where_they_are_no_surface(triangles: np.ndarray) -> None:
    n_vertices = int(triangles.max()) + 2
    edges = half_edges(triangles, n_vertices)
    listed = sorted(map(tuple, triangle_edges(triangles).tolist()))
    assert list(zip(edges.start.tolist(), edges.end.tolist(), strict=True)) == listed
    assert edges.outer.tolist() == [(b, a) not in listed for a, b in listed]
    assert edges.n_edges == len({frozenset(edge) for edge in listed})
    assert not edges.all_used  # the last vertex belongs to no triangle


def test_euler_characteristic_of_an_annulus_is_zero() -> None:
    assert half_edges(ANNULUS, 6).euler_characteristic == 0
    assert half_edges(np.concatenate([ANNULUS, [[3, 4, 5]]]), 6).euler_characteristic == 1


def test_outer_edges_of_a_cell_are_its_outline() -> None:
    mask, _ = clean_mask(simulate.random_spiky(3))
    mesh = mesh_inside(trace_outline(mask), mask, edge_length=0.9)
    edges = half_edges(mesh.triangles, len(mesh.vertices_yx))
    loop = np.arange(mesh.n_boundary)
    np.testing.assert_array_equal(edges.start[edges.outer], loop)
    np.testing.assert_array_equal(edges.end[edges.outer], np.roll(loop, -1))
    assert edges.all_used

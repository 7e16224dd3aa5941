import numpy as np
import pytest
from shapely import contains_xy
from shapely.geometry import Polygon

from cytodisk import simulate
from cytodisk.errors import MeshError
from cytodisk.geometry.half_edges import half_edges, triangle_edges
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mesh import (
    Mesh,
    hat_gradients,
    mesh_inside,
    triangle_areas,
)
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.polygon import signed_area


def mesh_of(mask: np.ndarray, edge_length: float = 1.0) -> tuple[Mesh, np.ndarray]:
    outline = trace_outline(mask)
    return mesh_inside(outline, mask, edge_length=edge_length), outline


def chords(mesh: Mesh) -> int:
    """Interior edges that join two boundary vertices."""
    edges = triangle_edges(mesh.triangles)
    pinned = (edges < mesh.n_boundary).all(axis=1)
    apart = (edges[:, 1] - edges[:, 0]) % mesh.n_boundary
    return int((pinned & (apart != 1)).sum())


@pytest.mark.parametrize("edge_length", [0.5, 1.0, 3.0])
@pytest.mark.parametrize("kind", simulate.KINDS)
def test_every_mesh_is_a_disk_without_chords(kind: str, edge_length: float) -> None:
    for seed in range(3):
        mesh, outline = mesh_of(clean_mask(simulate.random_mask(kind, seed))[0], edge_length)
        areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
        assert half_edges(mesh.triangles, len(mesh.vertices_yx)).euler_characteristic == 1
        np.testing.assert_array_equal(np.unique(mesh.triangles), np.arange(len(mesh.vertices_yx)))
        assert areas.min() > 0.0
        assert areas.sum() == pytest.approx(signed_area(outline), rel=1e-9)
        np.testing.assert_array_equal(mesh.vertices_yx[mesh.boundary], outline)
        assert chords(mesh) == 0


def test_edges_that_belong_to_one_triangle_are_the_outline_in_order() -> None:
    mesh, _ = mesh_of(simulate.random_spiky(1))
    edges = triangle_edges(mesh.triangles).tolist()
    seen = {tuple(edge) for edge in edges}
    assert len(seen) == len(edges)  # no edge twice in one direction
    outer = sorted((start, stop) for start, stop in seen if (stop, start) not in seen)
    n = mesh.n_boundary
    assert outer == [(k, (k + 1) % n) for k in range(n)]


def test_hat_gradients_differentiate_a_linear_function() -> None:
    mesh, _ = mesh_of(simulate.random_smooth(2))
    hats = hat_gradients(mesh.vertices_yx, mesh.triangles)
    linear = 3.0 * mesh.vertices_yx[:, 1] - 2.0 * mesh.vertices_yx[:, 0] + 5.0
    slope = np.einsum("tk,tka->ta", linear[mesh.triangles], hats)
    np.testing.assert_allclose(slope, np.broadcast_to([3.0, -2.0], slope.shape), atol=1e-9)


def test_an_outline_that_crosses_itself_is_refused() -> None:
    bow_tie = np.array([(0.0, 0.0), (10.0, 10.0), (0.0, 10.0), (10.0, 0.0)])
    with pytest.raises(MeshError, match=r"crosses itself|not a disk"):
        mesh_inside(bow_tie, np.ones((11, 11), dtype=bool), edge_length=0.9)


@pytest.mark.parametrize("kind", simulate.KINDS)
def test_triangles_are_those_that_the_library_leaves_inside_the_outline(kind: str) -> None:
    mask, _ = clean_mask(simulate.random_mask(kind, 3))
    outline = trace_outline(mask)
    mesh = mesh_inside(outline, mask, edge_length=1.5)
    polygon = Polygon(outline[:, ::-1])
    centres = mesh.vertices_yx[mesh.triangles].mean(axis=1)
    assert contains_xy(polygon, centres[:, 1], centres[:, 0]).all()
    assert triangle_areas(mesh.vertices_yx, mesh.triangles).sum() == pytest.approx(polygon.area)

import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.blocks import BlockSystem
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mesh import Mesh, mesh_inside
from cytodisk.geometry.outline import trace_outline


def mesh_of(mask: np.ndarray) -> Mesh:
    cleaned, _ = clean_mask(mask)
    return mesh_inside(trace_outline(cleaned), cleaned, edge_length=0.9)


def fill_at_random(system: BlockSystem, mesh: Mesh, seed: int) -> np.ndarray:
    """A random positive definite matrix in the system, and the same one as a dense array."""
    random = np.random.default_rng(seed)
    n = len(system.vertex)
    dense = np.zeros((n, 2, n, 2))
    system.blocks[:] = 0.0
    for triangle, place in zip(mesh.triangles, system.place, strict=True):
        half = random.normal(size=(6, 6))
        element = (half @ half.T).reshape(3, 2, 3, 2)
        for k, i in enumerate(system.unknown[triangle]):
            for l, j in enumerate(system.unknown[triangle]):
                if i >= 0 and j >= 0:
                    dense[i, :, j] += element[k, :, l]
                if place[k, l] >= 0:
                    assert i <= j
                    system.blocks[place[k, l]] += element[k, :, l]
    return dense.reshape(2 * n, 2 * n)


@pytest.mark.parametrize(
    "mask", [simulate.random_spiky(2, radius=6.0, spike_length=8.0), simulate.disk(9.0), np.ones((3, 40))]
)
def test_the_solution_is_that_of_the_dense_system(mask: np.ndarray) -> None:
    mesh = mesh_of(mask)
    system = BlockSystem(mesh)
    right = np.random.default_rng(1).normal(size=(len(system.vertex), 2))
    for seed in (0, 1):  # the second factorisation reuses what the first has found
        dense = fill_at_random(system, mesh, seed)
        system.factorise()
        found = dense @ system.solve(right).ravel()
        np.testing.assert_allclose(found, right.ravel(), atol=1e-8 * np.abs(dense).max())


def test_every_interior_vertex_is_one_unknown() -> None:
    mesh = mesh_of(simulate.random_smooth(1, radius=8.0))
    system = BlockSystem(mesh)
    np.testing.assert_array_equal(np.sort(system.vertex), np.arange(mesh.n_boundary, len(mesh.vertices_yx)))
    np.testing.assert_array_equal(system.unknown[system.vertex], np.arange(len(system.vertex)))
    assert (system.unknown[mesh.boundary] == -1).all()
    assert not np.array_equal(system.vertex, np.sort(system.vertex))  # an order was looked for


def test_a_cell_without_interior_vertices_has_an_empty_system() -> None:
    triangle = Mesh(np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]), np.array([[0, 1, 2]]), 3)
    system = BlockSystem(triangle)
    system.factorise()
    assert system.solve(np.empty((0, 2))).shape == (0, 2)

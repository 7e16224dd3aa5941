import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.block_pattern import BlockPattern
from cytodisk.disk.pressure_blocks import PressureSystem
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mesh import Mesh, mesh_inside
from cytodisk.geometry.outline import trace_outline


def fill_at_random(system: PressureSystem, mesh: Mesh, seed: int) -> np.ndarray:
    """A random quasi-definite matrix in the system, and the same one as a dense array."""
    random = np.random.default_rng(seed)
    n = len(system.pattern.vertex)
    dense = np.zeros((n, 3, n, 3))
    system.blocks[:] = 0.0
    for triangle, place in zip(mesh.triangles, system.pattern.place, strict=True):
        element = np.zeros((3, 3, 3, 3))
        half = random.normal(size=(6, 6))
        element[:, :2, :, :2] = (half @ half.T).reshape(3, 2, 3, 2)
        element[:, :2, :, 2] = random.normal(size=(3, 2, 3))
        element[:, 2, :, :2] = element[:, :2, :, 2].transpose(2, 0, 1)
        half = random.normal(size=(3, 3))
        element[:, 2, :, 2] = -half @ half.T
        for k, i in enumerate(system.pattern.unknown[triangle]):
            for l, j in enumerate(system.pattern.unknown[triangle]):
                if i >= 0 and j >= 0:
                    dense[i, :, j] += element[k, :, l]
                if place[k, l] >= 0:
                    system.blocks[place[k, l]] += element[k, :, l]
    return dense.reshape(3 * n, 3 * n)


@pytest.mark.parametrize(
    "mask", [simulate.random_spiky(2, radius=6.0, spike_length=8.0), simulate.disk(9.0), np.ones((3, 40))]
)
def test_the_solution_is_that_of_the_dense_system(mask: np.ndarray) -> None:
    cleaned, _ = clean_mask(mask)
    mesh = mesh_inside(trace_outline(cleaned), cleaned, edge_length=0.9)
    system = PressureSystem(BlockPattern(mesh))
    right = np.random.default_rng(1).normal(size=(len(system.pattern.vertex), 3))
    for seed in (0, 1):  # the second factorisation reuses what the first has found
        dense = fill_at_random(system, mesh, seed)
        values = np.linalg.eigvalsh(dense)
        assert (values > 0).sum() == 2 * (values < 0).sum()
        system.factorise()
        found = dense @ system.solve(right).ravel()
        np.testing.assert_allclose(found, right.ravel(), atol=1e-7 * np.abs(dense).max())


def test_a_cell_without_interior_vertices_has_an_empty_system() -> None:
    triangle = Mesh(np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]), np.array([[0, 1, 2]]), 3)
    system = PressureSystem(BlockPattern(triangle))
    system.factorise()
    assert system.solve(np.empty((0, 3))).shape == (0, 3)

import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.energy import Elements, derivatives, energy, jacobian, largest_step
from cytodisk.disk.harmonic import harmonic_map
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mesh import Mesh, hat_gradients, mesh_inside, triangle_areas
from cytodisk.geometry.outline import trace_outline

# One interior vertex per corner: nothing is pinned, so the whole 6 × 6 block of one triangle is seen.
ONE = np.array([[0, 1, 2]])


def psi(j: np.ndarray, weight: float) -> float:
    """The integrand written from its definition with det and Frobenius norm."""
    det = np.linalg.det(j.reshape(2, 2))
    return float(np.log(det) ** 2 + weight * ((j**2).sum() / det - 2.0))


def numeric_hessian(j: np.ndarray, weight: float) -> np.ndarray:
    """Central second differences of ψ with respect to (J11, J12, J21, J22), Richardson extrapolated."""

    def differences(h: float) -> np.ndarray:
        steps = h * np.eye(4)
        return np.array(
            [
                [
                    (
                        psi(j + p + q, weight)
                        - psi(j + p - q, weight)
                        - psi(j - p + q, weight)
                        + psi(j - p - q, weight)
                    )
                    / (4 * h * h)
                    for q in steps
                ]
                for p in steps
            ]
        )

    h = 2e-3 * np.linalg.svd(j.reshape(2, 2), compute_uv=False).min()
    return (4.0 * differences(h) - differences(2.0 * h)) / 3.0


def random_triangles(count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """Corners in the disk and hat gradients in the cell, all positive."""
    random = np.random.default_rng(3)
    found = []
    while len(found) < count:
        yx, uv = random.normal(size=(3, 2)), random.normal(size=(3, 2))
        in_cell, in_disk = triangle_areas(yx, ONE)[0], triangle_areas(uv[:, ::-1], ONE)[0]
        if min(in_cell, in_disk) > 0.05:
            found.append((uv, hat_gradients(yx, ONE)))
    return found


def free_triangle_hessian(uv: np.ndarray, hats: np.ndarray, weight: float) -> tuple[np.ndarray, np.ndarray]:
    gradient, blocks = np.empty((3, 2)), np.empty((6, 2, 2))
    place = np.array([[[0, 1, 3], [-1, 2, 4], [-1, -1, 5]]])
    cell = Elements(ONE, hats, np.ones(1))
    derivatives(uv, cell, weight, np.arange(3), place, False, gradient, blocks)
    full = np.zeros((3, 2, 3, 2))
    for k, l in zip(*np.nonzero(place[0] >= 0), strict=True):
        full[k, :, l] = blocks[place[0, k, l]]
        full[l, :, k] = blocks[place[0, k, l]].T
    for own in (0, 2, 5):
        np.testing.assert_allclose(blocks[own], blocks[own].T, atol=1e-12 * np.abs(blocks).max())
    return gradient.ravel(), full.reshape(6, 6)


def flattened(hats: np.ndarray) -> np.ndarray:
    """Matrix from (u0, v0, u1, v1, u2, v2) to (J11, J12, J21, J22)."""
    matrix = np.zeros((4, 6))
    for k in range(3):
        matrix[0:2, 2 * k] = hats[0, k]
        matrix[2:4, 2 * k + 1] = hats[0, k]
    return matrix


@pytest.mark.parametrize("weight", [1e-3, 0.005, 1.0])
def test_the_hessian_is_the_numeric_one_with_negative_eigenvalues_raised_to_zero(weight: float) -> None:
    clamped = 0
    for uv, hats in random_triangles(40):
        to_jacobian = flattened(hats)
        numeric = numeric_hessian(to_jacobian @ uv.ravel(), weight)
        values, modes = np.linalg.eigh(numeric)
        clamped += int((values < -1e-3).sum())
        expected = to_jacobian.T @ (modes * np.maximum(values, 0.0)) @ modes.T @ to_jacobian
        _, hessian = free_triangle_hessian(uv, hats, weight)
        np.testing.assert_allclose(hessian, expected, atol=1e-4 * np.abs(expected).max())
        assert np.linalg.eigvalsh(hessian).min() > -1e-9 * np.abs(hessian).max()
    assert clamped > 10  # the case is one where projection matters


def test_hessian_and_gradient_at_a_similarity_have_no_nan() -> None:
    yx = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]])
    hats = hat_gradients(yx, ONE)
    gradient, hessian = free_triangle_hessian(yx[:, ::-1].copy(), hats, 0.005)
    np.testing.assert_allclose(gradient, 0.0, atol=1e-12)
    # At J = identity: 2 I⊗I-part of (log det)² and 4 w on the two conformal directions.
    np.testing.assert_allclose(
        hessian,
        flattened(hats).T @ numeric_hessian(np.array([1.0, 0.0, 0.0, 1.0]), 0.005) @ flattened(hats),
        atol=1e-5,
    )


def test_the_hessian_of_a_large_similarity_is_finite_where_its_stretches_are_alike() -> None:
    yx = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]])
    _, hessian = free_triangle_hessian(5.0 * yx[:, ::-1], hat_gradients(yx, ONE), 1.0)
    assert np.isfinite(hessian).all()


@pytest.fixture(scope="module")
def problem() -> dict[str, np.ndarray | Mesh | Elements]:
    mask = simulate.random_spiky(4, radius=12.0, spike_length=15.0)
    mask, _ = clean_mask(mask)
    outline = trace_outline(mask)
    mesh = mesh_inside(outline, mask, edge_length=0.9)
    angles = boundary_angles(outline)
    uv, _ = harmonic_map(mesh, np.column_stack([np.cos(angles), np.sin(angles)]))
    areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
    hats = hat_gradients(mesh.vertices_yx * np.sqrt(np.pi / areas.sum()), mesh.triangles)
    return {"mesh": mesh, "uv": uv, "cell": Elements(mesh.triangles, hats, areas / areas.sum())}


def test_energy_is_the_sum_over_triangles(problem: dict) -> None:
    mesh, uv, cell = (problem[key] for key in ("mesh", "uv", "cell"))
    jacobians = np.einsum("tka,tkb->tab", uv[mesh.triangles], cell.hats)
    expected = sum(s * psi(j.ravel(), 0.005) for s, j in zip(cell.share, jacobians, strict=True))
    assert energy(uv, *cell, 0.005) == pytest.approx(expected, rel=1e-10)
    np.testing.assert_allclose(jacobian(uv, mesh.triangles[5], cell.hats[5]), jacobians[5].ravel())


def test_without_areas_a_larger_map_has_the_same_energy(problem: dict) -> None:
    uv, cell = problem["uv"], problem["cell"]._replace(area_weight=0.0)
    assert energy(3.0 * uv, *cell, 0.005) == pytest.approx(energy(uv, *cell, 0.005), rel=1e-10)
    assert energy(3.0 * uv, *problem["cell"], 0.005) > energy(uv, *problem["cell"], 0.005)
    assert energy(uv[:, ::-1], *cell, 0.005) == np.inf


def test_energy_of_a_flipped_triangle_is_infinite(problem: dict) -> None:
    uv, cell = problem["uv"], problem["cell"]
    flipped = uv.copy()
    flipped[-1] += 3.0
    assert energy(flipped, *cell, 0.005) == np.inf


@pytest.mark.parametrize("area_weight", [1.0, 0.3, 0.0])
def test_the_gradient_agrees_with_finite_differences(problem: dict, area_weight: float) -> None:
    mesh, uv = problem["mesh"], problem["uv"]
    cell = problem["cell"]._replace(area_weight=area_weight)
    system = BlockSystem(mesh)
    gradient = np.empty((len(system.vertex), 2))
    derivatives(
        uv,
        cell,
        0.005,
        system.unknown,
        system.place,
        False,
        gradient,
        system.blocks,
    )
    random = np.random.default_rng(0)
    for unknown, axis in zip(random.integers(0, len(gradient), 25), random.integers(0, 2, 25), strict=True):
        vertex = system.vertex[unknown]
        around = np.abs(uv[mesh.triangles[(mesh.triangles == vertex).any(axis=1)]] - uv[vertex]).max()
        h = 1e-5 * around
        values = []
        for sign in (1, -1):
            moved = uv.copy()
            moved[vertex, axis] += sign * h
            values.append(energy(moved, *cell, 0.005))
        assert gradient[unknown, axis] == pytest.approx((values[0] - values[1]) / (2 * h), rel=1e-3, abs=1e-6)


def test_the_assembled_hessian_is_the_sum_of_the_triangles_blocks(problem: dict) -> None:
    mesh, uv, cell = (problem[key] for key in ("mesh", "uv", "cell"))
    system = BlockSystem(mesh)
    derivatives(
        uv, cell, 0.005, system.unknown, system.place, False,
        np.empty((len(system.vertex), 2)), system.blocks,
    )  # fmt: skip
    expected = np.zeros_like(system.blocks)
    for t, triangle in enumerate(mesh.triangles):
        _, block = free_triangle_hessian(uv[triangle], cell.hats[t : t + 1], 0.005)
        for k in range(3):
            for l in range(3):
                if system.place[t, k, l] >= 0:
                    expected[system.place[t, k, l]] += (
                        cell.share[t] * block[2 * k : 2 * k + 2, 2 * l : 2 * l + 2]
                    )
    np.testing.assert_allclose(system.blocks, expected, atol=1e-9 * np.abs(expected).max())


def test_the_largest_step_is_where_the_first_triangle_loses_its_area() -> None:
    uv = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    hats = hat_gradients(uv[:, ::-1].copy(), ONE)
    towards = np.array([[0.0, 0.0], [0.0, 0.0], [0.0, -0.25]])
    assert largest_step(uv, towards, ONE, hats) == pytest.approx(4.0)
    assert largest_step(uv, -towards, ONE, hats) == np.inf
    assert largest_step(uv, np.ones((3, 2)), ONE, hats) == np.inf  # a shift
    assert largest_step(uv, -uv, ONE, hats) == pytest.approx(1.0)  # shrinks to a point: a double root


def test_the_largest_step_agrees_with_roots_of_every_triangle(problem: dict) -> None:
    mesh, uv, cell = (problem[key] for key in ("mesh", "uv", "cell"))
    direction = np.random.default_rng(2).normal(size=uv.shape)
    direction[: mesh.n_boundary] = 0.0
    first = np.inf
    for triangle in mesh.triangles:
        areas = [triangle_areas((uv + s * direction)[triangle][:, ::-1], ONE)[0] for s in (0.0, 1.0, -1.0)]
        square = 0.5 * (areas[1] + areas[2]) - areas[0]
        roots = np.roots([square, areas[1] - areas[0] - square, areas[0]])
        real = roots[np.abs(roots.imag) < 1e-12].real
        first = min(first, real[real > 0].min(initial=np.inf))
    assert largest_step(uv, direction, cell.triangles, cell.hats) == pytest.approx(first, rel=1e-6)

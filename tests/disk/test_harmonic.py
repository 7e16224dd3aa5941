import numpy as np
import pytest
from scipy.special import iv

from cytodisk import simulate
from cytodisk.disk.harmonic import fading_extension, harmonic_extension, harmonic_map
from cytodisk.disk.mapping import map_to_disk
from cytodisk.geometry.mesh import mesh_inside
from cytodisk.geometry.outline import trace_outline

SEMI_Y, SEMI_X = 30.0, 60.0


class EllipseSolution:
    """Harmonic map of an ellipse whose boundary goes to the circle by arc length, as a series.

    In elliptic coordinates x = c cosh μ cos ν, y = c sinh μ sin ν, the functions cosh nμ cos nν and
    sinh nμ sin nν are harmonic; the boundary μ = μ₀ has cos θ(ν) = Σ Aₙ cos nν and sin θ(ν) = Σ Bₙ sin nν.
    """

    def __init__(self, semi_y: float, semi_x: float, terms: int = 60):
        self._focus = np.sqrt(semi_x**2 - semi_y**2)
        self._edge = np.arctanh(semi_y / semi_x)
        nu = np.arange(8192) * 2.0 * np.pi / 8192
        speed = np.hypot(semi_x * np.sin(nu), semi_y * np.cos(nu))
        # Spectral integration of a periodic function: exact to rounding.
        modes = np.fft.rfft(speed)
        waves = np.arange(modes.size)
        waves[0] = 1
        integral = modes / (1j * waves)
        integral[0] = 0.0
        length = np.fft.irfft(integral)
        self._theta = nu + (length - length[0]) / speed.mean()
        self._nu = nu
        self._n = np.arange(1, terms)
        self._cosine = 2.0 * np.fft.rfft(np.cos(self._theta)).real[1:terms] / 8192
        self._sine = -2.0 * np.fft.rfft(np.sin(self._theta)).imag[1:terms] / 8192

    def theta(self, nu: np.ndarray) -> np.ndarray:
        """Angle on the circle of the boundary point at ν."""
        return nu + np.interp(nu, self._nu, self._theta - self._nu, period=2.0 * np.pi)

    def __call__(self, y: np.ndarray, x: np.ndarray) -> np.ndarray:
        w = np.arccosh((x + 1j * y) / self._focus)
        mu, nu = w.real[:, None], w.imag[:, None]
        n, edge = self._n, self._edge
        u = (self._cosine * np.cosh(n * mu) / np.cosh(n * edge) * np.cos(n * nu)).sum(axis=1)
        v = (self._sine * np.sinh(n * mu) / np.sinh(n * edge) * np.sin(n * nu)).sum(axis=1)
        return np.column_stack([u, v])


def test_the_series_itself_meets_its_boundary_and_a_circle_gives_the_identity() -> None:
    solution = EllipseSolution(SEMI_Y, SEMI_X)
    nu = np.linspace(0.1, 6.2, 50)
    on_edge = solution(SEMI_Y * np.sin(nu), SEMI_X * np.cos(nu))
    theta = solution.theta(nu)
    np.testing.assert_allclose(on_edge, np.column_stack([np.cos(theta), np.sin(theta)]), atol=1e-6)
    nearly_round = EllipseSolution(1.0, 1.0001)
    np.testing.assert_allclose(nearly_round(np.array([0.3]), np.array([0.4])), [[0.4, 0.3]], atol=1e-3)


def test_the_harmonic_map_of_an_ellipse_is_the_series() -> None:
    solution = EllipseSolution(SEMI_Y, SEMI_X)
    nu = np.linspace(0.0, 2.0 * np.pi, 320, endpoint=False)
    mask = simulate.ellipse((SEMI_Y, SEMI_X))
    middle = (np.array(mask.shape) - 1) / 2
    outline = np.column_stack([SEMI_Y * np.sin(nu), SEMI_X * np.cos(nu)])
    mesh = mesh_inside(outline + middle, mask, edge_length=0.9)
    theta = solution.theta(nu)
    uv, weights = harmonic_map(mesh, np.column_stack([np.cos(theta), np.sin(theta)]))
    expected = solution(*(mesh.vertices_yx - middle).T)
    assert weights == "cotangent"
    # Linear elements: the error is of second order in the spacing, up to 15 px in the middle of 60.
    assert np.abs(uv - expected).max() < 3e-3


def test_the_harmonic_map_of_an_ellipse_mask_is_the_series_up_to_its_pixels() -> None:
    mask = simulate.ellipse((SEMI_Y, SEMI_X))
    disk = map_to_disk(mask, method="harmonic")
    pixels = np.argwhere(mask).astype(float)
    expected = EllipseSolution(SEMI_Y, SEMI_X)(*(pixels - (np.array(mask.shape) - 1) / 2).T)
    away = np.hypot(*(disk.to_disk(pixels) - expected).T)
    # The outline is off by up to 0.7 px of 30, so by 0.023 of the disk's radius across.
    assert away.max() < 0.025
    assert np.median(away) < 0.008


@pytest.mark.parametrize("kind", ["spiky", "comb", "percolation"])
def test_the_harmonic_map_is_a_weighted_mean_so_it_stays_inside(kind: str) -> None:
    disk = map_to_disk(simulate.random_mask(kind, 5), method="harmonic")
    inner = np.hypot(*disk.vertices_uv[len(disk.boundary) :].T)
    assert disk.certificate.valid
    assert inner.max() < 1.0


@pytest.mark.parametrize("fade", [3.0, 8.0])
def test_a_shift_of_the_edge_fades_inwards_as_a_bessel_function(fade: float) -> None:
    mask = simulate.disk(25)
    mesh = mesh_inside(trace_outline(mask), mask, edge_length=0.7)
    radius = np.sqrt(mask.sum() / np.pi)
    shift = np.broadcast_to([2.0, -1.0], (mesh.n_boundary, 2))
    values = fading_extension(mesh, shift, fade)
    middle = np.argwhere(mask).mean(axis=0)
    depth = np.linalg.norm(mesh.vertices_yx - middle, axis=1)
    expected = iv(0, depth / fade) / iv(0, radius / fade)
    np.testing.assert_array_equal(values[: mesh.n_boundary], shift)
    np.testing.assert_allclose(values[mesh.n_boundary :, 0], 2.0 * expected[mesh.n_boundary :], atol=0.2)
    np.testing.assert_allclose(values[:, 1], -0.5 * values[:, 0], atol=1e-12)


def test_what_fades_slowly_is_harmonic() -> None:
    mask = simulate.random_smooth(2, radius=20.0)
    mesh = mesh_inside(trace_outline(mask), mask, edge_length=1.5)
    at_edge = np.random.default_rng(0).normal(size=(mesh.n_boundary, 2))
    np.testing.assert_allclose(
        fading_extension(mesh, at_edge, 1e4), harmonic_extension(mesh, at_edge), atol=1e-3
    )

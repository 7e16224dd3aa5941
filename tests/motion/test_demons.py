import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.errors import MissingPartError, ParameterError
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.geometry.polygon import edge_lengths
from cytodisk.motion.contour import Contour
from cytodisk.motion.demons import propagate, space_evenly
from cytodisk.motion.demons_parameters import DemonsParameters

LOOSE = DemonsParameters(redistribute=False)
# A stiffer field and more iterations carry the motion of the lobes' flanks to their tips.
THOROUGH = DemonsParameters(redistribute=False, sigma=5.0, iterations=300)
SHIFT = np.array([2.0, 1.0])


def contour(points_yx: np.ndarray) -> Contour:
    return Contour.of_outline(points_yx, 1e-3)


def lobed(radius: float = 45.0, depth: float = 0.2, turn: float = 0.0) -> Contour:
    angle = np.arange(400) * 2.0 * np.pi / 400
    r = radius * (1.0 + depth * np.cos(5.0 * angle + turn))
    return contour(60.3 + np.column_stack([r * np.sin(angle), r * np.cos(angle)]))


def evenly(curve: Contour, n: int = 200) -> np.ndarray:
    return curve.at(np.arange(n) * curve.length / n)


def distance(points_yx: np.ndarray, curve: Contour) -> np.ndarray:
    edge, share = nearest_on_outline(points_yx, curve.points_yx)
    start, end = curve.points_yx[edge], np.roll(curve.points_yx, -1, axis=0)[edge]
    return np.linalg.norm(points_yx - start - share[:, None] * (end - start), axis=1)


def test_a_shift_is_recovered() -> None:
    here = lobed()
    points = evenly(here)
    moved = propagate(here, contour(here.points_yx + SHIFT), points, THOROUGH)
    assert np.linalg.norm(moved - points - SHIFT, axis=1).mean() < 0.4


def test_the_defaults_go_the_way_of_a_shift_but_slip_along_the_boundary() -> None:
    here = lobed()
    points = evenly(here)
    s = np.arange(200) * here.length / 200
    moved = propagate(here, contour(here.points_yx + SHIFT), points, LOOSE) - points
    normal = here.normals(s)
    across = np.abs(((moved - SHIFT) * normal).sum(axis=1))
    assert across.mean() < 0.3
    assert 0.0 < np.dot(moved.mean(axis=0), SHIFT) / np.dot(SHIFT, SHIFT) < 1.1
    only_across = (normal @ SHIFT)[:, None] * normal
    error, blind = (np.linalg.norm(step - SHIFT, axis=1).mean() for step in (moved, only_across))
    assert error < 0.9 * blind


@pytest.mark.parametrize("growth", [1.5, -1.5, 10.0])
@pytest.mark.parametrize("parameters", [LOOSE, DemonsParameters()], ids=["loose", "even"])
def test_a_grown_disk_keeps_its_points_on_their_rays(growth: float, parameters: DemonsParameters) -> None:
    here, there = lobed(depth=0.0), lobed(45.0 + growth, depth=0.0)
    points = evenly(here)
    moved = propagate(here, there, points, parameters)
    assert np.abs(np.hypot(*(moved - 60.3).T) - 45.0 - growth).max() < 0.5
    expected = 60.3 + (points - 60.3) * (45.0 + growth) / 45.0
    assert np.linalg.norm(moved - expected, axis=1).mean() < 0.5


@pytest.mark.parametrize("n", [40, 200, 700])
def test_points_come_onto_the_boundary_in_their_number_and_order(n: int) -> None:
    here, there = lobed(), lobed(turn=0.4)
    moved = propagate(here, there, evenly(here, n), LOOSE)
    assert moved.shape == (n, 2)
    assert np.median(distance(moved, there)) < 0.3
    y, x = (moved - 60.3).T
    ahead = np.diff(np.unwrap(np.arctan2(y, x)))
    assert (ahead > 0.0).all()


def test_redistribution_spaces_evenly_and_keeps_point_0() -> None:
    here, there = lobed(), lobed(turn=0.4)
    points = evenly(here)
    loose, even = (propagate(here, there, points, LOOSE.changed(redistribute=r)) for r in (False, True))
    spacing = edge_lengths(even)
    assert np.abs(spacing / spacing.mean() - 1.0).max() < 0.02
    assert np.ptp(edge_lengths(loose)) > 5.0 * np.ptp(spacing)
    np.testing.assert_allclose(even[0], loose[0], atol=1e-9)
    assert np.median(distance(even, there)) < 0.3


def test_the_result_is_the_same_every_time() -> None:
    here, there = lobed(), lobed(turn=0.2)
    first, second = (propagate(here, there, evenly(here), DemonsParameters()) for _ in range(2))
    np.testing.assert_array_equal(first, second)


def test_whole_pixels_of_the_frame_do_not_matter() -> None:
    here, there = lobed(), lobed(turn=0.2)
    far = np.array([1000.0, -300.0])
    moved = propagate(here, there, evenly(here), LOOSE)
    there_too = propagate(
        contour(here.points_yx + far), contour(there.points_yx + far), evenly(here) + far, LOOSE
    )
    np.testing.assert_allclose(there_too - far, moved, atol=1e-6)


def circle(n: int) -> np.ndarray:
    angle = np.arange(n) * 2.0 * np.pi / n
    return 10.0 * np.column_stack([np.sin(angle), np.cos(angle)])


@pytest.mark.parametrize(
    "doubled",
    [lambda p: np.repeat(p, 2, axis=0), lambda p: np.concatenate([p, p[:1]]), lambda p: p],
    ids=["each", "last", "none"],
)
def test_coinciding_points_are_one_point_of_the_spline(doubled: Callable[[np.ndarray], np.ndarray]) -> None:
    points = doubled(circle(40))
    even = space_evenly(points)
    assert even.shape == points.shape
    np.testing.assert_allclose(even[0], points[0], atol=1e-9)
    np.testing.assert_allclose(even, circle(len(points)), atol=1e-2)


def test_a_boundary_that_fell_together_is_named() -> None:
    with pytest.raises(ParameterError, match=r"at least 4 distinct points .* got 3 of 6"):
        space_evenly(np.repeat(circle(3), 2, axis=0))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("iterations", -1),
        ("iterations", 2.5),
        ("iterations", True),
        ("snake_iterations", "many"),
        ("gvf_iterations", None),
        ("sigma", 0.0),
        ("sigma", np.nan),
        ("snake_step", -1.0),
        ("snake_step", "long"),
        ("gvf_mu", 0.3),
        ("snake_tension", -0.1),
        ("snake_stiffness", np.inf),
        ("redistribute", "no"),
    ],
)
def test_bad_parameters_are_named(name: str, value: object) -> None:
    with pytest.raises(ParameterError, match=f"{name} must be .*, got {value!r}"):
        DemonsParameters(**{name: value})


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.zeros((5, 3)), r"shape \(N, 2\)"),
        (np.full((3, 2), 60.0), "at least 4"),
        (np.full((5, 2), np.nan), "not finite"),
        (np.full((5, 2), 500.0), "far outside"),
    ],
)
def test_bad_points_are_named(points: np.ndarray, message: str) -> None:
    with pytest.raises(ParameterError, match=f"points_yx must .*{message}"):
        propagate(lobed(), lobed(), points, LOOSE)


def test_bad_outlines_are_named() -> None:
    speck = contour(60.5 + 0.01 * circle(8))
    with pytest.raises(ParameterError, match="there must enclose a pixel centre"):
        propagate(lobed(), speck, evenly(lobed()), LOOSE)
    with pytest.raises(ParameterError, match="finite points"):
        propagate(lobed(), replace(lobed(), points_yx=np.full((8, 2), np.inf)), evenly(lobed()), LOOSE)


def test_importing_the_module_leaves_the_registration_library_alone() -> None:
    program = "import sys, cytodisk.motion.demons; sys.exit('SimpleITK' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0


def test_without_simple_itk_the_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "SimpleITK", None)
    with pytest.raises(MissingPartError, match=r"type pip install 'cytodisk\[demons\]'"):
        cd.map_movie(cd.simulate.movie("bulging", frames=2, radius_px=10.0).masks, tracker="demons")

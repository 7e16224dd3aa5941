import numpy as np
import pytest
from curves import CENTRE, circle, evenly, exact, lobed, moved, runs_once, smooth_curves, wavy
from hypothesis import given
from hypothesis import strategies as st

from cytodisk.motion.contour import Contour
from cytodisk.motion.elastic_band import Target, relax_band
from cytodisk.motion.registration import RigidTransform

STILL = np.zeros(3)


def band_energy(
    points: np.ndarray,
    target: Contour,
    places: np.ndarray,
    spacing: float,
    smoothness: float,
    motion: np.ndarray = STILL,
    doubt: float = 0.0,
) -> float:
    """Plain twin of what is minimised."""
    d = target.at(places) - RigidTransform(*motion)(points)
    change = np.roll(d, -1, axis=0) - d
    stretch = np.diff(places, append=places[0] + target.length)
    uneven = (change**2).sum() + (stretch**2).sum()
    return float(spacing * (d**2).sum() + smoothness / spacing * uneven + doubt * motion[0] ** 2)


def relaxed(
    here: Contour,
    there: Contour,
    places: np.ndarray,
    smoothness: float = 64.0,
    motion: np.ndarray = STILL,
    rigid: bool = False,
    doubt: float = 0.0,
) -> tuple[np.ndarray, np.ndarray, float]:
    n = len(places)
    points = here.at(evenly(here, n))
    return relax_band(
        points, Target(there.points_yx, there.arc), places, here.length / n, smoothness, motion, rigid, doubt
    )


def assert_not_worse(here: Contour, there: Contour, n: int, smoothness: float, rigid: bool) -> None:
    points, spacing = here.at(evenly(here, n)), here.length / n
    start = evenly(there, n)
    places, motion, _ = relaxed(here, there, start, smoothness, rigid=rigid)
    before = band_energy(points, there, start, spacing, smoothness)
    after = band_energy(points, there, places, spacing, smoothness, motion)
    # Steps see one edge of the target's polygon at a time, so that the last may gain a little.
    assert after <= before * 1.001
    assert runs_once(places, there.length)


@given(smooth_curves(), smooth_curves(), st.floats(4.0, 500.0), st.integers(40, 300))
def test_the_energy_does_not_increase_and_order_is_kept(
    first: np.ndarray, second: np.ndarray, smoothness: float, n: int
) -> None:
    assert_not_worse(exact(first), exact(second), n, smoothness, rigid=False)


heights = st.lists(st.floats(0.05, 0.1), min_size=4, max_size=4)
phases = st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=4)


@given(heights, phases, st.floats(-6.0, 6.0), st.floats(-3.0, 3.0), st.floats(0.95, 1.1))
def test_the_energy_does_not_increase_with_a_free_motion(
    height: list[float], phase: list[float], degrees: float, shift: float, growth: float
) -> None:
    here, there = wavy(height, phase), moved(wavy(height, phase, 45.0 * growth), degrees, (shift, -shift))
    assert_not_worse(exact(here - CENTRE), exact(there - CENTRE), 250, 64.0, rigid=True)


def test_the_energy_does_not_increase_towards_a_round_target() -> None:
    here = exact(wavy([0.0, 0.0, 0.0, 0.0625], [0.0] * 4, 30.0))
    assert_not_worse(here, exact(circle(30.0, 600)), 40, 4.0, rigid=True)


@pytest.mark.parametrize("smoothness", [8.0, 64.0, 300.0])
@pytest.mark.parametrize("rigid", [False, True])
def test_the_result_is_stationary(smoothness: float, rigid: bool) -> None:
    here, there = exact(lobed()), exact(moved(lobed(48.0, 4000), 3.0, (1.0, -2.0)))
    n, doubt = 150, 1e4
    points, spacing = here.at(evenly(here, n)), here.length / n
    start = evenly(there, n)

    def slopes(places: np.ndarray, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Slope of the energy by each place and each part of the motion: central differences."""

        def energy(x: np.ndarray) -> float:
            return band_energy(points, there, x[:n], spacing, smoothness, x[n:], doubt)

        x = np.concatenate([places, motion])
        steps = np.concatenate([np.full(n, 0.05), [1e-4, 1e-3, 1e-3]])
        found = np.array([energy(x + s) - energy(x - s) for s in np.diag(steps)]) / (2.0 * steps)
        return found[:n], found[n:]

    places, motion, _ = relaxed(here, there, start, smoothness, rigid=rigid, doubt=doubt)
    stiffness = 2.0 * (spacing + 2.0 * smoothness / spacing)
    at_start, by_motion_at_start = slopes(start, STILL)
    by_place, by_motion = slopes(places, motion)
    assert np.abs(by_place).max() < 0.005 * stiffness
    assert np.abs(by_place).max() < 0.1 * np.abs(at_start).max()
    if rigid:
        assert (np.abs(by_motion) < 0.01 * np.abs(by_motion_at_start)).all()


@pytest.mark.parametrize("degrees", [-8.0, -2.0, 1.0, 6.0])
@pytest.mark.parametrize("shift", [(0.0, 0.0), (3.0, -5.0)])
def test_the_rigid_image_of_a_curve_is_laid_onto_it(degrees: float, shift: tuple[float, float]) -> None:
    here = exact(lobed() - CENTRE)
    there = exact(moved(lobed(), degrees, shift) - CENTRE)
    # The start is off by more than a lobe's slope: places are counted from where the shape began.
    places, motion, left_over = relaxed(here, there, evenly(here, 200) + 2.0, rigid=True)
    np.testing.assert_allclose(motion, [np.radians(degrees), *shift], atol=1e-3)
    np.testing.assert_allclose(places, evenly(here, 200), atol=5e-3)
    assert left_over < 1e-4


@pytest.mark.parametrize(
    ("degrees", "growth"),
    [
        (4.0, 1.1),
        (0.0, 1.1),
        (0.0, 1.0),
    ],
)
def test_what_is_left_over_is_that_of_the_result(degrees: float, growth: float) -> None:
    here, there = exact(lobed() - CENTRE), exact(moved(lobed(45.0 * growth), degrees, (1.0, -1.0)) - CENTRE)
    places, motion, left_over = relaxed(here, there, evenly(there, 250), rigid=True)
    d = there.at(places) - RigidTransform(*motion)(here.at(evenly(here, 250)))
    assert left_over == pytest.approx((d**2).sum() / 250, rel=0.05, abs=1e-3)


def test_a_curve_lies_on_itself() -> None:
    here = exact(lobed())
    start = evenly(here, 200)
    places, _, left_over = relaxed(here, here, start)
    np.testing.assert_allclose(places, start, atol=1e-9)
    assert left_over < 1e-18


def test_doubt_holds_the_angle_back() -> None:
    here, there = exact(lobed() - CENTRE), exact(moved(lobed(), 4.0, (0.0, 0.0)) - CENTRE)
    angles = [
        float(relaxed(here, there, evenly(here, 200), rigid=True, doubt=doubt)[1][0])
        for doubt in (0.0, 1e5, 1e9)
    ]
    assert angles[0] == pytest.approx(np.radians(4.0), abs=1e-3)
    assert angles[0] > angles[1] > angles[2] > -1e-6
    assert angles[2] < 1e-3


def test_the_arguments_stay_as_they_are() -> None:
    here, there = exact(lobed()), exact(moved(lobed(), 5.0, (2.0, 0.0)))
    start, motion = evenly(here, 200), np.zeros(3)
    relaxed(here, there, start, motion=motion, rigid=True)
    np.testing.assert_array_equal(start, evenly(here, 200))
    np.testing.assert_array_equal(motion, 0.0)

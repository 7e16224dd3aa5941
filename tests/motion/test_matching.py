import numpy as np
import pytest
from curves import CENTRE, circle, evenly, exact, lobed, moved, polar, runs_once, smooth_curves
from hypothesis import given
from hypothesis import strategies as st

from cytodisk.motion.contour import Contour
from cytodisk.motion.matching import carry, first_guess, match, rigid_motion

SMOOTHNESS = 64.0


def matched(here: Contour, there: Contour, s: np.ndarray) -> np.ndarray:
    return match(here, there, s, first_guess(here, there, s, SMOOTHNESS), SMOOTHNESS)


def from_even_to_rough(n: int, seed: int, period: float) -> np.ndarray:
    gaps = np.random.default_rng(seed).uniform(0.2, 1.0, n)
    return period * np.cumsum(gaps) / gaps.sum() + seed % 7


def test_a_curve_matches_itself_point_by_point() -> None:
    here = exact(lobed())
    s = evenly(here, 333)
    # Points lie between the samples of the grid on which the energy is minimised.
    np.testing.assert_allclose(matched(here, here, s), s, atol=1e-6)


@pytest.mark.parametrize("shift", [(1.0, 0.0), (-0.7, 0.7), (3.0, 2.0)])
def test_the_smoother_the_closer_a_shift_is_followed(shift: tuple[float, float]) -> None:
    here, there = exact(lobed()), exact(moved(lobed(), 0.0, shift))
    s = evenly(here)
    off = []
    for smoothness in (4.0, 64.0, 1e3, 1e5):
        places = match(here, there, s, first_guess(here, there, s, smoothness), smoothness)
        off.append(np.linalg.norm(there.at(places) - here.at(s) - np.array(shift), axis=1).mean())
    normals = here.normals(s)
    only_across = (normals @ np.array(shift))[:, None] * normals
    blind = np.linalg.norm(only_across - np.array(shift), axis=1).mean()
    assert off == sorted(off, reverse=True)
    assert off[1] < 0.95 * blind
    assert off[3] < 0.01 * np.hypot(*shift)


@pytest.mark.parametrize("degrees", [-25.0, -3.0, 10.0])
@pytest.mark.parametrize("shift", [(0.0, 0.0), (6.0, -2.0)])
def test_a_rigid_motion_is_found_and_then_every_point(degrees: float, shift: tuple[float, float]) -> None:
    here, there = exact(lobed()), exact(moved(lobed(), degrees, shift))
    s = evenly(here)
    guess = first_guess(here, there, s, SMOOTHNESS)
    angle, pivot, place, *_ = rigid_motion(here, there, s, guess, SMOOTHNESS)
    assert np.degrees(angle) == pytest.approx(degrees, abs=0.02)
    laid = exact(moved(here.points_yx - pivot + CENTRE, np.degrees(angle), place - CENTRE))
    np.testing.assert_allclose(laid.points_yx, there.points_yx, atol=0.02)
    np.testing.assert_allclose(np.mod(matched(laid, there, s) - s + 9.0, there.length) - 9.0, 0.0, atol=0.05)


@pytest.mark.parametrize("growth", [-6.0, 1.5, 12.0])
def test_points_of_a_growing_disk_stay_on_their_rays(growth: float) -> None:
    here, there = exact(circle(45.0)), exact(circle(45.0 + growth))
    s = evenly(here)
    expected = CENTRE + (here.at(s) - CENTRE) * (45.0 + growth) / 45.0
    np.testing.assert_allclose(there.at(matched(here, there, s)), expected, atol=0.02)


@pytest.mark.parametrize("stretch", [0.8, 1.2, 1.5])
def test_a_stretched_disk_keeps_its_axes_and_symmetry(stretch: float) -> None:
    here = exact(circle(40.0, 800))
    there = exact(CENTRE + (circle(40.0, 800) - CENTRE) * [1.0, stretch])
    s = here.length * np.arange(80) / 80
    found = there.at(matched(here, there, s)) - CENTRE
    np.testing.assert_allclose(
        found[::20], [[0, 40 * stretch], [40, 0], [0, -40 * stretch], [-40, 0]], atol=0.2
    )
    np.testing.assert_allclose(found[:41], np.roll(found[::-1], 1, axis=0)[:41] * [-1.0, 1.0], atol=0.2)


def test_a_growing_lobe_leaves_the_far_side_alone() -> None:
    angle = 2.0 * np.pi * np.arange(900) / 900
    bump = np.exp(-0.5 * ((angle - np.pi) / 0.2) ** 2)
    here, there = (exact(polar(40.0 + height * bump)) for height in (2.0, 12.0))
    s = evenly(here, 300)
    moves = there.at(matched(here, there, s)) - here.at(s)
    away = np.abs(np.arctan2(*(here.at(s) - CENTRE).T)) < np.pi / 3.0
    assert np.linalg.norm(moves[away], axis=1).max() < 0.1
    assert np.linalg.norm(moves, axis=1).max() == pytest.approx(10.0, abs=0.3)


@given(smooth_curves(0.12), smooth_curves(0.12), st.integers(3, 400), st.integers(0, 1000))
def test_order_is_kept(first: np.ndarray, second: np.ndarray, n: int, seed: int) -> None:
    here, there = exact(first), exact(second)
    s = from_even_to_rough(n, seed, here.length)
    guess = first_guess(here, there, s, SMOOTHNESS)
    assert runs_once(guess, there.length)
    assert runs_once(match(here, there, s, guess, SMOOTHNESS), there.length)


@given(smooth_curves(), smooth_curves())
def test_the_way_back_is_nearly_the_inverse(first: np.ndarray, second: np.ndarray) -> None:
    here, there = exact(first), exact(second)
    s = evenly(here)
    on = matched(here, there, s)
    back = match(there, here, on, s, SMOOTHNESS)
    size = np.linalg.norm(there.at(on) - here.at(s), axis=1).mean()
    assert np.abs(back - s).mean() < 0.05 + 0.5 * size


@given(st.integers(2, 40), st.integers(0, 1000), st.lists(st.floats(-50.0, 50.0), min_size=1, max_size=9))
def test_a_carried_map_goes_through_its_points_and_on_over_turns(n: int, seed: int, at: list[float]) -> None:
    x, y = from_even_to_rough(n, seed, 7.0), from_even_to_rough(n, seed + 1, 3.0)
    np.testing.assert_allclose(carry(x, x, y, 7.0, 3.0), y, atol=1e-12)
    places = np.array(at)
    once = carry(places, x, y, 7.0, 3.0)
    np.testing.assert_allclose(carry(places + 14.0, x, y, 7.0, 3.0), once + 6.0, atol=1e-9)
    np.testing.assert_allclose(carry(once, y, x, 3.0, 7.0), places, atol=1e-8)

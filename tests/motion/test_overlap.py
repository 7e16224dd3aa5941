import numpy as np
import pytest
from curves import circle, evenly, exact, lobed, moved

from cytodisk.motion.contour import Contour
from cytodisk.motion.matching import first_guess, match
from cytodisk.motion.overlap import corner_distance, least_overlap, outline_distance, overlap


def places(here: Contour, there: Contour) -> tuple[np.ndarray, np.ndarray]:
    s = evenly(here)
    return s, match(here, there, s, first_guess(here, there, s, 64.0), 64.0)


def test_a_disk_in_another_one_overlaps_by_the_quotient_of_areas() -> None:
    here, there = exact(circle(20.0)), exact(circle(40.0))
    assert overlap(here, there) == pytest.approx(0.25, rel=1e-3)
    assert least_overlap(here, there, *places(here, there)) == pytest.approx(0.25, rel=0.02)


@pytest.mark.parametrize("degrees", [0.0, 5.0, 40.0])
@pytest.mark.parametrize("shift", [(0.0, 0.0), (8.0, -3.0), (60.0, 0.0), (200.0, 0.0)])
def test_the_bound_is_below_the_overlap(degrees: float, shift: tuple[float, float]) -> None:
    here, there = exact(lobed()), exact(moved(lobed(), degrees, shift))
    assert least_overlap(here, there, *places(here, there)) <= overlap(here, there) + 1e-9


@pytest.mark.parametrize("turn", [0.3, 2.0])
def test_the_bound_holds_whatever_is_matched(turn: float) -> None:
    here, there = exact(lobed()), exact(lobed(48.0))
    s = evenly(here)
    bound = least_overlap(here, there, s, (s / here.length + turn) * there.length)
    assert bound <= overlap(here, there) + 1e-9


def test_no_corner_is_farther_than_the_outlines() -> None:
    here, there = exact(lobed()), exact(moved(lobed(), 10.0, (5.0, 1.0)))
    farthest = outline_distance(here, there)
    distances = [corner_distance(here, there, s) for s in evenly(here)]
    assert max(distances) <= farthest
    assert max(distances) > 0.5 * farthest

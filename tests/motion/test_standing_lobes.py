"""Lobes that grow where others shrink: the cell does not turn, and nothing leaps."""

import math
from collections.abc import Iterator

import numpy as np
import pytest
from curves import CENTRE, exact, lobed, moved, polar

from cytodisk.geometry.outline import trace_outline
from cytodisk.motion import tracking
from cytodisk.motion.contour import Contour
from cytodisk.motion.matching import match, rigid_motion
from cytodisk.motion.overlap import outline_distance
from cytodisk.motion.tracking import TrackedBoundary, first_boundary, follow, point_angles
from cytodisk.motion.tracking_parameters import TrackingSettings
from cytodisk.simulate.movie_signals import rasterised

_RADIUS = 35.0
_SETTINGS = TrackingSettings()


def lobes(
    modes: dict[int, tuple[float, float]], seed: int, frames: int, degrees: float = 0.0
) -> Iterator[np.ndarray]:
    """Outlines r = R + Σ A cos(k θ + phase) cos(2π t / period + start), turned in each frame.

    An infinite period is a lobe that stays.
    """
    random = np.random.default_rng(seed)
    centre = CENTRE + random.uniform(-0.5, 0.5, 2)
    angle = 2.0 * np.pi * np.arange(1440) / 1440
    phases, starts = random.uniform(0.0, 2.0 * np.pi, (2, len(modes)))
    for time in range(frames):
        radius = np.full(len(angle), _RADIUS)
        for (k, (height, period)), phase, start in zip(modes.items(), phases, starts, strict=True):
            swing = math.cos(2.0 * math.pi * time / period + start) if math.isfinite(period) else 1.0
            radius += height * swing * np.cos(k * angle + phase)
        yield moved(polar(radius, centre), degrees * time, (0.0, 0.0))


def pixels(outlines: Iterator[np.ndarray]) -> Iterator[Contour]:
    for outline in outlines:
        yield Contour.of_outline(trace_outline(rasterised(outline, (121, 121))))


def followed(contours: Iterator[Contour]) -> list[TrackedBoundary]:
    """Boundaries with the reference renewed every five frames, as in a movie."""
    start = next(contours)
    boundaries = [first_boundary(0, start, point_angles(len(start.points_yx)))]
    for frame, contour in enumerate(contours, 1):
        reference = boundaries[5 * ((frame - 1) // 5)]
        boundaries.append(follow(frame, contour, boundaries[-1], reference, _SETTINGS))
    return boundaries


def turns(boundaries: list[TrackedBoundary]) -> np.ndarray:
    return -np.diff([math.degrees(found.transform.angle) for found in boundaries])


def farthest_step(boundaries: list[TrackedBoundary]) -> float:
    places = np.stack([found.points_yx for found in boundaries])
    return float(np.linalg.norm(np.diff(places, axis=0), axis=2).max())


@pytest.mark.parametrize("k", [2, 3, 4, 5, 6])
@pytest.mark.parametrize(("height", "period"), [(3.0, 8.0), (6.0, 12.0), (10.0, 8.0)])
def test_standing_lobes_do_not_turn_the_cell(k: int, height: float, period: float) -> None:
    boundaries = followed(pixels(lobes({k: (height, period)}, 1000 + k, 14)))
    assert np.abs(turns(boundaries)).max() < 1.0
    assert farthest_step(boundaries) < 2.0 * height * math.sin(math.pi / period) + 1.5


@pytest.mark.parametrize("seed", [1001, 1002, 1003])
def test_several_standing_lobes_do_not_turn_the_cell(seed: int) -> None:
    modes = {2: (5.0, 8.0), 3: (4.0, 11.0), 5: (4.0, 7.0)}
    boundaries = followed(pixels(lobes(modes, seed, 14)))
    assert np.abs(turns(boundaries)).max() < 1.5
    assert farthest_step(boundaries) < sum(2 * a * math.sin(math.pi / p) for a, p in modes.values()) + 1.5


@pytest.mark.parametrize("degrees", [2.0, 5.0, -10.0])
@pytest.mark.parametrize(("k", "height"), [(2, 8.0), (3, 5.0), (4, 6.0), (6, 3.0)])
def test_lobes_that_turn_are_turned(degrees: float, k: int, height: float) -> None:
    contours = pixels(lobes({k: (height, math.inf)}, 1000, 7, degrees))
    found = turns(followed(contours))
    assert found.mean() == pytest.approx(degrees, rel=0.06, abs=0.15)


@pytest.mark.parametrize(("height", "degrees", "rel"), [(3.0, 5.0, 0.2), (3.0, 20.0, 0.15), (1.5, 10.0, 0.5)])
def test_a_faint_ellipse_that_turns_is_turned(height: float, degrees: float, rel: float) -> None:
    contours = pixels(lobes({2: (height, math.inf)}, 1000, 8, degrees))
    assert turns(followed(contours)).mean() == pytest.approx(degrees, rel=rel)


def test_an_energy_that_does_not_fall_towards_a_turn_speaks_against_it() -> None:
    still, flipped = (next(pixels(lobes({4: (height, math.inf)}, 1000, 1))) for height in (6.0, -6.0))
    turned = exact(moved(still.points_yx, 12.0, (0.0, 0.0)))
    grid = still.length * np.arange(300) / 300
    for contour, expected in ((turned, 12.0), (flipped, 0.0), (still, 0.0)):
        fit = rigid_motion(still, contour, grid, grid * contour.length / still.length, 64.0)
        assert math.degrees(fit.angle) == pytest.approx(expected, abs=0.5)


def test_lobes_that_turn_and_change_sign_do_not_leap() -> None:
    boundaries = followed(pixels(lobes({3: (7.5, 18.0)}, 1004, 24, 5.0)))
    rim = math.radians(5.0) * (_RADIUS + 7.5)
    assert farthest_step(boundaries) < rim + 2.0 * 7.5 * math.sin(math.pi / 18.0) + 2.0


def test_the_distance_of_outlines_is_that_of_the_worst_point() -> None:
    square = np.array([[0.0, 0.0], [0.0, 10.0], [10.0, 10.0], [10.0, 0.0]])
    pulled = square.copy()
    pulled[2] += (3.0, 4.0)
    assert outline_distance(exact(square), exact(square)) == 0.0
    assert outline_distance(exact(square), exact(pulled)) == pytest.approx(5.0)
    assert outline_distance(exact(pulled), exact(square)) == pytest.approx(5.0)


def test_points_that_leap_start_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    outlines = [exact(lobed()), exact(moved(lobed(), 0.0, (1.0, 0.0)))]
    assert followed(iter(outlines))[1].restarted == ""

    def leaping(
        here: Contour, there: Contour, s: np.ndarray, guess: np.ndarray, smoothness: float
    ) -> np.ndarray:
        return np.asarray(match(here, there, s, guess, smoothness) + 0.2 * there.length)

    monkeypatch.setattr(tracking, "match", leaping)
    there = followed(iter(outlines))[1]
    assert "px, outlines allow 4 (frames 0 and 1)" in there.restarted
    assert (np.diff(there.s, append=there.s[0] + there.contour.length) > 0.0).all()

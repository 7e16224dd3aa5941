import re

import numpy as np
import pytest
from curves import CENTRE, circle, exact, lobed, moved, runs_once, smooth_curves, wavy
from hypothesis import given
from hypothesis import strategies as st

from cytodisk.disk.circle import boundary_angles
from cytodisk.errors import ParameterError
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.motion.contour import Contour
from cytodisk.motion.registration import IDENTITY
from cytodisk.motion.tracking import TrackedBoundary, first_boundary, follow, point_angles
from cytodisk.motion.tracking_parameters import TrackingSettings

LOOSE = TrackingSettings(tension=0.0)
DEMONS = TrackingSettings(tracker="demons")


def started(contour: Contour) -> TrackedBoundary:
    return first_boundary(0, contour, boundary_angles(contour.outline_yx))


def followed(contours: list[Contour], settings: TrackingSettings = LOOSE) -> list[TrackedBoundary]:
    boundaries = [started(contours[0])]
    for time, contour in enumerate(contours[1:], 1):
        boundaries.append(follow(time, contour, boundaries[-1], boundaries[0], settings))
    return boundaries


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("tracker", "snakes"),
        ("tracker", None),
        ("tension", -0.1),
        ("tension", 1.01),
        ("tension", np.nan),
        ("smoothness_px2", 0.0),
        ("smoothness_px2", -1.0),
        ("smoothness_px2", np.inf),
        ("smoothness_px2", np.nan),
        ("renew_every", 0),
        ("renew_every", 2.5),
        ("renew_every", True),
    ],
)
def test_bad_settings_are_named(name: str, value: object) -> None:
    with pytest.raises(ParameterError, match=f"{name} must be .*got {re.escape(repr(value))}"):
        TrackingSettings(**{name: value})


@pytest.mark.parametrize("name", ["tension", "smoothness_px2"])
def test_settings_that_are_no_numbers_are_named(name: str) -> None:
    with pytest.raises(ParameterError, match=f"{name} must be .*got 'much'"):
        TrackingSettings(**{name: "much"})


@pytest.mark.parametrize("n", [1, 7, 256])
def test_point_angles_are_the_middles_of_even_arcs(n: int) -> None:
    angles = point_angles(n)
    assert angles.shape == (n,)
    assert angles[0] == pytest.approx(np.pi / n)
    np.testing.assert_allclose(np.diff(angles, append=angles[0] + 2.0 * np.pi), 2.0 * np.pi / n)


@pytest.mark.parametrize(("radius", "n"), [(10.0, 256), (40.0, 256), (60.0, 377)])
def test_there_is_a_point_a_pixel_and_256_at_least(radius: float, n: int) -> None:
    assert len(started(exact(circle(radius))).s) == n


def test_the_first_points_have_their_angles_on_the_disk() -> None:
    contour = Contour.of_outline(lobed(n=400))
    angles = boundary_angles(contour.outline_yx, 33.0)
    boundary = first_boundary(0, contour, angles)
    turn = 2.0 * np.pi
    at = np.interp(boundary.s % contour.length, contour.arc, np.append(angles, angles[0] + turn))
    np.testing.assert_allclose(np.exp(1j * at), np.exp(1j * point_angles(len(boundary.s))), atol=1e-9)
    assert runs_once(boundary.s, contour.length)
    assert (boundary.residual_px, boundary.restarted, boundary.transform) == (0.0, "", IDENTITY)


@given(smooth_curves(0.1), smooth_curves(0.1), st.sampled_from([0.0, 0.01, 0.5, 1.0]), st.booleans())
def test_order_is_strict(first: np.ndarray, second: np.ndarray, tension: float, register: bool) -> None:
    settings = TrackingSettings(tension=tension, registration=register)
    here, there = followed([exact(first), exact(second)], settings)
    assert len(there.s) == len(here.s)
    assert runs_once(there.s, there.contour.length)
    assert there.order_violations == 0
    assert (there.transform == IDENTITY) or register


def test_a_rigidly_moving_cell_keeps_its_points() -> None:
    contours = [exact(moved(lobed(), 3.0 * time, (1.0 * time, -0.5 * time))) for time in range(6)]
    boundaries = followed(contours, LOOSE)
    for time, boundary in enumerate(boundaries):
        expected = moved(boundaries[0].points_yx, 3.0 * time, (1.0 * time, -0.5 * time))
        np.testing.assert_allclose(boundary.points_yx, expected, atol=0.1)
        np.testing.assert_allclose(boundary.transform(boundary.points_yx), boundaries[0].points_yx, atol=0.1)
        assert boundary.residual_px < 0.05


@pytest.mark.parametrize("tension", [0.0, 0.01, 1.0])
def test_full_tension_gives_equidistant_points(tension: float) -> None:
    front = wavy([0.1, 0.0, 0.05], [0.0, 0.0, 1.0])
    grown = CENTRE + (front - CENTRE) * np.where(front[:, 1:] > CENTRE[1], 1.3, 1.0)
    _, there = followed([exact(front), exact(grown)], LOOSE.changed(tension=tension))
    gaps = np.diff(there.s, append=there.s[0] + there.contour.length)
    if tension == 1.0:
        np.testing.assert_allclose(gaps, there.contour.length / len(gaps), rtol=1e-9)
    else:
        assert gaps.max() > 1.1 * gaps.min()


def test_tension_leaves_the_mean_place() -> None:
    contours = [exact(lobed()), exact(moved(lobed(49.0), 2.0, (0.0, 1.0)))]
    loose, even = (followed(contours, LOOSE.changed(tension=tension))[1] for tension in (0.0, 1.0))
    assert even.s.mean() == pytest.approx(loose.s.mean(), abs=1e-6)


def test_lengths_sum_to_the_contour_and_normals_lead_out() -> None:
    boundary = followed([exact(lobed()), exact(lobed(48.0))])[1]
    assert boundary.lengths_px.sum() == pytest.approx(boundary.contour.length)
    assert boundary.lengths_px.min() > 0.0
    gaps = np.diff(boundary.s, append=boundary.s[0] + boundary.contour.length)
    assert boundary.lengths_px[5] == pytest.approx(0.5 * (gaps[4] + gaps[5]))
    assert np.ptp(gaps) > 1e-3
    outward = (boundary.normals_yx * (boundary.points_yx - CENTRE)).sum(axis=1)
    assert outward.min() > 0.0


@pytest.mark.parametrize("settings", [TrackingSettings(), DEMONS], ids=["matching", "demons"])
def test_a_cell_that_becomes_another_starts_anew(settings: TrackingSettings) -> None:
    here, there = followed([exact(circle(8.0)), exact(moved(lobed(), 0.0, (30.0, 40.0)))], settings)
    assert re.search(r"overlap by [0-9]% only \(frames 0 and 1\)", there.restarted)
    assert len(there.s) == len(here.s)
    assert runs_once(there.s, there.contour.length)
    after = follow(2, exact(moved(lobed(), 0.0, (31.0, 40.0))), there, there, settings)
    assert after.restarted == ""


def test_what_lies_apart_starts_anew_unless_registered() -> None:
    contours = [exact(lobed()), exact(moved(lobed(), 0.0, (200.0, 0.0)))]
    apart = followed(contours, LOOSE.changed(registration=False))[1]
    assert re.search(r"overlap by 0% only", apart.restarted)
    assert followed(contours)[1].restarted == ""


def test_a_new_start_has_the_angles_of_a_first_frame() -> None:
    shape = Contour.of_outline(lobed(n=400))
    new = followed([exact(circle(8.0)), shape])[1]
    assert new.restarted
    angles = boundary_angles(new.transform(shape.outline_yx))
    at = np.interp(new.s % shape.length, shape.arc, np.append(angles, angles[0] + 2.0 * np.pi))
    np.testing.assert_allclose(np.exp(1j * at), np.exp(1j * point_angles(len(new.s))), atol=1e-9)


def test_demons_follow_a_growing_disk_in_order() -> None:
    radii = [40.0, 41.5, 43.0]
    boundaries = followed([exact(circle(radius)) for radius in radii], DEMONS)
    for radius, boundary in zip(radii, boundaries, strict=True):
        distance = np.linalg.norm(boundary.points_yx - CENTRE, axis=1)
        np.testing.assert_allclose(distance, radius, atol=0.1)
        assert runs_once(boundary.s, boundary.contour.length)
        assert boundary.restarted == ""
    steps = boundaries[-1].points_yx - CENTRE - (boundaries[0].points_yx - CENTRE) * 43.0 / 40.0
    assert np.linalg.norm(steps, axis=1).mean() < 1.0
    assert 0.0 < boundaries[-1].residual_px < 1.0


def test_demons_come_to_lie_on_the_outline_of_a_lobed_cell() -> None:
    boundary = followed([exact(lobed()), exact(lobed(47.0))], DEMONS)[1]
    edge, share = nearest_on_outline(boundary.points_yx, boundary.contour.points_yx)
    start = boundary.contour.points_yx[edge]
    stop = np.roll(boundary.contour.points_yx, -1, axis=0)[edge]
    np.testing.assert_allclose(start + share[:, None] * (stop - start), boundary.points_yx, atol=1e-9)
    assert runs_once(boundary.s, boundary.contour.length)

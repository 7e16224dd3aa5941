import numpy as np
import pytest
from curves import CENTRE, circle, evenly, exact, lobed, masks_of, moved
from hypothesis import given
from hypothesis import strategies as st

from cytodisk import map_movie, simulate
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.polygon import centroid
from cytodisk.motion.contour import Contour
from cytodisk.motion.matching import first_guess
from cytodisk.motion.registration import (
    IDENTITY,
    Registration,
    RigidTransform,
    believable,
    first_transform,
    register,
)

transforms = st.builds(
    RigidTransform, st.floats(-10.0, 10.0), st.floats(-100.0, 100.0), st.floats(-100.0, 100.0)
)
POINTS = np.random.default_rng(0).uniform(-50.0, 50.0, (4, 5, 2))


def turned(moving: Contour, reference: Contour, start: RigidTransform) -> RigidTransform:
    s = evenly(reference)
    guess = first_guess(reference, start.of(moving), s, 64.0)
    return register(moving, reference, start, s, guess, 64.0).transform


@given(transforms)
def test_the_inverse_undoes_and_lengths_stay(transform: RigidTransform) -> None:
    there = transform(POINTS)
    assert there.shape == POINTS.shape
    np.testing.assert_allclose(transform.inverse(there), POINTS, atol=1e-9)
    np.testing.assert_allclose(transform(transform.inverse(POINTS)), POINTS, atol=1e-9)
    steps, steps_there = (np.linalg.norm(np.diff(x, axis=1), axis=-1) for x in (POINTS, there))
    np.testing.assert_allclose(steps_there, steps, atol=1e-9)
    assert np.linalg.det(transform.rotation) == pytest.approx(1.0)


@given(transforms, transforms)
def test_transforms_follow_each_other_and_are_undone(one: RigidTransform, other: RigidTransform) -> None:
    np.testing.assert_allclose(one.after(other)(POINTS), one(other(POINTS)), atol=1e-9)
    np.testing.assert_allclose(one.undone()(POINTS), one.inverse(POINTS), atol=1e-9)
    np.testing.assert_allclose(one.after(one.undone())(POINTS), POINTS, atol=1e-9)


@given(transforms)
def test_a_contour_is_transformed_point_by_point(transform: RigidTransform) -> None:
    contour = exact(lobed(n=50))
    image = transform.of(contour)
    np.testing.assert_allclose(image.points_yx, transform(contour.points_yx), atol=1e-12)
    np.testing.assert_allclose(image.outline_yx, transform(contour.outline_yx), atol=1e-12)
    assert image.length == pytest.approx(contour.length)
    s = evenly(contour, 20)
    np.testing.assert_allclose(image.normals(s), contour.normals(s) @ transform.rotation.T, atol=1e-9)


def test_a_quarter_turn_goes_from_x_to_y() -> None:
    turn = RigidTransform(np.pi / 2.0, 10.0, 20.0)
    np.testing.assert_allclose(
        turn(np.array([[0.0, 1.0], [1.0, 0.0]])), [[11.0, 20.0], [10.0, 19.0]], atol=1e-12
    )
    np.testing.assert_array_equal(IDENTITY(POINTS), POINTS)


def test_the_first_transform_keeps_its_angle_and_joins_the_centroids() -> None:
    moving, reference = exact(moved(lobed(), 30.0, (20.0, -9.0))), exact(lobed(50.0))
    transform = first_transform(moving, reference, 0.7)
    assert transform.angle == 0.7
    there = transform.of(moving)
    np.testing.assert_allclose(centroid(there.points_yx), centroid(reference.points_yx), atol=1e-9)


@pytest.mark.parametrize("degrees", [-12.0, 0.0, 3.0, 20.0])
@pytest.mark.parametrize("known", [0.0, 40.0])
def test_a_rigid_image_is_laid_onto_its_reference(degrees: float, known: float) -> None:
    reference = exact(lobed())
    moving = exact(moved(lobed(), degrees + known, (7.0, -3.0)))
    start = first_transform(moving, reference, np.radians(-known))
    transform = turned(moving, reference, start)
    assert np.degrees(transform.angle) == pytest.approx(-degrees - known, abs=0.02)
    np.testing.assert_allclose(transform(moving.points_yx), reference.points_yx, atol=0.03)


@given(st.floats(46.0, 52.0), st.floats(0.0, 6.0), st.integers(0, 399))
def test_a_round_curve_is_not_turned(radius: float, start_degrees: float, first: int) -> None:
    moving = exact(np.roll(circle(radius, centre=CENTRE + 5.0), first, axis=0))
    reference = exact(circle(45.0))
    start = first_transform(moving, reference, np.radians(start_degrees))
    transform = turned(moving, reference, start)
    assert np.degrees(abs(transform.angle - start.angle)) < 0.1
    np.testing.assert_allclose(transform(CENTRE + 5.0), CENTRE, atol=0.05)


@pytest.mark.parametrize(
    "shift",
    [
        (0.0, 0.0),
        (0.25, 0.0),
        (0.3, 0.1),
        (0.5, 0.0),
    ],
)
def test_a_round_mask_is_not_turned(shift: tuple[float, float]) -> None:
    outlines = circle(45.0), circle(45.0, centre=CENTRE + np.array(shift))
    reference, moving = (Contour.of_outline(trace_outline(mask)) for mask in masks_of(outlines, (121, 121)))
    transform = turned(moving, reference, first_transform(moving, reference, 0.0))
    assert np.degrees(abs(transform.angle)) < 1.0
    np.testing.assert_allclose(transform(CENTRE + np.array(shift)), CENTRE, atol=0.3)


def believed(moving: Contour, reference: Contour, found: RigidTransform) -> RigidTransform:
    s = evenly(reference)
    guess = first_guess(reference, moving, s, 64.0)
    return believable(IDENTITY, found, moving, reference, Registration(found, s, guess, guess), 64.0)


@given(st.floats(-5.0, 5.0), st.floats(0.3, 3.0))
def test_a_rigid_motion_is_believed_in(degrees: float, shift: float) -> None:
    reference, moving = exact(lobed()), exact(moved(lobed(), degrees, (shift, -shift)))
    back = RigidTransform(-np.radians(degrees))
    found = RigidTransform(back.angle, *(CENTRE - back(CENTRE + np.array([shift, -shift]))))
    np.testing.assert_allclose(found(moving.points_yx), reference.points_yx, atol=1e-9)
    transform = believed(moving, reference, found)
    np.testing.assert_allclose(transform(moving.points_yx), reference.points_yx, atol=0.05)


def test_what_explains_nothing_is_not_believed_in() -> None:
    reference, grown = exact(lobed()), exact(lobed(47.0))
    wrong = RigidTransform(0.0, 5.0, -5.0)
    transform = believed(grown, reference, wrong)
    np.testing.assert_allclose(transform(grown.points_yx), grown.points_yx, atol=1e-9)
    assert transform.angle == 0.0


@pytest.mark.parametrize("turn", [-4.0, 2.0])
def test_a_turning_movie_is_turned_back(turn: float) -> None:
    shown = simulate.movie("turning", 3, frames=15, turn_deg=turn, signals=False)
    movie = map_movie(shown.masks, edge_length=3.0, method="harmonic")
    angles = np.degrees([transform.angle for transform in movie.transforms if transform is not None])
    # A rotation is believed in only so far as it explains the motion, so that each falls a little short.
    np.testing.assert_allclose(angles, -turn * np.arange(15), rtol=0.03, atol=0.5)
    first = movie.registered(shown.boundary_yx)
    np.testing.assert_allclose(first, np.broadcast_to(shown.boundary_yx[0], first.shape), atol=2.0)


def test_a_jittering_disk_does_not_turn() -> None:
    shown = simulate.movie("growing", frames=15, speed_px=0.0, jitter_px=0.7, signals=False)
    movie = map_movie(shown.masks, edge_length=3.0, method="harmonic")
    angles = np.degrees([transform.angle for transform in movie.transforms if transform is not None])
    assert np.abs(np.diff(angles)).max() < 0.5


def test_a_turning_ellipse_never_flips() -> None:
    ellipse = CENTRE + (circle(1.0) - CENTRE) * [15.0, 30.0]
    masks = masks_of([moved(ellipse, 5.0 * time, (0.0, 0.0)) for time in range(60)], (121, 121))
    movie = map_movie(masks, edge_length=4.0, method="harmonic")
    angles = np.degrees([transform.angle for transform in movie.transforms if transform is not None])
    np.testing.assert_allclose(np.diff(angles), -5.0, atol=2.5)
    np.testing.assert_allclose(angles, -5.0 * np.arange(60), rtol=0.08, atol=0.5)


def test_without_registration_every_transform_is_the_identity() -> None:
    shown = simulate.movie("turning", 3, frames=4, signals=False)
    movie = map_movie(shown.masks, registration=False, edge_length=3.0, method="harmonic")
    assert movie.transforms == [IDENTITY] * 4

import numpy as np
import pytest
from curves import CENTRE, evenly, exact, lobed, masks_of, moved, smooth_curves
from hypothesis import given
from hypothesis import strategies as st

from cytodisk import map_to_disk, simulate
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.motion.contour import Contour
from cytodisk.motion.temporal import carried_inside, tracked_angles
from cytodisk.motion.tracking import TrackedBoundary, first_boundary, follow, point_angles
from cytodisk.motion.tracking_parameters import TrackingSettings


def uneven(n: int, seed: int, length: float, evenness: float) -> np.ndarray:
    random = np.random.default_rng(seed)
    gaps = random.uniform(size=n) ** 4 + evenness
    return length * (np.cumsum(gaps) / gaps.sum() + random.uniform(-2.0, 2.0))


def one_turn(angles: np.ndarray) -> bool:
    return bool((np.diff(angles, append=angles[0] + 2.0 * np.pi) > 0.0).all())


@given(smooth_curves(), st.integers(4, 400), st.integers(0, 10**6), st.sampled_from([1e-9, 1e-4, 0.1]))
def test_angles_increase_strictly_through_one_turn(
    points: np.ndarray, n: int, seed: int, evenness: float
) -> None:
    contour = exact(points)
    angles = tracked_angles(contour, uneven(n, seed, contour.length, evenness), point_angles(n))
    assert angles.shape == (len(points),)
    assert one_turn(angles)
    gaps = np.diff(angles, append=angles[0] + 2.0 * np.pi)
    assert gaps.min() > 1e-4 * gaps.mean()


@given(smooth_curves(), st.integers(2, 20), st.integers(-3, 3))
def test_tracked_points_keep_their_angles(points: np.ndarray, every: int, turns: int) -> None:
    contour = exact(points)
    chosen = np.arange(1, len(points), every)
    angles = point_angles(len(chosen))
    found = tracked_angles(contour, contour.arc[chosen] + turns * contour.length, angles)
    np.testing.assert_allclose(np.exp(1j * found[chosen]), np.exp(1j * angles), atol=1e-9)


def test_even_points_give_angles_by_arc_length() -> None:
    contour = exact(lobed(n=700))
    s = evenly(contour, 256)
    found = tracked_angles(contour, s, point_angles(256))
    expected = point_angles(256)[0] + 2.0 * np.pi * contour.arc[:-1] / contour.length
    np.testing.assert_allclose(np.exp(1j * found), np.exp(1j * expected), atol=1e-9)


def test_a_shift_by_whole_pixels_carries_the_map_exactly() -> None:
    mask = np.pad(simulate.random_smooth(3, radius=25.0), 10)
    previous = map_to_disk(mask)
    last = Contour.of_outline(previous.outline_yx)
    cell = mesh_cell(np.roll(mask, (4, -3), axis=(0, 1)), MappingParameters())
    contour = Contour.of_outline(cell.outline + cell.corner)
    s = evenly(last, 256)
    found = carried_inside(cell, contour, s, previous, last, s)
    expected = previous.to_disk(previous.vertices_yx, outside="nearest")
    np.testing.assert_allclose(found, expected, atol=1e-6)


@pytest.mark.parametrize("degrees", [0.0, 6.0])
def test_a_rigid_motion_carries_the_map(degrees: float) -> None:
    shift = np.array([2.4, -1.3])
    masks = masks_of([lobed(40.0), moved(lobed(40.0), degrees, shift)], (121, 121))
    previous, cell = map_to_disk(masks[0]), mesh_cell(masks[1], MappingParameters())
    last = Contour.of_outline(previous.outline_yx)
    boundary: TrackedBoundary = first_boundary(0, last, boundary_angles(last.outline_yx))
    contour = Contour.of_outline(cell.outline + cell.corner)
    followed = follow(1, contour, boundary, boundary, TrackingSettings())
    found = carried_inside(cell, contour, followed.s, previous, last, boundary.s)
    came_from = moved(cell.mesh.vertices_yx + cell.corner - shift, -degrees, (0.0, 0.0))
    inner = np.arange(len(found)) >= cell.mesh.n_boundary
    away = np.linalg.norm(found - previous.to_disk(came_from, outside="nearest"), axis=1)[inner]
    # The outline is known to half a pixel of 40 (0.0125).
    assert away.mean() < 0.02
    assert np.percentile(away, 99) < 0.04


def test_the_carried_inside_of_a_grown_cell_is_the_same_disk() -> None:
    masks = masks_of([lobed(36.0), CENTRE + (lobed(36.0) - CENTRE) * 1.08], (121, 121))
    previous, cell = map_to_disk(masks[0]), mesh_cell(masks[1], MappingParameters())
    last = Contour.of_outline(previous.outline_yx)
    boundary = first_boundary(0, last, boundary_angles(last.outline_yx))
    contour = Contour.of_outline(cell.outline + cell.corner)
    followed = follow(1, contour, boundary, boundary, TrackingSettings())
    found = carried_inside(cell, contour, followed.s, previous, last, boundary.s)
    assert np.hypot(*found.T).max() <= 1.0 + 1e-9
    came_from = CENTRE + (cell.mesh.vertices_yx + cell.corner - CENTRE) / 1.08
    away = np.linalg.norm(found - previous.to_disk(came_from, outside="nearest"), axis=1)
    assert np.median(away) < 0.03

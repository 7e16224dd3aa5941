import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from cytodisk import simulate
from cytodisk.disk.circle import boundary_angles
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.polygon import arc_lengths, edge_lengths
from cytodisk.simulate.drawing import half_covered

ALIKE = 1e-4  # rad; outlines of fewer than 100 vertices differ by up to 3.4e-5 in 1 694 random masks


def raster(outline_yx: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mask of an outline, and the shift of the outline into the mask's frame."""
    shift = 6.3 - outline_yx.min(axis=0)
    height, width = np.ceil((outline_yx + shift).max(axis=0)).astype(int) + 7
    return clean_mask(half_covered(outline_yx + shift, (height, width)))[0], shift


def round_outline(radius: float) -> np.ndarray:
    angle = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    return radius * np.column_stack([np.sin(angle), np.cos(angle)])


def turned(outline_yx: np.ndarray, degrees: float) -> np.ndarray:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return outline_yx @ np.array([[c, s], [-s, c]])


def off(angles: np.ndarray, true: np.ndarray) -> np.ndarray:
    return np.angle(np.exp(1j * (angles - true)))


@pytest.mark.parametrize("degrees", [0.0, 20.0, 45.0])
@pytest.mark.parametrize(("width", "length"), [(2, 20), (2, 60), (3, 40), (4, 20), (6, 20), (6, 60)])
def test_a_thin_protrusion_keeps_its_sectors(width: float, length: float, degrees: float) -> None:
    arm = shapely.LineString([(0.0, 0.0), (25.0 + length - 0.5 * width, 0.0)]).buffer(0.5 * width)
    drawn = turned(
        np.array(shapely.Point(0.0, 0.0).buffer(25.0, 64).union(arm).exterior.coords)[:-1, ::-1], degrees
    )
    mask, shift = raster(drawn)
    ahead = turned(np.array([0.0, 1.0]), degrees)
    fine = np.array(shapely.segmentize(shapely.Polygon(drawn).exterior, 0.05).coords)[:-1]
    true = edge_lengths(fine) @ (fine @ ahead > 25.5) / edge_lengths(fine).sum()
    outline = trace_outline(mask)
    on_arm = (outline - shift) @ ahead > 25.5
    angles = boundary_angles(outline)
    first = int(np.flatnonzero(~on_arm)[0])
    span = np.unwrap(np.roll(angles, -first))[np.roll(on_arm, -first)]
    edge = 2.0 * np.pi / len(outline)  # the arm ends between two points
    sectors = 60.0 * (np.ptp(span) + edge) / (2.0 * np.pi)
    assert sectors == pytest.approx(60.0 * true, abs=0.5)


@pytest.mark.parametrize(("height", "most"), [(1, 0.2), (2, 0.6), (3, 1.2)])
def test_a_spike_of_one_pixel_adds_little_length(height: int, most: float) -> None:
    plain = simulate.disk(25.0)
    top = int(plain[:, plain.shape[1] // 2].argmax())
    spiked = plain.copy()
    spiked[top - height : top, plain.shape[1] // 2] = True
    added = arc_lengths(trace_outline(spiked)).sum() - arc_lengths(trace_outline(plain)).sum()
    assert 0.0 < added < most  # its own sides are twice its height


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("radius", [12.0, 40.0])
def test_noise_of_a_pixel_moves_a_circle_by_less_than_a_pixel(radius: float, seed: int) -> None:
    mask, shift = raster(round_outline(radius))
    rim = (mask & ~ndimage.binary_erosion(mask)) | (ndimage.binary_dilation(mask) & ~mask)
    noisy = mask ^ (rim & (np.random.default_rng(seed).random(mask.shape) < 0.5))
    outline = trace_outline(clean_mask(noisy)[0])
    y, x = (outline - shift).T
    error = radius * off(boundary_angles(outline), np.arctan2(y, x))
    assert np.sqrt(np.square(error).mean()) < 0.65


@pytest.mark.parametrize("degrees", [0.0, 10.0, 26.565, 35.0, 45.0])
def test_sides_get_arcs_by_their_length_in_any_direction(degrees: float) -> None:
    box = turned(np.array([(-12.5, -25.0), (-12.5, 25.0), (12.5, 25.0), (12.5, -25.0)]), degrees)
    mask, shift = raster(box)
    outline = trace_outline(mask)
    middle = 0.5 * (outline + np.roll(outline, -1, axis=0)) - shift
    corners = zip(box, np.roll(box, -1, axis=0), strict=True)
    away = [shapely.distance(shapely.LineString(side), shapely.points(middle)) for side in corners]
    lengths, side = arc_lengths(outline), np.argmin(away, axis=0)
    share = np.bincount(side, lengths) / lengths.sum()
    np.testing.assert_allclose(150.0 * share, [50.0, 25.0, 50.0, 25.0], atol=2.0)


@pytest.mark.parametrize("radius", [5.0, 7.3, 10.0, 20.0, 60.0])
def test_points_of_a_pixel_disk_go_to_their_own_angles(radius: float) -> None:
    mask, shift = raster(round_outline(radius))
    outline = trace_outline(mask)
    y, x = (outline - shift).T
    error = np.abs(off(boundary_angles(outline), np.arctan2(y, x))).max()
    assert error * radius < 0.35
    assert np.degrees(error) < 3.0


@settings(max_examples=40, deadline=None)
@given(kind=st.sampled_from(simulate.KINDS), seed=st.integers(0, 10_000))
def test_one_turn_in_order_mirrored_and_turned_with_the_cell(kind: str, seed: int) -> None:
    mask, _ = clean_mask(simulate.random_mask(kind, seed))
    outline = trace_outline(mask)
    angles = boundary_angles(outline)
    assert (np.diff(angles) > 0).all()
    assert angles[-1] - angles[0] < 2.0 * np.pi
    mirrored = outline[::-1] * [1.0, -1.0]
    quarter = np.column_stack([outline[:, 1], -outline[:, 0]])
    np.testing.assert_allclose(off(boundary_angles(mirrored)[::-1], np.pi - angles), 0.0, atol=ALIKE)
    np.testing.assert_allclose(off(boundary_angles(quarter), angles + 0.5 * np.pi), 0.0, atol=ALIKE)


def test_a_mask_of_one_pixel_has_even_angles() -> None:
    angles = boundary_angles(trace_outline(np.pad(np.ones((1, 1), dtype=bool), 2)))
    np.testing.assert_allclose(np.diff(angles), 0.5 * np.pi)

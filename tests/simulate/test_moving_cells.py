from functools import cache

import numpy as np
import pytest
import shapely
from scipy import ndimage
from scipy.spatial import cKDTree
from scipy.spatial.distance import pdist

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.geometry.polygon import signed_area
from cytodisk.simulate import MOVIE_KINDS, SimulatedMovie, movie
from cytodisk.simulate.movie_kinds import MovieKind


def holes_and_pieces(mask: np.ndarray) -> tuple[int, int]:
    return ndimage.label(np.logical_not(mask), np.ones((3, 3)))[1] - 1, ndimage.label(mask)[1]


def edge_brightness(shown: SimulatedMovie, frame: int) -> tuple[FloatArray, np.ndarray]:
    """Edge signal of the outermost pixels without its decay, and the nearest boundary point of each."""
    assert shown.truth is not None
    pixels = np.argwhere(shown.masks[frame])
    depth, nearest = cKDTree(shown.boundary_yx[frame]).query(pixels)
    outer = depth < 3.0
    row, column = pixels[outer].T
    counts = shown.truth.sel(channel="edge").to_numpy()[frame, row, column] - 20.0
    return counts * np.exp(depth[outer] / 5.0), nearest[outer]


@cache
def long_movie(kind: MovieKind, seed: int) -> SimulatedMovie:
    return movie(kind, seed, frames=50, margin=7, signals=False)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", MOVIE_KINDS)
def test_every_cell_stays_one_piece_with_a_simple_edge(kind: MovieKind, seed: int) -> None:
    shown = long_movie(kind, seed)
    assert shapely.is_valid(shapely.polygons(shown.boundary_yx)).all()
    assert signed_area(shown.boundary_yx[0]) > 0.0
    assert all(holes_and_pieces(mask) == (0, 1) for mask in shown.masks[shown.present])
    anywhere = shown.masks.any(axis=0)
    inner = anywhere[7:-7, 7:-7]
    assert inner.sum() == anywhere.sum()
    assert np.isnan(shown.normal_displacement_px[-1]).all()
    assert np.abs(shown.normal_displacement_px[:-1]).max() < 9.0


@pytest.mark.parametrize("kind", [kind for kind in MOVIE_KINDS if kind != "still"])
def test_masks_have_the_area_of_the_edge(kind: MovieKind) -> None:
    shown = long_movie(kind, 0)
    area = [signed_area(outline) for outline in shown.boundary_yx[shown.present]]
    np.testing.assert_allclose(shown.masks[shown.present].sum(axis=(1, 2)), area, rtol=0.01)


@pytest.mark.parametrize("kind", MOVIE_KINDS)
def test_interior_points_stay_inside_and_the_points_are_even(kind: MovieKind) -> None:
    shown = long_movie(kind, 1)
    for outline, interior in zip(shown.boundary_yx[::7], shown.interior_yx[::7], strict=True):
        assert shapely.contains_xy(shapely.Polygon(outline).buffer(0.02), interior).all()
    start = 15 if kind == "filopodium" else 0
    steps = np.hypot(*np.diff(shown.boundary_yx[start], axis=0).T)
    np.testing.assert_allclose(steps, steps.mean(), rtol=0.2 if start else 0.03)  # shorter across a corner
    assert len(shown.interior_yx[0]) == pytest.approx(signed_area(shown.boundary_yx[0]) / 2.0, rel=0.02)


def test_the_same_arguments_give_the_same_movie() -> None:
    first, again, other = (movie("bulging", seed, frames=6) for seed in (5, 5, 6))
    np.testing.assert_array_equal(first.masks, again.masks)
    assert first.signal is not None
    assert again.signal is not None
    assert first.signal.identical(again.signal)
    assert first.signal.dtype == np.uint16
    assert first.boundary_yx.shape == other.boundary_yx.shape
    assert not np.array_equal(first.boundary_yx, other.boundary_yx)


def test_jitter_and_dropped_frames_leave_the_motion_as_it_is() -> None:
    clean = movie("bulging", 1, frames=10, signals=False)
    spoilt = movie("bulging", 1, frames=10, jitter_px=1.0, dropped=0.3, signals=False)
    np.testing.assert_array_equal(clean.normal_displacement_px, spoilt.normal_displacement_px)


def test_a_growing_disk_gains_its_speed_everywhere() -> None:
    shown = movie("growing", frames=12, speed_px=0.8, signals=False)
    np.testing.assert_allclose(shown.normal_displacement_px[:-1], 0.8, atol=1e-3)
    centre = shown.boundary_yx.mean(axis=1, keepdims=True)
    radius = np.hypot(*np.moveaxis(shown.boundary_yx - centre, -1, 0))
    np.testing.assert_allclose(radius, np.tile(45.0 + 0.8 * np.arange(12.0)[:, None], 3000), atol=1e-2)


@pytest.mark.parametrize("kind", ["translating", "turning", "still"])
def test_rigid_cells_keep_all_distances(kind: MovieKind) -> None:
    shown = movie(kind, 2, frames=20, signals=False)
    first, last = (np.concatenate([path[::50] for path in (shown.boundary_yx[k], shown.interior_yx[k])])
                   for k in (0, -1))  # fmt: skip
    np.testing.assert_allclose(pdist(last), pdist(first), atol=1e-9)


def test_cells_travel_and_turn_as_told() -> None:
    shown = movie("translating", 2, frames=11, speed_px=2.0, signals=False)
    assert np.hypot(*(shown.boundary_yx[-1] - shown.boundary_yx[0]).T) == pytest.approx(20.0)
    shown = movie("turning", 2, frames=11, turn_deg=3.0, signals=False)
    first, last = (outline[1500] - outline[0] for outline in shown.boundary_yx[[0, -1]])
    turn = np.degrees(np.arctan2(*last) - np.arctan2(*first))
    assert (turn + 180.0) % 360.0 - 180.0 == pytest.approx(30.0)


def test_a_neck_closes_to_five_pixels_and_opens() -> None:
    shown = movie("necking", 1, signals=False)
    depth = np.array([ndimage.distance_transform_edt(mask).max() for mask in shown.masks])
    assert depth.min() > 10.0  # the lobes stay
    neck = [shapely.Polygon(outline).buffer(-2.7).geom_type for outline in shown.boundary_yx]
    assert neck[0] == neck[-1] == "Polygon"
    assert "MultiPolygon" in neck
    assert all(shapely.Polygon(outline).buffer(-2.2).geom_type == "Polygon" for outline in shown.boundary_yx)


def test_jitter_has_its_size_and_length_and_no_memory() -> None:
    shown = movie("still", 1, frames=40, jitter_px=1.0, signals=False)
    assert (shown.normal_displacement_px[:-1] == 0.0).all()
    flips = (shown.masks[1:] != shown.masks[:-1]).sum(axis=(1, 2))
    length = shapely.Polygon(shown.boundary_yx[0]).length
    # The area between two outlines is their mean distance, √2 σ √(2/π), times the length.
    assert flips.mean() == pytest.approx(2.0 / np.sqrt(np.pi) * length, rel=0.15)


def test_dropped_frames_are_empty_but_never_at_the_ends() -> None:
    shown = movie("dropping", 3, frames=20, dropped=0.5)
    assert (~shown.present).sum() == 10
    assert shown.present[[0, -1]].all()
    np.testing.assert_array_equal(shown.masks.any(axis=(1, 2)), shown.present)
    assert shown.signal is not None
    np.testing.assert_array_equal(shown.signal.any(("channel", "y", "x")), shown.present)
    assert np.isfinite(shown.normal_displacement_px[:-1]).all()


@pytest.mark.parametrize("kind", ["neutrophil", "spiky", "ruffling"])
def test_the_material_channel_moves_with_the_material(kind: MovieKind) -> None:
    shown = movie(kind, 1, frames=15)
    assert shown.truth is not None
    counts = shown.truth.sel(channel="material").to_numpy()
    for frame in (1, 7, 14):
        deep = np.ones(shown.interior_yx.shape[1], dtype=bool)
        values = []
        for k in (0, frame):
            at = shown.interior_yx[k].T
            deep &= ndimage.map_coordinates(ndimage.distance_transform_edt(shown.masks[k]), at, order=1) > 5.0
            values.append(ndimage.map_coordinates(counts[k], at, order=3))
        np.testing.assert_allclose(values[1][deep], values[0][deep], rtol=0.05)


@pytest.mark.parametrize("lag", [3, 0, -2])
def test_the_edge_channel_follows_velocity_by_its_lag(lag: int) -> None:
    shown = movie("bulging", 1, frames=14, lag_frames=lag)
    inner = range(4, 9)
    brightness = [edge_brightness(shown, frame) for frame in inner]
    seen = np.concatenate([values for values, _ in brightness])
    fit = {}
    for shift in range(-4, 5):
        speed = [
            shown.normal_displacement_px[frame - shift, nearest]
            for frame, (_, nearest) in zip(inner, brightness, strict=True)
        ]
        fit[shift] = np.corrcoef(seen, np.concatenate(speed))[0, 1]
    assert max(fit, key=fit.__getitem__) == lag
    assert fit[lag] > 0.9999


def test_the_edge_channel_is_exact_in_the_first_and_last_frames() -> None:
    short, long = movie("bulging", 2, frames=5, lag_frames=3), movie("bulging", 2, frames=9, lag_frames=-3)
    for shown, frame, source in ((short, 4, 1), (long, 0, 3)):
        values, nearest = edge_brightness(shown, frame)
        expected = 500.0 + 80.0 * shown.normal_displacement_px[source, nearest]
        np.testing.assert_allclose(values, expected, rtol=1e-9)


@pytest.mark.parametrize(
    "wrong",
    [
        {"kind": "walking"},
        {"seed": -1},
        {"frames": 1},
        {"frames": 4.5},
        {"radius_px": 3.0},
        {"speed_px": -1.0},
        {"turn_deg": np.inf},
        {"protrusion_px": -2.0},
        {"kind": "still", "protrusion_px": 3.0},
        {"jitter_px": np.nan},
        {"dropped": 1.0},
        {"lag_frames": 2.5},
        {"pixel_size_um": 0.0},
        {"frame_interval_s": "5 s"},
        {"margin": -1},
    ],
)
def test_bad_arguments_are_named(wrong: dict[str, object]) -> None:
    with pytest.raises(ParameterError, match=list(wrong)[-1]):
        movie(**wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["speed_px", "protrusion_px", "jitter_px"])
def test_motion_beyond_any_cell_is_refused(name: str) -> None:
    with pytest.raises(ParameterError, match=f"{name} must be a number from 0 to 100, got"):
        movie("fluctuating", **{name: 1e12})

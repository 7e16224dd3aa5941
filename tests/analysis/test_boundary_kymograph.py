from typing import Any

import numpy as np
import pytest
import shapely
import xarray as xr

from cytodisk import DiskMovie, Scale, map_movie, map_to_disk
from cytodisk.analysis.boundary_depth import places_at_depth
from cytodisk.analysis.kymograph import boundary_kymograph
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError, SignalError

FRAMES, HEIGHT, WIDTH, RADIUS = 5, 70, 90, 24.0
EMPTY = 2  # a frame without a cell


def centre(time: int) -> tuple[float, float]:
    return 33.0, 35.0 + 3.0 * time


def polar(time: int) -> tuple[np.ndarray, np.ndarray]:
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    down, right = y - centre(time)[0], x - centre(time)[1]
    return np.hypot(down, right), np.arctan2(down, right)


@pytest.fixture(scope="module")
def movie() -> DiskMovie:
    """A round cell that moves to the right and is not there in one frame."""
    masks = np.array([polar(time)[0] <= RADIUS for time in range(FRAMES)])
    masks[EMPTY] = False
    return map_movie(xr.DataArray(masks, dims=("time", "y", "x"), attrs={"pixel_size_um": 0.5}))


@pytest.fixture(scope="module")
def signals() -> xr.DataArray:
    """Distance from the cell's centre, and a pattern by angle that moves with it."""
    values = [[polar(time)[0], 100.0 + 50.0 * np.cos(3.0 * polar(time)[1])] for time in range(FRAMES)]
    return xr.DataArray(values, {"channel": ["radius", "angle"]}, ("time", "channel", "y", "x"))


@pytest.mark.parametrize("depth_um", [0.0, 1.0, 2.5, 8.0])
def test_the_depth_of_a_round_cell_is_its_radius_less(
    movie: DiskMovie, signals: xr.DataArray, depth_um: float
) -> None:
    kymograph = boundary_kymograph(movie, depth_um, signals, points=90)
    assert kymograph.dims == ("time", "point", "channel")
    there = np.arange(FRAMES) != EMPTY
    assert np.isfinite(kymograph.to_numpy()).all(axis=(1, 2)).tolist() == there.tolist()
    radius = kymograph.sel(channel="radius").to_numpy()[there]
    # The nearest point of an outline with stair steps is more often on an inner corner than on an outer.
    np.testing.assert_allclose(radius, RADIUS - 2.0 * depth_um, atol=0.7)
    assert abs(radius.mean() - (RADIUS - 2.0 * depth_um)) < 0.4
    assert (kymograph.attrs["depth"], kymograph.attrs["depth_units"]) == (depth_um, "µm")


def test_a_frame_without_a_map_is_nan(movie: DiskMovie, signals: xr.DataArray) -> None:
    kymograph = boundary_kymograph(movie, 1.0, signals, points=12)
    assert np.isnan(kymograph[EMPTY]).all()
    assert np.isnan(kymograph["y"][EMPTY]).all()


def test_the_pattern_stays_where_it_is_on_the_cell(movie: DiskMovie, signals: xr.DataArray) -> None:
    kymograph = boundary_kymograph(movie, 2.0, signals.sel(channel="angle"), points=120)
    assert kymograph.dims == ("time", "point")
    expected = 100.0 + 50.0 * np.cos(3.0 * kymograph["angle"])
    for time in (0, 1, 3, 4):
        np.testing.assert_allclose(kymograph[time], expected, atol=8.0)
    np.testing.assert_allclose(kymograph["angle"], 2.0 * np.pi * (np.arange(120) + 0.5) / 120)


@pytest.fixture(scope="module")
def bar() -> DiskMap:
    """A rectangle: its outline is half a pixel outside rows 10 to 29 and columns 10 to 69."""
    mask = np.zeros((40, 80), dtype=bool)
    mask[10:30, 10:70] = True
    return map_to_disk(mask)


def angles(count: int) -> np.ndarray:
    return 2.0 * np.pi * (np.arange(count) + 0.5) / count


def distance_from_edge(disk: DiskMap, places: np.ndarray) -> np.ndarray:
    return np.asarray(shapely.distance(shapely.LinearRing(disk.outline_yx), shapely.points(places)))


@pytest.mark.parametrize("depth", [0.0, 0.3, 3.0, 7.5, 9.9])
def test_places_have_the_depth_exactly(bar: DiskMap, depth: float) -> None:
    places = places_at_depth(bar, angles(200), depth)
    known = np.isfinite(places[:, 0])
    assert known.mean() > (0.9 if depth < 8 else 0.4)
    np.testing.assert_allclose(distance_from_edge(bar, places[known]), depth, atol=1.1e-3)
    beside_the_top = known & (places[:, 0] < 19.5) & (np.abs(places[:, 1] - 39.5) < 15)
    assert beside_the_top.sum() > 20
    np.testing.assert_allclose(places[beside_the_top, 0], 9.5 + depth, atol=1.1e-3)


def test_nowhere_is_deeper_than_half_the_width(bar: DiskMap) -> None:
    assert np.isnan(places_at_depth(bar, angles(50), 10.1)).all()


def test_values_on_a_gradient_are_those_of_the_depth() -> None:
    masks = np.zeros((2, 40, 80), dtype=bool)
    masks[:, 10:30, 10:70] = True
    rows = np.broadcast_to(10.0 * np.arange(40.0)[:, None], (2, 40, 80))
    kymograph = boundary_kymograph(map_movie(masks), 3.0, rows, points=100)
    assert kymograph.attrs["depth_units"] == "px"
    np.testing.assert_allclose(kymograph, 10.0 * kymograph["y"])
    top = kymograph[0].where(np.abs(kymograph["x"][0] - 39.5) < 15).min()
    assert float(top) == pytest.approx(125.0, abs=0.011)


def dumbbell() -> DiskMap:
    y, x = np.mgrid[:60, :120]
    lobes = (np.hypot(y - 30, x - 28) <= 20) | (np.hypot(y - 30, x - 92) <= 16)
    return map_to_disk(lobes | ((np.abs(y - 30) <= 4) & (x > 28) & (x < 92)))


def test_rays_end_at_their_first_place_of_the_depth_or_have_none() -> None:
    disk, directions = dumbbell(), angles(60)
    radii = np.linspace(1.0, 0.0, 1500)
    rays = disk.to_cell(np.column_stack([np.cos(directions), np.sin(directions)])[:, None] * radii[:, None])
    below = distance_from_edge(disk, rays)
    lost = []
    for depth in (2.0, 4.0, 10.0, 14.0, 18.0):
        places = places_at_depth(disk, directions, depth)
        reached = below.max(axis=1)
        clear = np.abs(reached - depth) > 0.05  # the ray is drawn in straight pieces
        found = np.isfinite(places[:, 0])
        np.testing.assert_array_equal(found[clear], (reached >= depth)[clear])
        first = rays[np.arange(60), (below >= depth).argmax(axis=1)]
        off = np.linalg.norm(places - first, axis=1)[clear & found]
        assert np.median(off) < 0.1
        assert off.max() < 1.0
        lost.append(int((~found).sum()))
    assert lost[0] == 0
    assert 0 < lost[-1] < 60


def test_the_border_of_the_image_is_no_edge() -> None:
    y, x = np.mgrid[:50, :60]
    masks = np.array([np.hypot(y - 4, x - 30) <= 20] * 2)
    kymograph = boundary_kymograph(map_movie(masks), 2.0, np.ones((2, 50, 60)), points=80)
    up = np.isnan(kymograph[0]).to_numpy()
    assert 10 < up.sum() < 50
    assert not up[:30].any()  # angles towards +y, away from the border


def test_channels_and_times(movie: DiskMovie, signals: xr.DataArray) -> None:
    array = boundary_kymograph(movie, 1.0, signals.to_numpy(), points=8)
    assert array["channel"].to_numpy().tolist() == ["0", "1"]
    assert "time_s" not in array.coords
    timed = DiskMovie(movie.records, movie.image_shape, Scale(0.5, 4.0), movie.load)
    known = boundary_kymograph(timed, 1.0, signals, points=8)
    np.testing.assert_array_equal(known["time_s"], 4.0 * np.arange(FRAMES))
    np.testing.assert_array_equal(known, array)


@pytest.mark.parametrize(
    ("depth", "options", "message"),
    [
        (-1.0, {}, "depth must be a number of at least 0, got -1.0"),
        (np.inf, {}, "depth"),
        ("1", {}, "depth"),
        (1.0, {"points": 0}, "points must be a whole number from 1 to 1000000, got 0"),
        (1.0, {"points": 10.5}, "points"),
    ],
)
def test_numbers_out_of_range_are_refused(
    movie: DiskMovie, signals: xr.DataArray, depth: Any, options: dict[str, Any], message: str
) -> None:
    with pytest.raises(ParameterError, match=message):
        boundary_kymograph(movie, depth, signals, **options)


@pytest.mark.parametrize("other", [np.zeros((2, 9, 9)), "study", None])
def test_what_is_no_movie_is_refused(signals: xr.DataArray, other: Any) -> None:
    words = rf"movie must be a DiskMovie, got {type(other).__name__}: pass study\.movie\(cell\)"
    with pytest.raises(ParameterError, match=words):
        boundary_kymograph(other, 1.0, signals)


def test_signals_that_do_not_fit_are_refused(movie: DiskMovie, signals: xr.DataArray) -> None:
    with pytest.raises(SignalError, match=r"'movie\.tif'.*read_image"):
        boundary_kymograph(movie, 1.0, "movie.tif")
    with pytest.raises(SignalError, match="4 frames, the movie 5"):
        boundary_kymograph(movie, 1.0, signals[:4])
    frames = [*signals.to_numpy()[:4], signals.to_numpy()[4, :1]]
    with pytest.raises(SignalError, match="frame 4 of the signals"):
        boundary_kymograph(movie, 1.0, frames)

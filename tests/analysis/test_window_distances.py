from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk.analysis.pairs.window_distances import window_distances
from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError, WindowError
from cytodisk.windows.polar_windows import PolarGrid, polar_windows

RADIUS = 40.0


def table(distances: xr.Dataset, name: str) -> FloatArray:
    windows = distances.sizes["layer"] * distances.sizes["sector"]
    return distances[name].to_numpy().reshape(windows, windows)


def centres(disk: DiskMap, grid: PolarGrid) -> FloatArray:
    """Middle of each window's radii and angles, in the cell, (W, 2)."""
    radius = 0.5 * (grid.radii[:-1] + grid.radii[1:])
    angle = 0.5 * (grid.angles[:-1] + grid.angles[1:])
    uv = [[r * np.cos(phi), r * np.sin(phi)] for r in radius for phi in angle]
    return disk.to_cell(np.array(uv))


def slotted() -> Any:
    """A cell of 70 × 80 pixels in the form of a U: a slot of 20 pixels from above, 55 deep."""
    mask = np.zeros((80, 90), dtype=bool)
    mask[5:75, 5:85] = True
    mask[5:60, 35:55] = False
    return mask


@pytest.fixture(scope="module")
def round_cell() -> DiskMap:
    return cd.map_to_disk(cd.simulate.disk(RADIUS))


@pytest.fixture(scope="module")
def u_cell() -> DiskMap:
    return cd.map_to_disk(slotted())


def test_a_round_cell(round_cell: DiskMap) -> None:
    grid = polar_windows(4, 16)
    found = window_distances(round_cell, grid)
    assert found["straight"].dims == ("layer", "sector", "other_layer", "other_sector")
    assert found.attrs["units"] == found["edge"].attrs["units"] == "px"
    yx = centres(round_cell, grid)
    chords = np.linalg.norm(yx[:, None] - yx, axis=2)
    np.testing.assert_allclose(table(found, "straight"), chords, atol=1e-9)
    np.testing.assert_array_equal(found["interior"], found["straight"])
    radius = RADIUS * 0.5 * (grid.radii[:-1] + grid.radii[1:])
    across = [
        float(found["straight"].sel(layer=k, sector=3, other_layer=k, other_sector=11)) for k in range(4)
    ]
    np.testing.assert_allclose(across, 2.0 * radius, rtol=0.02)  # the map keeps areas, hence radii of a disk


def test_along_the_edge_of_a_round_cell_is_the_arc(round_cell: DiskMap) -> None:
    found = window_distances(round_cell, polar_windows(2, 16))["edge"]
    steps = np.abs(np.arange(16)[:, None] - np.arange(16))
    arc = 2.0 * np.pi * RADIUS * np.minimum(steps, 16 - steps) / 16.0
    for layer, other in np.ndindex(2, 2):  # whatever the layers
        np.testing.assert_allclose(found.sel(layer=layer, other_layer=other), arc, rtol=0.02)


def test_arms_that_are_near_but_not_inside(u_cell: DiskMap) -> None:
    grid = polar_windows(6, 36)
    found = window_distances(u_cell, grid)
    yx = centres(u_cell, grid)
    left, right = (yx[:, 0] < 55.0) & (yx[:, 1] < 34.0), (yx[:, 0] < 55.0) & (yx[:, 1] > 56.0)
    assert min(left.sum(), right.sum()) > 30
    corners = np.array([[59.5, 34.5], [59.5, 54.5]])  # the shortest way bends around the bottom of the slot
    around = [
        np.linalg.norm(yx[arm] - corner, axis=1) for arm, corner in zip((left, right), corners, strict=True)
    ]
    expected = around[0][:, None] + 20.0 + around[1]
    interior, straight = (table(found, name)[np.ix_(left, right)] for name in ("interior", "straight"))
    ratio = interior / expected
    assert ratio.min() > 0.99  # corners of pixels are cut by the outline
    assert ratio.max() < 1.10
    assert ratio.mean() < 1.03
    assert (interior > straight).all()  # none sees another across the slot
    assert (interior / straight).max() > 2.5  # between the tips of the arms
    edge = table(found, "edge")
    perimeter = 2.0 * (70.0 + 80.0 + 55.0)
    assert 0.47 * perimeter < edge.max() < 0.505 * perimeter


@pytest.mark.parametrize("shape", ["round", "u"])
@pytest.mark.parametrize("layers", [1, 5])
def test_what_every_distance_must_be(shape: str, layers: int, round_cell: DiskMap, u_cell: DiskMap) -> None:
    found = window_distances(round_cell if shape == "round" else u_cell, polar_windows(layers, 12))
    straight, interior, edge = (table(found, name) for name in ("straight", "interior", "edge"))
    for name, values in (("straight", straight), ("interior", interior), ("edge", edge)):
        np.testing.assert_allclose(values, values.T, atol=1e-9, err_msg=name)
        np.testing.assert_allclose(np.diag(values), 0.0, atol=1e-9, err_msg=name)
        assert np.isfinite(values).all()
        assert (values >= 0.0).all()
    off = ~np.eye(len(straight), dtype=bool)
    assert (straight[off] > 0.0).all()
    assert (interior >= straight).all()
    detour = straight[:, :, None] + straight[None]
    assert (straight[:, None] <= detour + 1e-9).all()
    np.testing.assert_array_equal(found["other_sector"], np.arange(12))


def test_of_a_movie_the_mean_in_micrometres() -> None:
    truth = cd.simulate.movie("growing", frames=6, signals=False)
    grid = polar_windows(2, 8)
    movie = cd.map_movie(truth.masks, pixel_size_um=0.5)
    found = window_distances(movie, grid, frames=3)
    assert found.attrs["units"] == found["interior"].attrs["units"] == "µm"
    each = [window_distances(movie[time], grid) for time in (0, 2, 5)]  # evenly spread, rounded to even
    for name in found:
        expected = np.mean([one[name] for one in each], axis=0)
        np.testing.assert_allclose(found[name], expected, rtol=1e-12)
    plain = window_distances(cd.map_movie(truth.masks), grid, frames=3)
    assert plain.attrs["units"] == "px"
    np.testing.assert_allclose(plain["edge"], 2.0 * found["edge"])
    np.testing.assert_allclose(
        window_distances(movie, grid, frames=99)["straight"],
        np.mean([window_distances(movie[time], grid)["straight"] for time in range(6)], axis=0),
    )


def test_frames_without_a_map_are_passed_over() -> None:
    masks = np.array(cd.simulate.movie("growing", frames=4, signals=False).masks)
    masks[1] = False
    movie = cd.map_movie(masks)
    found = window_distances(movie, polar_windows(1, 6))
    each = [window_distances(movie[time], polar_windows(1, 6))["straight"] for time in (0, 2, 3)]
    np.testing.assert_allclose(found["straight"], np.mean(each, axis=0))


def test_they_fit_correlate_pairs(u_cell: DiskMap) -> None:
    grid = polar_windows(2, 6)
    a = np.random.default_rng(0).normal(size=(30, 2, 6))
    found = cd.correlate_pairs(a, a, 2, distances=window_distances(u_cell, grid), bins=4)
    assert found["along"].to_numpy().tolist() == ["straight", "interior", "edge"]
    np.testing.assert_array_equal(found["n"].sum("distance"), 144)
    # with themselves; along the edge also with the other window of the sector
    np.testing.assert_array_equal(found["n"].isel(distance=0).sel(lag=0), [12, 12, 24])


@pytest.mark.parametrize("frames", [0, -1, 1.5, None, "all"])
def test_frames_that_make_no_sense(frames: Any, round_cell: DiskMap) -> None:
    with pytest.raises(ParameterError, match=r"frames.*at least 1"):
        window_distances(round_cell, polar_windows(1, 4), frames=frames)


def test_a_movie_without_a_map() -> None:
    masks = np.array(cd.simulate.movie("growing", frames=2, signals=False).masks)
    masks[1] = False
    movie = cd.map_movie(masks)
    movie = replace(movie, records=movie.records[1:])
    with pytest.raises(WindowError, match="no frame with a map"):
        window_distances(movie, polar_windows(1, 4))

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd

GRIDS = ((1, 1), (3, 8), (10, 60), (30, 150))


def holed(seed: int = 0, holes: int = 4) -> np.ndarray:
    """A cell of about 2 000 pixels with rectangular holes in its filled inside."""
    mask = cd.simulate.migrating(seed=3, size=0.4)
    rng = np.random.default_rng(seed)
    row, column = np.argwhere(mask).T
    for _ in range(holes):
        at = rng.integers(len(row))
        height, width = rng.integers(1, 9, size=2)
        mask[row[at] : row[at] + height, column[at] : column[at] + width] = False
    return cd.clean_mask(mask, holes="exclude")[0]


@pytest.fixture(scope="module")
def mask() -> np.ndarray:
    found = holed()
    assert cd.clean_mask(found)[1].holes > 0
    return found


@pytest.fixture(scope="module")
def disk(mask: np.ndarray) -> cd.DiskMap:
    return cd.map_to_disk(mask, holes="exclude")


def test_the_map_is_that_of_the_filled_mask(mask: np.ndarray, disk: cd.DiskMap) -> None:
    filled = cd.map_to_disk(mask)
    assert filled.holes is None
    assert_array_equal(disk.vertices_uv, filled.vertices_uv)
    assert_array_equal(disk.mask, filled.mask)
    assert disk.certificate.valid
    assert_array_equal(disk.mask_without_holes, mask)
    assert disk.holes is not None
    assert_array_equal(disk.holes.whole, filled.mask & ~mask)


@pytest.mark.parametrize("grid", GRIDS)
def test_windows_sum_to_the_mask_without_its_holes(
    mask: np.ndarray, disk: cd.DiskMap, grid: tuple[int, int]
) -> None:
    windows = cd.polar_windows(*grid).on(disk)
    assert_allclose(windows.areas.sum(), mask.sum(), rtol=1e-12)
    by_pixel = np.asarray(windows.weights.sum(axis=0)).ravel()
    assert_allclose(by_pixel[mask[disk.mask]], 1.0, rtol=1e-12)
    assert (by_pixel[~mask[disk.mask]] == 0.0).all()
    signal = np.random.default_rng(1).normal(100.0, 30.0, mask.shape)
    signal[~mask] = 1e9  # in a hole nothing is looked at
    data = cd.sample(windows, signal)
    total = float((data["n_pixels"] * data["mean"]).sum())
    assert_allclose(total, signal[mask].sum(), rtol=1e-9)
    assert float(data["max"].max()) < 1e6
    assert_allclose(windows.coverage, mask.sum() / disk.mask.sum())


@settings(max_examples=12)
@given(seed=st.integers(0, 10_000), holes=st.integers(1, 8), spacing=st.sampled_from(["area", "radius"]))
def test_sums_are_exact_whatever_the_holes(seed: int, holes: int, spacing: str) -> None:
    mask = holed(seed, holes)
    disk = cd.map_to_disk(mask, holes="exclude", method="harmonic")
    windows = cd.polar_windows(6, 40, spacing).on(disk)
    assert_allclose(windows.areas.sum(), mask.sum(), rtol=1e-12)
    assert_array_equal(windows.labels >= 0, mask)


def test_nan_in_a_hole_is_no_nan_in_a_window(mask: np.ndarray, disk: cd.DiskMap) -> None:
    signal = np.where(mask, 5.0, np.nan)
    data = cd.sample(cd.polar_windows(3, 8).on(disk), signal)
    assert_array_equal(data["n_nan"], 0.0)
    assert_allclose(data["mean"], 5.0)


def ringed(radius: int = 30, hole: float = 12.0) -> np.ndarray:
    """A disk with a round hole in its middle."""
    mask = cd.simulate.disk(radius)
    y, x = np.indices(mask.shape) - (np.array(mask.shape) // 2)[:, None, None]
    return np.asarray(mask & (y * y + x * x > hole * hole))


def test_windows_wholly_in_a_hole_are_honestly_empty() -> None:
    """Of 10 layers of a disk of 30 px the innermost lies within 9.5 px of the centre, the hole within 12."""
    mask = ringed()
    windows = cd.polar_windows(10, 12).on(cd.map_to_disk(mask, holes="exclude"))
    assert (windows.areas[-1] == 0.0).all()
    assert (windows.areas[:8] > 0.0).all()
    assert windows.n_empty == int((windows.areas == 0.0).sum()) == 12
    assert_array_equal(windows.completeness, [1.0] * 9 + [0.0])
    data = cd.sample(windows, np.ones(mask.shape))
    assert data["mean"][-1].isnull().all()
    assert (data["n_pixels"][-1] == 0.0).all()
    assert data["depth"][-1].isnull().all()
    assert np.isnan(windows.centroids_yx[-1]).all()
    assert (windows.pieces[-1] == 0).all()


def test_depth_is_that_to_the_outer_edge_not_to_the_hole() -> None:
    mask = ringed()
    holed_windows = cd.polar_windows(5, 12).on(cd.map_to_disk(mask, holes="exclude"))
    filled = cd.polar_windows(5, 12).on(cd.map_to_disk(mask))
    assert_allclose(holed_windows.depths[:4], filled.depths[:4])
    assert holed_windows.depths[3, :, 0].min() > 12.0  # next to the hole, far from the edge


def test_the_error_of_areas_is_that_of_the_map() -> None:
    mask = ringed()
    for grid in ((5, 12), (10, 60), (40, 150)):
        holed_windows = cd.polar_windows(*grid).on(cd.map_to_disk(mask, holes="exclude"))
        filled = cd.polar_windows(*grid).on(cd.map_to_disk(mask))
        assert holed_windows.area_error == pytest.approx(filled.area_error, rel=0.05)


def test_a_window_that_reaches_out_of_a_hole_by_less_than_a_subpixel_is_kept() -> None:
    """No window is empty whose centre, or any of whose 16×16 subpixels, lies in a pixel of the cell."""
    mask = holed(5, 6)
    disk = cd.map_to_disk(mask, holes="exclude")
    grid = cd.polar_windows(40, 200)
    windows = grid.on(disk)
    empty = np.flatnonzero(windows.areas.ravel() == 0.0)
    assert len(empty) > 20
    steps = (np.arange(16) + 0.5) / 16 - 0.5
    offsets = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    points = (np.argwhere(mask)[:, None] + offsets).reshape(-1, 2)
    held = np.unique(grid.window_of(disk.to_disk(points, outside="nearest")))
    assert not np.isin(empty, held).any()
    centres = np.rint(disk.to_cell(grid.centres_uv[empty])).astype(int)
    assert not mask[tuple(centres.T)].any()


def test_the_papers_map_excludes_them_too(mask: np.ndarray) -> None:
    disk = cd.map_to_disk(mask, holes="exclude", method="advection")
    windows = cd.polar_windows(5, 30).on(disk)
    assert_allclose(windows.areas.sum(), mask.sum(), rtol=1e-12)


@pytest.mark.parametrize("lay", [cd.edge_windows, cd.ring_windows])
def test_comparators_exclude_the_holes_of_a_mask_and_of_a_map(
    lay, mask: np.ndarray, disk: cd.DiskMap
) -> None:
    of_mask, of_map = lay(mask, 4, 12, holes="exclude"), lay(disk, 4, 12)
    filled = lay(mask, 4, 12)
    for windows in (of_mask, of_map):
        assert_allclose(windows.areas.sum(), mask.sum(), rtol=1e-12)
        assert_array_equal(windows.labels >= 0, mask)
        assert (windows.subpixel_labels >= 0).sum() == 16 * mask.sum()
        assert_array_equal(windows.mask_without_holes, mask)
    assert_allclose(of_mask.filled_areas.sum(), filled.areas.sum(), rtol=1e-12)
    assert_allclose(filled.areas.sum(), disk.mask.sum(), rtol=1e-12)


def test_the_image_on_the_disk_has_no_signal_in_holes(mask: np.ndarray, disk: cd.DiskMap) -> None:
    image = disk.image(np.where(disk.holes.whole, 1e6, 1.0), size=200)
    axis = (np.arange(200) + 0.5) / 100 - 1.0
    v, u = np.meshgrid(axis, axis, indexing="ij")
    points = disk.to_cell(np.column_stack([u.ravel(), v.ravel()]))
    inside = np.isfinite(points[:, 0])
    in_hole = disk.holes.whole[tuple(np.rint(points[inside]).astype(int).T)]
    assert in_hole.any()
    assert_array_equal(np.isnan(image.ravel()[inside]), in_hole)
    assert_allclose(image.ravel()[inside][~in_hole], 1.0)  # nothing of a hole beside it


def test_holes_go_with_a_map_to_files_images_and_processes(
    tmp_path, mask: np.ndarray, disk: cd.DiskMap
) -> None:
    disk.save(tmp_path / "map.npz")
    pickled = pickle.loads(pickle.dumps(disk))
    larger = disk.placed((3, 4), (mask.shape[0] + 10, mask.shape[1] + 10))
    cut = larger.holes.whole[3 : 3 + mask.shape[0], 4 : 4 + mask.shape[1]]
    assert_array_equal(cut, disk.holes.whole)
    for same in (cd.load_map(tmp_path / "map.npz"), pickled):
        assert_array_equal(same.holes.whole, disk.holes.whole)
        assert same.report == disk.report
        assert_array_equal(cd.polar_windows(4, 9).on(same).areas, cd.polar_windows(4, 9).on(disk).areas)


def test_a_place_at_a_depth_that_lies_in_a_hole_has_no_signal() -> None:
    """A disk with a hole of radius 12: 20 px below the edge lies 10 px from the centre."""
    masks = np.stack([ringed()] * 2)
    signal = np.where(masks, 5.0, 1e6)
    movie = cd.map_movie(masks, holes="exclude")
    assert cd.boundary_kymograph(movie, 20.0, signal, points=36).isnull().all()
    assert_allclose(cd.boundary_kymograph(movie, 10.0, signal, points=36), 5.0)


def test_cells_in_geojson_have_the_area_of_their_windows(mask: np.ndarray, disk: cd.DiskMap) -> None:
    cell, *windows = cd.polar_windows(3, 8).on(disk).geojson(cell="a")["features"]
    measured = [window["properties"]["measurements"]["area px^2"] for window in windows]
    assert_allclose(cell["properties"]["measurements"]["area px^2"], sum(measured))
    assert_allclose(sum(measured), mask.sum())

import json

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial import cKDTree

import cytodisk as cd
from cytodisk.geometry.polygon import signed_area
from cytodisk.windows.nucleus.nucleus_raster import paint_nucleus_windows
from cytodisk.windows.pixel_shares.shares import DIVIDED, Subpixels
from cytodisk.windows.pixel_shares.subpixels import subpixel_places
from cytodisk.windows.weights import windows_of_subpixels

SPACINGS = ("area", "radius")
CELL, NUCLEUS = 40, 16  # radii in px of the concentric pair


def concentric(cell: int = CELL, nucleus: int = NUCLEUS) -> tuple[np.ndarray, np.ndarray]:
    """Masks of two round disks around one centre."""
    mask = cd.simulate.disk(cell)
    inner = cd.simulate.disk(nucleus)
    beside = (mask.shape[0] - inner.shape[0]) // 2
    return mask, np.pad(inner, beside)


def random_map(seed: int) -> cd.DiskMap:
    mask, nucleus = cd.simulate.random_pair(seed)
    return cd.map_to_disk(mask, nucleus=nucleus)


@pytest.fixture(scope="module")
def round_map() -> cd.DiskMap:
    mask, nucleus = concentric()
    return cd.map_to_disk(mask, nucleus=nucleus, nucleus_radius="area")


@pytest.fixture(scope="module")
def off_centre() -> cd.CellWindows:
    mask, nucleus = cd.simulate.random_pair(4)
    return cd.polar_windows(6, 20, nucleus_layers=2).on(cd.map_to_disk(mask, nucleus=nucleus))


def all_subpixels(subpixels: Subpixels) -> np.ndarray:
    """Windows of the 4×4 subpixels of all pixels, (P, 16)."""
    window = np.repeat(subpixels.whole[:, None], 16, axis=1)
    window[subpixels.whole == DIVIDED] = subpixels.window.reshape(-1, 16)
    return window


counts = st.tuples(st.integers(1, 30), st.integers(1, 90), st.integers(1, 12))


@given(seed=st.integers(0, 10_000), counts=counts, spacing=st.sampled_from(SPACINGS))
@settings(max_examples=25, deadline=None)
def test_every_subpixel_is_in_the_window_that_its_place_maps_into(
    seed: int, counts: tuple[int, int, int], spacing: str
) -> None:
    layers, sectors, nucleus_layers = counts
    disk = random_map(seed)
    grid = cd.polar_windows(layers, sectors, spacing, nucleus_layers=nucleus_layers).on(disk).grid
    pixels = np.argwhere(disk.mask)
    found = all_subpixels(paint_nucleus_windows(grid, disk))
    apart = found != windows_of_subpixels(grid, disk, pixels, 4)
    # Rounding may decide for a subpixel that lies on the border between two windows, or at the centre.
    uv = disk.to_disk(subpixel_places(pixels, 4)[apart], outside="nearest")
    turned = [(1.0 + a) * uv @ np.array([[1.0, b], [-b, 1.0]]) for a in (-1e-9, 1e-9) for b in (-1e-9, 1e-9)]
    beside = (np.array([grid.window_of(near) for near in turned]) == found[apart]).any(axis=0)
    assert (beside | (np.hypot(*uv.T) < 1e-9)).all()
    assert apart.sum() <= 16 + 1e-3 * apart.size


@pytest.mark.slow
@given(
    seed=st.integers(0, 10_000),
    counts=st.tuples(st.integers(1, 100), st.integers(1, 200), st.integers(1, 50)),
    spacing=st.sampled_from(SPACINGS),
)
@settings(max_examples=40, deadline=None)
def test_windows_of_a_compartment_share_out_its_pixels(
    seed: int, counts: tuple[int, int, int], spacing: str
) -> None:
    layers, sectors, nucleus_layers = counts
    disk = random_map(seed)
    windows = cd.polar_windows(layers, sectors, spacing, nucleus_layers=nucleus_layers).on(disk)
    assert disk.nucleus is not None
    nucleus = disk.nucleus.mask
    signal = np.random.default_rng(seed).uniform(1.0, 1000.0, disk.mask.shape)
    data = cd.sample(windows, signal)
    by_layer = (data["mean"] * data["n_pixels"]).sum("sector")
    for name, mask in (("nucleus", nucleus), ("cytoplasm", disk.mask & ~nucleus)):
        own = windows.grid.compartments == name
        assert windows.areas[own].sum() == pytest.approx(mask.sum(), rel=1e-9)
        assert float(by_layer[own].sum()) == pytest.approx(signal[mask].sum(), rel=1e-9)
        assert not windows.weights[np.repeat(own, sectors)][:, ~mask[disk.mask]].count_nonzero()
    assert windows.n_empty == 0
    assert_allclose(windows.weights.sum(axis=0), 1.0, rtol=1e-12)


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize(("side", "gap"), [(1, 1), (2, 1), (3, 2), (12, 1)])
def test_no_window_of_the_finest_grid_is_empty(side: int, gap: int, spacing: str) -> None:
    nucleus = np.pad(np.ones((side, side), dtype=bool), gap)
    disk = cd.map_to_disk(np.ones_like(nucleus), nucleus=nucleus)
    windows = cd.polar_windows(50, 200, spacing, nucleus_layers=50).on(disk)
    assert windows.areas.min() > 0
    assert windows.areas[50:].sum() == pytest.approx(side**2, rel=1e-9)
    assert windows.areas.sum() == pytest.approx(nucleus.size, rel=1e-9)


def test_windows_of_concentric_disks_have_known_areas(round_map: cd.DiskMap) -> None:
    """π (outer² − inner²) / sectors, to what pixels and their quarters allow."""
    windows = cd.polar_windows(6, 20, nucleus_layers=2).on(round_map)
    radii = CELL * windows.grid.radii
    expected = np.pi * (radii[:-1] ** 2 - radii[1:] ** 2) / 20
    assert windows.grid.radii[6] == pytest.approx(NUCLEUS / CELL, rel=0.01)
    assert_allclose(windows.areas.mean(axis=1), expected, rtol=0.01)
    assert_allclose(windows.areas, np.broadcast_to(expected[:, None], windows.areas.shape), rtol=0.08)
    assert windows.area_error < 0.03
    assert set(windows.area_errors) == {"cytoplasm", "nucleus"}


def test_a_signal_linear_in_the_share_of_cytoplasm_comes_back_linear(round_map: cd.DiskMap) -> None:
    y, x = np.indices(round_map.mask.shape) - (round_map.mask.shape[0] - 1) / 2
    share = (CELL**2 - y**2 - x**2) / (CELL**2 - NUCLEUS**2)
    windows = cd.polar_windows(5, 12, nucleus_layers=1).on(round_map)
    found = cd.sample(windows, share)["mean"].mean("sector").to_numpy()[:5]
    assert_allclose(found, (np.arange(5) + 0.5) / 5, atol=0.015)


def test_distances_to_the_nucleus_are_known_on_concentric_disks(round_map: cd.DiskMap) -> None:
    windows = cd.polar_windows(5, 8, nucleus_layers=3).on(round_map)
    radii = CELL * windows.grid.radii
    outer, inner = radii[:-1, None], radii[1:, None]
    assert windows.nucleus_distances is not None
    found = windows.nucleus_distances.mean(axis=1)
    at = np.sqrt(outer**2 + np.array([0.5, 0.05, 0.95]) * (inner**2 - outer**2))
    away = np.abs(at - NUCLEUS)
    away[:5, 1:] = away[:5, :0:-1]  # in the cytoplasm the share grows towards the nucleus
    assert_allclose(found, away, atol=0.5)
    assert_allclose(windows.depths.mean(axis=1)[:, 0], CELL - at[:, 0], atol=0.5)


def test_distances_are_percentiles_over_the_subpixels_of_a_window(off_centre: cd.CellWindows) -> None:
    disk = off_centre.disk
    assert disk.nucleus is not None
    outline = shapely.Polygon(disk.vertices_yx[disk.nucleus.boundary])
    pixels = np.argwhere(disk.mask)
    points = shapely.points(subpixel_places(pixels, 4))
    distance = shapely.distance(points, outline.exterior)
    nuclear = disk.nucleus.mask[tuple(pixels.T)][:, None]
    distance[shapely.contains(outline, points) != nuclear] = 0.0
    numbers = off_centre.subpixel_windows
    expected = np.full((off_centre.grid.n_windows, 3), np.nan)
    for number in range(len(expected)):
        held = distance[numbers == number]
        if held.size:
            expected[number] = np.quantile(held, (0.5, 0.05, 0.95), method="inverted_cdf")
    distances = off_centre.nucleus_distances
    assert distances is not None
    off = np.abs(distances.reshape(-1, 3) - expected)
    assert np.nanmean(off) < 0.05
    assert np.nanmax(off) < 0.5
    assert (distances >= 0).all()


def test_outlines_tile_both_compartments(off_centre: cd.CellWindows) -> None:
    disk, sectors = off_centre.disk, off_centre.grid.sectors
    assert disk.nucleus is not None
    polygons = off_centre.polygons()
    areas = np.array([signed_area(polygon) for polygon in polygons])
    nuclear_outline = disk.vertices_yx[disk.nucleus.boundary]
    assert areas[6 * sectors :].sum() == pytest.approx(signed_area(nuclear_outline), rel=1e-9)
    assert areas.sum() == pytest.approx(signed_area(disk.outline_yx), rel=1e-9)
    assert len(set(np.sign(areas))) == 1
    for layer in (5, 6):
        points = np.concatenate(polygons[layer * sectors : (layer + 1) * sectors])
        assert cKDTree(points).query(nuclear_outline)[0].max() < 1e-9


def test_geojson_says_the_compartment(off_centre: cd.CellWindows) -> None:
    features = json.loads(json.dumps(off_centre.geojson()))["features"]
    named = [feature["properties"]["compartment"] for feature in features]
    assert named == ["cytoplasm"] * 120 + ["nucleus"] * 40
    plain = cd.polar_windows(2, 3).on(cd.map_to_disk(cd.simulate.disk(8)))
    assert "compartment" not in plain.geojson()["features"][0]["properties"]


def test_samples_have_compartment_and_distance(off_centre: cd.CellWindows) -> None:
    data = cd.sample(off_centre, off_centre.mask * 1.0)
    assert data["compartment"].to_numpy().tolist() == ["cytoplasm"] * 6 + ["nucleus"] * 2
    assert_array_equal(data["nucleus_distance"], off_centre.depth_columns["nucleus_distance"])
    assert data["nucleus_distance_p95"].attrs["units"] == "px"
    assert dict(data.isel(layer=data["compartment"] == "nucleus").sizes)["layer"] == 2


def test_layers_by_depth_end_at_the_nucleus() -> None:
    mask, nucleus = concentric()
    disk = cd.map_to_disk(mask, nucleus=nucleus, nucleus_radius=0.5, pixel_size_um=0.1)
    windows = cd.polar_windows(sectors=8, depth_um=(0.5, 1.5), nucleus_layers=2).on(disk)
    assert windows.layers == 5
    # The 95th percentile lies a little before the border.
    assert_allclose(windows.depths[:2, :, 2].mean(axis=1), (5, 15), atol=0.8)
    assert windows.grid.radii[3] == 0.5
    deeper = cd.polar_windows(sectors=8, depth_um=(0.5, 3.0, 3.5), nucleus_layers=2).on(disk)
    assert deeper.grid.present.tolist() == [True, True, False, False, True, True]
    assert deeper.n_empty == 0
    assert deeper.areas[4:].sum() == pytest.approx(nucleus.sum(), rel=1e-9)
    assert np.isnan(deeper.completeness).tolist() == [False, False, True, True, False, False]
    assert [len(polygon) > 0 for polygon in deeper.polygons()] == np.repeat(deeper.grid.present, 8).tolist()

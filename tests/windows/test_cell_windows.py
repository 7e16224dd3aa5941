import json

import numpy as np
import pytest
import shapely
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial import cKDTree

import cytodisk as cd
from cytodisk.errors import WindowError
from cytodisk.geometry.polygon import signed_area


def test_labels_name_the_window_with_the_largest_share(windows: cd.CellWindows) -> None:
    weights = windows.weights.toarray()
    labels = windows.labels[windows.mask]
    assert_array_equal(weights[labels, np.arange(weights.shape[1])], weights.max(axis=0))
    assert (windows.labels[~windows.mask] == -1).all()


def test_linear_signal_has_its_value_at_the_centroid(windows: cd.CellWindows) -> None:
    """Centroids are weighted with the same pixel shares as means, so both sides differ by rounding only."""
    signal = cd.simulate.linear_signal(windows.mask.shape, (2.0, -3.0), 7.0)
    y, x = np.moveaxis(windows.centroids_yx, -1, 0)
    assert_allclose(cd.sample(windows, signal)["mean"], 7.0 + 2.0 * y - 3.0 * x, rtol=1e-11, atol=1e-9)


def test_centroids_are_those_of_the_outlines(windows: cd.CellWindows) -> None:
    """Parts of a pixel are 1/4 px wide and fall whole on one side of an outline, and at the cell's edge the
    squares of pixels stand out of the outline by up to half a pixel, over windows some 7 px across: a
    centroid moves by a fraction of that."""
    from_outline = [shapely.Polygon(polygon).centroid.coords[0] for polygon in windows.polygons()]
    assert_allclose(windows.centroids_yx.reshape(-1, 2), from_outline, atol=0.2)


def test_areas_are_those_of_the_outlines(windows: cd.CellWindows) -> None:
    """Up to the pixel squares' overhang at the edge, which is less than half a pixel along it."""
    by_outline = np.abs([signed_area(polygon) for polygon in windows.polygons()])
    inner = windows.grid.sectors  # the windows from layer 1 on do not touch the edge
    assert_allclose(windows.areas.ravel()[inner:], by_outline[inner:], rtol=0.02)
    assert_allclose(windows.areas.ravel()[:inner], by_outline[:inner], rtol=0.04)


def test_eccentricity_has_a_plain_twin(windows: cd.CellWindows) -> None:
    points = np.argwhere(windows.mask)
    for number, weights in enumerate(windows.weights.toarray()):
        covariance = np.cov(points.T, aweights=weights, ddof=0) + np.eye(2) / 12
        small, large = np.linalg.eigvalsh(covariance)
        found = windows.eccentricities.ravel()[number]
        assert found == pytest.approx(np.sqrt(1 - small / large), abs=1e-6)


def test_eccentricity_of_a_rectangle_is_known() -> None:
    """A rectangle of h × w pixels has the second moments h²/12 and w²/12."""
    mask = np.zeros((12, 40), dtype=bool)
    mask[3:9, 4:34] = True
    windows = cd.polar_windows(1, 1).on(cd.map_to_disk(mask))
    assert windows.eccentricities[0, 0] == pytest.approx(np.sqrt(1 - 6**2 / 30**2), rel=1e-9)


def test_eccentricity_of_a_single_pixel_is_0() -> None:
    windows = cd.polar_windows(2, 3).on(cd.map_to_disk(np.ones((1, 1), dtype=bool)))
    assert_allclose(windows.eccentricities, 0.0, atol=1e-7)


@pytest.mark.parametrize(("layers", "sectors"), [(1, 1), (1, 2), (4, 12), (10, 60)])
@pytest.mark.parametrize("spacing", ["area", "radius"])
def test_outlines_tile_the_cell(cell: cd.DiskMap, layers: int, sectors: int, spacing: str) -> None:
    polygons = cd.polar_windows(layers, sectors, spacing).on(cell).polygons()
    areas = [signed_area(polygon) for polygon in polygons]
    assert len(areas) == layers * sectors
    assert sum(areas) == pytest.approx(signed_area(cell.outline_yx), rel=1e-9)
    assert len(set(np.sign(areas))) == 1


def test_neighbours_share_the_points_between_them(windows: cd.CellWindows) -> None:
    sectors = windows.grid.sectors
    sets = [set(map(tuple, polygon)) for polygon in windows.polygons()]
    for number, points in enumerate(sets):
        layer, sector = divmod(number, sectors)
        beside = sets[layer * sectors + (sector + 1) % sectors]
        assert len(points & beside) >= 256 // windows.grid.layers  # a whole spoke
        if layer + 1 < windows.grid.layers:
            assert len(points & sets[number + sectors]) >= 3  # a whole arc


def test_layer_0_follows_the_cell_outline(cell: cd.DiskMap, windows: cd.CellWindows) -> None:
    points = np.concatenate(windows.polygons()[: windows.grid.sectors])
    distance, _ = cKDTree(points).query(cell.outline_yx)
    assert distance.max() < 1e-9


def test_no_point_of_an_outline_is_repeated(windows: cd.CellWindows) -> None:
    for polygon in windows.polygons():
        assert (np.diff(polygon, axis=0, append=polygon[:1]) != 0).any(axis=1).all()


def test_geojson_holds_closed_rings_in_xy(windows: cd.CellWindows) -> None:
    values = np.arange(48.0).reshape(4, 12)
    values[1, 2] = np.nan
    collection = json.loads(json.dumps(windows.geojson({"mean": values}), allow_nan=False))
    assert collection["type"] == "FeatureCollection"
    assert len(collection["features"]) == 48
    for number, (feature, polygon) in enumerate(zip(collection["features"], windows.polygons(), strict=True)):
        assert (feature["type"], feature["geometry"]["type"]) == ("Feature", "Polygon")
        (ring,) = feature["geometry"]["coordinates"]
        assert ring[0] == ring[-1]
        assert_array_equal(ring[:-1], polygon[:, ::-1])
        layer, sector = divmod(number, 12)
        properties = feature["properties"]
        assert (properties["layer"], properties["sector"]) == (layer, sector)
        assert properties["area_px"] == windows.areas[layer, sector]
        assert properties["mean"] == (None if number == 14 else number)


def test_geojson_values_of_another_shape_are_refused(windows: cd.CellWindows) -> None:
    with pytest.raises(WindowError, match=r"values\['mean'\] has shape \(3,\), the windows \(4, 12\)"):
        windows.geojson({"mean": np.zeros(3)})

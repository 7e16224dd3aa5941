"""Windows as GeoJSON: QuPath's frame, names and measurements, and polygons that are valid."""

import json
from typing import Any

import numpy as np
import pytest
import shapely

import cytodisk as cd

Features = list[dict[str, Any]]


def features(windows: cd.CellWindows, *given: Any, **named: Any) -> Features:
    collection = json.loads(json.dumps(windows.geojson(*given, **named), allow_nan=False))
    assert collection["type"] == "FeatureCollection"
    assert all(feature["type"] == "Feature" for feature in collection["features"])
    found: Features = collection["features"]
    return found


def shapes(found: Features) -> list[Any]:
    return [shapely.geometry.shape(feature["geometry"]) for feature in found]


@pytest.fixture(scope="module")
def windows() -> cd.CellWindows:
    return cd.polar_windows(layers=4, sectors=12).on(cd.map_to_disk(cd.simulate.star(), pixel_size_um=0.5))


def test_a_pixel_covers_0_to_1() -> None:
    mask = np.zeros((20, 30), dtype=bool)
    mask[4:12, 6:22] = True  # covers x from 6 to 22 and y from 4 to 12
    cell, *_ = features(cd.polar_windows(2, 6).on(cd.map_to_disk(mask)), cell="cell 3")
    assert shapes([cell])[0].bounds == (6.0, 4.0, 22.0, 12.0)
    _, window, *_ = features(
        cd.polar_windows(2, 6).on(cd.map_to_disk(mask)), cell="cell 3", corner=(100, 200)
    )
    assert window["properties"]["name"] == "layer 0, sector 0"
    assert shapes([window])[0].bounds[0] > 206.0


def test_the_cell_is_an_annotation_and_windows_are_detections(windows: cd.CellWindows) -> None:
    cell, *rest = features(windows, cell="cell 3")
    area = int(windows.mask.sum())
    assert cell["properties"] == {
        "objectType": "annotation",
        "name": "cell 3",
        "measurements": {"area px^2": area, "area µm^2": area / 4},
    }
    assert [feature["properties"]["objectType"] for feature in rest] == ["detection"] * 48
    assert rest[29]["properties"]["name"] == "layer 2, sector 5"
    assert rest[29]["properties"]["classification"] == {"name": "layer 2"}
    assert [rest[29]["properties"][name] for name in ("layer", "sector")] == [2, 5]
    assert len(features(windows)) == 48


def test_numbers_are_measurements_and_nan_is_left_out(windows: cd.CellWindows) -> None:
    values = np.arange(48.0).reshape(4, 12)
    values[1, 2] = np.nan
    found = [feature["properties"]["measurements"] for feature in features(windows, {"mean a.u.": values})]
    areas = windows.areas.ravel()
    assert [numbers["area px^2"] for numbers in found] == areas.tolist()
    assert [numbers["area µm^2"] for numbers in found] == (areas / 4).tolist()
    assert [numbers.get("mean a.u.") for numbers in found] == [None if k == 14 else k for k in range(48)]


@pytest.mark.parametrize("shape", ["star", "dumbbell", "disk", "ellipse"])
@pytest.mark.parametrize("grid", [(1, 1), (3, 1), (1, 2), (4, 12), (10, 60)])
def test_polygons_are_valid_and_have_the_areas_of_the_windows(shape: str, grid: tuple[int, int]) -> None:
    windows = cd.polar_windows(*grid).on(cd.map_to_disk(getattr(cd.simulate, shape)()))
    found = shapes(features(windows))
    assert all(polygon.is_valid and polygon.area > 0 for polygon in found)
    areas = np.array([polygon.area for polygon in found])
    # Areas of windows are those of 4×4 parts of pixels, which lie in a window or do not.
    assert np.abs(areas - windows.areas.ravel()).max() < 4.0
    assert areas.sum() == pytest.approx(windows.mask.sum() - 0.5, rel=1e-3)


def test_windows_do_not_overlap_beyond_their_sides(windows: cd.CellWindows) -> None:
    found = shapes(features(windows))
    together = shapely.union_all(found)
    assert together.area == pytest.approx(sum(polygon.area for polygon in found), rel=1e-4)


def test_layers_deeper_than_the_cell_have_no_feature() -> None:
    disk = cd.map_to_disk(cd.simulate.disk(12), pixel_size_um=0.1)
    windows = cd.polar_windows(sectors=6, depth_um=(0.5, 1.0, 5.0)).on(disk)
    assert len(features(windows)) == 6 * int(windows.grid.present.sum()) == 18

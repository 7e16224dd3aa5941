"""Cells and windows of whole studies as GeoJSON."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from placed_windows import GRID, SIZE_UM, check_places, two_cells, windows_of
from shapely.geometry import shape

import cytodisk as cd


def features_in(path: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["features"]
    return found


def test_one_file_holds_all_cells_with_their_windows_and_means(mapped: cd.Study, tmp_path: Path) -> None:
    (path,) = cd.run_export(mapped.path, tmp_path, to="geojson")
    features = features_in(path)
    names = [feature["properties"]["name"] for feature in features]
    assert len(set(names)) == len(names) == 2 * 13
    assert names[13:15] == ["cell 1", "cell 1, layer 0, sector 0"]
    for cell in (0, 1):
        windows, own = windows_of(mapped, cell), features[13 * cell + 1 : 13 * cell + 13]
        check_places(windows, [shape(feature["geometry"]) for feature in own])
        measured = [feature["properties"]["measurements"] for feature in own]
        rows = mapped.windows.query(f"cell == {cell} and channel == 'RhoA'")
        np.testing.assert_allclose([one["mean RhoA a.u."] for one in measured], rows["mean"])
        np.testing.assert_allclose([one["area µm^2"] for one in measured], windows.areas.ravel() * SIZE_UM**2)
    assert "plane" not in features[0]["geometry"]


def test_cells_alone_are_masks_again(mapped: cd.Study, tmp_path: Path) -> None:
    (path,) = cd.run_export(mapped.path, tmp_path, to="geojson", windows=False)
    signal = mapped.path.parent / "signal.ome.tif"
    again = cd.run_map(path, tmp_path / "again", signal=signal, **GRID)
    for cell in (0, 1):
        np.testing.assert_array_equal(again.map(cell).mask, mapped.map(cell).mask)


def test_frames_are_planes(followed: cd.Study, tmp_path: Path) -> None:
    (path,) = cd.run_export(followed.path, tmp_path, to="geojson", windows=False)
    assert [feature["geometry"]["plane"]["t"] for feature in features_in(path)] == [0, 1, 3]


def test_each_file_of_masks_has_a_file_of_its_own(tmp_path: Path) -> None:
    masks = tmp_path / "masks"
    masks.mkdir()
    for name in ("a 1.tif", "b.tif"):
        tifffile.imwrite(masks / name, two_cells())
    tifffile.imwrite(masks / "c.tif", np.zeros((9, 9), dtype=np.uint8))
    study = cd.run_map(masks, tmp_path / "out", **GRID)
    written = cd.run_export(study.path, tmp_path / "qupath", to="geojson", windows=False)
    assert [path.name for path in written] == ["a_1_cells.geojson", "b_cells.geojson"]
    assert [feature["properties"]["name"] for feature in features_in(written[1])] == ["cell 2", "cell 3"]


@pytest.mark.parametrize("depths", [(0.5, 1.0, 50.0)])
def test_layers_deeper_than_a_cell_have_no_outline(
    mapped: cd.Study, tmp_path: Path, depths: tuple[float, ...]
) -> None:
    given = {"depth_um": depths, "sectors": 4, "pixel_size_um": SIZE_UM}
    cd.run_map(mapped.path.parent / "cells.tif", tmp_path / "out", **given)
    (path,) = cd.run_export(tmp_path / "out", tmp_path, to="geojson", cells=(1,))
    assert len(features_in(path)) == 1 + 3 * 4

"""Studies as SpatialData: written, read back, and its coordinates held against the pixels."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from placed_windows import GRID, SIZE_UM, centres_in, check_places, two_cells, windows_of

import cytodisk as cd
from cytodisk.errors import MissingPartError, ReadError
from cytodisk.store.spatial import spatial_parts
from cytodisk.store.spatial.study_places import images_of

N_WINDOWS = 12

# spatialdata and its kin warn of each other.
pytestmark = [
    pytest.mark.filterwarnings("ignore::DeprecationWarning"),
    pytest.mark.filterwarnings("ignore::FutureWarning"),
    pytest.mark.filterwarnings("ignore::pandas.errors.Pandas4Warning"),
    pytest.mark.filterwarnings("ignore::UserWarning"),
]


@pytest.fixture(scope="session")
def spatialdata() -> Any:
    return pytest.importorskip("spatialdata", reason="spatialdata is not installed")


def pixels_of(element: Any) -> np.ndarray:
    return np.asarray(element.data.compute())


@pytest.mark.slow
def test_a_map_written_and_read_back_has_its_windows_on_their_pixels(
    mapped: cd.Study, spatialdata: Any, tmp_path: Path
) -> None:
    mapped.to_spatialdata().write(tmp_path / "a.zarr")
    data = spatialdata.read_zarr(tmp_path / "a.zarr")
    assert set(data.coordinate_systems) == {"global", "µm"}
    image = data["image"]
    assert image.coords["c"].to_numpy().tolist() == ["Rac1", "RhoA"]
    stored = tifffile.imread(mapped.path.parent / "signal.ome.tif")
    np.testing.assert_array_equal(pixels_of(image), stored)
    cells, windows = pixels_of(data["cell_labels"]), pixels_of(data["window_labels"])
    np.testing.assert_array_equal(cells, np.select([two_cells() == 2, two_cells() == 5], [1, 2]))
    for cell in (0, 1):
        here = windows_of(mapped, cell)
        own = data["windows"][data["windows"]["cell"] == cell]
        assert own.index.tolist() == [1 + cell * N_WINDOWS + window for window in range(N_WINDOWS)]
        check_places(here, list(own.geometry))
        held = here.labels >= 0
        np.testing.assert_array_equal(windows[held], 1 + cell * N_WINDOWS + here.labels[held])
        np.testing.assert_allclose(own.geometry.area.sum(), data["cells"].geometry[cell + 1].area, rtol=1e-4)
        np.testing.assert_array_equal(
            centres_in(data["cells"].geometry[cell + 1], cells.shape), cells == cell + 1
        )


@pytest.mark.slow
def test_spatialdata_counts_pixels_from_their_corners_as_the_shapes_do(
    mapped: cd.Study, spatialdata: Any
) -> None:
    data = mapped.to_spatialdata()
    assert spatialdata.get_extent(data["image"]) == {"x": (0.0, 70.0), "y": (0.0, 40.0)}
    assert spatialdata.get_extent(data["image"], coordinate_system="µm")["x"] == (0.0, 70.0 * SIZE_UM)
    by_label = spatialdata.get_centroids(data["cell_labels"]).compute()
    by_shape = spatialdata.get_centroids(data["cells"]).compute()
    by_table = data["cell_table"].obsm["spatial"]
    for cell in (0, 1):  # which shift by half a pixel if one of them counts from centres
        np.testing.assert_allclose(by_shape.loc[cell + 1], by_label.loc[cell + 1], atol=0.05)
        np.testing.assert_allclose(by_table[cell], by_label.loc[cell + 1], atol=0.05)
    in_um = spatialdata.transform(data["windows"], to_coordinate_system="µm").geometry.area.sum()
    np.testing.assert_allclose(in_um, data["windows"].geometry.area.sum() * SIZE_UM**2)


@pytest.mark.slow
def test_tables_know_their_shapes_and_hold_what_the_study_holds(mapped: cd.Study, spatialdata: Any) -> None:
    data = mapped.to_spatialdata()
    table = data["window_table"]
    assert table.obs["region"].unique().tolist() == ["windows"]
    shapes, joined = spatialdata.join_spatialelement_table(
        data, spatial_element_names="windows", table_name="window_table", how="inner"
    )
    assert joined.n_obs == len(shapes["windows"]) == 2 * N_WINDOWS
    for name in ("cell", "layer", "sector"):
        by_shape = shapes["windows"][name].loc[joined.obs["instance_id"]]
        assert by_shape.tolist() == joined.obs[name].tolist()
    for column, channel in enumerate(("Rac1", "RhoA")):
        rows = mapped.windows[mapped.windows["channel"] == channel]
        np.testing.assert_array_equal(table.X[:, column], rows["mean"])
        np.testing.assert_array_equal(table.layers["sd"][:, column], rows["sd"])
        np.testing.assert_array_equal(table.obs["depth"], rows["depth"])
    stored = tifffile.imread(mapped.path.parent / "signal.ome.tif")
    expected = [[stored[channel][two_cells() == label].mean() for channel in (0, 1)] for label in (2, 5)]
    np.testing.assert_allclose(data["cell_table"].X, expected)
    assert data["cell_table"].obs["label"].tolist() == [2, 5]
    assert data["cell_table"].uns["cytodisk"]["units"]["area"] == "µm²"


@pytest.mark.slow
def test_frames_of_a_movie_have_elements_and_systems_of_their_own(
    followed: cd.Study, spatialdata: Any, tmp_path: Path
) -> None:
    (path,) = cd.run_export(followed.path, tmp_path, to="spatialdata", frames=(1, 3))
    data = spatialdata.read_zarr(path)
    assert set(data.coordinate_systems) == {"frame_001", "frame_003"}
    assert data.attrs["cytodisk"]["left_out"][0].startswith("cell 0, frame 2: ")
    table = data["window_table"]
    assert table.obs["region"].cat.categories.tolist() == ["windows_frame_001", "windows_frame_003"]
    for frame in (1, 3):
        name = f"windows_frame_{frame:03}"
        check_places(windows_of(followed, 0, frame), list(data[name].geometry))
        own = table.obs[table.obs["region"] == name]
        assert own["instance_id"].tolist() == data[name].index.tolist()
        edge = followed.edge.query(f"frame == {frame}")["velocity"].to_numpy()
        np.testing.assert_array_equal(own["velocity"].to_numpy()[:6], edge)
    stored = tifffile.imread(followed.path.parent / "signal.tif")
    np.testing.assert_array_equal(pixels_of(data["image_frame_003"])[0], stored[3])


@pytest.mark.slow
def test_images_of_a_folder_are_found_by_name_and_missed_by_name(spatialdata: Any, tmp_path: Path) -> None:
    folder = tmp_path / "cells"
    folder.mkdir()
    for number, name in enumerate(("a", "b")):
        tifffile.imwrite(folder / f"{name}_masks.tif", two_cells())
        tifffile.imwrite(folder / f"{name}_img.tif", (10 * number + two_cells()).astype(np.uint16))
    study = cd.run_map(folder, tmp_path / "out", signal="_img", channels=("actin",), **GRID)
    data = study.to_spatialdata(windows=False, cells=(0, 3))
    np.testing.assert_array_equal(pixels_of(data["image_b_masks"])[0], 10 + two_cells())
    assert data["image_b_masks"].coords["c"].to_numpy().tolist() == ["actin"]
    assert data["cell_table"].obs_names.tolist() == ["a_masks_cell0", "b_masks_cell3"]
    assert "window_table" not in data.tables
    tifffile.imwrite(folder / "b_img.tif", np.zeros((40, 70), dtype=np.uint16))
    with pytest.raises(ReadError, match=r"b_img.tif does not hold what was measured.*images=False"):
        cd.run_export(study.path, tmp_path / "new", to=("roi", "spatialdata"))
    assert not (tmp_path / "new").exists()
    shutil.move(folder / "b_img.tif", tmp_path)
    with pytest.raises(ReadError, match=r"b_masks.tif .*cannot be read.*images=False \(--no-images\)"):
        study.to_spatialdata()
    assert "image_b_masks" not in study.to_spatialdata(images=False)


@pytest.mark.slow
@pytest.mark.usefixtures("spatialdata")
def test_a_study_without_a_signal_has_tables_without_columns(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "cells.tif", two_cells())
    data = cd.run_map(tmp_path / "cells.tif", tmp_path / "out", **GRID).to_spatialdata()
    assert not data.images
    assert data["window_table"].shape == (2 * N_WINDOWS, 0)
    data.write(tmp_path / "out.zarr")


def test_what_does_not_fit_into_memory_is_refused_with_the_choice(
    mapped: cd.Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(spatial_parts, "free_bytes", lambda: 100_000)
    places = cd.SpatialParameters()
    images = images_of(mapped, places)
    with pytest.raises(ReadError, match=r"maps of cells: 2, images: 1; .*frames=\(first, last\)"):
        spatial_parts.check_room(mapped, images, places, N_WINDOWS)


def test_without_spatialdata_what_to_install_is_said(
    mapped: cd.Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "spatialdata", None)
    with pytest.raises(MissingPartError, match=r"needs spatialdata.*pip install 'cytodisk\[spatialdata\]'"):
        mapped.to_spatialdata()

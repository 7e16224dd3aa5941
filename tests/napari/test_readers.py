"""What the plugin opens, and what it leaves to others."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import ReadError
from cytodisk.store.study import Study

pytestmark = pytest.mark.slow
pytest.importorskip("napari.viewer")

from cytodisk.napari.readers import get_reader  # noqa: E402
from cytodisk.napari.study_layers.shown_study import shown_studies  # noqa: E402


@pytest.fixture(scope="module")
def movie(tmp_path_factory: pytest.TempPathFactory) -> Study:
    folder = tmp_path_factory.mktemp("readers")
    truth = cd.simulate.movie("growing", frames=3, radius_px=12.0)
    masks = truth.masks.astype(np.uint8)
    tifffile.imwrite(folder / "masks.tif", masks, photometric="minisblack", metadata={"axes": "TYX"})
    tifffile.imwrite(folder / "signal.tif", truth.signal.to_numpy(), metadata={"axes": "TCYX"})
    settings = {"signal": folder / "signal.tif", "layers": 2, "sectors": 6}
    return cd.run_movie(folder / "masks.tif", folder / "out", **settings)


def names(path: Path) -> list[str]:
    reader = get_reader(str(path))
    assert reader is not None
    return [settings["name"] for _, settings, _ in reader(str(path))]


def test_files_and_folders_of_others_are_left_to_others(movie: Study, tmp_path: Path) -> None:
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    (tmp_path / "broken.npz").write_bytes(b"PK\x03\x04")
    (tmp_path / "provenance.json").write_text("{}")
    others = [tmp_path, tmp_path / "other.npz", tmp_path / "broken.npz", tmp_path / "provenance.json"]

    assert [get_reader(str(path)) for path in others] == [None] * 4
    assert get_reader(str(movie.path.parent / "masks.tif")) is None
    assert get_reader(str(tmp_path / "gone.npz")) is None
    assert get_reader([str(movie.path), str(tmp_path)]) is None


def test_a_study_that_is_dropped_on_the_viewer_follows_its_slider(
    movie: Study, make_viewer: Callable[..., Any]
) -> None:
    viewer = make_viewer()

    viewer.open(movie.path, plugin="cytodisk")

    (shown,) = shown_studies(viewer)
    viewer.dims.set_current_step(0, 1)
    assert shown.frame == 1
    rows = movie.windows[(movie.windows["frame"] == 1) & (movie.windows["channel"] == shown.channel)]
    assert shown.layers["windows"].features["sector"].tolist() == rows["sector"].tolist()
    assert shown.layers["outlines"].data[0, 0, 0] == 1.0


def test_maps_and_activity_are_opened(movie: Study, tmp_path: Path) -> None:
    alone = tmp_path / "alone.npz"
    shutil.copy(movie.path / "maps" / "cell_00000_t00001.npz", alone)

    assert names(alone) == ["windows of alone", "labels of alone"]
    assert names(movie.path / "maps" / "cell_00000_t00001.npz")[0] == "windows of cell_00000_t00001"
    assert names(movie.path / "activity.zarr.zip")[0].startswith("velocity of the edge")
    assert names(movie.path / "provenance.json")[-1] == "windows"


def test_what_is_damaged_is_told_in_the_words_of_the_library(movie: Study, tmp_path: Path) -> None:
    damaged = tmp_path / "damaged"
    shutil.copytree(movie.path, damaged)
    (damaged / "cells.parquet").write_bytes(b"no table")
    reader = get_reader(str(damaged))
    assert reader is not None
    with pytest.raises(ReadError) as told:
        cd.open_study(damaged)

    with pytest.raises(ReadError) as shown:
        reader(str(damaged))

    assert str(shown.value) == str(told.value)


def test_a_movie_without_maps_shows_its_activity(movie: Study, tmp_path: Path) -> None:
    bare = tmp_path / "bare"
    shutil.copytree(movie.path, bare)
    shutil.rmtree(bare / "maps")

    assert names(bare)[0].startswith("velocity of the edge")

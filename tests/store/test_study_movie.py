"""Reading a movie's study back."""

from pathlib import Path

import numpy as np
import pytest
import tifffile
from numpy.testing import assert_array_equal

import cytodisk as cd
from cytodisk.errors import MapError, ReadError
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.map import map_study as map_module
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.movie import movie_study as movie_module
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters

FRAMES, EMPTY = 4, 2


@pytest.fixture(scope="module")
def masks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A growing disk; one frame is empty."""
    y, x = np.indices((40, 40)) - 20
    frames = np.stack([y**2 + x**2 < (10 + time) ** 2 for time in range(FRAMES)])
    frames[EMPTY] = False
    path = tmp_path_factory.mktemp("masks") / "masks.tif"
    tifffile.imwrite(path, frames.astype(np.uint8), photometric="minisblack")
    return path


@pytest.fixture(scope="module")
def movie_study(masks: Path, tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    parameters = MovieParameters(layers=2, sectors=6, pixel_size_um=0.5, frame_interval_s=3.0)
    out = tmp_path_factory.mktemp("movie") / "out"
    movie_module.movie_study(open_movie(masks, None, parameters), out)
    return cd.open_study(out)


@pytest.fixture(scope="module")
def map_study(masks: Path, tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    inputs = open_inputs(masks, None, MapParameters(layers=2, sectors=6))
    return map_module.map_study(inputs, tmp_path_factory.mktemp("map") / "out")


def test_a_study_knows_what_it_is_of(movie_study: cd.Study, map_study: cd.Study) -> None:
    assert (movie_study.is_movie, map_study.is_movie) == (True, False)
    for name in ("edge", "consistency"):
        with pytest.raises(ReadError, match=f"is not that of a movie: it has no {name}"):
            getattr(map_study, name)
    assert ": 1 cells in 4 frames>" in repr(movie_study)
    assert ": 4 cells>" in repr(map_study)


def test_a_map_is_that_of_its_frame(movie_study: cd.Study, masks: Path) -> None:
    frames = tifffile.imread(masks)
    for time in (0, 1, 3):
        disk = movie_study.map(0, time)
        assert_array_equal(disk.mask, frames[time])
        assert disk.certificate.valid


def test_the_movie_has_the_maps_and_the_scale_of_the_study(movie_study: cd.Study) -> None:
    movie = movie_study.movie(0)
    assert (len(movie), movie.image_shape) == (FRAMES, (40, 40))
    assert (movie.scale.pixel_size_um, movie.scale.frame_interval_s) == (0.5, 3.0)
    assert movie.status == ["ok", "ok", "refused", "ok"]
    assert_array_equal(movie.mapped, [True, True, False, True])
    for time in (0, 1, 3):
        one, other = movie[time], movie_study.map(0, time)
        for name in ("vertices_yx", "vertices_uv", "triangles", "outline_yx", "mask"):
            assert_array_equal(getattr(one, name), getattr(other, name))


def test_the_tracked_boundary_lies_on_the_outline(movie_study: cd.Study) -> None:
    movie = movie_study.movie(0)
    away = np.hypot(*(movie.points_yx - 20.0).transpose(2, 0, 1))
    assert np.isnan(away[EMPTY]).all()
    for time in (0, 1, 3):
        np.testing.assert_allclose(away[time], 10 + time, atol=1.0)


def test_activity_has_a_frame_for_each_of_the_recording(movie_study: cd.Study) -> None:
    activity = movie_study.activity(0)
    assert_array_equal(activity["time_s"], 3.0 * np.arange(FRAMES))
    assert [str(word) for word in activity["status"].to_numpy()] == ["ok", "ok", "refused", "ok"]
    assert activity["velocity"].attrs["units"] == "µm/s"
    np.testing.assert_allclose(activity["velocity"][0], 0.5 / 3.0, rtol=0.5)


def test_a_frame_without_a_map_has_its_reason(movie_study: cd.Study) -> None:
    with pytest.raises(ReadError, match=r"cell 0.*no map.*empty"):
        movie_study.map(0, EMPTY)
    with pytest.raises(MapError, match=r"frame 2.*no map.*empty"):
        movie_study.movie(0)[EMPTY]


def test_a_movies_map_needs_a_frame_and_another_needs_none(
    movie_study: cd.Study, map_study: cd.Study
) -> None:
    with pytest.raises(ReadError, match=r"out: pass cell and frame"):
        movie_study.map(0)
    with pytest.raises(ReadError, match=r"out: pass the cell alone"):
        map_study.map(0, 0)
    assert map_study.map(0).certificate.valid


def test_a_frame_that_is_not_there(movie_study: cd.Study) -> None:
    for time in (FRAMES, -1):
        with pytest.raises(ReadError, match=rf"cell 0 of .* is not in frame {time}"):
            movie_study.map(0, time)
    with pytest.raises(IndexError, match="frame 4 of a movie of 4 frames"):
        movie_study.movie(0)[FRAMES]


@pytest.mark.parametrize("cell", [1, -1])
def test_a_cell_that_is_not_there(movie_study: cd.Study, cell: int) -> None:
    for read in (movie_study.movie, movie_study.activity, lambda number: movie_study.map(number, 0)):
        with pytest.raises(ReadError, match=rf"has no cell {cell}: it has only cell 0"):
            read(cell)


def test_a_study_of_single_masks_has_no_movie(map_study: cd.Study) -> None:
    with pytest.raises(ReadError, match=r"is not that of a movie: use map\(0\)"):
        map_study.movie(0)
    with pytest.raises(ReadError, match="activity"):
        map_study.activity(0)


@pytest.mark.parametrize("name", ["edge.parquet", "consistency.parquet", "windows.parquet", "cells.parquet"])
def test_a_table_that_is_gone_or_damaged(masks: Path, tmp_path: Path, name: str) -> None:
    study = movie_module.movie_study(
        open_movie(masks, None, MovieParameters(layers=1, sectors=2)), tmp_path / "out"
    )
    (study.path / name).write_bytes(b"PAR1 damaged")
    with pytest.raises(
        ReadError, match=r"out.*\.parquet (is not a table that cytodisk wrote|does not exist)"
    ):
        cd.open_study(study.path)
    (study.path / name).unlink()
    with pytest.raises(
        ReadError, match=r"out.*\.parquet (is not a table that cytodisk wrote|does not exist)"
    ):
        cd.open_study(study.path)


def test_a_map_or_store_that_is_gone_or_damaged(masks: Path, tmp_path: Path) -> None:
    study = movie_module.movie_study(
        open_movie(masks, None, MovieParameters(layers=1, sectors=2)), tmp_path / "out"
    )
    movie = study.movie(0)
    path = study.path / "maps" / "cell_00000_t00001.npz"
    path.write_bytes(path.read_bytes()[:-200])
    for read in (lambda: study.map(0, 1), lambda: movie[1], lambda: movie.points_yx):
        with pytest.raises(ReadError, match=r"cell_00000_t00001\.npz"):
            read()
    (study.path / "activity.zarr.zip").rename(study.path / "elsewhere")
    with pytest.raises(ReadError, match=r"activity\.zarr\.zip has no activity of cell 0"):
        study.activity(0)

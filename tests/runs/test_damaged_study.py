"""A part counts as done only if its row, its tables and its map are as they were written."""

import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from movie_files import SMALL, Stopped, assert_same_movie, stop_after, write_movie

import cytodisk as cd
from cytodisk.errors import DamagedPartWarning, ReadError, StudyError
from cytodisk.runs.movie.movie_inputs import MovieInputs, open_movie
from cytodisk.runs.movie.movie_study import movie_study

FRAMES = 6


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> MovieInputs:
    truth = cd.simulate.movie("growing", frames=FRAMES, radius_px=14.0)
    return open_movie(*write_movie(tmp_path_factory.mktemp("movie"), truth), SMALL)


@pytest.fixture(scope="module")
def whole(inputs: MovieInputs, tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    return movie_study(inputs, tmp_path_factory.mktemp("study") / "whole")


@pytest.fixture
def out(whole: cd.Study, tmp_path: Path) -> Path:
    """A copy of the whole study, to be harmed."""
    return Path(shutil.copytree(whole.path, tmp_path / "out"))


@pytest.fixture(scope="module")
def stopped(inputs: MovieInputs, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study that was stopped after five of six frames."""
    folder = tmp_path_factory.mktemp("stopped") / "out"
    with pytest.raises(Stopped):
        movie_study(inputs, folder, progress=stop_after(5))
    return folder


def cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-7])


def change(file: Path) -> None:
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)


HARMS = {
    "a map is gone": ("maps/cell_00000_t00002.npz", Path.unlink, 2),
    "a map is cut": ("maps/cell_00000_t00001.npz", cut, 1),
    "one bit of a map": ("maps/cell_00000_t00003.npz", change, 3),
    "a row is cut": (".parts/00000_t00002.json", cut, 2),
    "one bit of a row": (".parts/00000_t00000.json", change, 0),
    "a table is empty": (".parts/00000_t00001.windows.arrow", lambda file: file.write_bytes(b""), 1),
    "motion, which the next frame tells, is gone": (".parts/00000_t00001.motion.arrow", Path.unlink, 2),
}


@pytest.mark.parametrize(("name", "harm", "done"), HARMS.values(), ids=HARMS)
def test_a_damaged_frame_of_a_stopped_movie_and_what_follows_it_are_done_anew(
    inputs: MovieInputs,
    whole: cd.Study,
    stopped: Path,
    tmp_path: Path,
    name: str,
    harm: Callable[[Path], object],
    done: int,
) -> None:
    shutil.copytree(stopped, tmp_path / "out")
    harm(tmp_path / "out" / name)
    calls: list[tuple[int, int]] = []
    with pytest.warns(DamagedPartWarning, match=rf"damaged parts are made anew: 00000_t0000{done}"):
        resumed = movie_study(
            inputs, tmp_path / "out", resume=True, progress=lambda *call: calls.append(call)
        )
    assert calls[0] == (done, FRAMES)
    assert_same_movie(whole, resumed)


@pytest.mark.parametrize(
    "name", ["maps/cell_00000_t00002.npz", "windows.parquet", "activity.zarr.zip", "cells.parquet"]
)
@pytest.mark.parametrize("harm", [Path.unlink, cut, change])
def test_a_complete_study_that_is_not_whole_is_not_called_done(
    inputs: MovieInputs, whole: cd.Study, out: Path, name: str, harm: Callable[[Path], object]
) -> None:
    harm(out / name)
    with pytest.warns(DamagedPartWarning, match=f"{name} gone or damaged: it is made anew"):
        assert_same_movie(whole, movie_study(inputs, out, resume=True))


def test_a_part_of_something_else_is_named(inputs: MovieInputs, tmp_path: Path) -> None:
    with pytest.raises(Stopped):
        movie_study(inputs, tmp_path / "out", progress=stop_after(2))
    (tmp_path / "out" / ".parts" / "00009_t00000.json").write_text("{}")
    with pytest.raises(StudyError, match=r"parts that are not of this run: 00009_t00000\. Remove them"):
        movie_study(inputs, tmp_path / "out", resume=True)


def swapped(folder: Path) -> None:
    first, second = (folder / f"maps/cell_00000_t0000{frame}.npz" for frame in (1, 2))
    content = first.read_bytes()
    first.write_bytes(second.read_bytes())
    second.write_bytes(content)


def without_a_chunk(folder: Path) -> None:
    """The activity without some of its numbers, which would read as NaN."""
    packed = folder / "activity.zarr.zip"
    with zipfile.ZipFile(packed) as archive:
        held = {name: archive.read(name) for name in archive.namelist()}
    del held["cell_00000/velocity/0.0"]
    with zipfile.ZipFile(packed, "w") as archive:
        for name, content in held.items():
            archive.writestr(name, content)


@pytest.mark.parametrize(
    ("harm", "read", "named"),
    [
        (swapped, lambda study: study.map(0, 1), "cell_00000_t00001.npz"),
        (swapped, lambda study: study.movie()[2], "cell_00000_t00002.npz"),
        (swapped, lambda study: study.movie().points_yx, "cell_00000_t00001.npz"),
        (without_a_chunk, lambda study: study.activity().load(), "activity.zarr.zip"),
    ],
)
def test_what_the_run_did_not_write_is_not_read(
    out: Path,
    harm: Callable[[Path], None],
    read: Callable[[cd.Study], object],
    named: str,
) -> None:
    read(cd.open_study(out))
    harm(out)
    with pytest.raises(ReadError, match=rf"{named} is not the file that the run wrote.*--resume"):
        read(cd.open_study(out))

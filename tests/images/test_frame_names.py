"""Which files are the frames of one movie, in which order, and what is missing."""

from pathlib import Path

import numpy as np
import pytest
import tifffile

from cytodisk.errors import ReadError
from cytodisk.images.frame_file import NO_CHOICE
from cytodisk.images.sequences.frame_names import FrameNames, by_series, frame_names, series_of
from cytodisk.images.sequences.movie_files import open_movie_masks
from cytodisk.images.sequences.movie_signals import open_movie_signal


def named(folder: Path, *names: str) -> FrameNames:
    return frame_names(folder, {name: folder / name for name in names})


def names_of(found: FrameNames) -> list[str]:
    return [file.name for file in found.files]


@pytest.mark.parametrize(
    "names",
    [
        ["t1.tif", "t2.tif", "t9.tif", "t10.tif", "t11.tif"],
        ["img_000000008_t8.tif", "img_000000009_t9.tif", "img_000000010_t10.tif"],
        ["5min.tif", "10min.tif", "15min.tif"],
        ["Scan12_frame3_v7.tif", "Scan12_frame20_v8.tif"],
        ["20240101_1158.tif", "20240101_1159.tif", "20240101_1200.tif", "20240101_1201.tif"],
    ],
)
def test_files_come_in_natural_order(tmp_path: Path, names: list[str]) -> None:
    found = named(tmp_path, *reversed(names))
    if "t9.tif" not in names:
        assert (names_of(found), found.missing) == (names, frozenset())
    else:
        assert [name for name in names_of(found) if tmp_path / name not in found.missing] == names


@pytest.mark.parametrize(
    ("there", "missing"),
    [
        (["a001.tif", "a002.tif", "a004.tif"], ["a003.tif"]),
        (["a98.tif", "a99.tif", "a101.tif"], ["a100.tif"]),
        (["a000.tif", "a010.tif", "a030.tif", "a040.tif"], ["a020.tif"]),
        (["t007_x2.tif", "t008_x2.tif", "t010_x2.tif", "t011_x2.tif"], ["t009_x2.tif"]),
        (["a5.tif", "a7.tif", "a9.tif"], []),
    ],
)
def test_a_gap_in_the_numbers_is_a_missing_frame(
    tmp_path: Path, there: list[str], missing: list[str]
) -> None:
    found = named(tmp_path, *there)
    assert [name for name in names_of(found) if tmp_path / name in found.missing] == missing
    assert len(found.files) == len(there) + len(missing)
    assert all(name in found.note for name in missing)
    assert bool(found.note) == bool(missing)


def test_numbers_that_hardly_count_frames_are_told(tmp_path: Path) -> None:
    found = named(tmp_path, "a1.tif", "a2.tif", "a900000000.tif")
    assert (len(found.files), found.missing) == (3, frozenset())
    assert "go from 1 to 900000000 with most left out" in found.note


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (["a_c1_t1.tif", "a_c1_t2.tif", "a_c2_t1.tif", "a_c2_t2.tif"], r"channels: .*'.*a_c1_t\*.tif'"),
        (["a_t1_z1.tif", "a_t1_z2.tif", "a_t2_z1.tif", "a_t2_z2.tif"], r"slices of a z-stack"),
        (["e1_t1.tif", "e1_t2.tif", "e2_t1.tif", "e2_t2.tif"], r"more than one movie: .*'.*e1_t\*.tif'"),
        (["z001.tif", "z002.tif", "z003.tif"], r"slices of a z-stack by their names .*'.*z\*.tif'"),
        (["Pos1.tif", "Pos2.tif"], "positions by their names"),
        (["t1.tif", "t01.tif"], "two files with one number"),
    ],
)
def test_names_that_count_something_else_are_refused(tmp_path: Path, names: list[str], words: str) -> None:
    with pytest.raises(ReadError, match=words):
        named(tmp_path, *names)


def test_a_number_that_no_integer_holds(tmp_path: Path) -> None:
    found = named(tmp_path, "t1.tif", "t2.tif", f"t{'9' * 40}.tif")
    assert len(found.files) == 3
    assert "most left out" in found.note


def test_a_pattern_says_that_slices_are_frames(tmp_path: Path) -> None:
    pattern = tmp_path / "z*.tif"
    found = frame_names(pattern, {name: tmp_path / name for name in ("z1.tif", "z2.tif")})
    assert names_of(found) == ["z1.tif", "z2.tif"]


def test_a_clock_has_no_gap_at_the_full_hour(tmp_path: Path) -> None:
    times = [f"{hour:02d}{minute:02d}" for hour in (11, 12) for minute in range(60)]
    found = named(tmp_path, *(f"x_{time}.tif" for time in times))
    assert (len(found.files), found.note) == (120, "")


def test_series_differ_in_more_than_numbers() -> None:
    assert list(by_series(["a1.tif", "b1.tif", "a2.tif"]).values()) == [["a1.tif", "a2.tif"], ["b1.tif"]]
    assert series_of(["VASP_t001.tif", "VASP_t002.tif"]) == "VASP"
    assert series_of(["cell3_time_1.tif", "cell3_time_2.tif"]) == "cell3"
    assert series_of(["t001.tif", "t002.tif"]) == ""


def test_thousands_of_files_are_looked_at_once_each(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    count = 300
    for number in range(count):
        tifffile.imwrite(tmp_path / f"t{number:04d}.tif", np.ones((4, 4), np.uint8))
        tifffile.imwrite(tmp_path / f"t{number:04d}_masks.tif", np.ones((4, 4), np.uint8))
    resolved: list[Path] = []
    resolve = Path.resolve
    monkeypatch.setattr(Path, "resolve", lambda file, *how: resolved.append(file) or resolve(file, *how))
    masks = open_movie_masks(tmp_path, NO_CHOICE)
    signal = open_movie_signal(tmp_path, masks, NO_CHOICE)
    assert [file.name for file in signal.files] == [f"t{number:04d}.tif" for number in range(count)]
    assert len(resolved) < 5 * count


@pytest.mark.parametrize("number", [0, 4, 7, 99, 101])
def test_a_missing_file_is_named_after_the_nearest(tmp_path: Path, number: int) -> None:
    found = named(tmp_path, "a005.tif", "a006.tif", "a100.tif", "a102.tif").taken([5, number])
    assert names_of(found) == ["a005.tif", f"a{number:03d}.tif"]
    assert found.missing == {tmp_path / f"a{number:03d}.tif"}

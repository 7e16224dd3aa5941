"""Axes by what the user says, else the file, else its shape."""

from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest
import tifffile
import xarray as xr

import cytodisk as cd
from cytodisk.errors import ReadError
from cytodisk.images.file_axes import FileAxes, file_axes
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frames import open_frames

FILE = Path("a.tif")


@pytest.mark.parametrize(
    ("said", "shape", "unnamed", "letters", "by"),
    [
        ("TYX", (5, 20, 30), "T", "TYX", "file"),
        ("QYX", (5, 20, 30), "T", "TYX", "nobody"),
        ("QYX", (5, 20, 30), "C", "CYX", "nobody"),
        ("IYX", (5, 20, 30), "T", "TYX", "nobody"),
        ("SYX", (5, 20, 30), "T", "TYX", "nobody"),
        ("YXS", (20, 30, 3), "T", "YXC", "file"),
        ("QTCYX", (1, 5, 2, 20, 30), "C", "TCYX", "file"),
        ("YX", (20, 30), "T", "YX", "file"),
    ],
)
def test_what_is_named_and_what_is_guessed(
    said: str, shape: tuple[int, ...], unnamed: str, letters: str, by: str
) -> None:
    known = file_axes(FILE, said, shape, unnamed)
    assert (known.letters, known.said_by, known.doubt) == (letters, by, "")
    assert ("guessed" in known.evidence) == (by == "nobody")


@pytest.mark.parametrize("shape", [(96, 96, 60), (96, 96, 6), (96, 96, 2), (300, 200, 40), (48, 48, 100)])
def test_a_shape_speaks_against_time_first(shape: tuple[int, ...]) -> None:
    known = file_axes(FILE, "QYX", shape, "T")
    assert known.letters == "TYX"
    assert "pass --axes YXT; else pass --axes TYX" in known.doubt
    assert file_axes(FILE, "TYX", shape, "T").doubt == ""  # the file says so
    assert "--axes YXC" in file_axes(FILE, "QYX", shape, "C").doubt


@pytest.mark.parametrize("shape", [(60, 96, 96), (600, 512, 256), (40, 30, 20), (2, 20, 31), (96, 96, 96)])
def test_a_shape_says_nothing_against_time_first(shape: tuple[int, ...]) -> None:
    assert file_axes(FILE, "QYX", shape, "T").doubt == ""


@pytest.mark.parametrize(
    ("said", "words"),
    [("RYX", "4 positions"), ("MYX", "4 tiles of a mosaic"), ("AYX", "4 angles"), ("HYX", "4 lifetimes")],
)
def test_what_is_no_time_is_not_taken_for_time(said: str, words: str) -> None:
    with pytest.raises(ReadError, match=f"{words}.*save one of them alone; or if.*--axes TYX"):
        file_axes(FILE, said, (4, 20, 30), "T")


def test_the_user_overrules_the_file() -> None:
    assert file_axes(FILE, "ZYX", (60, 20, 30), "T", "TYX") == FileAxes("TYX", (60, 20, 30), "user")
    assert file_axes(FILE, "QYX", (20, 30, 60), "T", "YXT") == FileAxes("YXT", (20, 30, 60), "user")
    assert file_axes(FILE, "QZYX", (1, 60, 20, 30), "T", "TYX").shape == (60, 20, 30)
    with pytest.raises(ReadError, match=r"3 axes of sizes \(5, 20, 30\), --axes TCYX names 4"):
        file_axes(FILE, "QYX", (5, 20, 30), "T", "TCYX")


@pytest.mark.parametrize("name", ["a.tif", "a.npy"])
@pytest.mark.parametrize("order", ["YXT", "YTX", "TXY"])
def test_frames_are_the_same_wherever_time_stands(tmp_path: Path, name: str, order: str) -> None:
    movie = np.random.default_rng(0).integers(0, 255, (5, 20, 31)).astype(np.uint8)
    stored = np.ascontiguousarray(movie.transpose(["TYX".index(axis) for axis in order]))
    if name == "a.npy":
        np.save(tmp_path / name, stored)
    else:
        tifffile.imwrite(tmp_path / name, stored, photometric="minisblack")
    file = open_frames(tmp_path / name, choice=FileChoice(axes=order))
    assert (file.n_frames, file.image_shape, file.evidence) == (5, (20, 31), f"axes {order} as given")
    for number in range(5):
        np.testing.assert_array_equal(file.frame(number)[0], movie[number])


def test_planes_of_a_colour_picture_are_no_frames(tmp_path: Path) -> None:
    planes = np.zeros((3, 12, 10), dtype=np.uint8)
    tifffile.imwrite(tmp_path / "a.tif", planes, photometric="rgb", planarconfig="separate")
    assert open_frames(tmp_path / "a.tif").axes == "CYX"
    assert open_frames(tmp_path / "a.tif", choice=FileChoice(axes="TYX")).n_frames == 3


@pytest.mark.parametrize("name", ["a.npy", "a.tif"])
@pytest.mark.parametrize("axes", ["TZCYX", "TZYX"])
@pytest.mark.parametrize("z", ["3", "max"])
def test_axes_of_length_one_may_be_named_beside_slices(tmp_path: Path, name: str, axes: str, z: str) -> None:
    stack = np.arange(3 * 5 * 20 * 30, dtype=np.uint16).reshape(3, 5, 1, 20, 30)
    path = tmp_path / name
    if name == "a.npy":
        np.save(path, stack)
    else:
        tifffile.imwrite(path, stack, photometric="minisblack")
    file = open_frames(path, choice=FileChoice(axes=axes, z=z))
    assert (file.axes, file.offers) == ("TYX", ("z",))
    np.testing.assert_array_equal(file.frame(1)[0], stack[1, 4 if z == "max" else 3, 0])


@pytest.mark.parametrize(("axes", "letters"), [("YXT", "YXT"), ("yxc", "YXC"), ("CYX", "CYX")])
def test_axes_of_a_colour_png_are_those_that_are_said(tmp_path: Path, axes: str, letters: str) -> None:
    colour = np.arange(20 * 30 * 3, dtype=np.uint8).reshape(20, 30, 3)
    imageio.imwrite(tmp_path / "a.png", colour)
    image = cd.read_image(tmp_path / "a.png", axes=axes)
    wanted = xr.DataArray(
        colour, dims=[{"T": "time", "C": "channel", "Y": "y", "X": "x"}[a] for a in letters]
    )
    np.testing.assert_array_equal(image, wanted.transpose(*image.dims))


@pytest.mark.parametrize("axes", ["TYX", "YXC"])
def test_axes_that_a_grey_png_has_not_are_refused(tmp_path: Path, axes: str) -> None:
    imageio.imwrite(tmp_path / "a.png", np.zeros((20, 30), np.uint8))
    with pytest.raises(ReadError, match=rf"2 axes .* axes {axes} names 3: pass one letter an axis"):
        cd.read_image(tmp_path / "a.png", axes=axes)


@pytest.mark.parametrize(
    ("stored", "axes"), [((20, 31, 1), "YX"), ((5, 20, 31, 1), "TYX"), ((1, 20, 31, 1), "YX")]
)
def test_a_last_axis_of_one_is_the_only_channel(tmp_path: Path, stored: tuple[int, ...], axes: str) -> None:
    movie = np.random.default_rng(0).integers(0, 255, stored).astype(np.uint8)
    np.save(tmp_path / "a.npy", movie)
    file = open_frames(tmp_path / "a.npy")
    assert file.axes == axes
    frames = movie.reshape(-1, 20, 31)
    assert file.n_frames == len(frames)
    for number, frame in enumerate(frames):
        np.testing.assert_array_equal(file.frame(number)[0], frame)

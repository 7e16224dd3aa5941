"""What a mask file is taken for, and what is refused with the remedy."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from PIL import Image
from scipy import ndimage

from cytodisk.errors import MaskError
from cytodisk.images.file_parameters import KindParameters
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.frames import open_frames
from cytodisk.images.what_it_is import MaskLook, look_at


def cell(size: int = 96, radius: float = 28, centre: tuple[float, float] = (48, 48), turn: float = 0) -> Any:
    y, x = np.indices((size, size))
    away = np.hypot(y - centre[0], x - centre[1])
    angle = np.arctan2(y - centre[0], x - centre[1])
    return away < radius * (1 + 0.2 * np.cos(3 * angle + turn))


MOVIE = np.stack([cell(turn=0.1 * t) for t in range(20)])
CELLS = (
    cell(radius=14, centre=(24, 24))
    + 2 * cell(radius=14, centre=(70, 30))
    + 3 * cell(radius=14, centre=(48, 75))
)


def written(folder: Path, values: np.ndarray, axes: str | None = None, **layout: Any) -> FrameFile:
    layout = {"photometric": "minisblack"} | layout
    values = values.astype(np.uint8) if values.dtype == bool else values
    tifffile.imwrite(folder / "a.tif", values, **layout)
    return open_frames(folder / "a.tif", choice=FileChoice(axes=axes), flag="--mask-channel")


def seen(folder: Path, values: np.ndarray, axes: str | None = None, **how: Any) -> MaskLook:
    return look_at(written(folder, values, axes), KindParameters(**how))


def scaled(mask: np.ndarray, size: int, filter_: Any) -> np.ndarray:
    return np.asarray(Image.fromarray(mask.astype(np.uint8)).resize((size, size), filter_))


GREY = {
    "scaled down": scaled(cell(192, 60, (96, 96)) * 255, 150, Image.Resampling.BILINEAR),
    "scaled up": scaled(cell() * 255, 300, Image.Resampling.BILINEAR),
    "scaled up a little": scaled(cell() * 255, 110, Image.Resampling.BICUBIC),
    "rotated": np.asarray(
        Image.fromarray((cell() * 255).astype(np.uint8)).rotate(20, Image.Resampling.BILINEAR)
    ),
    "smoothed": ndimage.gaussian_filter(cell() * 255.0, 1).astype(np.uint8),
    "of 16 bits": ndimage.zoom((cell() * 65535.0), 1.5, order=1).astype(np.uint16),
    "of labels": scaled(CELLS * 60, 140, Image.Resampling.BILINEAR),
    "one pixel of 254": np.where((np.indices((96, 96)) == 48).all(0), 254, cell() * 255).astype(np.uint8),
    "one pixel of 2 in a mask of 1": np.where((np.indices((96, 96)) == 48).all(0), 2, cell()).astype(
        np.uint8
    ),
    "one speck of 254": np.where((np.indices((96, 96)) == 2).all(0), 254, cell() * 255).astype(np.uint8),
}


@pytest.mark.parametrize("name", GREY)
def test_a_mask_with_grey_pixels_is_no_label_image(tmp_path: Path, name: str) -> None:
    with pytest.raises(MaskError, match=r"looks like a picture.*threshold it, or pass .*--kind labels"):
        seen(tmp_path, GREY[name])


@pytest.mark.parametrize("name", ["scaled down", "scaled up", "rotated", "of 16 bits"])
def test_grey_edges_are_named_with_the_remedy(tmp_path: Path, name: str) -> None:
    with pytest.raises(MaskError, match=r"scaling or smoothing a mask makes .*again without interpolation"):
        seen(tmp_path, GREY[name])


@pytest.mark.parametrize(
    "labels",
    [
        CELLS,
        CELLS + 252 * (CELLS > 0),  # up to 255
        np.where((np.indices((96, 96)) == 48).all(0), 9, CELLS),  # a speck with a label of its own
        np.kron(np.arange(1, 37).reshape(6, 6), np.ones((16, 16), int)) * (np.indices((96, 96)).min(0) > 8),
    ],
)
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_label_images_stay_label_images(tmp_path: Path, labels: np.ndarray, dtype: Any) -> None:
    look = seen(tmp_path, labels.astype(dtype))
    assert look.kind == "labels"
    assert look.labels[0] == tuple(np.unique(labels[labels != 0]).tolist())
    np.testing.assert_array_equal(look.file.frame(0)[0], labels)
    assert np.issubdtype(look.file.frame(0).dtype, np.integer)
    assert look.file.frame(0).dtype == look.file.dtype


def test_floats_that_are_whole_numbers_are_one_mask_too(tmp_path: Path) -> None:
    look = seen(tmp_path, cell().astype(np.float32) * 255)
    assert look.kind == "mask"
    assert look.file.frame(0).max() == 255
    assert seen(tmp_path, MOVIE.astype(np.float64)).kind == "stack"


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (
            ndimage.gaussian_filter(cell().astype(float), 2).astype(np.float32),
            "looks like probabilities.*> 0.5",
        ),
        (
            np.random.default_rng(0).normal(100, 5, (30, 40)).astype(np.float32),
            "looks like a picture.*threshold",
        ),
        (np.stack([cell() * 0.5] * 3).astype(np.float32), "probabilities"),
    ],
)
def test_what_is_no_whole_number_is_no_mask(tmp_path: Path, values: np.ndarray, words: str) -> None:
    with pytest.raises(MaskError, match=words):
        seen(tmp_path, values)


@pytest.mark.parametrize("axes", ["YXT", "YTX"])
@pytest.mark.parametrize("frames", [20, 6, 96])
def test_rows_are_no_frames(tmp_path: Path, axes: str, frames: int) -> None:
    movie = np.stack([cell(turn=0.1 * t) for t in range(frames)])
    stored = movie.transpose(["TYX".index(axis) for axis in axes])
    with pytest.raises(MaskError, match=f"does not name its axes.*--axes {axes}; else pass --axes TYX"):
        seen(tmp_path, stored)
    look = seen(tmp_path, stored, axes)
    assert (look.kind, look.file.n_frames) == ("stack", frames)
    np.testing.assert_array_equal(look.file.frame(3)[0], movie[3])


def test_as_many_frames_as_rows_are_frames(tmp_path: Path) -> None:
    movie = np.stack([cell(turn=0.1 * t)[:, 10:86] for t in range(96)])
    assert open_frames(written(tmp_path, movie).path).doubt
    look = seen(tmp_path, movie)
    assert (look.kind, look.file.n_frames) == ("stack", 96)
    assert "guessed" in look.words


def test_what_is_not_looked_at_is_not_guessed(tmp_path: Path) -> None:
    with pytest.raises(MaskError, match="--axes YXT"):
        seen(tmp_path, MOVIE.transpose(1, 2, 0), kind="stack")


@pytest.mark.parametrize(
    "values",
    [~cell(), ~MOVIE, np.where(cell(), 0, 255).astype(np.uint8), CELLS + 1, ~cell(centre=(48, 5))],
    ids=["mask", "movie", "255", "labels", "cell at the border"],
)
def test_an_inverted_mask_is_refused(tmp_path: Path, values: np.ndarray) -> None:
    with pytest.raises(MaskError, match=r"looks inverted.*Invert it.*--kind (mask|stack|labels)"):
        seen(tmp_path, values)


def test_one_frame_that_is_inverted_is_not_the_file(tmp_path: Path) -> None:
    assert seen(tmp_path, np.stack([cell(), ~cell(), cell()])).kind == "stack"
    assert seen(tmp_path, ~cell(), kind="mask").kind == "mask"


def test_pieces_are_numbered(tmp_path: Path) -> None:
    look = seen(tmp_path, np.stack([CELLS > 0, cell()]), label=True)
    assert (look.kind, look.labels) == ("labels", ((1, 2, 3), (1,)))
    assert sorted(np.unique(look.file.frame(0))) == [0, 1, 2, 3]
    with pytest.raises(MaskError, match=r"holds labels already.*leave out --label"):
        seen(tmp_path, CELLS.astype(np.uint8), label=True)
    with pytest.raises(MaskError, match="leave out --label"):
        seen(tmp_path, cell(), label=True, kind="labels")


LABELS = CELLS.astype(np.uint8)
COLOURS = [0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255] + [0] * 756


@pytest.mark.parametrize("name", ["a.png", "a.tif"])
@pytest.mark.parametrize("bits", [8, 2])
def test_a_palette_of_colours_holds_labels(tmp_path: Path, name: str, bits: int) -> None:
    picture = Image.fromarray(LABELS, mode="L").convert("P")
    picture.putpalette(COLOURS)
    picture.save(tmp_path / name, **({"bits": bits} if name == "a.png" else {}))
    file = open_frames(tmp_path / name)
    look = look_at(file)
    assert (look.kind, look.labels) == ("labels", ((1, 2, 3),))
    np.testing.assert_array_equal(file.frame(0)[0], LABELS)
    assert "numbers of a palette's colours" in file.notes[0]


def test_a_palette_of_greys_is_what_it_looks_like(tmp_path: Path) -> None:
    picture = Image.fromarray(np.where(cell(), 0, 1).astype(np.uint8), mode="L").convert("P")
    picture.putpalette([255] * 3 + [0] * 765)  # number 0 is white
    picture.save(tmp_path / "a.png")
    file = open_frames(tmp_path / "a.png")
    np.testing.assert_array_equal(file.frame(0)[0], cell() * 255)
    assert (file.notes, look_at(file).kind) == ((), "mask")


@pytest.mark.parametrize("layout", [{}, {"compression": "zlib"}, {"tile": (32, 32), "compression": "zlib"}])
def test_where_0_is_white_one_bit_is_turned_round(tmp_path: Path, layout: dict[str, Any]) -> None:
    tifffile.imwrite(tmp_path / "a.tif", ~cell(), photometric="miniswhite", software="Fiji", **layout)
    shown = np.asarray(Image.open(tmp_path / "a.tif")) if not layout else cell()
    np.testing.assert_array_equal(shown, cell())  # as viewers show it
    file = open_frames(tmp_path / "a.tif")
    np.testing.assert_array_equal(file.frame(0)[0], cell())
    assert (file.dtype, look_at(file).kind) == (bool, "mask")
    found = file.stored.by_piece(0)
    if found is not None:
        np.testing.assert_array_equal(found[0](slice(10, 40), slice(20, 90))[0], cell()[10:40, 20:90])
    tifffile.imwrite(tmp_path / "b.tif", cell(), photometric="minisblack", **layout)
    np.testing.assert_array_equal(open_frames(tmp_path / "b.tif").frame(0)[0], cell())

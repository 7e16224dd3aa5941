"""Frames by piece: the same pixels, labels, boxes and words as from whole frames, whatever the layout."""

import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from numpy.testing import assert_array_equal
from scipy import ndimage
from skimage import measure

import cytodisk as cd
from cytodisk.errors import MaskError, ReadError
from cytodisk.images import frame_pixels as module
from cytodisk.images.evidence.value_pieces import count_pieces, share_alike, thick_values, touching_values
from cytodisk.images.file_parameters import KindParameters
from cytodisk.images.formats.tiff_segments import TiffSegments
from cytodisk.images.frame_pixels import frame_pixels
from cytodisk.images.frames import open_frames
from cytodisk.images.label_boxes import cell_box, label_boxes
from cytodisk.images.mask_files import SourceCell, list_images, open_mask_files

Write = Callable[[Path, np.ndarray], Path]

LABELS = cd.simulate.label_image(7, 3)
NOISE = np.random.default_rng(1).integers(0, 4, (61, 83)).astype(np.uint16)


def tiff(**options: Any) -> Write:
    def write(folder: Path, values: np.ndarray) -> Path:
        axes = {2: "YX", 3: "CYX", 4: "TCYX"}[values.ndim]
        tifffile.imwrite(
            folder / "a.tif", values, photometric="minisblack", metadata={"axes": axes}, **options
        )
        return folder / "a.tif"

    return write


def npy(order: str) -> Write:
    def write(folder: Path, values: np.ndarray) -> Path:
        np.save(folder / "a.npy", np.asarray(values, order=order))
        return folder / "a.npy"

    return write


LAYOUTS = {
    "one strip": tiff(),
    "strips": tiff(rowsperstrip=7),
    "tiles": tiff(tile=(16, 32)),
    "compressed strips": tiff(rowsperstrip=7, compression="zlib"),
    "compressed tiles": tiff(tile=(32, 16), compression="lzw"),
    "all in one piece": tiff(rowsperstrip=100_000, compression="zlib"),
    "other byte order": tiff(byteorder=">"),
    "other byte order, compressed": tiff(byteorder=">", compression="zlib", rowsperstrip=7),
    "npy": npy("C"),
    "npy by column": npy("F"),
}


@pytest.fixture(params=LAYOUTS)
def write(request: pytest.FixtureRequest) -> Write:
    return LAYOUTS[request.param]


@pytest.fixture
def by_piece(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "WHOLE_BYTES", 0)
    monkeypatch.setattr(module, "_STRIP_PX", 2000)


def cells_of(path: Path, kind: Any = "auto") -> Iterator[SourceCell]:
    return (
        cell
        for image in list_images(open_mask_files(path, KindParameters(kind=kind)))
        for cell in image.cells()
    )


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "uint32", "int64", "float32"])
def test_pieces_are_the_file_s_pixels(tmp_path: Path, write: Write, dtype: str, by_piece: None) -> None:
    file = open_frames(write(tmp_path, LABELS.astype(dtype)))
    frame = frame_pixels(file, 0)
    assert not frame.is_whole
    for rows, columns in (
        (slice(0, 1), slice(0, 1)),
        (slice(5, 40), slice(30, 71)),
        (slice(30, 90), slice(1, 17)),
    ):
        piece = frame.cut(rows, columns)
        assert piece.dtype == dtype
        assert_array_equal(piece[0], LABELS[rows, columns])
    assert_array_equal(np.concatenate([strip for _, strip in frame.strips()]), LABELS)


@pytest.mark.parametrize("dtype", ["uint8", "int16", "uint32", "float32"])
@pytest.mark.parametrize("layout", [{"rowsperstrip": 9}, {"tile": (16, 32)}])
def test_predictors_are_undone(tmp_path: Path, layout: dict[str, Any], dtype: str, by_piece: None) -> None:
    values = NOISE.astype(dtype) * 30
    for order in "<>":
        file = open_frames(
            tiff(compression="zlib", predictor=True, byteorder=order, **layout)(tmp_path, values)
        )
        frame = frame_pixels(file, 0)
        assert not frame.is_whole
        assert_array_equal(frame.cut(slice(5, 50), slice(11, 80))[0], values[5:50, 11:80])


def test_colours_that_lie_pixel_by_pixel(tmp_path: Path, by_piece: None) -> None:
    colours = np.random.default_rng(0).integers(0, 255, (40, 50, 3)).astype(np.uint8)
    for options in ({}, {"compression": "zlib", "tile": (16, 16)}, {"compression": "jpeg", "tile": (16, 16)}):
        tifffile.imwrite(tmp_path / "a.tif", colours, photometric="rgb", **options)
        file = open_frames(tmp_path / "a.tif")
        assert_array_equal(
            frame_pixels(file, 0).cut(slice(3, 33), slice(7, 50)), file.frame(0)[:, 3:33, 7:50]
        )


def test_frames_before_the_end_of_a_file_that_is_cut_short(tmp_path: Path, by_piece: None) -> None:
    movie = np.random.default_rng(0).integers(0, 999, (3, 40, 50)).astype(np.uint16)
    tifffile.imwrite(tmp_path / "a.tif", movie, photometric="minisblack", metadata={"axes": "TYX"})
    file = open_frames(tmp_path / "a.tif")
    pixels = [frame_pixels(file, number) for number in range(3)]
    with tifffile.TiffFile(tmp_path / "a.tif") as opened:
        start = opened.series[0].dataoffset
    with (tmp_path / "a.tif").open("r+b") as opened_file:
        opened_file.truncate(start + movie[:2].nbytes + 10)
    for number in range(2):
        assert_array_equal(pixels[number].cut(slice(0, 40), slice(0, 50))[0], movie[number])
    with pytest.raises(ReadError, match="frame 2 cannot be read"):
        pixels[2].cut(slice(0, 40), slice(0, 50))


def test_a_large_piece_of_a_file_is_gone_through_by_strip(
    tmp_path: Path, by_piece: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("cytodisk.images.formats.tiff_segments._KEPT_BYTES", 0)
    monkeypatch.setattr(module, "_STRIP_PX", 5 * LABELS.shape[1])
    decoded: list[tuple[int, int]] = []
    once = TiffSegments._decoded
    monkeypatch.setattr(
        TiffSegments,
        "_decoded",
        lambda found, *place: decoded.append(place[1:]) or once(found, *place),
    )
    for name in ("all in one piece", "compressed tiles"):
        frame = frame_pixels(open_frames(LAYOUTS[name](tmp_path, LABELS)), 0)
        decoded.clear()
        strips = [strip for _, strip in frame.strips()]
        assert {len(strip) for strip in strips[:-1]} == {5}
        assert_array_equal(np.concatenate(strips), LABELS)
        assert len(decoded) == len(set(decoded))


def test_channels_and_frames_are_cut_too(tmp_path: Path, by_piece: None) -> None:
    movie = np.random.default_rng(0).integers(0, 999, (3, 2, 40, 50)).astype(np.uint16)
    for write in (LAYOUTS["one strip"], LAYOUTS["compressed tiles"], LAYOUTS["compressed strips"]):
        file = open_frames(write(tmp_path, movie))
        for number in range(3):
            frame = frame_pixels(file, number)
            assert not frame.is_whole
            assert_array_equal(frame.cut(slice(9, 33), slice(15, 50)), movie[number, :, 9:33, 15:50])


@pytest.mark.parametrize("kind", ["auto", "labels"])
@pytest.mark.parametrize("dtype", ["uint16", "uint32", "int64"])
def test_cells_are_the_same_as_from_whole_frames(
    tmp_path: Path, write: Write, dtype: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path, LABELS.astype(dtype))
    whole = list(cells_of(path, kind))
    monkeypatch.setattr(module, "WHOLE_BYTES", 0)
    monkeypatch.setattr(module, "_STRIP_PX", 2000)
    cut = list(cells_of(path, kind))
    assert len(whole) == len(cut) == 7
    for one, other, box in zip(whole, cut, ndimage.find_objects(LABELS), strict=True):
        assert (one.label, one.corner, one.image_shape) == (other.label, other.corner, other.image_shape)
        assert one.corner == tuple(max(side.start - 1, 0) for side in box)
        assert_array_equal(one.mask, other.mask)


@pytest.mark.parametrize("dtype", ["bool", "uint8", "uint64", "float64"])
def test_a_single_mask_is_cut_the_same(tmp_path: Path, dtype: str, monkeypatch: pytest.MonkeyPatch) -> None:
    path = npy("C")(tmp_path, (LABELS == 3).astype(dtype))
    (whole,) = cells_of(path)
    monkeypatch.setattr(module, "WHOLE_BYTES", 0)
    monkeypatch.setattr(module, "_STRIP_PX", 2000)
    (cut,) = cells_of(path)
    assert (whole.label, whole.corner) == (cut.label, cut.corner) == (1, cut.corner)
    assert_array_equal(whole.mask, cut.mask)
    assert [found.mask.dtype for found in (whole, cut) if found.mask is not None] == [dtype, dtype]


def test_strips_know_what_the_whole_frame_knows() -> None:
    for values in (
        LABELS,
        NOISE,
        NOISE * np.uint64(70_000_000_000),
        np.zeros_like(NOISE),
        np.full_like(NOISE, 3),
    ):
        strips = [(first, values[first : first + 6]) for first in range(0, len(values), 6)]
        found = label_boxes(strips)
        wanted = np.unique(values)
        assert_array_equal(found.labels, wanted[wanted != 0])
        assert (found.least, found.greatest) == (values.min(), values.max())
        for label, box in found:
            held = np.argwhere(values == label)
            assert [(side.start, side.stop) for side in box] == list(
                zip(held.min(0), held.max(0) + 1, strict=True)
            )
        left, right = values[:, :-1], values[:, 1:]
        both = (left != 0) & (right != 0)
        assert share_alike(strips) == ((left == right)[both].mean() if both.any() else 1.0)
        assert count_pieces(strips) == measure.label(values, background=0, connectivity=2).max()
        squares = np.lib.stride_tricks.sliding_window_view(values, (3, 3))
        filled = squares.min(axis=(2, 3)) == squares.max(axis=(2, 3))
        assert_array_equal(thick_values(strips), np.unique(values[1:-1, 1:-1][filled]))
        down = zip(values[1:].flat, values[:-1].flat, strict=True)
        beside = [*down, *zip(right.flat, left.flat, strict=True)]
        touching = {value for pair in beside if 0 not in pair and pair[0] != pair[1] for value in pair}
        assert set(touching_values(strips).tolist()) == touching
        box, greatest = cell_box(strips)
        assert greatest == values.max()
        assert (box is None) == (not values.any())
        if box is not None:
            assert_array_equal(values[box].any(axis=1)[[0, -1]], [True, True])
            assert np.count_nonzero(values[box]) == np.count_nonzero(values)


def test_a_picture_is_refused_in_the_same_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = LAYOUTS["compressed strips"](tmp_path, NOISE)
    words = []
    for _ in range(2):
        with pytest.raises(MaskError, match="looks like a picture") as caught:
            open_mask_files(path)
        words.append(str(caught.value))
        monkeypatch.setattr(module, "WHOLE_BYTES", 0)
        monkeypatch.setattr(module, "_STRIP_PX", 2000)
    assert words[0] == words[1]


def test_a_damaged_piece_is_told(tmp_path: Path, by_piece: None) -> None:
    path = LAYOUTS["compressed strips"](tmp_path, LABELS)
    with tifffile.TiffFile(path) as opened:
        offset = opened.pages[0].dataoffsets[2]
    content = bytearray(path.read_bytes())
    content[offset : offset + 6] = b"broken"
    path.write_bytes(content)
    with pytest.raises(ReadError, match="frame 0 cannot be read as an image"):
        open_mask_files(path)


def test_memory_does_not_grow_with_the_frame(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "WHOLE_BYTES", 2**16)
    monkeypatch.setattr(module, "_STRIP_PX", 2**16)
    monkeypatch.setattr("cytodisk.images.formats.tiff_segments._KEPT_BYTES", 2**18)
    peaks = []
    for copies in (4, 12):
        labels = np.tile(LABELS, (copies, copies)).astype(np.uint32)
        rows, columns = (np.arange(size * copies) // size for size in LABELS.shape)
        labels[labels > 0] += (7 * (copies * rows[:, None] + columns)).astype(np.uint32)[labels > 0]
        path = tiff(tile=(64, 64), compression="zlib")(tmp_path, labels)
        next(cells_of(path))  # what is kept of any file
        tracemalloc.start()
        try:
            assert sum(1 for _ in cells_of(path)) == 7 * copies**2
            peaks.append(tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
    assert peaks[1] < 0.3 * labels.nbytes
    assert peaks[1] < 4 * peaks[0]  # strips are three times as wide, frames nine times as large

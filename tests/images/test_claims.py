"""Sizes that small files claim, files that never end, and names that do not say what a file is."""

import io
import os
import pickle
import struct
import tracemalloc
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from numpy.testing import assert_array_equal
from PIL import Image

from cytodisk.errors import ReadError
from cytodisk.images import claims
from cytodisk.images.frame_pixels import frame_pixels
from cytodisk.images.frames import open_frames, read_image


def npy_header(shape: tuple[int, ...], kind: str) -> bytes:
    out = io.BytesIO()
    np.lib.format.write_array_header_1_0(out, {"descr": kind, "fortran_order": False, "shape": shape})
    return out.getvalue()


def png(width: int, height: int, content: bytes) -> bytes:
    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", content) + chunk(b"IEND", b"")


def tiff_that_claims(path: Path, size: int, compression: str | None) -> Path:
    """A TIFF whose page says that it is so many pixels high and wide."""
    tifffile.imwrite(path, np.zeros((64, 64), np.uint8), compression=compression, metadata=None)
    with tifffile.TiffFile(path, mode="r+") as tiff:
        for name in ("ImageWidth", "ImageLength", "RowsPerStrip"):
            tag = tiff.pages[0].tags[name]
            tag.overwrite(size, dtype="I") if tag.dtype == 4 else tag.overwrite(min(size, 65535))
    return path


GIANTS = {
    "array.npy": npy_header((10**9, 96, 96), "<u2") + b"abc",
    "negative.npy": npy_header((2, -3, 96), "<u2") + b"abc",
    "picture.png": png(2**31 - 1, 2**31 - 1, zlib.compress(b"abc")),
    "picture_60000.png": png(60_000, 60_000, zlib.compress(bytes(1000))),
}


@pytest.mark.parametrize("name", GIANTS)
def test_a_small_file_that_claims_a_giant_is_refused_at_once(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(GIANTS[name])
    tracemalloc.start()
    try:
        with pytest.raises(ReadError, match=r"copy it again") as caught:
            read_image(tmp_path / name)
        assert tracemalloc.get_traced_memory()[1] < 2**24
    finally:
        tracemalloc.stop()
    assert name in str(caught.value)


@pytest.mark.parametrize("compression", [None, "zlib", "lzw", "packbits"])
def test_a_tiff_that_claims_more_than_it_holds(tmp_path: Path, compression: str | None) -> None:
    path = tiff_that_claims(tmp_path / "a.tif", 60_000, compression)
    with pytest.raises(ReadError, match="copy it again"):
        open_frames(path)


@pytest.mark.parametrize("name", ["ImageWidth", "ImageLength"])
def test_a_page_without_pixels(tmp_path: Path, name: str) -> None:
    tifffile.imwrite(tmp_path / "a.tif", np.ones((8, 8), np.uint8), metadata=None)
    with tifffile.TiffFile(tmp_path / "a.tif", mode="r+") as tiff:
        tiff.pages[0].tags[name].overwrite(0)
    with pytest.raises(ReadError, match=r"it is damaged; copy it again|holds no image"):
        open_frames(tmp_path / "a.tif")


@pytest.mark.parametrize("pages", [1, 3, 150])
@pytest.mark.parametrize("bigtiff", [False, True])
def test_pages_that_go_in_a_circle(tmp_path: Path, pages: int, bigtiff: bool) -> None:
    path = tmp_path / "a.tif"
    movie = np.ones((pages, 8, 8), np.uint8)
    tifffile.imwrite(
        path, movie, photometric="minisblack", metadata=None, bigtiff=bigtiff, compression="zlib"
    )
    with tifffile.TiffFile(path) as tiff:
        first, last = tiff.pages[0].offset, tiff.pages[-1].offset
        count = len(tiff.pages[-1].tags)
    assert open_frames(path).n_frames == pages
    content = bytearray(path.read_bytes())
    end = last + (8 + 20 * count if bigtiff else 2 + 12 * count)
    content[end : end + 4] = struct.pack("<I", first)
    path.write_bytes(content)
    with pytest.raises(ReadError, match="its pages go in a circle"):
        open_frames(path)


@pytest.mark.parametrize("codec", ["none", "packbits", "zlib", "lzw"])
def test_what_compresses_best_is_not_refused(tmp_path: Path, codec: str) -> None:
    path = tmp_path / "a.tif"
    empty = np.zeros((2000, 2000), np.uint16)
    tifffile.imwrite(path, empty, compression=None if codec == "none" else codec, rowsperstrip=2000)
    assert_array_equal(open_frames(path).frame(0)[0], empty)


def test_numbers_in_a_pickle_do_not_fill_the_memory(tmp_path: Path) -> None:
    head = npy_header((), "|O")
    bodies = {
        "memo": b"}r" + struct.pack("<I", 2**32 - 2) + b".",
        "bytes": b"\x8e" + struct.pack("<Q", 2**62) + b"abc.",
        "frame": b"\x95" + struct.pack("<Q", 2**62) + b"}.",
    }
    for name, body in bodies.items():
        path = tmp_path / f"{name}_seg.npy"
        path.write_bytes(head + pickle.PROTO + b"\x04" + body)
        tracemalloc.start()
        try:
            with pytest.raises(ReadError):
                open_frames(path)
            assert tracemalloc.get_traced_memory()[1] < 2**24
        finally:
            tracemalloc.stop()


def test_what_needs_more_memory_than_is_free_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(claims, "_SMALL", 0)
    monkeypatch.setattr(claims, "free_bytes", lambda: 20_000)
    labels = np.zeros((300, 300), np.uint16)
    tifffile.imwrite(tmp_path / "a.tif", labels, compression="zlib", rowsperstrip=10)
    file = open_frames(tmp_path / "a.tif")
    with pytest.raises(ReadError, match=r"frame 0 takes 180 kB of memory, and 20 kB are free: crop it"):
        file.frame(0)
    monkeypatch.setattr("cytodisk.images.frame_pixels.WHOLE_BYTES", 0)
    assert_array_equal(frame_pixels(file, 0).cut(slice(50, 90), slice(0, 300))[0], labels[50:90])
    Image.fromarray(labels.astype(np.uint8)).save(tmp_path / "a.png")
    with pytest.raises(ReadError, match="save it as TIFF, in tiles"):
        open_frames(tmp_path / "a.png")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in the file system")
@pytest.mark.parametrize("name", ["a.tif", "a.png", "a_seg.npy"])
def test_a_pipe_or_a_device_is_no_file(tmp_path: Path, name: str) -> None:
    os.mkfifo(tmp_path / name)
    (tmp_path / f"zero_{name}").symlink_to("/dev/zero")
    for path in (tmp_path / name, tmp_path / f"zero_{name}"):
        with pytest.raises(ReadError, match="is a pipe or a device"):
            open_frames(path)


@pytest.mark.parametrize("name", ["a.jpg", "a.JPEG", "a.png", "a.tif"])
def test_a_jpeg_is_refused_with_the_reason(tmp_path: Path, name: str) -> None:
    Image.fromarray(np.zeros((8, 8), np.uint8)).save(tmp_path / name, format="JPEG")
    with pytest.raises(
        ReadError, match=r"is a JPEG, which changes pixels .*as TIFF or PNG from the raw file"
    ):
        open_frames(tmp_path / name)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "is empty"),
        (b"<!DOCTYPE HTML><html></html>", "its download failed"),
        (b"version https://git-lfs.github.com/spec/v1", "git lfs pull"),
        (b"\x1f\x8b\x08\x00", "unpack it"),
        (b"%PDF-1.7", "is a PDF"),
    ],
)
def test_what_is_no_image_is_named(tmp_path: Path, content: bytes, words: str) -> None:
    (tmp_path / "a.tif").write_bytes(content)
    with pytest.raises(ReadError, match=words):
        open_frames(tmp_path / "a.tif")


@pytest.mark.parametrize("name", ["a.png", "a.lsm", "a.btf", "a"])
def test_a_tiff_is_one_whatever_its_name(tmp_path: Path, name: str) -> None:
    plane = np.arange(80, dtype=np.uint8).reshape(8, 10)
    tifffile.imwrite(tmp_path / name, plane)
    assert_array_equal(open_frames(tmp_path / name).frame(0)[0], plane)


def test_a_picture_above_the_limit_of_pillow(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plane = np.arange(80, dtype=np.uint8).reshape(8, 10)
    Image.fromarray(plane).save(tmp_path / "a.png")
    for limit in (50, 20):  # a warning; an error
        monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", limit)
        assert_array_equal(open_frames(tmp_path / "a.png").frame(0)[0], plane)
        assert limit == Image.MAX_IMAGE_PIXELS


def test_words_for_sizes() -> None:
    sizes: dict[int, Any] = {3: "3 bytes", 37_400: "37.4 kB", 18 * 10**12: "18 TB", 10**25: "1e+07 EB"}
    assert {size: claims._size(size) for size in sizes} == sizes


def test_a_large_image_in_one_compressed_piece_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("cytodisk.images.formats.tiff_file._LARGEST_SEGMENT", 100 * 100 - 1)
    image = np.eye(100, dtype=np.uint8)
    tifffile.imwrite(tmp_path / "one.tif", image, compression="zlib", rowsperstrip=100)
    tifffile.imwrite(tmp_path / "tiles.tif", image, compression="zlib", tile=(16, 16))
    with pytest.raises(ReadError, match=r"compressed in one piece of 100 × 100 pixels.*in tiles"):
        open_frames(tmp_path / "one.tif")
    assert open_frames(tmp_path / "tiles.tif").image_shape == (100, 100)

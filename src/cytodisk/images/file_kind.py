"""What a file is by its first bytes, whatever its name says."""

from __future__ import annotations

import stat
from pathlib import Path

from cytodisk.errors import ReadError

_IMAGES = {
    b"II*\0": ".tif",
    b"MM\0*": ".tif",
    b"II+\0": ".tif",
    b"MM\0+": ".tif",
    b"\x89PNG\r\n\x1a\n": ".png",
    b"\x93NUMPY": ".npy",
}
_JPEG = (
    "is a JPEG, which changes pixels when it is saved, most of all at edges: save masks and images as TIFF "
    "or PNG from the raw file; converting the JPEG does not bring the pixels back"
)
_REFUSED = {
    b"\xff\xd8\xff": _JPEG,
    b"\0\0\0\x0cjP  ": "is a JPEG 2000: save it as TIFF from the raw file",
    b"GIF8": "is a GIF, which keeps 256 colours and no grey values: save it as TIFF from the raw file",
    b"BM": "is a BMP: save it as TIFF",
    b"\x1f\x8b": "is compressed with gzip: unpack it first",
    b"\x89HDF\r\n\x1a\n": (
        "is an HDF5 file: export it as TIFF; in ilastik, choose Format: tif under Choose "
        "Export Image Settings"
    ),
    b"%PDF": "is a PDF: save the image alone, as TIFF",
    b"<!DOCTYPE html": "is a web page, so its download failed: download it again",
    b"<html": "is a web page, so its download failed: download it again",
    b"version https://git-lfs": "only points to a file in git-lfs: fetch it with git lfs pull",
}
_JPEG_NAMES = (".jpg", ".jpeg", ".jpe", ".jfif")


def image_kind(file: Path) -> str | None:
    """The usual ending of an image file, by its first bytes; None for what they do not tell.

    Parameters
    ----------
    file : Path

    Raises
    ------
    ReadError
        It is a pipe or a device, which may give bytes without end, or none; it is empty, or something that is
        no image to measure.
    """
    if not stat.S_ISREG(file.stat().st_mode):
        raise ReadError(f"{file} is a pipe or a device, no file: save the image as a file first")
    with file.open("rb") as opened:
        head = opened.read(32)
    if not head and file.suffix.lower() in (".tiff", *_IMAGES.values()):
        raise ReadError(f"{file} cannot be read as an image: it is empty; copy it again")
    for start, kind in _IMAGES.items():
        if head.startswith(start):
            return kind
    for start, words in _REFUSED.items():
        if head.lower().startswith(start.lower()):
            raise ReadError(f"{file} {words}")
    if file.suffix.lower() in _JPEG_NAMES:
        raise ReadError(f"{file} {_JPEG}")
    return None

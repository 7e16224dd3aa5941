"""One ROI of ImageJ as bytes, read and written by roifile, which is imported here alone."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.errors import MissingPartError, ReadError

CORNER = 0.5
"""Of a pixel's centre in ImageJ, which counts areas from the corner of the first pixel."""


def decoded_roi(path: Path, name: str, content: bytes) -> Any:
    """The ROI that some bytes of a file hold.

    Parameters
    ----------
    path : Path
    name : str
        Of the ROI in the file.
    content : bytes

    Returns
    -------
    roifile.ImagejRoi

    Raises
    ------
    ReadError
        It is damaged.
    MissingPartError
        roifile is not installed.
    """
    roi_class = _roifile(f"{path}: reading ImageJ's ROIs needs roifile").ImagejRoi
    try:
        return roi_class.frombytes(content)
    except Exception as error:
        words = " ".join(str(error).split())
        raise ReadError(f"{path}: ROI {name} is damaged ({words}): save the ROIs again") from error


def require_roifile() -> None:
    """Raise MissingPartError unless ROIs can be written."""
    _roifile("writing ImageJ's ROIs needs roifile")


def encoded_roi(
    polygon_yx: FloatArray, name: str, colour: tuple[int, int, int], frame: int | None = None
) -> bytes:
    """A polygon as a ROI with subpixel resolution, freehand: ImageJ draws a handle at each point of others.

    Parameters
    ----------
    polygon_yx : ndarray of shape (N, 2)
        (row, column) in pixels, pixel centres at integers; last point not repeated.
    name : str
    colour : (int, int, int)
        Red, green and blue of its line, 0 to 255.
    frame : int, optional
        Number of its frame from 0, which ImageJ counts from 1; without it the ROI stands in all.

    Returns
    -------
    bytes

    Raises
    ------
    MissingPartError
        roifile is not installed.
    """
    roifile = _roifile("writing ImageJ's ROIs needs roifile")
    points = (polygon_yx[:, ::-1] + CORNER).astype(np.float32)
    roi = roifile.ImagejRoi.frompoints(points, name=name, t=frame)
    roi.stroke_color = bytes((255, *colour))  # and no width: a line of one pixel at any zoom
    content: bytes = roi.tobytes()
    return content


def _roifile(needed_by: str) -> Any:
    try:
        import roifile
    except ImportError as error:
        missing = isinstance(error, ModuleNotFoundError)
        fault = "is not installed" if missing else f"cannot be imported ({error})"
        raise MissingPartError.of(needed_by, "roi", fault) from error
    return roifile

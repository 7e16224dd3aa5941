"""Sets of ImageJ's ROIs: `.roi`, and `.zip` as the ROI Manager of Fiji, StarDist and Cellpose write it."""

from __future__ import annotations

import logging
import zipfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.errors import ReadError
from cytodisk.images.formats.outlined.outline_file import open_outlines
from cytodisk.images.formats.outlined.outline_set import Outline, OutlineSet
from cytodisk.images.formats.outlined.roi_bytes import CORNER, decoded_roi
from cytodisk.images.frame_file import FileChoice, FrameFile

_LARGEST_ROI, _LARGEST_SET = 2**26, 2**30  # bytes
_POINTS_OF_CURVE = 16
_MOVE, _LINE, _QUADRATIC, _CUBIC, _CLOSE = range(5)  # steps of a path, with so many points each
_POINTS = {_MOVE: 1, _LINE: 1, _QUADRATIC: 2, _CUBIC: 3, _CLOSE: 0}


def open_rois(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at a set of ROIs as label images; see `cytodisk.images.frames.open_frames`."""
    return open_outlines(file, read_rois, choice)


def read_rois(path: Path) -> OutlineSet:
    """The outlines of a set of ROIs.

    Parameters
    ----------
    path : Path
        `.roi` or `.zip`.

    Returns
    -------
    OutlineSet

    Raises
    ------
    ReadError
        The file is damaged, or no set of ROIs.
    MissingPartError
        roifile is not installed.
    """
    outlines: list[Outline] = []
    without_area: Counter[str] = Counter()
    rounded = 0
    with _quiet_log() as logged:
        for number, (name, content) in enumerate(_contents(path), start=1):
            roi = decoded_roi(path, name, content)
            rings = _rings(roi)
            if rings is None:
                without_area[roi.roitype.name.lower()] += 1
                continue
            rounded += roi.roitype.name == "RECT" and roi.rounded_rect_arc_size > 0
            frame, slice_ = _position(roi)
            label = roi.name or name.removesuffix(".roi") or str(number)
            outlines.append(Outline(rings, label, frame, slice_))
    remarks = list(dict.fromkeys(logged))
    if without_area:
        kinds = ", ".join(f"{number} × {kind}" for kind, number in without_area.items())
        remarks.append(f"ROIs without an area left out: {kinds}")
    if rounded:
        remarks.append(f"{rounded} rectangles have round corners, which are taken as square")
    if not outlines:
        raise ReadError(f"{path} holds no ROI with an area: {'; '.join(remarks) or 'it is empty'}")
    return OutlineSet(tuple(outlines), tuple(remarks))


def _contents(path: Path) -> Iterator[tuple[str, bytes]]:
    """Name and content of each ROI."""
    if path.suffix.lower() == ".roi":
        if path.stat().st_size > _LARGEST_ROI:
            raise ReadError(f"{path} is too large for a ROI: {path.stat().st_size} bytes")
        yield path.name, path.read_bytes()
        return
    if not zipfile.is_zipfile(path):
        raise ReadError(f"{path} is no zip file, or is cut short: save the ROIs again")
    with zipfile.ZipFile(path) as opened:
        entries = [entry for entry in opened.infolist() if _is_roi(entry.filename)]
        if not entries:
            raise ReadError(
                f"{path} holds no ROI (.roi): pass a set of ImageJ's ROI Manager, or unpack the files in it"
            )
        if sum(entry.file_size for entry in entries) > _LARGEST_SET:
            raise ReadError(f"{path} unpacks to more than {_LARGEST_SET >> 20} MB: that is no set of ROIs")
        for entry in entries:
            yield entry.filename.rpartition("/")[2], opened.read(entry)


def _is_roi(name: str) -> bool:
    last = name.rpartition("/")[2]
    return last.lower().endswith(".roi") and not last.startswith(".")  # as "._a.roi" of macOS


@contextmanager
def _quiet_log() -> Iterator[list[str]]:
    """What roifile logs, which would stand between the lines of a command."""
    logged: list[str] = []
    watch = logging.Handler(logging.WARNING)
    watch.emit = lambda record: logged.append(record.getMessage())  # type: ignore[method-assign]
    log = logging.getLogger("roifile")
    passed_on = log.propagate
    log.addHandler(watch)
    log.propagate = False
    try:
        yield logged
    finally:
        log.removeHandler(watch)
        log.propagate = passed_on


def _position(roi: Any) -> tuple[int | None, int | None]:
    """Frame and slice, from 0; a position in a plain stack counts as a slice."""
    if roi.t_position > 0:
        return roi.t_position - 1, roi.z_position - 1 if roi.z_position > 0 else None
    position = roi.z_position if roi.z_position > 0 else roi.position
    return None, position - 1 if position > 0 else None


def _rings(roi: Any) -> tuple[FloatArray, ...] | None:
    """Closed polygons of a ROI; None if it has no area."""
    kind = roi.roitype.name
    if roi.multi_coordinates is not None and len(roi.multi_coordinates):
        rings = _path_rings(np.asarray(roi.multi_coordinates, dtype=float))
    elif kind == "OVAL":
        rings = [_oval(*_rectangle(roi))]
    elif kind == "RECT":
        top, left, bottom, right = _rectangle(roi)
        rings = [np.array([(left, top), (right, top), (right, bottom), (left, bottom)])]
    elif kind in ("POLYGON", "FREEHAND", "TRACED"):
        rings = [np.asarray(roi.coordinates(), dtype=float)]
    else:
        return None
    return tuple(ring[:, ::-1] - CORNER for ring in rings)


def _rectangle(roi: Any) -> tuple[float, float, float, float]:
    """(top, left, bottom, right)."""
    if roi.subpixelrect:
        return roi.yd, roi.xd, roi.yd + roi.heightd, roi.xd + roi.widthd
    return roi.top, roi.left, roi.bottom, roi.right


def _oval(top: float, left: float, bottom: float, right: float) -> FloatArray:
    """(x, y) of an ellipse, so that sides are about half a pixel long."""
    height, width = (bottom - top) / 2, (right - left) / 2
    points = int(np.clip(4 * np.pi * max(height, width), 32, 10_000))
    angle = np.linspace(0.0, 2.0 * np.pi, points, endpoint=False)
    # Sides of such a polygon lie within the ellipse: it is made larger to have the ellipse's area.
    grown = np.sqrt(2 * np.pi / points / np.sin(2 * np.pi / points))
    return np.column_stack(
        [left + width + grown * width * np.cos(angle), top + height + grown * height * np.sin(angle)]
    )


def _path_rings(path: FloatArray) -> list[FloatArray]:
    """(x, y) of the closed polygons of a path that is made of several, as ImageJ writes composite ROIs."""
    rings: list[list[tuple[float, float]]] = []
    place = 0
    while place < len(path):
        step = int(path[place])
        if step not in _POINTS:
            raise ReadError(f"a composite ROI has the step {step}, which is unknown: save the ROIs again")
        size = 2 * _POINTS[step]
        points = [(float(x), float(y)) for x, y in path[place + 1 : place + 1 + size].reshape(-1, 2)]
        place += 1 + size
        if step == _MOVE:
            rings.append(points)
        elif step != _CLOSE:
            if not rings:
                raise ReadError("a composite ROI begins with no point: save the ROIs again")
            rings[-1] += _curve(rings[-1][-1], points)
    return [np.array(ring) for ring in rings]


def _curve(start: tuple[float, float], points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points along a Bézier curve, without its start; a straight line has one."""
    if len(points) == 1:
        return points
    held = np.array([start, *points])
    along = np.linspace(0.0, 1.0, _POINTS_OF_CURVE + 1)[1:, None, None]
    level = np.broadcast_to(held, (_POINTS_OF_CURVE, *held.shape))
    for _ in range(len(held) - 1):  # de Casteljau's construction
        level = (1 - along) * level[:, :-1] + along * level[:, 1:]
    return [(float(x), float(y)) for x, y in level[:, 0]]

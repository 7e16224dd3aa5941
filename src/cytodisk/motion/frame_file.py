"""A mapped frame in one file: its disk map and its tracked boundary."""

from __future__ import annotations

import os
import warnings
from dataclasses import astuple
from pathlib import Path

import numpy as np

from cytodisk.array_archive import ArrayArchive, reading_arrays
from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.loading import load_map
from cytodisk.errors import EarlierVersionWarning, ReadError
from cytodisk.motion.contour import Contour
from cytodisk.motion.mapped_frame import MappedFrame
from cytodisk.motion.nucleus.tracked_nucleus_file import (
    FURTHEST_PX,
    MOST_FRAMES,
    REMEDY,
    load_nucleus,
    load_nucleus_boundary,
    nucleus_arrays,
    tracked_places,
)
from cytodisk.motion.registration import RigidTransform
from cytodisk.motion.tracking import TrackedBoundary

_NO_MATCH = np.empty((2, 0))  # of a first frame, and of the paper's tracker


def save_frame(path: str | os.PathLike[str], frame: MappedFrame) -> None:
    """Write a frame to a `.npz` file; `load_map` reads its map, `load_boundary` its boundary.

    Parameters
    ----------
    path : path-like
    frame : MappedFrame

    Raises
    ------
    StudyError
        The file cannot be written.
    """
    boundary = frame.boundary
    of_nucleus = {} if frame.nucleus is None else nucleus_arrays(frame.nucleus)
    frame.disk.save(
        path,
        of_nucleus
        | {
            "track_matched_s": _NO_MATCH if boundary.matched_s is None else boundary.matched_s,
            "track_s": boundary.s,
            "track_transforms": np.array([astuple(boundary.transform), astuple(boundary.alignment)]),
            "track_residual_px": np.array(boundary.residual_px),
            "track_times": np.array([boundary.frame, frame.reference.frame, boundary.order_violations]),
            "track_restarted": np.array(boundary.restarted),
        },
    )


def load_boundary(path: str | os.PathLike[str], disk: DiskMap | None = None) -> TrackedBoundary:
    """Read the tracked boundary of a frame that `save_frame` wrote.

    Parameters
    ----------
    path : path-like
    disk : DiskMap, optional
        The frame's map, when it has been read already.

    Returns
    -------
    TrackedBoundary
        Bit for bit as it was saved.

    Raises
    ------
    ReadError
        The file is missing, damaged, or holds no boundary.

    Warns
    -----
    EarlierVersionWarning
        An earlier version wrote it, which kept no match of the step to this frame.
    """
    return _read(path, disk)[0]


def load_frame(path: str | os.PathLike[str], path_at: dict[int, Path]) -> MappedFrame:
    """Read a whole frame back.

    Parameters
    ----------
    path : path-like
    path_at : dict of int to Path
        Files of the movie's frames by number, for the frame that this one was registered to.

    Returns
    -------
    MappedFrame

    Raises
    ------
    ReadError
        A file is missing, damaged, or holds no boundary.
    """
    disk = load_map(path)
    boundary, reference_frame = _read(path, disk)
    nucleus = None
    if disk.nucleus is not None:
        nucleus = load_nucleus(
            path, disk, boundary, lambda frame: _nucleus_at(_path_of(path, frame, path_at))
        )
    if reference_frame == boundary.frame:
        return MappedFrame(disk, boundary, boundary, nucleus=nucleus)
    reference = load_boundary(_path_of(path, reference_frame, path_at))
    return MappedFrame(disk, boundary, reference, nucleus=nucleus)


def _path_of(path: str | os.PathLike[str], frame: int, path_at: dict[int, Path]) -> Path:
    if frame not in path_at:
        raise ReadError(f"{path} refers to frame {frame}, which has no file")
    return path_at[frame]


def _nucleus_at(path: Path) -> TrackedBoundary:
    disk = load_map(path)
    return load_nucleus_boundary(path, disk, _read(path, disk)[0])


def _read(path: str | os.PathLike[str], disk: DiskMap | None) -> tuple[TrackedBoundary, int]:
    contour = Contour.of_outline((disk or load_map(path)).outline_yx)
    with reading_arrays(path, "the map of a movie's frame", REMEDY) as archive:
        if "track_s" not in archive.names:
            raise ReadError(f"{path} holds no tracked boundary: it is no frame of a movie, or {REMEDY}")
        times = archive.integers("track_times", (3,), least=0, most=MOST_FRAMES)
        number, reference_frame, violations = times.tolist()
        rows = archive.floats("track_transforms", (2, 3), low=-FURTHEST_PX, high=FURTHEST_PX)
        transform, alignment = (RigidTransform(*row) for row in rows.tolist())
        boundary = TrackedBoundary(
            number,
            contour,
            tracked_places(archive, "track_s", contour),
            transform,
            alignment,
            float(archive.floats("track_residual_px", (), low=0.0, high=FURTHEST_PX)),
            violations,
            archive.texts("track_restarted")[0],
            _match(path, archive) if number != reference_frame else None,
        )
    return boundary, reference_frame


def _match(path: str | os.PathLike[str], archive: ArrayArchive) -> FloatArray | None:
    """Match of the step to this frame, None if there is none; a file that does not say so is told."""
    if "track_matched_s" not in archive.names:
        warnings.warn(
            f"{path} was written by an earlier version: velocity is taken from its tracked points alone, and "
            "that of a thin protrusion gets lost; run cytodisk movie again",
            EarlierVersionWarning,
            stacklevel=4,
        )
        return None
    matched = archive.floats("track_matched_s", (2, None), low=-FURTHEST_PX, high=FURTHEST_PX)
    return matched if matched.size else None

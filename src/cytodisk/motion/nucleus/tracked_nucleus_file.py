"""What a mapped frame's file holds of its tracked nucleus."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import astuple

import numpy as np

from cytodisk.array_archive import ArrayArchive, reading_arrays
from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ReadError
from cytodisk.motion.contour import Contour
from cytodisk.motion.registration import RigidTransform
from cytodisk.motion.tracked_nucleus import TrackedNucleus, nucleus_contour
from cytodisk.motion.tracking import TrackedBoundary

REMEDY = "run cytodisk movie again"
FURTHEST_PX = 1e8  # along an outline, or from a frame to the movie's first
MOST_FRAMES = 10**6


def nucleus_arrays(nucleus: TrackedNucleus) -> dict[str, FloatArray]:
    """Arrays of a tracked nucleus for the file of its frame.

    Parameters
    ----------
    nucleus : TrackedNucleus
    """
    boundary = nucleus.boundary
    return {
        "nucleus_track_s": boundary.s,
        "nucleus_track_transforms": np.array([astuple(boundary.transform), astuple(boundary.alignment)]),
        "nucleus_track_numbers": np.array([boundary.residual_px, nucleus.twist]),
        "nucleus_track_times": np.array(
            [boundary.frame, nucleus.reference.frame, boundary.order_violations, int(nucleus.unwound)]
        ),
        "nucleus_track_words": np.array([boundary.restarted, nucleus.held]),
    }


def load_nucleus(
    path: str | os.PathLike[str],
    disk: DiskMap,
    cell: TrackedBoundary,
    reference_in: Callable[[int], TrackedBoundary],
) -> TrackedNucleus:
    """Read the tracked nucleus of a frame.

    Parameters
    ----------
    path : path-like
    disk : DiskMap
        The frame's.
    cell : TrackedBoundary
        The frame's membrane.
    reference_in : callable
        Gives the nuclear outline of another frame, in the movie's common frame.

    Returns
    -------
    TrackedNucleus
        Bit for bit as it was saved.

    Raises
    ------
    ReadError
        The file is missing, damaged, or holds no tracked nucleus.
    """
    contour = nucleus_contour(disk)
    with _reading(path) as archive:
        boundary, reference = _boundary(archive, cell.alignment.of(contour))
        twist = float(archive.floats("nucleus_track_numbers", (2,), low=-FURTHEST_PX, high=FURTHEST_PX)[1])
        unwound = bool(archive.integers("nucleus_track_times", (4,), least=0, most=MOST_FRAMES)[3])
        held = archive.texts("nucleus_track_words", (2,))[1]
    before = boundary if reference == boundary.frame else reference_in(reference)
    return TrackedNucleus(boundary, before, contour, twist, unwound, held)


def load_nucleus_boundary(
    path: str | os.PathLike[str], disk: DiskMap, cell: TrackedBoundary
) -> TrackedBoundary:
    """Read the tracked nuclear outline of a frame alone; as `load_nucleus`."""
    if disk.nucleus is None:
        raise ReadError(f"{path} holds no nucleus, but a frame after it has one: {REMEDY}")
    with _reading(path) as archive:
        return _boundary(archive, cell.alignment.of(nucleus_contour(disk)))[0]


def _reading(path: str | os.PathLike[str]) -> AbstractContextManager[ArrayArchive]:
    return reading_arrays(path, "the map of a movie's frame", REMEDY)


def _boundary(archive: ArrayArchive, contour: Contour) -> tuple[TrackedBoundary, int]:
    """The outline, and the number of the frame that it was registered to."""
    times = archive.integers("nucleus_track_times", (4,), least=0, most=MOST_FRAMES)
    number, reference, violations, _ = times.tolist()
    rows = archive.floats("nucleus_track_transforms", (2, 3), low=-FURTHEST_PX, high=FURTHEST_PX)
    transform, alignment = (RigidTransform(*row) for row in rows.tolist())
    residual = archive.floats("nucleus_track_numbers", (2,), low=-FURTHEST_PX, high=FURTHEST_PX)[0]
    boundary = TrackedBoundary(
        number,
        contour,
        tracked_places(archive, "nucleus_track_s", contour),
        transform,
        alignment,
        float(residual),
        violations,
        archive.texts("nucleus_track_words", (2,))[0],
    )
    return boundary, reference


def tracked_places(archive: ArrayArchive, name: str, contour: Contour) -> FloatArray:
    """Tracked points along a contour, in order through one turn."""
    s = archive.floats(name, (None,), low=-FURTHEST_PX, high=FURTHEST_PX)
    if len(s) < 3 or not (np.diff(s) > 0).all() or s[-1] - s[0] >= contour.length:
        raise archive.fault(name, "does not go once around the outline")
    return s

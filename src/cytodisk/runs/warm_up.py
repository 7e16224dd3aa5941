"""Compile the kernels that a run needs late, in a process beside it, while it compiles those it needs first.

What one process has compiled the other finds in Numba's folder. It is done on a disk and its fan of
triangles, which need none of the kernels that lead to a map.
"""

import gc
from dataclasses import replace

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.nucleus_report import NucleusReport
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.motion.contour import Contour
from cytodisk.motion.edge import edge_motion
from cytodisk.motion.tracking import first_boundary, follow
from cytodisk.motion.tracking_parameters import TrackingSettings
from cytodisk.windows.polar_windows import polar_windows

_CORNERS = 48


def warm_up(movie: bool, nuclei: bool = False) -> None:
    """Compile the kernels of windows, and of the motion of edges for a movie.

    Parameters
    ----------
    movie : bool
    nuclei : bool
        Whether cells have nuclei.
    """
    gc.disable()  # a sixth of the time of compiling goes into looking for garbage
    try:
        _warm_up(movie, nuclei)
    finally:
        gc.enable()


def _warm_up(movie: bool, nuclei: bool) -> None:
    angles = 2.0 * np.pi * np.arange(_CORNERS) / _CORNERS
    disk = _fan(8.0, angles)
    measured = _with_nucleus(8.0, angles) if nuclei else disk
    if not movie:
        _measure(measured)
        return
    bigger = _fan(9.0, angles)
    before = first_boundary(0, Contour.of_outline(disk.outline_yx), angles)
    after = follow(1, Contour.of_outline(bigger.outline_yx), before, before, TrackingSettings())
    _measure(measured)
    edge_motion(before, after, disk, bigger, 8)


def _measure(disk: DiskMap) -> tuple[FloatArray, dict[str, FloatArray]]:
    windows = polar_windows(3, 8, nucleus_layers=None if disk.nucleus is None else 2).on(disk)
    return windows.areas, windows.depth_columns


def _fan(radius: float, angles: FloatArray) -> DiskMap:
    """A disk that is mapped as it is."""
    around = np.stack([np.sin(angles), np.cos(angles)], axis=1)
    vertices = np.concatenate([around, np.zeros((1, 2))])
    first = np.arange(len(angles))
    triangles = np.stack([first, np.roll(first, -1), np.full_like(first, len(angles))], axis=1)
    y, x = np.mgrid[:25, :25] - 12.0
    mask, report = clean_mask(y**2 + x**2 < (radius - 0.5) ** 2)
    uv = np.ascontiguousarray(vertices[:, ::-1])
    return DiskMap(
        radius * vertices + 12.0,
        uv,
        triangles,
        first,
        PlacedMask.of(mask),
        report,
        "harmonic",
        "uniform",
        1.0,
        1.0,
        0,
        True,
    )


def _with_nucleus(radius: float, angles: FloatArray) -> DiskMap:
    """A disk with a nucleus of half its radius that is mapped as it is."""
    fan, count = _fan(radius, angles), len(angles)
    first = np.arange(count)
    following = np.roll(first, -1)
    ring = (first, following, count + first), (following, count + following, count + first)
    core = count + first, count + following, np.full(count, 2 * count)
    triangles = np.concatenate([np.stack(corners, axis=1) for corners in (*ring, core)])
    inside = np.arange(3 * count) >= 2 * count
    crosses = (triangles % count == count - 1).any(axis=1) & ~inside  # the place where a turn ends
    turns = np.tile(first / count, 2)
    places = np.concatenate([np.column_stack([np.repeat([0.0, 1.0], count), turns]), np.zeros((1, 2))])
    nucleus = Nucleus(
        0.5,
        count + first,
        inside,
        places,
        ((triangles % count == 0) & crosses[:, None]).astype(np.int64),
        _round_mask(0.5 * radius),
        NucleusReport(1),
    )
    around, centre = fan.vertices_yx[:-1], fan.vertices_yx[-1:]
    vertices = np.concatenate([around, 0.5 * (around + centre), centre])
    uv = np.ascontiguousarray((vertices - centre)[:, ::-1]) / radius
    return replace(fan, vertices_yx=vertices, vertices_uv=uv, triangles=triangles, nucleus=nucleus)


def _round_mask(radius: float) -> PlacedMask:
    """A round mask in the middle of an image."""
    y, x = np.mgrid[:25, :25] - 12.0
    return PlacedMask.of(y**2 + x**2 < (radius - 0.5) ** 2)

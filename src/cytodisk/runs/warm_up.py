"""Compile the kernels that a run needs late, in a process beside it, while it compiles those it needs first.

What one process has compiled the other finds in Numba's folder. It is done on a disk and its fan of
triangles, which need none of the kernels that lead to a map.
"""

import gc

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.motion.contour import Contour
from cytodisk.motion.edge import edge_motion
from cytodisk.motion.tracking import first_boundary, follow
from cytodisk.motion.tracking_parameters import TrackingSettings
from cytodisk.windows.polar_windows import CellWindows, polar_windows

_CORNERS = 48


def warm_up(movie: bool) -> None:
    """Compile the kernels of windows, and of the motion of edges for a movie.

    Parameters
    ----------
    movie : bool
    """
    gc.disable()  # a sixth of the time of compiling goes into looking for garbage
    try:
        _warm_up(movie)
    finally:
        gc.enable()


def _warm_up(movie: bool) -> None:
    angles = 2.0 * np.pi * np.arange(_CORNERS) / _CORNERS
    disk = _fan(8.0, angles)
    if not movie:
        _measure(disk)
        return
    bigger = _fan(9.0, angles)
    before = first_boundary(0, Contour.of_outline(disk.outline_yx), angles)
    after = follow(1, Contour.of_outline(bigger.outline_yx), before, before, TrackingSettings())
    _measure(disk)
    edge_motion(before, after, disk, bigger, 8)


def _measure(disk: DiskMap) -> tuple[FloatArray, FloatArray]:
    windows = CellWindows(polar_windows(3, 8), disk)
    return windows.areas, windows.depths


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

"""Maps and windows of a study's cells, read when asked for, and their labels, kept within a bound."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from cytodisk.arrays import IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.napari.study_layers.byte_cache import ByteCache
from cytodisk.store.study import Study
from cytodisk.windows.polar_windows import CellWindows, PolarGrid
from cytodisk.windows.study_grid import StudyGrids

MAP_BYTES = 32 * 2**20
"""Of maps with their windows."""
LABEL_BYTES = 64 * 2**20
"""Of packed labels."""

_FASTEST = 1  # level of compression
_PER_PIXEL = 64  # bytes of windows: weights, subpixels and moments, about
_PER_ARRAY = 3  # a map's arrays, with those that it computes to locate points


@dataclass(frozen=True)
class LabelBox:
    """Labels of one cell's windows: number of the window + 1, and 0 outside.

    Attributes
    ----------
    slices : (slice, slice)
        Rows and columns of the box in the image.
    shape : (int, int)
    packed : bytes
    """

    slices: tuple[slice, slice]
    shape: tuple[int, int]
    packed: bytes

    @classmethod
    def of(cls, windows: CellWindows) -> LabelBox:
        """Labels of some windows."""
        slices = windows.placed_mask.slices
        labels = (windows.labels[slices] + 1).astype(np.int32)
        return cls(slices, labels.shape, zlib.compress(labels.tobytes(), _FASTEST))

    @property
    def labels(self) -> IntArray:
        """Number of the window + 1 in the box, shape (h, w)."""
        found: Any = np.frombuffer(zlib.decompress(self.packed), dtype=np.int32)
        return found.reshape(self.shape)  # type: ignore[no-any-return]


class CellWindowsCache:
    """Maps, windows and labels of a study.

    Parameters
    ----------
    study : Study
    map_bytes, label_bytes : int
        How much is kept, about.
    """

    def __init__(self, study: Study, map_bytes: int = MAP_BYTES, label_bytes: int = LABEL_BYTES):
        self.study = study
        self._grids = StudyGrids(study.provenance)
        self._windows: ByteCache[CellWindows] = ByteCache(map_bytes, _size_of)
        self.boxes: ByteCache[LabelBox] = ByteCache(label_bytes, lambda box: len(box.packed))

    @property
    def grid(self) -> PolarGrid:
        """The study's windows on the disk; layers by depth have radii in each cell alone."""
        return self._grids.usual

    def windows_at(self, cell: int, frame: int) -> CellWindows:
        """Windows of a cell in a frame.

        Parameters
        ----------
        cell, frame : int

        Raises
        ------
        ReadError
            There is no map, as the row of the cell says, or it is damaged.
        """
        return self._windows.get((cell, frame), lambda: self._read(cell, frame))

    def _read(self, cell: int, frame: int) -> CellWindows:
        disk = self.study.map(cell, frame if self.study.is_movie else None)
        return self._grids.of(disk).on(disk)

    def map_at(self, cell: int, frame: int) -> DiskMap:
        """Map of a cell in a frame; see `windows_at`."""
        return self.windows_at(cell, frame).disk

    def box_at(self, cell: int, frame: int) -> LabelBox:
        """Labels of the windows of a cell in a frame; see `windows_at`."""
        return self.boxes.get((cell, frame), lambda: LabelBox.of(self.windows_at(cell, frame)))


def _size_of(windows: CellWindows) -> int:
    disk = windows.disk
    arrays = disk.vertices_yx.nbytes + disk.vertices_uv.nbytes + disk.triangles.nbytes
    return _PER_ARRAY * arrays + _PER_PIXEL * disk.placed_mask.box.size

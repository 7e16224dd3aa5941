"""Labels of all windows of a frame, and values of windows painted into the cell."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.errors import CytodiskError
from cytodisk.napari.study_layers.byte_cache import ByteCache
from cytodisk.napari.study_layers.cell_windows_cache import CellWindowsCache
from cytodisk.napari.study_layers.shown_cells import ShownCells
from cytodisk.napari.study_layers.window_values import WindowValues

FRAME_BYTES = 32 * 2**20
"""Of whole frames."""


class PaintedFrames:
    """Images of a source, made frame by frame.

    Parameters
    ----------
    cells : ShownCells
        With some map.
    windows : CellWindowsCache
    values : WindowValues
    """

    def __init__(self, cells: ShownCells, windows: CellWindowsCache, values: WindowValues):
        self.cells, self.windows, self.values = cells, windows, values
        self._frames: ByteCache[Any] = ByteCache(FRAME_BYTES, lambda image: int(image.nbytes))

    @cached_property
    def faults(self) -> dict[tuple[int, int], str]:
        """Why a cell that has a map cannot be shown, by cell and frame, of frames that were looked at."""
        return {}

    def shown(self, frame: int) -> list[int]:
        """Cells of a frame whose map and numbers can be read; of the others `faults` says why not."""
        return [cell for cell in self.cells.mapped.get(frame, ()) if self._can_be_read(cell, frame)]

    def _can_be_read(self, cell: int, frame: int) -> bool:
        if (cell, frame) in self.faults:
            return False
        try:
            self.windows.box_at(cell, frame)
            self.values.at(cell, frame)
        except CytodiskError as error:
            self.faults[cell, frame] = str(error)
            return False
        return True

    @cached_property
    def n_windows(self) -> int:
        """Windows a cell, by which labels of cells are offset."""
        return self.windows.grid.n_windows

    @cached_property
    def dtype(self) -> Any:
        """Of the labels: the smallest that holds all of them."""
        return np.uint16 if self.cells.most_places * self.n_windows < 2**16 - 1 else np.int32

    @property
    def shape(self) -> tuple[int, int]:
        """(H, W) of a frame."""
        shape = self.cells.image_shape
        assert shape is not None
        return shape

    def first_label(self, cell: int, frame: int) -> int:
        """Label of window 0 of a cell."""
        return 1 + self.cells.place(cell, frame) * self.n_windows

    def labels(self, frame: int) -> Any:
        """Number of the window + 1, plus the offset of its cell, shape (H, W); 0 where there is none."""
        return self._frames.get((frame, "labels"), lambda: self._labels(frame))

    def _labels(self, frame: int) -> Any:
        image = np.zeros(self.shape, dtype=self.dtype)
        for cell in self.shown(frame):
            box = self.windows.box_at(cell, frame)
            labels, part = box.labels, image[box.slices]
            np.add(labels, self.first_label(cell, frame) - 1, out=part, where=labels > 0, casting="unsafe")
        return image

    def painted(self, frame: int, channel: str) -> Any:
        """Mean of a channel in the window of each pixel, shape (H, W) and dtype float32; NaN outside."""
        number = self.values.channels.index(channel)
        return self.of_windows(
            frame, lambda cell: self.values.at(cell, frame)["mean"][number], np.float32(np.nan)
        )

    def of_windows(self, frame: int, values_of: Callable[[int], Any | None], nothing: Any) -> Any:
        """The number of the window of each pixel, shape (H, W).

        Parameters
        ----------
        frame : int
        values_of : callable
            Numbers of a cell, of shape (layers, sectors); None for a cell without.
        nothing : scalar
            Of all other pixels; its type is that of the image.
        """
        colours = np.full(1 + self.cells.most_places * self.n_windows, nothing)
        for cell in self.shown(frame):
            values = values_of(cell)
            if values is not None:
                first = self.first_label(cell, frame)
                colours[first : first + values.size] = values.ravel()
        return colours[self.labels(frame)]

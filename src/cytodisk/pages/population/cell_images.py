"""The signal around single cells of a study, read from the files that it was measured in."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from cytodisk.arrays import AnyArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import CytodiskError
from cytodisk.images.signal_files import SignalFrame, open_image
from cytodisk.runs.map.input_files import FoundInputs, find_inputs
from cytodisk.store.inputs.study_signal import FoundSignal, find_signal
from cytodisk.store.study import Study

_MARGIN = 0.6  # of a cell's longer side, on each side of it


class CellImages:
    """Pieces of a study's images.

    Parameters
    ----------
    study : Study
        Of `cytodisk map` or `cytodisk movie`.

    Attributes
    ----------
    fault : str
        Why there are none; empty if there are, or nobody asked yet.
    """

    def __init__(self, study: Study) -> None:
        self.study = study
        self.fault = ""

    def around(self, disk: DiskMap, cell: int, frame: int, channel: str) -> tuple[DiskMap, AnyArray] | None:
        """The signal around a cell, and its map placed in that piece; None where it cannot be read.

        Parameters
        ----------
        disk : DiskMap
            As the study keeps it, in the whole image.
        cell : int
            Its number in the study.
        frame : int
            Number of the frame in its file.
        channel : str
        """
        if self.study.is_movie:
            return self._of_movie(disk, cell, frame, channel)
        image = self._image(cell, frame)
        if image is None:
            return None
        if channel not in image.channels:
            self.fault = f"{channel} is not a channel of the images"
            return None
        rows, columns = _box(disk)
        try:
            values = image.cut(rows, columns).values[image.channels.index(channel)]
        except CytodiskError as error:
            self.fault = str(error)
            return None
        return _placed(disk, rows, columns, values)

    def _of_movie(
        self, disk: DiskMap, cell: int, frame: int, channel: str
    ) -> tuple[DiskMap, AnyArray] | None:
        found = self._movie
        self.fault = found.fault or ("" if found.source is not None else "the study has no signal")
        if found.source is None:
            return None
        activity = self.study.activity(cell)
        names = [str(name) for name in activity["channel"].to_numpy()] if "channel" in activity else []
        if channel not in names:
            self.fault = f"{channel} is not a channel of the images"
            return None
        rows, columns = _box(disk)
        try:
            values = found.source.frame(frame)[names.index(channel)]
        except CytodiskError as error:
            self.fault = str(error)
            return None
        return _placed(disk, rows, columns, values[rows, columns])

    def _image(self, cell: int, frame: int) -> SignalFrame | None:
        found = self._inputs
        self.fault = found.fault
        if found.inputs is None:
            return None
        rows = self.study.cells[self.study.cells["cell"] == cell]
        name = str(rows["source"].iloc[0]) if "source" in rows else found.inputs.sources[0].name
        signal = found.inputs.signals.get(name)
        if signal is None or signal.file is None:
            self.fault = f"{name} has no image"
            return None
        opened = open_image(signal.file, frame)
        if isinstance(opened, CytodiskError):
            self.fault = str(opened)
            return None
        return opened

    @cached_property
    def _inputs(self) -> FoundInputs:
        return find_inputs(self.study)

    @cached_property
    def _movie(self) -> FoundSignal:
        return find_signal(self.study)


def _box(disk: DiskMap) -> tuple[slice, slice]:
    """Rows and columns of a cell and what is around it, within the image."""
    outline = disk.outline_yx
    low, high = outline.min(axis=0), outline.max(axis=0)
    room = _MARGIN * float((high - low).max()) + 2.0
    shape = np.array(disk.placed_mask.image_shape)
    top, left = np.maximum(np.floor(low - room), 0).astype(int).tolist()
    bottom, right = np.minimum(np.ceil(high + room) + 1, shape).astype(int).tolist()
    return slice(top, bottom), slice(left, right)


def _placed(disk: DiskMap, rows: slice, columns: slice, values: AnyArray) -> tuple[DiskMap, AnyArray]:
    return disk.placed((-rows.start, -columns.start), values.shape), values

"""The way of all runs over cells: a few of one image go to a worker and into a file together."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice
from typing import Any, TypeAlias

import xarray as xr

from cytodisk.errors import CytodiskError
from cytodisk.images.mask_files import MaskImage, SourceCell, list_images
from cytodisk.images.signal_files import load_image
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.runs.executor import Executor
from cytodisk.runs.run_options import Progress
from cytodisk.store.study_folder import StudyFolder, part_key


@dataclass(frozen=True)
class CellTask:
    """One cell with its signal.

    Attributes
    ----------
    found : SourceCell
    signal : DataArray with dims (channel, y, x), or None
        Cut out as the cell's mask is.
    fault : CytodiskError or None
        Why the signal cannot be used.
    image : DataArray with dims (channel, y, x), or None
        The whole image, for a cell that is drawn.
    drawn : bool
    """

    found: SourceCell
    signal: xr.DataArray | None = None
    fault: CytodiskError | None = None
    image: xr.DataArray | None = None
    drawn: bool = False


Rows: TypeAlias = list[tuple[dict[str, Any], dict[str, dict[str, Any]]]]
"""Rows of the table of cells, each with what goes into the other tables, as columns."""

Work: TypeAlias = Callable[[CellTask], Rows]


@dataclass(frozen=True)
class CellRun:
    """A run over the cells of mask files.

    Attributes
    ----------
    inputs : CellInputs
    work : callable
        What to do with a cell; can be pickled.
    at_once : int
        Cells in a part, at most.
    draw_at_most : int
        How many cells, from the first, are drawn.
    """

    inputs: CellInputs
    work: Work
    at_once: int
    draw_at_most: int = 0

    def fill(self, folder: StudyFolder, workers: int, progress: Progress) -> list[str]:
        """Work on all cells that are not done yet.

        Parameters
        ----------
        folder : StudyFolder
        workers : int
        progress : callable
            Called with (cells done, cells in all).

        Returns
        -------
        list of str
            Keys of all parts.
        """
        images = list_images(self.inputs.sources)
        sizes = {part_key(first): size for image in images for first, size in self._parts_of(image)}
        done, total = sum(size for key, size in sizes.items() if folder.has(key)), sum(sizes.values())
        pending = {key for key in sizes if not folder.has(key)}
        progress(done, total)
        write = partial(_work_on_part, work=self.work, folder=folder.for_workers())
        with Executor(min(workers, max(1, len(pending)))) as executor:
            for size in executor.each(write, self._pending_parts(images, pending)):
                done += size
                progress(done, total)
        return list(sizes)

    def _parts_of(self, image: MaskImage) -> Iterator[tuple[int, int]]:
        """First cell and number of cells of each part: always the same, so that a stopped run can go on."""
        for start in range(0, image.n_cells, self.at_once):
            yield image.first_cell + start, min(self.at_once, image.n_cells - start)

    def _pending_parts(self, images: Sequence[MaskImage], pending: set[str]) -> Iterator[list[CellTask]]:
        """Cells by part; an image of which all is done is not read."""
        for image in images:
            if pending.isdisjoint(part_key(first) for first, _ in self._parts_of(image)):
                continue
            signal = self.inputs.signals[image.source.name]
            loaded = signal.fault or load_image(signal.file, image.frame)
            cells = image.cells()
            while part := list(islice(cells, self.at_once)):
                if part_key(part[0].cell) in pending:
                    yield [self._task(found, loaded) for found in part]

    def _task(self, found: SourceCell, loaded: xr.DataArray | CytodiskError | None) -> CellTask:
        drawn = found.cell < self.draw_at_most
        if isinstance(loaded, CytodiskError):
            return CellTask(found, None, loaded, None, drawn)
        if loaded is None or found.mask is None:
            return CellTask(found, drawn=drawn)
        (y, x), (height, width) = found.corner, found.mask.shape
        # A copy, so that a waiting cell does not hold its whole image.
        signal = loaded[:, y : y + height, x : x + width].copy()
        return CellTask(found, signal, None, loaded if drawn else None, drawn)


def _work_on_part(cells: Sequence[CellTask], work: Work, folder: StudyFolder) -> int:
    """Rows of a part's cells into the folder; how many cells there were."""
    rows = [row for task in cells for row in work(task)]
    folder.add_cells(part_key(cells[0].found.cell), rows)
    return len(cells)

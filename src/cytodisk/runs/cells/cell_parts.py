"""The way of all runs over cells: a few of one image go to a worker and into a file together."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any, TypeAlias

from cytodisk.errors import CytodiskError, ReadError, as_data
from cytodisk.files import flushed_later
from cytodisk.images.frame_pixels import FramePixels
from cytodisk.images.mask_files import MaskImage, SourceCell, list_images
from cytodisk.images.nuclei.frame_matches import FrameMatches
from cytodisk.images.signal_files import SignalFrame, SignalPiece, open_image
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.runs.cells.cell_nuclei import CellNucleus, with_nucleus
from cytodisk.runs.executor import Executor
from cytodisk.runs.run_options import Progress
from cytodisk.store.study_folder import StudyFolder, part_key


@dataclass(frozen=True)
class CellTask:
    """One cell with its signal.

    Attributes
    ----------
    found : SourceCell
    signal : SignalPiece or None
        Cut out as the cell's mask is.
    fault : CytodiskError or None
        Why the signal cannot be used.
    image : SignalPiece or None
        The whole image, or of a large one what lies around the cell, for a cell that is drawn.
    image_corner : (int, int)
        (row, column) of its first pixel in the whole image.
    drawn : bool
    nucleus : CellNucleus or None
        None without nuclei.
    """

    found: SourceCell
    signal: SignalPiece | None = None
    fault: CytodiskError | None = None
    image: SignalPiece | None = None
    image_corner: tuple[int, int] = (0, 0)
    drawn: bool = False
    nucleus: CellNucleus | None = None


Rows: TypeAlias = list[tuple[dict[str, Any], dict[str, dict[str, Any]]]]
"""Rows of the table of cells, each with what goes into the other tables, as columns."""


Work: TypeAlias = Callable[[CellTask], Rows]
Files: TypeAlias = Callable[[CellTask], list[Path]]


def no_files(_task: CellTask) -> list[Path]:
    """Of a run that writes nothing but rows."""
    return []


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
    files : callable
        What `work` may write for a cell beside its rows; can be pickled.
    """

    inputs: CellInputs
    work: Work
    at_once: int
    draw_at_most: int = 0
    files: Files = no_files

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
        folder.expect(sizes)
        done, total = sum(size for key, size in sizes.items() if folder.has(key)), sum(sizes.values())
        pending = {key for key in sizes if not folder.has(key)}
        progress(done, total)
        write = partial(_work_on_part, work=self.work, files=self.files, folder=folder.for_workers())
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
            loaded = signal.fault or open_image(signal.file, image.frame)
            nuclei = self.inputs.nuclei.get(image.source.name)
            matches = None if nuclei is None else nuclei.matches(image.source, image.frame)
            cells = image.cells()
            while part := list(islice(cells, self.at_once)):
                if part_key(part[0].cell) in pending:
                    yield [self._task(found, loaded, matches, image.first_cell) for found in part]

    def _task(
        self,
        found: SourceCell,
        loaded: SignalFrame | CytodiskError | None,
        matches: FrameMatches | CytodiskError | None,
        first_cell: int,
    ) -> CellTask:
        nucleus = None
        if matches is not None:
            found, nucleus = with_nucleus(found, matches, found.cell == first_cell)
        task = CellTask(found, drawn=found.cell < self.draw_at_most, nucleus=nucleus)
        if isinstance(loaded, CytodiskError):
            return replace(task, fault=loaded)
        if loaded is None or found.mask is None:
            return task
        (y, x), (height, width) = found.corner, found.mask.shape
        box = slice(y, y + height), slice(x, x + width)
        try:
            task = replace(task, signal=loaded.cut(*box))
        except ReadError as fault:
            return replace(task, fault=as_data(fault))
        if not task.drawn:
            return task
        rows, columns = _around(box, loaded.pixels)
        try:
            return replace(task, image=loaded.cut(rows, columns), image_corner=(rows.start, columns.start))
        except ReadError:  # what is damaged lies around the cell, whose own pixels can be drawn
            return replace(task, image=task.signal, image_corner=found.corner)


def _around(box: tuple[slice, slice], pixels: FramePixels) -> tuple[slice, slice]:
    """All of a frame in memory; of a larger one the box and as much again on each side."""
    rows, columns = (
        slice(0, size)
        if pixels.is_whole
        else slice(max(0, 2 * side.start - side.stop), min(size, 2 * side.stop - side.start))
        for side, size in zip(box, pixels.image_shape, strict=True)
    )
    return rows, columns


def _work_on_part(cells: Sequence[CellTask], work: Work, files: Files, folder: StudyFolder) -> int:
    """Rows of a part's cells into the folder; how many cells there were."""
    key, expected = part_key(cells[0].found.cell), [file for task in cells for file in files(task)]
    with flushed_later():
        folder.begin(key, expected)
        rows = [row for task in cells for row in work(task)]
        folder.add_cells(key, rows, [file for file in expected if file.exists()])
    return len(cells)

"""The studies that the cells of a population are from: their grid, maps and images."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd

from cytodisk.analysis.shape.features import shape_features
from cytodisk.analysis.shape.medoid_cell import medoid_cell
from cytodisk.arrays import AnyArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import CytodiskError, EarlierVersionWarning, ReadError
from cytodisk.pages.population.cell_images import CellImages
from cytodisk.store.study import Study, open_study
from cytodisk.windows.polar_windows import CellWindows, PolarGrid
from cytodisk.windows.study_grid import polar_grid_of

_MOST_SHAPES = 120  # cells among which the representative one is chosen
_RADIUS = 0.5  # of a nucleus in the disk, where no study says it


class CellSources:
    """Maps of the cells of a population, from the studies that they are from.

    Parameters
    ----------
    cells : DataFrame
        With the columns study and number, and shift where cells were turned; rows are counted from 0.
    used : ndarray of dtype int
        Rows of the cells among which grid and representative cell are looked for.

    Attributes
    ----------
    note : str
        What of the grid had to be guessed; empty if nothing.
    """

    def __init__(self, cells: pd.DataFrame, used: IntArray) -> None:
        self.cells, self.used = cells, used
        self.note = self.image_fault = ""
        self._studies: dict[str, Study | str] = {}
        self._images: dict[str, CellImages] = {}

    def study(self, row: int) -> Study:
        """The study that a cell is from.

        Raises
        ------
        ReadError
            It is not there, or is not one of maps.
        """
        if "study" not in self.cells or "number" not in self.cells:
            raise ReadError("the table of cells does not say which studies the cells are from")
        path = str(self.cells["study"].iloc[row])
        if path not in self._studies:
            self._studies[path] = _opened(path)
        found = self._studies[path]
        if isinstance(found, str):
            raise ReadError(found)
        return found

    def disk(self, row: int) -> DiskMap:
        """The map of a cell; of a movie that of the middle one of its frames.

        Raises
        ------
        ReadError
            It was not kept, or the study is not there.
        """
        study, number = self.study(row), int(self.cells["number"].iloc[row])
        return study.map(number, self.frame(row)) if study.is_movie else study.map(number)

    def windows(self, row: int) -> CellWindows:
        """The windows of a cell.

        Raises
        ------
        CytodiskError
            Its map is not there, or does not go with the grid of its study.
        """
        return polar_grid_of(self.study(row).provenance).on(self.disk(row))

    def image(self, row: int, channel: str, disk: DiskMap) -> tuple[DiskMap, AnyArray | None]:
        """The signal around a cell with the map placed in it; without the image the map as it is."""
        study = self.study(row)
        images = self._images.setdefault(str(study.path), CellImages(study))
        frame = self.frame(row)
        found = images.around(disk, int(self.cells["number"].iloc[row]), frame, channel)
        self.image_fault = images.fault or self.image_fault
        return (disk, None) if found is None else found

    def frame(self, row: int) -> int:
        """Number of the frame that a cell is drawn in; of a movie the middle one of those with a map.

        Raises
        ------
        ReadError
            No frame of the movie has a map.
        """
        study, number = self.study(row), int(self.cells["number"].iloc[row])
        if not study.is_movie:
            frames = study.cells.loc[study.cells["cell"] == number, "frame"]
            return int(frames.iloc[0]) if len(frames) else 0
        own = study.cells[(study.cells["cell"] == number) & (study.cells["status"] == "ok")]
        frames = own["frame"]
        if frames.empty:
            raise ReadError(f"cell {number} of {study.path} has no frame with a map")
        return int(frames.iloc[len(frames) // 2])

    def shift(self, row: int) -> int:
        """Sector of the cell that is sector 0 of the population."""
        if "shift" not in self.cells:
            return 0
        return int(np.nan_to_num(float(self.cells["shift"].iloc[row])))

    def name(self, row: int) -> str:
        """Name of a cell."""
        return str(self.cells["cell"].iloc[row])

    def grid(self, layers: int, sectors: int, nucleus_layers: int) -> PolarGrid:
        """The grid on the disk, with the radii of one cell where they differ between cells."""
        for row in self._some_rows():
            try:
                grid = polar_grid_of(self.study(row).provenance)
                if not grid.has_radii:
                    grid = self.windows(row).grid
            except CytodiskError:
                continue
            if (grid.layers, grid.sectors, grid.nucleus_layers) == (layers, sectors, nucleus_layers):
                return grid
            if layers == 1 and grid.sectors == sectors:  # what is of the edge, such as its velocity
                return grid
        self.note = "the studies of the cells are not there: all layers are drawn with equal areas"
        return PolarGrid(
            layers, sectors, nucleus_layers=nucleus_layers, nucleus_radius=_RADIUS if nucleus_layers else None
        )

    @cached_property
    def representative(self) -> int | None:
        """Row of the cell whose shape is most like all others; None if no map can be read.

        Among many cells, some at even steps through the table are compared.
        """
        rows, tables = [], []
        for row in self._some_rows():
            try:
                disk = self.disk(row)
            except CytodiskError:
                continue
            rows.append(row)
            tables.append(shape_features(disk.placed_mask.box, pixel_size_um=disk.scale.pixel_size_um))
        if not rows:
            return None
        features = pd.concat(tables, ignore_index=True)
        return rows[medoid_cell(features)]

    @cached_property
    def missing(self) -> str:
        """Why no map of a cell can be read; empty if one can."""
        words = "no cell has a map"
        for place, row in enumerate(self._some_rows()):
            try:
                self.disk(row)
            except CytodiskError as error:
                words = words if place else str(error)
            else:
                return ""
        return words

    def _some_rows(self) -> Iterator[int]:
        count = len(self.used)
        chosen = np.linspace(0, count - 1, min(count, _MOST_SHAPES)).astype(np.int64)
        yield from self.used[np.unique(chosen)].tolist()


def _opened(path: str) -> Study | str:
    """A study, or why it cannot be read."""
    if not Path(path).exists():
        return f"{path} is not there any more"
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", EarlierVersionWarning)  # said when the population was made
            return open_study(path)
    except CytodiskError as error:
        return str(error)

"""Pictures of single cells: pixels of each channel, the window of each pixel, and the windows' numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import CytodiskError, ReadError
from cytodisk.images.mask_files import MaskImage, SourceCell, list_images
from cytodisk.images.signal_files import SignalFrame, open_image
from cytodisk.pages.report.boxes import Box, box_between
from cytodisk.pages.report.cells.window_numbers import WindowNumbers
from cytodisk.pages.report.encode import pack_floats, pack_labels, pack_picture
from cytodisk.pages.report.pictures import (
    OUTSIDE,
    grey_picture,
    picture_limits,
    resampled,
    window_labels,
)
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.store.study import Study
from cytodisk.store.study_folder import part_key
from cytodisk.store.study_kind import MAPS
from cytodisk.windows.polar_windows import PolarGrid
from cytodisk.windows.study_grid import StudyGrids

LONGEST_SIDE = 320
"""Of a picture, in its own pixels."""


@dataclass(frozen=True, eq=False)
class CellPictures:
    """Encoder of a study's cells.

    Attributes
    ----------
    study : Study
    inputs : CellInputs or None
        Without them there are windows alone, and no picture of a cell without a map.
    numbers : WindowNumbers
        Of the cells to show.
    """

    study: Study
    inputs: CellInputs | None
    numbers: WindowNumbers

    def of(
        self, cells: Sequence[int], progress: Callable[[int, int], None] | None = None
    ) -> Iterator[tuple[int, dict[str, Any] | None]]:
        """Pictures of some cells, one after the other, with the number of the cell.

        Parameters
        ----------
        cells : sequence of int
            In the order of the table.
        progress : callable, optional
            Called with the number of cells done and that of all.

        Yields
        ------
        (int, dict or None)
            The cell, and what `page.decode` takes; None where there is nothing to show of it.
        """
        done = 0
        for image, numbers in self._images(cells):
            loaded, masks = self._loaded(image), self._masks(image, numbers)
            for cell in numbers:
                yield cell, self._picture(cell, loaded, masks.get(cell))
                done += 1
                if progress is not None:
                    progress(done, len(cells))

    def _images(self, cells: Sequence[int]) -> Iterator[tuple[MaskImage | None, list[int]]]:
        """The images that cells lie in, each with those cells."""
        if self.inputs is None:
            yield None, list(cells)
            return
        wanted = set(cells)
        for image in list_images(self.inputs.sources):
            there = range(image.first_cell, image.first_cell + image.n_cells)
            if numbers := sorted(wanted.intersection(there)):
                yield image, numbers

    def _loaded(self, image: MaskImage | None) -> SignalFrame | None:
        if self.inputs is None or image is None:
            return None
        signal = self.inputs.signals[image.source.name]
        found = None if signal.fault else open_image(signal.file, image.frame)
        return None if isinstance(found, CytodiskError) else found  # whose cells have a row that says why

    def _masks(self, image: MaskImage | None, cells: Sequence[int]) -> dict[int, SourceCell]:
        """Masks of those cells that have no map; the file is not read if there are none."""
        if image is None or all(map(self._has_map, cells)):
            return {}
        return {found.cell: found for found in image.cells()}

    def _picture(
        self, cell: int, loaded: SignalFrame | None, found: SourceCell | None
    ) -> dict[str, Any] | None:
        if self._has_map(cell):
            disk = self.study.map(cell)
            outline, shape = disk.outline_yx, disk.placed_mask.image_shape
            box = box_between(outline.min(axis=0), outline.max(axis=0), shape, LONGEST_SIDE)
            grid = self.grids.of(disk)
            labels, radii = window_labels(disk, grid, box), self._radii(grid, disk)
        elif found is not None and (mask := _mask_of(found)) is not None:
            box, labels = _mask_labels(mask, found)
            radii = None
        else:
            return None
        return {
            "shape": list(box.shape),
            "box": [box.top, box.left, box.height, box.width],
            "labels": pack_labels(labels),
            "windows": self._has_map(cell),  # else labels tell the mask alone
            "plain": self._has_map(cell) and grid is not self.grids.usual,
            "numbers": self._numbers(cell) if self._has_map(cell) or self.grids.usual.has_radii else None,
            "radii": radii,
            **_channels(loaded, box),
        }

    def _numbers(self, cell: int) -> dict[str, Any] | None:
        found = self.numbers.by_cell.get(cell)
        return found and {name: pack_floats(_short(values)) for name, values in found.items()}

    def _radii(self, grid: PolarGrid, disk: DiskMap) -> list[float] | None:
        """Of cells with radii of their own."""
        if grid is self.grids.usual and grid.has_radii:
            return None
        return [float(radius) for radius in grid.on(disk).grid.radii]

    @cached_property
    def grids(self) -> StudyGrids:
        """The windows on the disk."""
        return StudyGrids(self.study.provenance)

    def _has_map(self, cell: int) -> bool:
        return cell in self.mapped

    @cached_property
    def mapped(self) -> set[int]:
        """Cells whose map is in the study."""
        rows = self.study.cells
        cells = rows.loc[rows["status"] == "ok", "cell"].tolist()
        maps = self.study.path / MAPS
        return {cell for cell in cells if (maps / f"cell_{part_key(cell)}.npz").is_file()}


def _mask_of(found: SourceCell) -> BoolArray | None:
    """Pixels of a cell, also where it was refused; None if there are none."""
    pixels = found.refused if found.mask is None else found.mask
    return np.asarray(pixels) != 0 if pixels is not None and np.any(pixels) else None


def _mask_labels(mask: BoolArray, found: SourceCell) -> tuple[Box, Any]:
    """A box around a cell without a map, and 0 where its mask is."""
    corner = np.array(found.corner)
    places = np.argwhere(mask)
    box = box_between(
        places.min(axis=0) + corner, places.max(axis=0) + corner, found.image_shape, LONGEST_SIDE
    )
    y, x = (
        np.floor(along + 0.5).astype(int) - first for along, first in zip(box.axes_yx, corner, strict=True)
    )
    whole = np.pad(mask, 1)
    rows, columns = (np.clip(place + 1, 0, size - 1) for place, size in zip((y, x), whole.shape, strict=True))
    return box, np.where(whole[np.ix_(rows, columns)], 0, OUTSIDE)


def _channels(loaded: SignalFrame | None, box: Box) -> dict[str, Any]:
    """Pixels of each channel as a picture, with the values of its black and white."""
    nothing: dict[str, Any] = {"channels": None, "limits": None}
    if loaded is None:
        return nothing
    rows, columns = slice(box.top, box.top + box.height), slice(box.left, box.left + box.width)
    try:
        values = loaded.cut(rows, columns).values
    except ReadError:  # a damaged image has its row and its flag in the study
        return nothing
    own = replace(box, top=0, left=0)
    limits = [picture_limits([resampled(image, own)]) for image in values]
    pairs = zip(values, limits, strict=True)
    return {
        "channels": [pack_picture(grey_picture(image, own, *pair)) for image, pair in pairs],
        "limits": limits,
    }


def _short(values: Any) -> Any:
    """Numbers to about four digits, which take half as much room."""
    bits = np.asarray(values, dtype=np.float32).view(np.uint32)
    rounded = (bits + np.uint32(0x400)) & np.uint32(0xFFFFF800)
    return np.where(np.isfinite(values), rounded, bits).astype(np.uint32).view(np.float32)


def size_of(picture: dict[str, Any] | None) -> int:
    """Length of an encoded picture as text."""
    if picture is None:
        return 0
    numbers = sum(len(one["data"]) for one in (picture["numbers"] or {}).values())
    return len(picture["labels"]) + sum(map(len, picture["channels"] or [])) + numbers


def means_limits(numbers: WindowNumbers) -> list[Any]:
    """Means of windows by channel, of all cells that are kept, to choose colours from."""
    found = [one["mean"] for one in numbers.by_cell.values()]
    return [np.concatenate([values[k] for values in found]) for k in range(len(numbers.channels)) if found]

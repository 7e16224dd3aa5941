"""What an image of a study holds, as arrays and polygons with the numbers that link them to tables."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
import shapely

from cytodisk.arrays import AnyArray, IntArray
from cytodisk.errors import ReadError
from cytodisk.memory import free_bytes
from cytodisk.store.inputs.study_images import StudyImages
from cytodisk.store.spatial.place_parameters import SpatialParameters
from cytodisk.store.spatial.study_places import MappedStudy, PlacedCell, StudyImage
from cytodisk.windows.window_features import area_within

Number = TypeVar("Number", int, IntArray)

_BYTES_A_WINDOW = 5000  # its polygon of about a hundred points, and its row: measured
_SHARE = 0.5  # of free memory


@dataclass
class Shapes:
    """Polygons, with a number and numbers of their own for each.

    Attributes
    ----------
    numbers : list of int
        Instances: they link a polygon to its pixels and to its row in a table.
    polygons : list of Polygon or MultiPolygon
        (x, y) in pixels from the image's corner.
    columns : dict of str to list of int
        As "cell".
    """

    numbers: list[int] = field(default_factory=list)
    polygons: list[shapely.Polygon | shapely.MultiPolygon] = field(default_factory=list)
    columns: dict[str, list[int]] = field(default_factory=dict)

    def add(self, number: int, polygon: shapely.Polygon | shapely.MultiPolygon, **columns: int) -> None:
        """Add one."""
        self.numbers.append(number)
        self.polygons.append(polygon)
        for name, value in columns.items():
            self.columns.setdefault(name, []).append(value)


@dataclass
class ImageParts:
    """The parts of one image.

    Attributes
    ----------
    image : ndarray of shape (C, H, W) or None
    cell_labels, window_labels : ndarray of shape (H, W)
        Number of the cell and of the window of each pixel, 0 for none.
    cells, windows, nuclei : Shapes
    """

    image: AnyArray | None
    cell_labels: IntArray
    window_labels: IntArray
    cells: Shapes = field(default_factory=Shapes)
    windows: Shapes = field(default_factory=Shapes)
    nuclei: Shapes = field(default_factory=Shapes)


def cell_number(cell: Number) -> Number:
    """What stands for a cell in labels, shapes and tables: 0 is the background."""
    return cell + 1


def window_number(cell: Number, window: Number, windows: int) -> Number:
    """What stands for a window, out of so many of a cell; the same in all frames of a movie."""
    return 1 + cell * windows + window


def parts_of(
    study: MappedStudy, image: StudyImage, images: StudyImages | None, with_windows: bool, n_windows: int
) -> ImageParts:
    """Read an image's cells, and its pixels where they are wanted.

    Parameters
    ----------
    study : Study
    image : StudyImage
    images : StudyImages, optional
    with_windows : bool
    n_windows : int
        Of each cell of the study.

    Returns
    -------
    ImageParts

    Raises
    ------
    ReadError
        A map is not there, or the image is gone or of another size.
    """
    found: ImageParts | None = None
    for placed in image.cells(study):
        if found is None:
            found = _empty(placed.image_shape, int(image.rows["cell"].max()) + 1, n_windows)
        _add(found, placed, with_windows, n_windows)
    assert found is not None  # an image without cells is none of a study's
    if images is not None:
        found.image = images.frame(image.source, image.frame)
        if found.image.shape[1:] != found.cell_labels.shape:
            raise ReadError(
                f"the image of study {study.path} has {found.image.shape[1:]} pixels, its masks "
                f"{found.cell_labels.shape}: pass images=False (--no-images)"
            )
    return found


def _empty(shape: tuple[int, int], cells: int, n_windows: int) -> ImageParts:
    kind = np.int32 if 1 + cells * n_windows < 2**31 else np.int64
    return ImageParts(None, np.zeros(shape, dtype=np.int32), np.zeros(shape, dtype=kind))


def _add(found: ImageParts, placed: PlacedCell, with_windows: bool, n_windows: int) -> None:
    windows, cell = placed.windows, placed.cell
    number, (top, left) = cell_number(cell), placed.corner
    mask = windows.mask_without_holes
    height, width = mask.shape
    box = slice(top, top + height), slice(left, left + width)
    found.cell_labels[box][mask] = number
    found.cells.add(number, area_within(windows.outline_yx, placed.corner), cell=cell, label=placed.label)
    nucleus = windows.disk.nucleus_outline_yx
    if nucleus is not None:
        found.nuclei.add(number, area_within(nucleus, placed.corner), cell=cell)
    if not with_windows:
        return
    labels = windows.labels
    held = labels >= 0
    found.window_labels[box][held] = window_number(cell, 0, n_windows) + labels[held]
    for window, polygon in enumerate(windows.polygons()):
        if len(polygon):  # layers by depth that are deeper than the cell have none
            layer, sector = divmod(window, windows.sectors)
            number, area = window_number(cell, window, n_windows), area_within(polygon, placed.corner)
            found.windows.add(number, area, cell=cell, layer=layer, sector=sector)


def check_room(
    study: MappedStudy, images: Iterable[StudyImage], parameters: SpatialParameters, n_windows: int
) -> None:
    """Raise ReadError if what is wanted takes more than half of the free memory.

    Parameters
    ----------
    study : Study
    images : iterable of StudyImage
    parameters : SpatialParameters
    n_windows : int
        Of each cell.
    """
    wanted = list(images)
    cells = sum(len(image.rows) for image in wanted)
    first = wanted[0]
    cell, frame = int(first.rows["cell"].iloc[0]), first.frame if study.is_movie else None
    height, width = study.map(cell, frame).placed_mask.image_shape
    layers = 8 + (16 if parameters.images else 0)  # bytes a pixel: two labels, and some channels
    needed = layers * height * width * len(wanted)
    needed += cells * _BYTES_A_WINDOW * (n_windows if parameters.windows else 1)
    free = free_bytes()
    if needed > _SHARE * free:
        raise ReadError(
            f"study {study.path}: maps of cells: {cells}, images: {len(wanted)}; they take about "
            f"{needed / 1e9:.1f} GB, and "
            f"{free / 1e9:.1f} GB are free: choose some with frames=(first, last) or cells=(…), or pass "
            "windows=False or images=False (--frames, --cells, --no-windows, --no-images)"
        )

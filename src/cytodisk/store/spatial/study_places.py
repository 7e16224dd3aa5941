"""The cells of a study by the image that they lie in, and their windows there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

import pandas as pd

from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError, ReadError
from cytodisk.scale import Scale
from cytodisk.store.inputs.study_signal import MeasuredStudy
from cytodisk.store.spatial.place_parameters import PlaceParameters
from cytodisk.store.table_file import rows_of_cell
from cytodisk.windows.polar_windows import CellWindows, PolarGrid
from cytodisk.windows.study_grid import polar_grid_of


class MappedStudy(MeasuredStudy, Protocol):
    """What is asked of a study of `cytodisk map` or `cytodisk movie`."""

    @property
    def is_movie(self) -> bool: ...
    @property
    def scale(self) -> Scale: ...
    @property
    def windows(self) -> pd.DataFrame: ...
    @property
    def edge(self) -> pd.DataFrame: ...

    def map(self, cell: int, frame: int | None = None) -> DiskMap: ...


@dataclass(frozen=True)
class PlacedCell:
    """One cell in its image.

    Attributes
    ----------
    cell, label : int
        Its number in the study, and its value in the label image.
    windows : CellWindows
        In a box of the image that holds the cell and one pixel around it.
    corner : (int, int)
        (row, column) of the first pixel of that box in the image.
    image_shape : (int, int)
    """

    cell: int
    label: int
    windows: CellWindows
    corner: tuple[int, int]
    image_shape: tuple[int, int]


@dataclass(frozen=True)
class StudyImage:
    """One image of a study: a frame of a movie, or of a file of masks.

    Attributes
    ----------
    name : str
        In names of files and elements, as "frame_012"; empty where the study has one image alone.
    source : str
        Name of the mask file; empty for a movie.
    frame : int
    is_stack : bool
        Whether it is one of several frames.
    rows : DataFrame
        The cells with a map, out of the study's table.
    """

    name: str
    source: str
    frame: int
    is_stack: bool
    rows: pd.DataFrame

    def cells(self, study: MappedStudy) -> Iterator[PlacedCell]:
        """Its cells, each read from disk when asked for."""
        grid = polar_grid_of(study.provenance)
        for cell, label in zip(self.rows["cell"], self.rows["label"], strict=True):
            disk = study.map(int(cell), self.frame if study.is_movie else None)
            yield _placed(int(cell), int(label), disk, grid)


def _placed(cell: int, label: int, disk: DiskMap, grid: PolarGrid) -> PlacedCell:
    """A cell in its box: the border of the image, which is no edge of the cell, stays where it is."""
    rows, columns = disk.placed_mask.slices
    height, width = disk.placed_mask.image_shape
    top, left = max(rows.start - 1, 0), max(columns.start - 1, 0)
    shape = min(rows.stop + 1, height) - top, min(columns.stop + 1, width) - left
    if disk.nucleus is None and grid.nucleus_layers:  # mapped without, as missing="plain" says
        layers = grid.layers - grid.nucleus_layers
        grid = replace(grid, layers=layers, nucleus_layers=0, nucleus_radius=None)
    windows = grid.on(disk.placed((-top, -left), shape))
    return PlacedCell(cell, label, windows, (top, left), (height, width))


def images_of(study: MappedStudy, places: PlaceParameters) -> list[StudyImage]:
    """The images that hold the chosen cells in the chosen frames.

    Parameters
    ----------
    study : Study
    places : PlaceParameters

    Returns
    -------
    list of StudyImage
        In the order of the table of cells; without those that hold no cell with a map.

    Raises
    ------
    ReadError
        A chosen cell is not there, or no chosen cell has a map.
    ParameterError
        The study has none of the frames.
    """
    rows = chosen_rows(study, places)
    ready = rows[rows["status"] == "ok"]
    if ready.empty:
        reason = rows["reason"].iloc[0] or rows["status"].iloc[0]
        raise ReadError(f"study {study.path} has no map of any of the chosen cells: {reason}")
    sources = ["source"] if "source" in ready else []
    named = _names(study.cells[[*sources, "frame"]], study.is_movie)
    found = []
    for key, group in ready.groupby([*sources, "frame"], sort=False):
        (name, is_stack), frame = named[key], int(group["frame"].iloc[0])
        found.append(StudyImage(name, str(key[0]) if sources else "", frame, is_stack, group))
    return found


def chosen_rows(study: MappedStudy, places: PlaceParameters) -> pd.DataFrame:
    """Rows of the table of cells that were chosen, with and without a map.

    Raises
    ------
    ReadError, ParameterError
        There is no such cell or frame.
    """
    rows = study.cells
    for cell in places.cells or ():
        rows_of_cell(study.cells, cell, study.path)
    if places.cells is not None:
        rows = rows[rows["cell"].isin(places.cells)]
    if places.frames is not None:
        first, last = places.frames
        there = rows[rows["frame"].between(first, last)]
        if there.empty:
            raise ParameterError(
                f"frames must be some of {rows['frame'].min()} to {rows['frame'].max()}, which study "
                f"{study.path} has, got {first}:{last}"
            )
        rows = there
    return rows


def left_out_words(study: MappedStudy, places: PlaceParameters) -> list[str]:
    """A sentence for each chosen cell that has no map, by frame."""
    rows = chosen_rows(study, places)
    lost = rows[rows["status"] != "ok"]
    where = lost["source"] if "source" in lost else lost["frame"].map("frame {}".format)
    return [
        f"cell {cell}, {place}: {reason or status}"
        for cell, place, reason, status in zip(
            lost["cell"], where, lost["reason"], lost["status"], strict=True
        )
    ]


def _names(images: pd.DataFrame, is_movie: bool) -> dict[Any, tuple[str, bool]]:
    """The name of each image of a study, and if it is one of several frames; by (source, frame)."""
    keys = list(images.drop_duplicates().itertuples(index=False, name=None))
    digits = max(3, len(str(images["frame"].max())))
    frames = {key: f"frame_{key[-1]:0{digits}}" for key in keys}
    if is_movie:
        return {key: (frames[key], True) for key in keys}
    stems = _plain_stems(list(dict.fromkeys(str(key[0]) for key in keys)))
    stacks = set(images.loc[images["frame"] > 0, "source"])
    return {
        key: (
            "_".join([stems[key[0]]] * (len(stems) > 1) + [frames[key]] * (key[0] in stacks)),
            key[0] in stacks,
        )
        for key in keys
    }


def _plain_stems(sources: list[str]) -> dict[str, str]:
    """Names of files without ending, in letters that names of elements may have, each unlike the others."""
    found: dict[str, str] = {}
    taken: set[str] = set()
    for source in sources:
        stem = re.sub(r"[^A-Za-z0-9._-]+", "_", Path(source).stem).lstrip("_") or "image"
        number, name = 1, stem
        while name.lower() in taken:
            number += 1
            name = f"{stem}-{number}"
        taken.add(name.lower())
        found[source] = name
    return found

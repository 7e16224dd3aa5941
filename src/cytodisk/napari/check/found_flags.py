"""What is wrong with masks or with a study: each kind once, with the places that have it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.errors import CytodiskError
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag
from cytodisk.store.study import Study

Point = tuple[float, float]

_AT_THE_EDGE = 0.97  # of the disk's radius


@dataclass(frozen=True)
class FlagPlace:
    """One place that is wrong.

    Attributes
    ----------
    frame : int or None
        Number of the frame; None for a cell as a whole.
    cell : str
        As "3", or "3 of a.tif".
    note : str
        What was found there.
    yx : (float, float) or None
        (row, column) in pixels; None where there is none to look at.
    """

    frame: int | None
    cell: str
    note: str = ""
    yx: Point | None = None


@dataclass(frozen=True)
class FoundFlag:
    """One kind of fault.

    Attributes
    ----------
    name : str
    finding : str
        A sentence.
    remedy : str
        What to do.
    meaning : str
        What it means for the results.
    places : tuple of FlagPlace
    """

    name: str
    finding: str
    remedy: str = ""
    meaning: str = ""
    places: tuple[FlagPlace, ...] = ()

    @property
    def words(self) -> str:
        """All that there is to read of it."""
        lines = [sentence(f"{self.name}: {self.finding}"), self.meaning]
        return " ".join(filter(None, [*lines, f"What to do: {self.remedy}" if self.remedy else ""]))


def sentence(words: str) -> str:
    """With a full stop at its end."""
    return words if words.endswith((".", "!", "?", "…")) else f"{words}."


def flags_of_study(
    study: Study,
    flags: Iterable[QCFlag],
    cells: pd.DataFrame,
    edge: Callable[[Place], Point | None] | None,
    *,
    has_time: bool = True,
) -> list[FoundFlag]:
    """The QC flags of a study, with places to look at.

    Parameters
    ----------
    study : Study
    flags : iterable of QCFlag
    cells : DataFrame
        Rows of the cells that are shown; others have no place.
    edge : callable, optional
        Where on the cell's edge a place is that names a sector.
    has_time : bool
        Whether frames are shown.

    Returns
    -------
    list of FoundFlag
    """
    places = _Centres(study, cells)
    of_cell = (
        dict(zip(study.cells["cell"], study.cells["source"], strict=True)) if "source" in study.cells else {}
    )
    many = len(set(of_cell.values())) > 1

    def place(one: Place) -> FlagPlace:
        yx = edge(one) if one.sector is not None and edge is not None else None
        yx = places.at(one.cell, one.frame) if yx is None else yx
        cell = f"{one.cell} of {of_cell[one.cell]}" if many and one.cell in of_cell else str(one.cell)
        frame = places.frame(one.cell) if one.frame is None else one.frame
        frame = frame if has_time else None
        note = one.note if one.other_frame is None else f"{one.frames_words}: {one.note}".removesuffix(": ")
        return FlagPlace(frame, cell, note, yx)

    return [
        FoundFlag(one.name, one.what, one.advice, one.meaning, tuple(place(each) for each in one.places))
        for one in flags
    ]


class _Centres:
    """Where the cells of a study lie."""

    def __init__(self, study: Study, cells: pd.DataFrame):
        self._movie = study.is_movie
        self._of: dict[int, tuple[Any, Any]] = {}
        rows = cells[["cell", "frame", "centroid_y", "centroid_x"]]
        for cell, held in rows.groupby("cell", sort=False):
            self._of[int(str(cell))] = (
                held["frame"].to_numpy(),
                held[["centroid_y", "centroid_x"]].to_numpy(float),
            )

    def frame(self, cell: int) -> int | None:
        """First frame of a cell; None for one that is not shown."""
        return int(self._of[cell][0][0]) if cell in self._of else None

    def at(self, cell: int, frame: int | None) -> Point | None:
        """Centre of a cell in a frame; without a map there, in the nearest frame that has one."""
        if cell not in self._of:
            return None
        frames, centres = self._of[cell]
        known = np.flatnonzero(np.isfinite(centres).all(axis=1))
        if not known.size:
            return None
        wanted = frames[0] if frame is None else frame
        y, x = centres[known[np.abs(frames[known] - wanted).argmin()]]
        return float(y), float(x)


def sector_place(shown: Any, place: Place, sectors: int) -> Point | None:
    """The middle of a sector on the edge of a cell; None where it has no map.

    Parameters
    ----------
    shown : ShownStudy
    place : Place
    sectors : int
        Of the study's grid.
    """
    if place.sector is None or place.frame is None:
        return None
    try:
        disk = shown.map_at(place.cell, place.frame)
    except CytodiskError:
        return None  # a frame without a map, which has a flag of its own
    angle = 2 * np.pi * (place.sector + 0.5) / sectors
    y, x = disk.to_cell([_AT_THE_EDGE * np.cos(angle), _AT_THE_EDGE * np.sin(angle)])
    return float(y), float(x)


def count_places(flags: Sequence[FoundFlag]) -> int:
    """How many places are wrong."""
    return sum(len(one.places) for one in flags)

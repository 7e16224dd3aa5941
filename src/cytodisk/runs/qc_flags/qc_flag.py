"""`QCFlag` and `Place`: a fault that a study shows, and where."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pandas as pd

from cytodisk.number_words import counted
from cytodisk.store.study import Study


@dataclass(frozen=True)
class Place:
    """Where a flag was raised.

    Attributes
    ----------
    cell : int
    frame : int or None
        Number of the frame; None for the cell as a whole, or a study without time.
    note : str
        What was found there, in words; empty if the flag says all.
    sector : int or None
        Where on the edge, if it is one place of it.
    other_frame : int or None
        The other frame of a pair, for what is between two frames.
    """

    cell: int
    frame: int | None
    note: str = ""
    sector: int | None = None
    other_frame: int | None = None

    @property
    def frames_words(self) -> str:
        """As "frame 4", or "frames 3 and 4"; empty for the cell as a whole."""
        if self.frame is None:
            return ""
        if self.other_frame is None:
            return f"frame {self.frame}"
        first, second = sorted((self.frame, self.other_frame))
        return f"frames {first} and {second}"


@dataclass(frozen=True)
class QCFlag:
    """One kind of fault that a study shows.

    Attributes
    ----------
    name : str
        Short and fixed, to be matched by programs, as "area jumps".
    what : str
        What was found and how often, as a sentence.
    meaning, advice : str
        What it means for the results, and what to do.
    places : tuple of Place
        Empty for a fault of the whole run.
    """

    name: str
    what: str
    meaning: str
    advice: str
    places: tuple[Place, ...] = ()


def places_of(rows: pd.DataFrame, note: Callable[[Any], str] | None = None) -> tuple[Place, ...]:
    """The cell and frame of each row, with a note where there is one to write."""
    rows = rows.copy(deep=False)
    rows.attrs = {}  # which pandas copies for each row
    frames = rows["frame"] if "frame" in rows else [None] * len(rows)
    return tuple(
        Place(int(row["cell"]), None if frame is None else int(frame), note(row) if note else "")
        for (_, row), frame in zip(rows.iterrows(), frames, strict=True)
    )


def frames_of(study: Study, number: int) -> str:
    """A number of rows of the table of cells in words: frames of a movie, or else cells."""
    return counted(number, "frame" if study.is_movie else "cell")


def mapped_rows(study: Study) -> pd.DataFrame:
    """Rows of the cells and frames that have a map."""
    return study.cells[study.cells["status"] == "ok"]

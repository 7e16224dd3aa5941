"""Which cells of a study are in which frame of a recording or of a file of masks."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from cytodisk.errors import ParameterError
from cytodisk.store.study import Study
from cytodisk.store.study_folder import part_key
from cytodisk.store.study_kind import MAPS

_SHOWN = 8  # names in a message


@dataclass(frozen=True, eq=False)
class ShownCells:
    """The cells of one source.

    Attributes
    ----------
    study : Study
    source : str
        Name of the file of masks, in a study of single cells; empty for a movie.
    rows : DataFrame
        Rows of `study.cells` that are of this source.
    """

    study: Study
    source: str
    rows: pd.DataFrame

    @classmethod
    def of(cls, study: Study, source: str | None = None) -> ShownCells:
        """Cells of a source, by default the first one.

        Parameters
        ----------
        study : Study
        source : str, optional
            One of `sources_of`.

        Raises
        ------
        ParameterError
            There is no such source.
        """
        known = sources_of(study)
        chosen = known[0] if source is None else source
        if chosen not in known:
            more = f" and {len(known) - _SHOWN} more" if len(known) > _SHOWN else ""
            raise ParameterError(
                f"source must be a file of masks in study {study.path}, got {source!r}: "
                f"pass one of {', '.join(map(repr, known[:_SHOWN]))}{more}"
            )
        rows = study.cells if study.is_movie else study.cells[study.cells["source"] == chosen]
        return cls(study, chosen, rows)

    @cached_property
    def numbers(self) -> list[int]:
        """Numbers of its cells, in order."""
        return sorted({int(cell) for cell in self.rows["cell"]})

    @cached_property
    def n_frames(self) -> int:
        """Frames up to the last one that the study has a row of."""
        return int(self.rows["frame"].max()) + 1

    @cached_property
    def is_stack(self) -> bool:
        """Whether layers have an axis of time."""
        return self.study.is_movie or self.n_frames > 1

    @cached_property
    def mapped(self) -> dict[int, list[int]]:
        """Cells whose map is there, by frame, in the order of the table."""
        return self._by_frame(self._has_map)

    @cached_property
    def missing(self) -> dict[int, list[tuple[int, str]]]:
        """By frame, cells without a map, with the reason."""
        found: dict[int, list[tuple[int, str]]] = {}
        rows = self.rows[~self._has_map]
        for cell, frame, status, reason in zip(
            rows["cell"], rows["frame"], rows["status"], rows["reason"], strict=True
        ):
            words = f"{status}: {reason}" if status != "ok" else "its map was not kept"
            found.setdefault(int(frame), []).append((int(cell), words))
        return found

    @cached_property
    def _has_map(self) -> pd.Series[bool]:
        maps = self.study.path / MAPS
        there = {path.name for path in maps.iterdir()} if maps.is_dir() else set()
        movie = self.study.is_movie
        names = [
            f"cell_{part_key(int(cell), int(frame) if movie else None)}.npz"
            for cell, frame in zip(self.rows["cell"], self.rows["frame"], strict=True)
        ]
        files = pd.Series([name in there for name in names], index=self.rows.index, dtype=bool)
        return files & (self.rows["status"] == "ok")

    def _by_frame(self, chosen: pd.Series[bool]) -> dict[int, list[int]]:
        rows = self.rows[chosen]
        found: dict[int, list[int]] = {}
        for cell, frame in zip(rows["cell"], rows["frame"], strict=True):
            found.setdefault(int(frame), []).append(int(cell))
        return found

    @cached_property
    def _place(self) -> dict[int, int]:
        return {cell: place for place, cell in enumerate(self.numbers)}

    def place(self, cell: int, frame: int) -> int:
        """Number of a cell among those of its frame, by which its labels are offset; the same in a movie."""
        return self._place[cell] if self.study.is_movie else self.mapped[frame].index(cell)

    @cached_property
    def most_places(self) -> int:
        """Above the largest `place`."""
        if self.study.is_movie:
            return len(self._place)
        return max(map(len, self.mapped.values()), default=0)

    @cached_property
    def image_shape(self) -> tuple[int, int] | None:
        """(H, W) of the masks; None where no map tells it."""
        if "image_shape" in self.study.provenance:
            height, width = self.study.provenance["image_shape"]
            return height, width
        for frame, cells in self.mapped.items():
            disk = self.study.map(cells[0], frame if self.study.is_movie else None)
            return disk.placed_mask.image_shape
        return None

    @property
    def diameter_px(self) -> float:
        """Of a disk as large as the median cell."""
        return float(np.sqrt(self.rows["area_px"].median() * 4.0 / np.pi))

    @property
    def missing_words(self) -> str:
        """What has no map, in one sentence; empty if all has."""
        count = sum(map(len, self.missing.values()))
        if not count:
            return ""
        if not self.mapped and (self.rows["status"] == "ok").any():
            return (
                f"study {self.study.path} has no maps, so windows cannot be shown: run the same command "
                "again without --no-maps"
            )
        frame, (cell, words) = min((frame, cells[0]) for frame, cells in self.missing.items())
        where = f"cell {cell}, frame {frame}" if self.is_stack else f"cell {cell}"
        which = "frames of cells" if self.study.is_movie else "cells"
        if count == 1:
            return f"{where} has no map ({words})"
        return f"{count} {which} of {len(self.rows)} have no map; the first is {where} ({words})"


def sources_of(study: Study) -> list[str]:
    """Names of the files of masks, in the order of the table; one empty name for a movie.

    Parameters
    ----------
    study : Study

    Returns
    -------
    list of str
    """
    return [""] if study.is_movie else [str(name) for name in dict.fromkeys(study.cells["source"])]

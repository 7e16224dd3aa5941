"""One cell of a movie's study, opened for drawing, and the heading of its pages."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.movie_cell import MovieCell
from cytodisk.pages.sheet import Sheet, broken_lines
from cytodisk.plot.style import WIDE_MM
from cytodisk.runs.channel_names import shown_name
from cytodisk.store.study_folder import part_key
from cytodisk.store.study_kind import FIGURES
from cytodisk.windows.polar_windows import CellWindows

LEFT_MM = 4.0

_TITLE_MM, _LINE_MM = 8.4, 3.6  # down to below the name, and of each line below it

_LONGEST_CHANNEL = 24


@dataclass(frozen=True, eq=False)
class DrawnMovie(MovieCell):
    """A cell of a movie's study, with what its pages draw."""

    @property
    def first(self) -> int:
        """Number of the cell's first frame."""
        return int(self.activity["frame"][0])

    @property
    def frames(self) -> int:
        """Frames from the cell's first to its last."""
        return self.activity.sizes["time"]

    @cached_property
    def mapped(self) -> list[int]:
        """Numbers of the frames with a map."""
        return [int(frame) for frame in np.flatnonzero(self.maps.mapped)]

    def shown_name(self, channel: int = 0) -> str:
        """Name of a channel for headings and labels."""
        if not self.channels:
            return "signal"
        return shown_name(self.channels[channel], _LONGEST_CHANNEL)

    @cached_property
    def points_yx(self) -> FloatArray:
        """Tracked boundary points from the cell's first frame on, shape (frames, N, 2); NaN without map."""
        return self.maps.points_yx[self.first :]

    def windows(self, frame: int) -> CellWindows:
        """Windows of a mapped frame to draw."""
        return self.grid.on(self.maps[frame])

    def write_heading(self, sheet: Sheet, what: str) -> None:
        """Name of the cell and what the page shows; below it frames, grid and scale."""
        label = self.activity.attrs.get("label")
        name = f"cell {self.cell}" + ("" if label is None else f" (label {label})")
        sheet.title(LEFT_MM, 5.0, f"{name}: {what}")
        for number, words in enumerate(self._lines):
            sheet.text(LEFT_MM, 8.8 + _LINE_MM * number, words, color="0.3")

    @property
    def heading_mm(self) -> float:
        """From the page's upper border to what comes below the heading."""
        return _TITLE_MM + _LINE_MM * len(self._lines)

    @cached_property
    def _lines(self) -> list[str]:
        return broken_lines(self._facts(), " · ", WIDE_MM - 2 * LEFT_MM)

    def path(self, ending: str) -> Path:
        """Where a figure is to stand; see `cytodisk.store.figures_folder.drawing`."""
        return self.study.path / FIGURES / f"cell_{part_key(self.cell)}{ending}"

    def _facts(self) -> list[str]:
        last = self.first + self.frames - 1
        lost = self.frames - len(self.mapped)
        which = f"frames {self.first}–{last}" if last > self.first else f"frame {last}"
        facts = [which + (f", {lost} without a map" if lost else "")]
        facts.append(grid_words(self.grid))
        pixel, interval = self.scale.pixel_size_um, self.scale.frame_interval_s
        facts.append("pixel size unknown" if pixel is None else f"{pixel:.4g} µm/px")
        facts.append("frame interval unknown" if interval is None else f"{interval:.4g} s/frame")
        return facts

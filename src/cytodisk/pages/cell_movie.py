"""One cell of a movie's study, opened for drawing, and the heading of its pages."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.files import replacing
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.style import DPI
from cytodisk.store.study import Study
from cytodisk.store.study_folder import figures_folder, part_key
from cytodisk.windows.cell_windows import CellWindows
from cytodisk.windows.grid import PolarGrid, polar_windows

HEADING_MM = 12.0
LEFT_MM = 4.0

_LONGEST_CHANNEL = 24


@dataclass(frozen=True, eq=False)
class CellMovie:
    """A cell's tables and maps.

    Attributes
    ----------
    study : Study
    cell : int
    activity : Dataset with dims (time, channel, layer, sector)
    maps : DiskMovie
        Frame 0 is the recording's, also if the cell enters later.
    """

    study: Study
    cell: int
    activity: xr.Dataset
    maps: DiskMovie

    @classmethod
    def of(cls, study: Study, cell: int) -> CellMovie:
        """Open a cell of a study."""
        return cls(study, cell, study.activity(cell), study.movie(cell))

    @property
    def first(self) -> int:
        """Number of the cell's first frame."""
        return int(self.activity["frame"][0])

    @property
    def frames(self) -> int:
        """Frames from the cell's first to its last."""
        return self.activity.sizes["time"]

    @property
    def interval_s(self) -> float | None:
        """Seconds between frames; None when unknown."""
        return self.maps.scale.frame_interval_s

    @property
    def pixel_size_um(self) -> float | None:
        """Micrometres a pixel; None when unknown."""
        return self.maps.scale.pixel_size_um

    @cached_property
    def mapped(self) -> list[int]:
        """Numbers of the frames with a map."""
        return [int(time) for time in np.flatnonzero(self.maps.mapped)]

    @property
    def channels(self) -> list[str]:
        """Names of the signal's channels, as the tables have them; empty without a signal."""
        return [str(name) for name in self.activity["channel"].to_numpy()] if "mean" in self.activity else []

    def shown_name(self, channel: int = 0) -> str:
        """Name of a channel for headings and labels."""
        if not self.channels:
            return "signal"
        name = self.channels[channel]
        if name.isdigit():  # a file without names
            return f"channel {name}" if len(self.channels) > 1 else "signal"
        return name if len(name) <= _LONGEST_CHANNEL else f"{name[: _LONGEST_CHANNEL - 1]}…"

    @cached_property
    def points_yx(self) -> FloatArray:
        """Tracked boundary points from the cell's first frame on, shape (frames, N, 2); NaN without map."""
        return self.maps.points_yx[self.first :]

    @cached_property
    def grid(self) -> PolarGrid:
        """The windows on the disk."""
        parameters = self.study.provenance["parameters"]
        layers = self.study.provenance["layers"]
        return polar_windows(layers, parameters["sectors"], parameters["spacing"])

    def windows(self, time: int) -> CellWindows:
        """Windows of a mapped frame to draw."""
        return self.grid.on(self.maps[time])

    def unit(self, name: str) -> str:
        """Unit of a variable of the activity."""
        return str(self.activity[name].attrs["units"])

    def write_heading(self, sheet: Sheet, what: str) -> None:
        """Name of the cell, its frames, scale, and what the page shows, in two lines."""
        label = self.activity.attrs.get("label")
        name = f"cell {self.cell}" + ("" if label is None else f" (label {label})")
        sheet.text(LEFT_MM, 5.0, f"{name}: {what}", fontsize=8, weight="bold")
        sheet.text(LEFT_MM, 8.8, " · ".join(self._facts()), color="0.3")

    def save(self, sheet: Sheet, what: str) -> Path:
        """Write a page whole or not at all."""
        path = self.path(f"_{what}.png")
        with replacing(path) as temporary:
            sheet.figure.savefig(temporary, dpi=DPI)
        return path

    def path(self, ending: str) -> Path:
        """Where a figure is to stand."""
        return figures_folder(self.study.path) / f"cell_{part_key(self.cell)}{ending}"

    def _facts(self) -> list[str]:
        last = self.first + self.frames - 1
        lost = self.frames - len(self.mapped)
        which = f"frames {self.first}–{last}" if last > self.first else f"frame {last}"
        facts = [which + (f", {lost} without a map" if lost else "")]
        facts.append(f"{self.grid.layers} layers × {self.grid.sectors} sectors")
        pixel, interval = self.pixel_size_um, self.interval_s
        facts.append("pixel size unknown" if pixel is None else f"{pixel:.4g} µm/px")
        facts.append("frame interval unknown" if interval is None else f"{interval:.4g} s/frame")
        return facts

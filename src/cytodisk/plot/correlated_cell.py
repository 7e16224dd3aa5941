"""A cell with its correlation, opened for drawing, and the heading of its pages."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.io.correlation_store import Correlation
from cytodisk.plot.correlation_cell import PeakMap
from cytodisk.plot.movie_cell import LEFT_MM, CellMovie
from cytodisk.plot.sheet import Sheet

VELOCITY_NAMES = {"velocity": "velocity", "velocity_cell_frame": "velocity (cell frame)"}
"""What edge velocities are called in pictures."""


@dataclass(frozen=True, eq=False)
class CellCorrelation:
    """A cell with its correlation, opened for drawing.

    Attributes
    ----------
    movie : CellMovie
    correlation : Correlation
    """

    movie: CellMovie
    correlation: Correlation

    @property
    def cell(self) -> int:
        """Number of the cell."""
        return self.movie.cell

    @property
    def by_velocity(self) -> bool:
        """Whether the signal was correlated with the motion of the edge."""
        return self.correlation.with_ in VELOCITY_NAMES

    @property
    def signal_name(self) -> str:
        """Name of the signal in pictures."""
        return self.movie.shown_name(self.movie.channels.index(self.correlation.signal))

    @property
    def with_name(self) -> str:
        """Name of the other quantity in pictures."""
        other = self.correlation.with_
        if other in VELOCITY_NAMES:
            return VELOCITY_NAMES[other]
        name = self.movie.shown_name(self.movie.channels.index(other))
        return f"{name} at the edge" if self.correlation.settings.get("against") == "edge" else name

    @property
    def with_words(self) -> str:
        """The same in headings."""
        return f"edge {self.with_name}" if self.by_velocity else self.with_name

    @cached_property
    def peaks(self) -> PeakMap:
        """Peaks of the windows."""
        return PeakMap.of(self.correlation.windows, self.movie.grid, cell=self.cell)

    @property
    def time(self) -> Any:
        """Of the time axis."""
        return {"frame_interval_s": self.movie.interval_s, "first_frame": self.movie.first}

    def activity(self, name: str, layer: int = 0) -> FloatArray:
        """Mean of a signal in a layer, shape (T, S)."""
        values = self.movie.activity["mean"].sel(channel=name).isel(layer=layer)
        return np.asarray(values.transpose("time", "sector"), dtype=np.float64)

    @property
    def velocity(self) -> xr.DataArray:
        """What stands for the motion of the edge, by time and sector."""
        return self.movie.activity[self.correlation.with_].transpose("time", "sector").load()

    def rows(self, table: pd.DataFrame | None) -> pd.DataFrame:
        """Rows of the cell in a table, which may not be there."""
        return pd.DataFrame() if table is None else table[table["cell"] == self.cell]

    def write_heading(self, sheet: Sheet, what: str, *, raw: bool = False) -> None:
        """What the page shows, and below it of which cell and, unless values are raw, how it was made."""
        settings = self.correlation.settings
        facts = [f"cell {self.cell}", f"{self.movie.grid.layers} layers × {self.movie.grid.sectors} sectors"]
        facts.append(f"{self.movie.frames} frames")
        if not raw and settings.get("detrend", "none") != "none":
            facts.append(f"{settings['detrend']} detrending")
        if not raw and settings.get("difference"):
            facts.append("differences")
        sheet.text(LEFT_MM, 4.5, what, fontsize=8, weight="bold")
        sheet.text(LEFT_MM, 8.3, " · ".join(facts), color="0.3")

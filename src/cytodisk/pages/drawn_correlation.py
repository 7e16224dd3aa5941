"""A cell with its correlation, opened for drawing, and the heading of its pages."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import BoolArray
from cytodisk.pages.drawn_movie import LEFT_MM, DrawnMovie
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.settings_words import settings_words, used_windows
from cytodisk.pages.sheet import BOLD_MM, Sheet, broken_lines
from cytodisk.plot.correlation.correlation_peaks import PeakMap
from cytodisk.runs.channel_names import shortened
from cytodisk.runs.correlate.verdict import jittered_rows
from cytodisk.runs.partial_words import lost_clusters, lost_rows, without_words
from cytodisk.store.correlation_store import Correlation

VELOCITY_NAMES = {"velocity": "velocity", "velocity_cell_frame": "velocity (cell frame)"}
"""What edge velocities are called in pictures."""

_HEADING_MM, _LINE_MM = 13.0, 3.5
_LONGEST_NAME = 18


@dataclass(frozen=True, eq=False)
class DrawnCorrelation:
    """A cell with its correlation, opened for drawing.

    Attributes
    ----------
    movie : DrawnMovie
    correlation : Correlation
    """

    movie: DrawnMovie
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
    def first_names(self) -> tuple[str, str]:
        """Signal and other quantity in a few characters, for the words about which comes first."""
        channels, other = self.movie.channels, self.correlation.with_
        last = "velocity" if self.by_velocity else self.movie.shown_name(channels.index(other))
        return shortened(self.signal_name, _LONGEST_NAME), shortened(last, _LONGEST_NAME)

    @property
    def with_words(self) -> str:
        """The same in headings."""
        return f"edge {self.with_name}" if self.by_velocity else self.with_name

    @cached_property
    def peaks(self) -> PeakMap:
        """Peaks of the windows."""
        lost = lost_clusters(self.rows(self.correlation.clusters))
        return PeakMap.of(self.correlation.windows, self.movie.grid, cell=self.cell, lost=lost)

    @property
    def partial_words(self) -> str:
        """What the partial correlation is, as "without geometry"; empty if there is none of this cell."""
        curves = self.rows(self.correlation.layer_curves)
        if "correlation_partial" not in curves or not curves["correlation_partial"].notna().any():
            return ""
        return without_words(self.correlation, self.cell)

    @property
    def lost(self) -> pd.Series[bool]:
        """Which layers do not survive once the controls are regressed out."""
        return lost_rows(self.rows(self.correlation.layers))

    @property
    def jittered(self) -> pd.Series[bool]:
        """Which layers, of all cells, have their peak at a lag that jitter of the masks makes."""
        return jittered_rows(self.correlation, self.correlation.layers)

    @cached_property
    def used(self) -> BoolArray:
        """Which frames and sectors the correlation used, shape (T, S)."""
        movie = self.movie
        return used_windows(self.correlation.settings, movie.first, movie.frames, movie.grid.sectors)

    @property
    def drawn_time(self) -> int:
        """Number of the frame with a map in the middle of those that were used."""
        within = np.any(self.used, axis=1).tolist()
        times = [time for time in self.movie.mapped if within[time - self.movie.first]] or self.movie.mapped
        return times[len(times) // 2]

    def activity(self, name: str, layer: int = 0) -> xr.DataArray:
        """Mean of a signal in a layer, by time and sector; NaN where it was not used."""
        values = self.movie.activity["mean"].sel(channel=name).isel(layer=layer).transpose("time", "sector")
        return values.load().where(self.used)

    @property
    def velocity(self) -> xr.DataArray:
        """What stands for the motion of the edge, by time and sector; NaN where it was not used.

        A step needs both of its frames.
        """
        velocity = self.movie.activity[self.correlation.with_].transpose("time", "sector").load()
        return velocity.where(self.used & np.append(self.used[1:], self.used[-1:] & False, axis=0))

    def rows(self, table: pd.DataFrame | None) -> pd.DataFrame:
        """Rows of the cell in a table, which may not be there."""
        return pd.DataFrame() if table is None else table[table["cell"] == self.cell]

    def used_events(self) -> pd.DataFrame:
        """Events of the edge in the frames and sectors that were used."""
        events = self.rows(self.correlation.events)
        if events.empty:
            return events
        first, used = self.movie.first, self.used
        spans = zip(events["onset"] - first, events["end"] - first, events["sector"], strict=True)
        return events[[bool(used[onset:end, sector].any()) for onset, end, sector in spans]]

    def heading(self, width_mm: float, what: str, *notes: str) -> Heading:
        """What a page shows, and of which cell and how it was made.

        Parameters
        ----------
        width_mm : float
            Width of the page: long lines are broken.
        what : str
        *notes : str
            More to say below it.
        """
        grid = self.movie.grid
        facts = [f"cell {self.cell}", grid_words(grid)]
        facts.append(f"{self.movie.frames} frames")
        facts += [*settings_words(self.correlation.settings), *notes]
        title = broken_lines(what.split(" "), " ", width_mm - 2 * LEFT_MM, BOLD_MM)
        return Heading(title, broken_lines(facts, " · ", width_mm - 2 * LEFT_MM))


@dataclass(frozen=True)
class Heading:
    """Lines above a page.

    Attributes
    ----------
    title, facts : list of str
        The first bold, the second grey.
    """

    title: list[str]
    facts: list[str]

    @property
    def height_mm(self) -> float:
        """From the page's upper border to what comes below."""
        return _HEADING_MM + _LINE_MM * (len(self.title) + len(self.facts) - 2)

    def write(self, sheet: Sheet) -> None:
        """Put the lines on the page."""
        top = 4.5
        for words in self.title:
            sheet.title(LEFT_MM, top, words)
            top += _LINE_MM
        for words in self.facts:
            sheet.text(LEFT_MM, top + 0.3, words, color="0.3")
            top += _LINE_MM

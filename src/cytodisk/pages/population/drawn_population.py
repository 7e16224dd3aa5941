"""A population's study, opened for drawing, and the words of its pages."""

from __future__ import annotations

import shlex
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import BoolArray
from cytodisk.number_words import counted, rounded
from cytodisk.pages.drawn_correlation import Heading
from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.population.cell_sources import CellSources
from cytodisk.pages.sheet import BOLD_MM, broken_lines
from cytodisk.plot.population.difference_map import DifferenceMap
from cytodisk.plot.units import with_unit
from cytodisk.runs.channel_names import shortened, shown_name
from cytodisk.store.populations.population_study import PopulationStudy
from cytodisk.store.populations.window_arrays import window_arrays
from cytodisk.windows.polar_windows import PolarGrid

CHARACTER_MM = 1.3
"""Width of a character of a name at 7 points, rather too much than too little."""

MOST_CHANNELS = 4
"""Channels that have figures: the page and the tables have all."""

_LONGEST_CHANNEL = 24
_SUMMARIES = {
    "sd": "sd over frames of {}",
    "velocity": "edge velocity",
    "peak_correlation": "peak correlation of {}",
    "lag": "lag of the peak of {}",
    "around_events": "{} less that at any moment",
    "gain": "gain of {} beyond chance",
    "gain_score": "score of {}",
    "waves": "order of waves of {}",
}
_SIGNED = ("velocity", "peak_correlation", "lag", "gain", "gain_score")  # whose 0 has a meaning of its own
_DIRECTIONS = {
    "nucleus": "away from the nucleus",
    "front": "at the front",
    "motion": "where the cell moves to",
    "axis": "at an end of the long axis",
}


def in_two_lines(name: str, room_mm: float) -> str:
    """A name broken between its words where it is too long, with its middle left out if two lines are."""
    longest = max(int(room_mm / CHARACTER_MM), 6)
    first, *others = broken_lines(name.split(" "), " ", room_mm, CHARACTER_MM)
    lines = [first, " ".join(others)] if others else [first]
    return "\n".join(shortened(line, longest) for line in lines)


@dataclass(frozen=True, eq=False)
class DrawnPopulation:
    """A population's study with what its pages draw.

    Attributes
    ----------
    study : PopulationStudy
    """

    study: PopulationStudy

    @cached_property
    def sources(self) -> CellSources:
        """The studies that its cells are from."""
        return CellSources(self.study.cells, np.flatnonzero(self._is_used))

    @cached_property
    def used(self) -> pd.DataFrame:
        """The cells that are in the means; an experiment that is unknown is an empty text."""
        cells = self.study.cells[self._is_used].reset_index(drop=True)
        return cells.assign(experiment=cells["experiment"].fillna("").astype(str))

    @cached_property
    def _is_used(self) -> BoolArray:
        return np.asarray(self.study.cells["left_out"].fillna("") == "", dtype=bool)

    @property
    def conditions(self) -> list[str]:
        """The control first."""
        return list(self.study.conditions)

    @property
    def compared(self) -> list[str]:
        """Conditions that were compared with the control, or stand beside it where nothing was tested."""
        return [name for name in self.study.compared if name in self.conditions]

    @property
    def channels(self) -> list[str]:
        """Names of channels that have values."""
        return [name for name in self.study.channels if name]

    @property
    def drawn_channels(self) -> list[str]:
        """The channels that have figures."""
        return self.channels[:MOST_CHANNELS]

    @property
    def undrawn_words(self) -> str:
        """Which channels have no figures, and what draws them; empty if all have."""
        rest = self.channels[MOST_CHANNELS:]
        if not rest:
            return ""
        drawn, more = ", ".join(self.drawn_channels), shlex.quote(",".join(rest[:MOST_CHANNELS]))
        return (
            f"Figures are of the first {MOST_CHANNELS} of {len(self.channels)} channels ({drawn}): to draw "
            f"others, run the command again with --channel {more} and another --out."
        )

    @cached_property
    def grid(self) -> PolarGrid:
        """The windows on the disk; with the radii of one cell where they differ between cells."""
        atlas = self.study.atlas_arrays
        inside = 0
        if "compartment" in atlas.coords:
            inside = int((atlas["compartment"].to_numpy() == "nucleus").sum())
        return self.sources.grid(atlas.sizes["layer"], atlas.sizes["sector"], inside)

    @property
    def direction_words(self) -> str:
        """Where sector 0 lies in each cell; empty if cells were not turned."""
        align = str(self.study.parameters.get("align") or "none")
        if align == "none":
            return ""
        return _DIRECTIONS.get(align, f"at the brightest side of {align.removeprefix('signal:')}")

    @property
    def lag_unit(self) -> str:
        """Unit of the lags of curves, as "s" or "frames"; empty if it is unknown."""
        unit = str(self.study.provenance.get("lag_unit") or "")
        return "frames" if unit == "frame" else unit

    @property
    def are_known(self) -> bool:
        """Whether each condition has an experiment that is known."""
        known = self.used.loc[self.used["experiment"] != "", "condition"]
        return set(self.conditions) <= set(known)

    @property
    def repeated(self) -> bool:
        """Whether a condition has several experiments."""
        known = self.used[self.used["experiment"] != ""]
        return bool((known.groupby("condition")["experiment"].nunique() > 1).any())

    def atlas(self, channel: str) -> xr.Dataset:
        """Means and counts of a channel by condition, layer and sector."""
        return self._on_grid(self.study.atlas_arrays.sel(channel=channel))

    def trend(self, channel: str) -> DifferenceMap | None:
        """Change of a channel by one step of the dose; None where no trend was tested."""
        table = self.study.trends
        own = table[table["channel"] == channel]
        if own.empty:
            return None
        told = own[["channel", "layer", "sector", "p_fwer"]].assign(difference=own["slope"])
        return DifferenceMap.of(self._on_grid(window_arrays(told).sel(channel=channel)))

    def _on_grid(self, windows: xr.Dataset) -> xr.Dataset:
        """All layers of the grid: what is of the edge alone has no values in the others."""
        return windows.reindex(layer=np.arange(self.grid.layers))

    def difference(self, condition: str, channel: str) -> DifferenceMap:
        """Difference of a condition from the control in a channel."""
        clusters = self.study.clusters
        own = clusters[(clusters["condition"] == condition) & (clusters["channel"] == channel)]
        windows = self.study.window_arrays(condition).sel(channel=channel)
        return replace(DifferenceMap.of(self._on_grid(windows), clusters=own), correction=self.correction)

    def channel_words(self, channel: str) -> str:
        """Name of a channel for headings and labels."""
        return shown_name(channel, _LONGEST_CHANNEL)

    def value_label(self, channel: str) -> str:
        """What the values of windows are, with their unit."""
        settings, name = self.study.parameters, self.channel_words(channel)
        summary = str(settings.get("summary") or "mean")
        words = _SUMMARIES.get(summary, "mean {}").format(name)
        normalised = str(settings.get("normalise") or "none")
        if normalised != "none" and summary == "mean":
            words = f"{name} above background" if normalised == "background" else name
        return with_unit(words, self.unit)

    @property
    def unit(self) -> str:
        """Unit of the values of windows."""
        return str(self.study.atlas_arrays["mean"].attrs.get("units", ""))

    @cached_property
    def has_tested_scalars(self) -> bool:
        """Whether any scalar has a p."""
        scalars = self.study.scalars
        return bool(len(scalars) and scalars["p_fwer"].notna().any())

    @property
    def is_by_cell(self) -> bool:
        """Whether each cell's own level was taken out, so that bright and dim cells are compared alike."""
        return self.study.parameters.get("normalise") in ("cell mean", "cell total", "z-score")

    @property
    def is_signed(self) -> bool:
        """Whether values of windows lie on both sides of 0, as edge velocity does."""
        settings = self.study.parameters
        return settings.get("summary") in _SIGNED or settings.get("normalise") == "z-score"

    @property
    def correction(self) -> str:
        """How p was corrected, in words."""
        return "max-T, Holm" if len(self.compared) > 1 else "max-T"

    @property
    def paired(self) -> bool:
        """Whether experiments were compared with themselves."""
        return bool((self.study.comparisons["design"] == "paired").any())

    def facts(self) -> list[str]:
        """Numbers of cells and experiments, grid, alignment."""
        cells = self.used
        count = int(cells.loc[cells["experiment"] != "", "experiment"].nunique())
        facts = [
            counted(len(cells), "cell"),
            counted(count, "experiment") if count else "experiments unknown",
        ]
        if not self.study.is_curves and self.channels:
            facts.append(grid_words(self.grid))
        if self.direction_words:
            facts.append(f"sector 0: {self.direction_words}")
        return facts

    def comparison_words(self, condition: str) -> str:
        """How a condition was compared, and the smallest p that this can give."""
        rows = self.study.comparisons
        row = rows[rows["condition"] == condition].iloc[0]
        design, against = str(row["design"]), f"{condition} against {row['control']}"
        unit = "cells" if row["unit"] == "cell" else "experiments"
        smallest = float(row["smallest_p_holm"])
        if design not in ("paired", "unpaired") or not np.isfinite(smallest):
            return f"{against}: not tested"
        first, second = int(row["n_control"]), int(row["n_treated"])
        units = f"{first} pairs" if design == "paired" else f"{first} + {second} {unit}"
        return f"{against}: {units}, {design}, smallest p possible {rounded(smallest, 2)}"

    def heading(self, width_mm: float, what: str, *notes: str) -> Heading:
        """What a page shows, and of which cells.

        Parameters
        ----------
        width_mm : float
            Width of the page: long lines are broken.
        what : str
        *notes : str
            More to say below it.
        """
        room = width_mm - 2 * LEFT_MM
        title = broken_lines(what.split(" "), " ", room, BOLD_MM)
        lines: list[str] = []
        for part in (*self.facts(), *notes):
            pieces = broken_lines(part.split(" "), " ", room)
            joined = broken_lines([*lines[-1:], pieces[0]], " · ", room)
            lines = [*lines[:-1], *joined, *pieces[1:]]
        return Heading(title, lines)

    @property
    def path(self) -> Path:
        """Folder of the study."""
        return self.study.path

"""A cell with its waves, opened for drawing, and the heading of its pages."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.pages.drawn_correlation import VELOCITY_NAMES, Heading
from cytodisk.pages.drawn_movie import LEFT_MM, DrawnMovie
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.settings_words import scope_words
from cytodisk.pages.sheet import BOLD_MM, broken_lines
from cytodisk.plot.layer_looks import layer_word
from cytodisk.runs.findings.wave_words import chance_words, speed_words, time_words, wave_numbers
from cytodisk.runs.qc_flags.wave_doubts import has_inside
from cytodisk.store.waves.waves_store import Waves

_FAINT = 0.5
"""Of the root mean square of a layer's amplitudes: where a wave is weaker, its phase is mostly noise."""


def faint(amplitude: pd.Series[float]) -> pd.Series[bool]:
    """Where a wave is too weak to have a phase, by the amplitudes of a layer."""
    return ~(amplitude >= _FAINT * float(np.sqrt((amplitude**2).mean())))


@dataclass(frozen=True, eq=False)
class DrawnWaves:
    """A cell with its waves.

    Attributes
    ----------
    movie : DrawnMovie
    waves : Waves
    """

    movie: DrawnMovie
    waves: Waves

    @property
    def by_velocity(self) -> bool:
        """Whether it is the motion of the edge, which has no layers."""
        return self.waves.signal in VELOCITY_NAMES

    @cached_property
    def row(self) -> Any:
        """The cell's row: the numbers of the chosen layer."""
        cells = self.waves.cells
        return cells[cells["cell"] == self.movie.cell].iloc[0]

    @property
    def there(self) -> bool:
        """Whether there is a wave beyond chance."""
        return bool(self.row["kind"] != "none")

    @property
    def inside(self) -> bool:
        """Whether there is a wave through all layers beyond chance."""
        return has_inside(self.row)

    @property
    def layer(self) -> int | None:
        """The layer that is drawn; None for velocity."""
        return None if self.by_velocity else int(self.row["layer"])

    @property
    def signal_name(self) -> str:
        """What waves were looked for in, in pictures."""
        if self.by_velocity:
            return f"edge {VELOCITY_NAMES[self.waves.signal]}"
        return self.movie.shown_name(self.movie.channels.index(self.waves.signal))

    @property
    def place_name(self) -> str:
        """The same with its layer."""
        if self.layer is None:
            return self.signal_name
        word = layer_word(self.layer, self.movie.grid.layers, self.movie.cytoplasm_layers)
        return f"{self.signal_name}, {word}"

    def rows(self, table: pd.DataFrame | None) -> pd.DataFrame:
        """Rows of the cell, and of the drawn layer where the table has layers."""
        if table is None:
            return pd.DataFrame()
        own = table[table["cell"] == self.movie.cell]
        return own if self.layer is None or "layer" not in own else own[own["layer"] == self.layer]

    @cached_property
    def frames(self) -> list[int]:
        """Numbers of the frames that were used."""
        return sorted(int(frame) for frame in self.rows(self.waves.phase)["frame"].unique())

    @cached_property
    def phase(self) -> xr.DataArray:
        """Phase of the drawn layer by (time, sector), with its frames and times; NaN where it is faint."""
        rows = self.rows(self._phases).sort_values(["frame", "sector"])
        table = rows["phase"].to_numpy().reshape(len(self.frames), -1)
        coords = self.movie.scale.time_coords(np.asarray(self.frames))
        found = xr.DataArray(table, coords, ("time", "sector"))
        return found.assign_attrs(self.movie.scale.attrs)

    @cached_property
    def _phases(self) -> pd.DataFrame:
        """Phases of the cell; empty where the wave is faint: too weak for a phase that means something."""
        own = self.waves.phase[self.waves.phase["cell"] == self.movie.cell]
        layers = [layer for _, layer in own.groupby("layer", dropna=False)]
        for name in ("phase", "phase_inside"):
            size = name.replace("phase", "amplitude")
            layers = [one.assign(**{name: one[name].where(~faint(one[size]))}) for one in layers]
        return pd.concat(layers)

    @cached_property
    def values(self) -> xr.DataArray:
        """The values of the drawn layer by (time, sector), of the frames that were used."""
        activity = self.movie.activity
        if self.layer is None:
            one = activity[self.waves.signal]
        else:
            one = activity["mean"].sel(channel=self.waves.signal, drop=True).isel(layer=self.layer)
        first = self.frames[0] - self.movie.first
        return one.transpose("time", "sector").isel(time=slice(first, first + len(self.frames))).load()

    def phase_at(self, frame: int) -> FloatArray:
        """Phase in one frame, of shape (sectors,) for velocity, else (layers, sectors); NaN where faint."""
        rows = self._phases
        rows = rows[rows["frame"] == frame]
        if self.layer is None:
            return rows.sort_values("sector")["phase"].to_numpy(dtype=np.float64)
        table = np.full((self.movie.grid.layers, self.movie.grid.sectors), np.nan)
        column = "phase_inside" if self.inside else "phase"
        table[rows["layer"].astype(int), rows["sector"].astype(int)] = rows[column]
        return table

    def heading(self, width_mm: float, what: str, *notes: str, inside: bool = False) -> Heading:
        """What a page shows; below it the wave in numbers, the cell and its windows.

        Parameters
        ----------
        width_mm : float
            Width of the page: long lines are broken.
        what : str
        *notes : str
            More to say below it.
        inside : bool
            The numbers are those of the wave through all layers.
        """
        own = self._inside_words() if inside else self._wave_words()
        facts = [*own, f"cell {self.movie.cell}", grid_words(self.movie.grid)]
        facts += [f"{len(self.frames)} frames", *scope_words(self.waves.settings), *notes]
        if self.waves.name:
            facts.append(f"“{self.waves.name}”")
        title = broken_lines(what.split(" "), " ", width_mm - 2 * LEFT_MM, BOLD_MM)
        return Heading(title, broken_lines(facts, " · ", width_mm - 2 * LEFT_MM))

    def _wave_words(self) -> list[str]:
        row, chance = self.row, chance_words(self.row)
        if not self.there:
            return [f"no waves beyond chance, {chance}"]
        parts = wave_numbers(row, self.movie.scale).split(", ")
        return [f"{row['kind']} wave", *parts, chance]

    def _inside_words(self) -> list[str]:
        row, scale = self.row, self.movie.scale
        if not self.inside:
            return [f"no wave through all layers beyond chance, p = {row['p_inside']:.2g}"]
        way = str(row["inside_way"] or "")
        words = [f"wave through all layers: {row['inside']}{', ' * bool(way)}{way}"]
        if np.isfinite(row["inward_speed"]):
            out = "outwards" if row["inward_speed"] < 0 else "inwards"
            words.append(f"{speed_words(row['inward_speed'], scale, row['frames'])} {out}")
        if np.isfinite(row["around_speed"]):
            words.append(f"{speed_words(row['around_speed'], scale, row['frames'])} around")
        return [*words, f"period {time_words(row['inside_period'], scale)}", f"p = {row['p_inside']:.2g}"]

"""The numbers of one cell that the dock shows, by window in a frame and through time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.napari.disk_view.disk_choices import DiskChoice
from cytodisk.napari.disk_view.window_words import number_with_unit
from cytodisk.number_words import rounded
from cytodisk.plot.correlation.correlation_peaks import LAG_COLOURS
from cytodisk.plot.style import DIVERGING_COLOURS, SIGNAL_COLOURS, signal_limits
from cytodisk.plot.time_axis import FrameTimes
from cytodisk.scale import ShownUnit, suited_lag
from cytodisk.windows.polar_windows import PolarGrid
from cytodisk.windows.study_grid import polar_grid_of

SIGNIFICANT = 0.05


@dataclass(frozen=True, eq=False)
class WindowNumbers:
    """One number a window, and how it is coloured.

    Attributes
    ----------
    values : ndarray of shape (layers, sectors) and dtype float
    limits : (float, float)
        Of the colours.
    colours : str
        Name of the colour map.
    unit : str
    hatched : ndarray of shape (layers, sectors) and dtype bool, or None
        Windows whose number is not significant.
    peaks : (ndarray, ndarray) or None
        Correlation at the peak and its lag in the unit that suits lags, both of shape (layers, sectors).
    """

    values: FloatArray
    limits: tuple[float, float]
    colours: str
    unit: str
    hatched: BoolArray | None = None
    peaks: tuple[FloatArray, FloatArray] | None = None


class CellNumbers:
    """Numbers of one cell of a shown study.

    Parameters
    ----------
    shown : ShownStudy
    cell : int
    """

    def __init__(self, shown: Any, cell: int):
        self.shown, self.cell = shown, cell
        self._means: dict[str, FloatArray] = {}
        self._peaks: dict[tuple[str, ...], pd.DataFrame] = {}

    @property
    def is_movie(self) -> bool:
        """Whether it has a time, and an edge that moves."""
        return bool(self.shown.study.is_movie)

    @cached_property
    def grid(self) -> PolarGrid:
        """The study's windows, which have no radii where these differ from cell to cell."""
        return polar_grid_of(self.shown.study.provenance)

    def no_map(self, frame: int | None) -> str:
        """Why the cell has no map in a frame; empty if it has one."""
        cells = self.shown.cells
        if frame is None:
            return "there is no frame under the time slider"
        if self.cell in cells.mapped.get(frame, ()):
            return ""
        words = dict(cells.missing.get(frame, ())).get(self.cell)
        return words or f"cell {self.cell} is not in frame {frame}"

    def of_windows(self, choice: DiskChoice, frame: int) -> WindowNumbers:
        """Numbers of the windows in a frame with a map.

        Parameters
        ----------
        choice : DiskChoice
            For an image, the area of the windows.
        frame : int

        Returns
        -------
        WindowNumbers
        """
        if choice.is_peak:
            return self._peak(choice)
        if choice.kind == "mean":
            (channel,) = choice.names
            values = np.asarray(self.shown.values(self.cell, channel, frame), dtype=np.float64)
            return WindowNumbers(values, self.shown.limits(channel), SIGNAL_COLOURS, self.shown.unit(channel))
        values = np.asarray(self.shown.values(self.cell, "area", frame), dtype=np.float64)
        return WindowNumbers(values, signal_limits(values), SIGNAL_COLOURS, self.shown.unit("area"))

    def _peak(self, choice: DiskChoice) -> WindowNumbers:
        found = self.shown.study.correlation(*choice.names)
        if choice.names not in self._peaks:
            self._peaks[choice.names] = found.windows[found.windows["cell"] == self.cell]
        table, scale = self._peaks[choice.names], self.shown.study.scale
        values, lags = self._by_window(table, "correlation"), self._by_window(table, "lag")
        lags = scale.time(lags) * self._lag_unit.factor
        chance = self._by_window(table, "q") >= SIGNIFICANT
        if choice.kind == "lag":
            top = _largest(lags) or 1.0
            return WindowNumbers(lags, (-top, top), LAG_COLOURS, self._lag_unit.name, chance, (values, lags))
        top = max(0.1, np.ceil(10.0 * _largest(values)) / 10.0)
        return WindowNumbers(values, (-top, top), DIVERGING_COLOURS, "", chance, (values, lags))

    def _by_window(self, table: pd.DataFrame, name: str) -> FloatArray:
        grid = self.grid
        values = np.full((grid.layers, grid.sectors), np.nan)
        if name in table:
            values[table["layer"].to_numpy(), table["sector"].to_numpy()] = table[name].to_numpy(np.float64)
        return values

    def depth(self, frame: int, layer: int, sector: int) -> float:
        """Median depth of a window in the unit of length."""
        return float(self.shown.values(self.cell, "depth", frame)[layer, sector])

    def velocities(self, frame: int) -> FloatArray | None:
        """Velocity of the edge by sector; None in a study without time."""
        if not self.is_movie:
            return None
        return np.asarray(self.shown.values(self.cell, "velocity", frame), dtype=np.float64)

    @cached_property
    def _activity(self) -> xr.Dataset:
        found: xr.Dataset = self.shown.study.activity(self.cell)
        return found

    @cached_property
    def times(self) -> FrameTimes:
        """Where the frames lie on the axis of time."""
        frames = self._activity["frame"].to_numpy()
        return FrameTimes(int(frames[0]), len(frames), self.shown.study.scale.frame_interval_s)

    def mean_through_time(self, channel: str, layer: int, sector: int) -> FloatArray:
        """Mean of a channel in a window in all frames; NaN without a map."""
        if channel not in self._means:
            means = self._activity["mean"].sel(channel=channel)
            self._means = {channel: means.transpose("time", "layer", "sector").to_numpy()}
        return self._means[channel][:, layer, sector]

    @property
    def speed_unit(self) -> ShownUnit:
        """The unit that suits the edge's velocity, the same in all frames."""
        shown = self.shown
        found: ShownUnit = shown.study.scale.shown_velocity(shown.top_speed, shown.cells.n_frames)
        return found

    @property
    def _lag_unit(self) -> ShownUnit:
        interval = self.shown.study.scale.frame_interval_s
        return ShownUnit("frames") if interval is None else suited_lag(interval)

    @cached_property
    def _velocity(self) -> FloatArray:
        return np.asarray(self._activity["velocity"].transpose("time", "sector").to_numpy())

    def velocity_through_time(self, sector: int) -> FloatArray:
        """Velocity of the edge of a sector in all frames, in `speed_unit`."""
        return self._velocity[:, sector] * self.speed_unit.factor

    def value_words(
        self, numbers: WindowNumbers, choice: DiskChoice, frame: int, window: tuple[int, int]
    ) -> list[str]:
        """What is shown of a window, in words.

        Parameters
        ----------
        numbers : WindowNumbers
            Of the choice in the frame.
        choice : DiskChoice
        frame : int
        window : (int, int)
            Its layer and sector.

        Returns
        -------
        list of str
            One line each.
        """
        if choice.is_peak:
            return [self._peak_words(numbers, window)]
        value, of, label = float(numbers.values[window]), numbers.unit, choice.label
        if choice.kind == "image" and self.shown.channel:
            mean = DiskChoice("mean", (self.shown.channel,))
            value, label = float(self.of_windows(mean, frame).values[window]), mean.label
            of = self.shown.unit(self.shown.channel)
        elif choice.kind == "image":
            label = "window area"
        lines = [f"{label}: {number_with_unit(value, of)}"]
        velocities = self.velocities(frame)
        if velocities is not None:
            unit, speed = self.speed_unit, float(velocities[window[1]])
            words = number_with_unit(speed * unit.factor, unit.name, signed=True)
            lines.append(f"edge velocity: {words}")
        return lines

    def _peak_words(self, numbers: WindowNumbers, window: tuple[int, int]) -> str:
        if numbers.peaks is None or numbers.hatched is None:
            return "not correlated"
        correlation, lag = (float(values[window]) for values in numbers.peaks)
        if not np.isfinite(correlation):
            return "not correlated"
        chance = ", not significant" if numbers.hatched[window] else ""
        words = f"peak correlation {rounded(correlation, 2)}".replace("-", "−")
        return f"{words} at lag {number_with_unit(lag, self._lag_unit.name)}{chance}"


def _largest(values: FloatArray) -> float:
    """The largest without its sign; 0 if none is known."""
    known = np.abs(values[np.isfinite(values)])
    return float(known.max()) if known.size else 0.0

"""The numbers of one cell that the dock shows, by window in a frame and through time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.napari.disk_view.disk_choices import DiskChoice
from cytodisk.napari.disk_view.window_words import number_with_unit
from cytodisk.napari.study_layers.window_peaks import window_peaks
from cytodisk.number_words import rounded
from cytodisk.plot.correlation.correlation_peaks import LAG_COLOURS, PeakMap
from cytodisk.plot.style import DIVERGING_COLOURS, SIGNAL_COLOURS, signal_limits
from cytodisk.plot.time_axis import FrameTimes
from cytodisk.scale import ShownUnit
from cytodisk.windows.polar_windows import PolarGrid
from cytodisk.windows.study_grid import polar_grid_of


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
    peaks : PeakMap or None
        What the number is of, where it is of the peak of a correlation.
    """

    values: FloatArray
    limits: tuple[float, float]
    colours: str
    unit: str
    hatched: BoolArray | None = None
    peaks: PeakMap | None = None


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
        self._peaks: dict[tuple[str, ...], tuple[dict[str, Any], PeakMap | None]] = {}

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
        peaks, is_lag = self._peaks_of(choice), choice.kind == "lag"
        colours = LAG_COLOURS if is_lag else DIVERGING_COLOURS
        if peaks is None:
            nothing = np.full((self.grid.layers, self.grid.sectors), np.nan)
            return WindowNumbers(nothing, (-1.0, 1.0), colours, "")
        top = peaks.limit("lag" if is_lag else "correlation")
        pale = None if peaks.significant is None else peaks.pale
        values, unit = (peaks.lag, peaks.lag_unit.unit) if is_lag else (peaks.correlation, "")
        return WindowNumbers(values, (-top, top), colours, unit, pale, peaks)

    def _peaks_of(self, choice: DiskChoice) -> PeakMap | None:
        """Peaks of a correlation, read again when it was made anew."""
        found = self.shown.study.correlation(*choice.names)
        known = self._peaks.get(choice.names)
        if known is None or known[0] != found.settings:
            known = found.settings, window_peaks(found, self.cell, self.grid)
            self._peaks[choice.names] = known
        return known[1]

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
        peaks = numbers.peaks
        if peaks is None or not np.isfinite(peaks.correlation[window]):
            return "not correlated"
        correlation, lag = float(peaks.correlation[window]), float(peaks.lag[window])
        chance = ", not significant" if peaks.pale[window] else ""
        words = f"peak correlation {rounded(correlation, 2)}".replace("-", "−")
        return f"{words} at lag {number_with_unit(lag, peaks.lag_unit.unit)}{chance}"

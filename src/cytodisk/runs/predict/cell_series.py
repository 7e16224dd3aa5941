"""The series of a cell that predict each other: as they are, and without what geometry alone would give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import xarray as xr

from cytodisk.analysis.controls.without_controls import FEWEST_FRAMES, without_controls
from cytodisk.analysis.correlation.prepared_series import prepare_series
from cytodisk.errors import ParameterError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.predict.predict_parameters import PredictParameters
from cytodisk.runs.run_options import Progress
from cytodisk.runs.used_series.cell_controls import CellControls, too_few_frames
from cytodisk.runs.used_series.chosen_series import chosen_series
from cytodisk.store.study import Study


@dataclass(frozen=True, eq=False)
class CellSeries:
    """Series of one cell by name.

    Attributes
    ----------
    raw : dict of str to DataArray
        Channels by (time, layer, sector), velocity by (time, sector).
    left : dict of str to DataArray
        The same without what geometry alone would give; empty where that is not known, or not asked for.
    not_tested : str
        Why it is not known; empty if it is, or was not asked for.
    partial_frames : float
        Frames in which a window's signal and controls have values, median over windows, of the signal with
        fewest; NaN without controls.
    """

    raw: dict[str, xr.DataArray]
    left: dict[str, xr.DataArray] = field(default_factory=dict)
    not_tested: str = ""
    partial_frames: float = np.nan

    @property
    def frames(self) -> int:
        """Number of frames."""
        return int(next(iter(self.raw.values())).sizes["time"])

    @property
    def gaps(self) -> int:
        """Frames without any value of one of the signals, but for the last, which has no velocity."""
        missing = np.zeros(self.frames, dtype=bool)
        for name, series in self.raw.items():
            known = series.notnull().any([str(dim) for dim in series.dims if dim != "time"]).to_numpy()
            missing[: self.frames - (name in VELOCITIES)] |= ~known[: self.frames - (name in VELOCITIES)]
        return int(missing.sum())


@dataclass(frozen=True)
class SeriesOfStudy:
    """Opens the series of cells; the same for all cells of a study.

    Attributes
    ----------
    study : Study
    names : tuple of str
        Channels and velocities.
    lag : int
        Frames before and after a frame that are left out of its mean in the lab.
    options : PredictParameters
    """

    study: Study
    names: tuple[str, ...]
    lag: int
    options: PredictParameters

    def of(self, cell: int, progress: Progress | None) -> CellSeries:
        """Series of a cell.

        Parameters
        ----------
        cell : int
        progress : callable, optional
            Called with (steps done, in all) of what geometry would give.

        Raises
        ------
        ParameterError
            One of the signals has no value.
        """
        activity = chosen_series(self.study.activity(cell), self.options)
        raw = {name: self._prepared(series_of(activity, name)) for name in self.names}
        for name, series in raw.items():
            if not np.isfinite(series).any():
                raise ParameterError(f"cell {cell} has no values of {name}")
        if not self.options.geometry:
            return CellSeries(raw)
        channels = [name for name in self.names if name not in VELOCITIES]
        found = CellControls(self.study, self.lag, self.options).of(cell, activity, channels, progress)
        if not found.there:
            return CellSeries(raw, not_tested=found.not_tested)
        left = {name: self._left(raw[name], found.by_channel.get(name)) for name in self.names}
        frames = min(float(left[name].count("time").median()) for name in channels)
        if frames < FEWEST_FRAMES:
            return CellSeries(raw, not_tested=too_few_frames(frames), partial_frames=frames)
        return CellSeries(raw, left, "", frames)

    def _prepared(self, series: xr.DataArray) -> xr.DataArray:
        by_time: xr.DataArray = series.load().transpose("time", ...)
        return by_time.copy(data=prepare_series(by_time, detrend=self.options.detrend))

    def _left(self, series: xr.DataArray, controls: xr.Dataset | None) -> xr.DataArray:
        """A signal with its controls taken out, which are prepared as it is; velocity has none."""
        if controls is None or not len(controls):
            return series
        return without_controls(series, [self._prepared(one) for one in controls.data_vars.values()])


def series_of(activity: xr.Dataset, name: str) -> xr.DataArray:
    """A signal of a cell by its name: a channel in its windows, or a velocity by sector."""
    found = activity[name] if name in VELOCITIES else activity["mean"].sel(channel=name, drop=True)
    return found.rename(name)


def given_to(
    source: str, target: str, names: Sequence[str], given: Sequence[str] | None, network: bool
) -> tuple[str, ...]:
    """What is given where a source is to predict a target.

    Parameters
    ----------
    source, target : str
    names : sequence of str
        Of all signals.
    given : sequence of str, or None
        As it was asked for.
    network : bool
        Whether all others are given where nothing else was asked for.
    """
    asked = (names if network else ()) if given is None else given
    return tuple(name for name in asked if name not in (source, target))

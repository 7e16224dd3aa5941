"""Controls of the cells of a study: made from its maps and the images it was measured on, and channels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.controls.geometry_controls import geometry_controls
from cytodisk.analysis.controls.without_controls import FEWEST_FRAMES
from cytodisk.errors import CytodiskError
from cytodisk.images.signal_files import FrameSource
from cytodisk.runs.run_options import Progress
from cytodisk.runs.used_series.chosen_series import chosen_sectors
from cytodisk.runs.used_series.used_parameters import UsedSeriesParameters
from cytodisk.store.inputs.study_signal import FoundSignal, find_signal
from cytodisk.store.study import Study
from cytodisk.windows.study_grid import polar_grid_of


@dataclass(frozen=True, eq=False)
class FoundControls:
    """What is to be regressed out of the signals of one cell.

    Attributes
    ----------
    by_channel : dict of str to Dataset
        Controls of each signal, which may have no variables.
    not_tested : str
        Why controls by geometry are missing; empty if they are there, or were not asked for.
    """

    by_channel: dict[str, xr.Dataset]
    not_tested: str = ""

    @property
    def there(self) -> bool:
        """Whether there is anything to regress out."""
        return any(len(controls) for controls in self.by_channel.values())


def too_few_frames(frames: float, when: str = "at other times") -> str:
    """Why nothing is left without geometry: so few frames, median over windows, have controls."""
    return (
        f"the cell moves on: half of the windows have {frames:.0f} frames or fewer at places that it held "
        f"{when}, too; {FEWEST_FRAMES} are needed"
    )


@dataclass(frozen=True)
class CellControls:
    """Makes the controls of a cell; the same for all cells of a study.

    Attributes
    ----------
    study : Study
    max_lag : int
        In frames.
    options : UsedSeriesParameters
    control : tuple of str
        Channels that are regressed out, too.
    """

    study: Study
    max_lag: int
    options: UsedSeriesParameters
    control: tuple[str, ...] = ()

    @property
    def asked(self) -> bool:
        """Whether anything is to be regressed out."""
        return self.options.geometry or bool(self.control)

    def of(
        self, cell: int, activity: xr.Dataset, channels: Sequence[str], progress: Progress | None
    ) -> FoundControls:
        """Controls of some channels of a cell.

        Parameters
        ----------
        cell : int
        activity : Dataset
            Of the cell, of the frames and sectors that are used.
        channels : sequence of str
        progress : callable, optional
            Called with (steps done, in all).
        """
        options = self.options
        given = {
            f"channel {name}": activity["mean"].sel(channel=name, drop=True).load() for name in self.control
        }
        by_channel = {channel: xr.Dataset(given) for channel in channels}
        if not options.geometry:
            return FoundControls(by_channel)
        try:
            made = self._geometry(cell, activity, channels, progress)
        except CytodiskError as error:
            return FoundControls(by_channel, str(error))
        if isinstance(made, str):
            return FoundControls(by_channel, made)
        for channel in channels:
            by_channel[channel] = by_channel[channel].assign(
                {str(name): one.sel(channel=channel, drop=True) for name, one in made.data_vars.items()}
            )
        return FoundControls(by_channel)

    def _geometry(
        self, cell: int, activity: xr.Dataset, channels: Sequence[str], progress: Progress | None
    ) -> xr.Dataset | str:
        """Controls made from the movie itself, by channel; or why there are none."""
        found = self._signal
        if found.source is None:
            return found.fault or "the study has no signal"
        frames = activity["frame"].to_numpy()
        used = sorted({int(frame) for frame in frames} - set(self.options.without_frames))
        if len(used) < FEWEST_FRAMES:
            return f"{len(used)} frames are too few, {FEWEST_FRAMES} are needed"
        movie, grid = self.study.movie(cell), self._grid
        names = [str(name) for name in self.study.activity(cell)["channel"].to_numpy()]
        images = _Channels(found.source, [names.index(channel) for channel in channels], len(movie))
        made = geometry_controls(movie, grid, images, self.max_lag, frames=used, progress=progress)
        made = made.assign_coords(channel=list(channels)).sel(frame=frames)
        return made.isel(sector=chosen_sectors(self.options, grid.sectors))

    @cached_property
    def _signal(self) -> FoundSignal:
        """The images that the study was measured on, their hash checked once."""
        return find_signal(self.study)

    @property
    def _grid(self) -> Any:
        return polar_grid_of(self.study.provenance)


@dataclass(frozen=True, eq=False)
class _Channels:
    """Some channels of a movie, frame by frame, as `geometry_controls` takes them."""

    source: FrameSource
    numbers: list[int]
    frames: int

    def __len__(self) -> int:
        return self.frames

    def __getitem__(self, frame: int) -> np.ndarray[Any, Any]:
        return self.source.frame(frame)[self.numbers]

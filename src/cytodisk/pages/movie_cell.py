"""One cell of a movie's study, opened to be shown."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import xarray as xr

from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.scale import Scale
from cytodisk.store.study import Study
from cytodisk.windows.polar_windows import PolarGrid, polar_windows


@dataclass(frozen=True, eq=False)
class MovieCell:
    """A cell's tables and maps.

    Attributes
    ----------
    study : Study
    cell : int
    """

    study: Study
    cell: int

    @cached_property
    def activity(self) -> xr.Dataset:
        """The signal and the edge in all frames, dims (time, channel, layer, sector)."""
        return self.study.activity(self.cell)

    @cached_property
    def maps(self) -> DiskMovie:
        """Maps by number of the frame: frame 0 is the recording's, also if the cell enters later."""
        return self.study.movie(self.cell)

    @property
    def scale(self) -> Scale:
        """µm per pixel and seconds per frame, or unknown."""
        return self.study.scale

    @cached_property
    def channels(self) -> list[str]:
        """Names of the signal's channels, as the tables have them; empty without a signal."""
        return [str(name) for name in self.activity["channel"].to_numpy()] if "mean" in self.activity else []

    @cached_property
    def grid(self) -> PolarGrid:
        """The windows on the disk."""
        sizes = self.activity.sizes
        return polar_windows(sizes["layer"], sizes["sector"], self.study.provenance["parameters"]["spacing"])

    def unit(self, name: str) -> str:
        """Unit of a variable of the activity."""
        return str(self.activity[name].attrs.get("units", ""))

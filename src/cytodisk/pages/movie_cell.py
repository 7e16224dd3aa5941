"""One cell of a movie's study, opened to be shown."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import xarray as xr

from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.runs.depth_layers import layer_borders
from cytodisk.scale import Scale
from cytodisk.store.study import Study
from cytodisk.windows.polar_windows import PolarGrid
from cytodisk.windows.study_grid import polar_grid_of

_FRAMES = 9  # from which the radii of layers by depth are taken, at most


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

    @property
    def depths(self) -> xr.DataArray:
        """Depth of the windows in all frames; NaN in a study that was made before windows had one."""
        if "depth" in self.activity:
            return self.activity["depth"].assign_attrs(borders=layer_borders(self.grid))
        unknown = xr.full_like(self.activity["area"], np.nan)
        return unknown.assign_attrs(units=self.scale.length_unit)

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
        """The windows on the disk; with layers by depth, their radii are those of a frame."""
        return polar_grid_of(self.study.provenance)

    @cached_property
    def disk_grid(self) -> PolarGrid:
        """The windows on the disk as they are drawn: radii that frames differ in are medians over these."""
        if self.grid.has_radii:
            return self.grid
        mapped = np.flatnonzero(self.maps.mapped)
        places = np.linspace(0, len(mapped) - 1, min(_FRAMES, len(mapped)))
        maps = [self.maps[int(mapped[place])] for place in np.unique(places.round().astype(int))]
        radii = np.median([self.grid.on(disk).grid.radii for disk in maps], axis=0)
        return self.grid.with_radii(radii)

    @property
    def cytoplasm_layers(self) -> int | None:
        """How many layers are not in the nucleus, of cells with one; None of others."""
        return self.grid.cytoplasm_layers if self.grid.nucleus_layers else None

    def unit(self, name: str) -> str:
        """Unit of a variable of the activity."""
        return str(self.activity[name].attrs.get("units", ""))

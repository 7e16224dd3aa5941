"""What waves of a cell are looked for in: its values by time and window, and how long the way around is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.used_series.chosen_series import chosen_series
from cytodisk.runs.used_series.used_parameters import UsedSeriesParameters
from cytodisk.runs.waves.wave_run_parameters import WavesParameters
from cytodisk.scale import Scale
from cytodisk.store.study import Study


@dataclass(frozen=True, eq=False)
class WaveSeries:
    """The values of one cell, from the first frame with any to the last.

    Attributes
    ----------
    activity : Dataset
        Of the cell, of the frames that are used.
    values : DataArray with dims (time, sector) or (time, layer, sector)
        Velocity has no layers.
    """

    activity: xr.Dataset
    values: xr.DataArray

    @property
    def layers(self) -> list[int | None]:
        """Numbers of the layers; of velocity None alone."""
        if "layer" not in self.values.dims:
            return [None]
        return [int(layer) for layer in self.values["layer"].to_numpy()]

    def of(self, layer: int | None) -> xr.DataArray:
        """The values of a layer, dims (time, sector)."""
        return self.values if layer is None else self.values.sel(layer=layer, drop=True)

    def way(self, layer: int | None) -> FloatArray:
        """Length of each sector along the edge, or along the middle of a layer inside; in units of the study.

        Returns
        -------
        ndarray of shape (T, S) and dtype float
            NaN in frames without a map.
        """
        if not layer:
            length = self.activity["edge_length"].transpose("time", "sector").to_numpy()
            return _last_filled(np.asarray(length, dtype=np.float64))
        places = [
            self.activity[f"centroid_{axis}"].sel(layer=layer).transpose("time", "sector").to_numpy()
            for axis in "yx"
        ]
        steps = np.hypot(*(np.roll(one, -1, axis=1) - one for one in places))
        between = Scale.of(self.values).length(steps)  # centroids are in px
        return np.asarray(0.5 * (between + np.roll(between, 1, axis=1)))

    @property
    def edge_length(self) -> float:
        """Length of the whole edge, median over frames; NaN if none is known."""
        whole = self.way(None).sum(axis=1)
        return float(np.nanmedian(whole)) if np.isfinite(whole).any() else float("nan")


def wave_series(study: Study, signal: str, cell: int, options: WavesParameters) -> WaveSeries:
    """Values of a cell of the frames that are used.

    Raises
    ------
    ParameterError
        There are no such frames, or no values.
    """
    activity = chosen_series(study.activity(cell), used_series(options))
    values = activity[signal] if signal in VELOCITIES else activity["mean"].sel(channel=signal, drop=True)
    values = values.transpose("time", ..., "sector").load()
    values = values.drop_vars(["centroid_y", "centroid_x"], errors="ignore").assign_attrs(study.scale.attrs)
    there = np.flatnonzero(np.isfinite(values.to_numpy()).reshape(len(values), -1).any(axis=1))
    if not there.size:
        raise ParameterError(f"cell {cell} has no values of {signal}")
    used = slice(int(there[0]), int(there[-1]) + 1)
    return WaveSeries(activity.isel(time=used), values.isel(time=used))


def used_series(options: WavesParameters) -> UsedSeriesParameters:
    """What is used of a cell: some frames, and the whole way around."""
    return UsedSeriesParameters(
        frames=options.frames, without_frames=options.without_frames, geometry=options.geometry
    )


def _last_filled(length: FloatArray) -> FloatArray:
    """The last frame has no step to the next, and takes the lengths of the one before."""
    if len(length) > 1 and not np.isfinite(length[-1]).any():
        length = length.copy()
        length[-1] = length[-2]
    return length

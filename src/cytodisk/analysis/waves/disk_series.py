"""Values in windows of the whole disk as waves need them: checked, with seconds, places and depths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.waves.edge_modes import highest_mode, mode_weights, modes_of
from cytodisk.analysis.waves.edge_series import EdgeSeries, frame_times, sector_lengths
from cytodisk.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from cytodisk.errors import ParameterError


@dataclass(frozen=True, eq=False)
class DiskSeries:
    """All layers of a cell that have values.

    Attributes
    ----------
    layers : tuple of EdgeSeries
        With the same seconds.
    numbers : ndarray of shape (L,) and dtype int
        Place of these layers in the values.
    depth : ndarray of shape (L,) and dtype float
        In µm, or in layers where that is not known.
    is_um : bool
    """

    layers: tuple[EdgeSeries, ...]
    numbers: IntArray
    depth: FloatArray
    is_um: bool

    @property
    def used(self) -> BoolArray:
        """Frames in which each layer has at least half of its sectors."""
        return np.asarray(np.logical_and.reduce([layer.used for layer in self.layers]))

    def whole(self) -> EdgeSeries:
        """All windows as if they were sectors of one layer, with the frames that are not used empty."""
        first = self.layers[0]
        values = np.concatenate([layer.values for layer in self.layers], axis=1)
        values = np.where(self.used[:, None], values, np.nan)
        lengths = np.full(values.shape, 1.0 / values.shape[1])
        return EdgeSeries(values, first.seconds, lengths, first.edge_um)

    def modes(self, max_mode: int) -> ComplexArray:
        """Modes around the cell of the frames that are used, shape (T, M + 1, L)."""
        used, found = self.used, []
        for layer in self.layers:
            values = layer.values[used]
            highest = highest_mode(values.shape[1], max_mode)
            weights = mode_weights(layer.lengths[used], np.isfinite(values), highest)
            found.append(modes_of(values[:, :, None], weights)[:, :, 0])
        return np.stack(found, axis=2)


def disk_series(
    values: xr.DataArray, frame_interval_s: float | None, edge_length_um: Any, depth_um: Any
) -> DiskSeries:
    """Layers with their depth.

    Parameters
    ----------
    values : DataArray with dims (time, layer, sector)
    frame_interval_s, edge_length_um, depth_um
        See `disk_waves`.

    Raises
    ------
    ParameterError
        Nothing has a value, or an argument does not fit.
    """
    seconds = frame_times(values, frame_interval_s)
    frames, layers, sectors = values.shape
    lengths, edge_um = sector_lengths(edge_length_um, (frames, sectors))
    plain = values.to_numpy().astype(np.float64)
    known = np.flatnonzero(np.isfinite(plain).any(axis=(0, 2)))
    if not known.size:
        raise ParameterError("values holds nothing but NaN: pass a signal with values")
    if depth_um is None and "depth_um" in values.coords:
        depth_um = values["depth_um"]
    depth = np.arange(float(layers)) if depth_um is None else _by_layer(depth_um, (frames, layers, sectors))
    depth = depth[known]
    if not (np.isfinite(depth).all() and (np.diff(depth) > 0).all()):
        raise ParameterError(
            "depth_um must be known for all layers with values and increase from layer to layer, got "
            f"{', '.join(f'{one:g}' for one in depth)}: number layers from the edge inwards"
        )
    series = tuple(EdgeSeries(plain[:, layer], seconds, lengths, edge_um) for layer in known)
    return DiskSeries(series, known, depth, depth_um is not None)


def _by_layer(depth_um: Any, shape: tuple[int, int, int]) -> FloatArray:
    """Mean depth of each layer, over time and sectors where it is given by them."""
    frames, layers, sectors = shape
    if isinstance(depth_um, xr.DataArray) and set(depth_um.dims) <= {"time", "layer", "sector"}:
        depth_um = depth_um.transpose("time", "layer", "sector", missing_dims="ignore")
    try:
        given = np.asarray(depth_um, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ParameterError(f"depth_um must be numbers: {error}") from error
    axes = {
        (layers,): (),
        (layers, sectors): (1,),
        (frames, layers): (0,),
        (frames, layers, sectors): (0, 2),
    }.get(given.shape)
    if axes is None:
        raise ParameterError(
            f"depth_um must be by layer ({layers},), (layer, sector), (time, layer) or (time, layer, "
            f"sector), got shape {given.shape}"
        )
    known = np.isfinite(given)
    count = known.sum(axis=axes)
    total = np.where(known, given, 0.0).sum(axis=axes)
    return np.asarray(np.where(count > 0, total / np.maximum(count, 1), np.nan))

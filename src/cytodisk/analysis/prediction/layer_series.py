"""Signals laid out for autoregressions: one set of series (time, sector) for each layer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.correlation.cluster_fields import WindowRing
from cytodisk.analysis.correlation.pairing import aligned_series
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.scale import Scale

_DIMS = ("time", "layer", "sector")


@dataclass(frozen=True, eq=False)
class LayerSeries:
    """Series of one layer.

    Attributes
    ----------
    target, source : ndarray of shape (T, S) and dtype float
        NaN where there is no value.
    beside : tuple of ndarray of shape (T, S)
        The target of the neighbours: to both sides, of one where there is one, none where there is none.
    given : tuple of ndarray of shape (T, S)
    turns : bool
        Whether the source can be turned around the cell: it differs between sectors.
    """

    target: FloatArray
    source: FloatArray
    beside: tuple[FloatArray, ...]
    given: tuple[FloatArray, ...]
    turns: bool

    @property
    def reversed(self) -> LayerSeries:
        """The same on reversed time."""
        beside, given = (tuple(one[::-1] for one in some) for some in (self.beside, self.given))
        return LayerSeries(self.target[::-1], self.source[::-1], beside, given, self.turns)


@dataclass(frozen=True, eq=False)
class Signals:
    """Source, target and given signals with the same frames and windows.

    Attributes
    ----------
    source, target : DataArray
    given : dict of str to DataArray
    scale : Scale
        Of time alone.
    """

    source: xr.DataArray
    target: xr.DataArray
    given: dict[str, xr.DataArray]
    scale: Scale

    @classmethod
    def of(cls, source: Any, target: Any, given: Any) -> Signals:
        """Signals from what a user passes.

        Raises
        ------
        ParameterError
            They do not fit each other, or have other dims than time, layer and sector.
        """
        named = _named_given(given)
        words = {"source": source, "target": target} | {f"given {name}": one for name, one in named.items()}
        series, scale = aligned_series(words)
        for name, one in zip(words, series, strict=True):
            if other := [str(dim) for dim in one.dims if dim not in _DIMS]:
                raise ParameterError(
                    f"{name} has the dims {[str(dim) for dim in one.dims]}: select one {other[0]}, so that "
                    "time, layer and sector are left"
                )
        signals = cls(series[0], series[1], dict(zip(named, series[2:], strict=True)), scale)
        for name, one in zip(words, series, strict=True):
            if "sector" in one.dims and "sector" not in signals.target.dims:
                raise ParameterError(
                    f"target has no sectors, but {name} has: average {name} over its sectors, or pass the "
                    "target by sector"
                )
            if "layer" in one.dims and name.startswith("given") and not signals.has_layers:
                raise ParameterError(
                    f"{name} has layers, but neither source nor target has: select one of its layers"
                )
        return signals

    @property
    def has_layers(self) -> bool:
        """Whether there is one model for each layer."""
        return "layer" in self.source.dims or "layer" in self.target.dims

    @property
    def layers(self) -> FloatArray | None:
        """Numbers of the layers."""
        if not self.has_layers:
            return None
        with_layers = self.source if "layer" in self.source.dims else self.target
        return np.asarray(with_layers["layer"].to_numpy())

    def layer(self, place: int, neighbours: bool, edge_sectors: int | None) -> LayerSeries:
        """Series of the layer at a place."""
        target = _table(self.target, place, 1)
        sectors = target.shape[1]
        beside: tuple[FloatArray, ...] = ()
        if neighbours and "sector" in self.target.dims:
            beside = _beside(target, self.target["sector"].to_numpy(), edge_sectors)
        given = tuple(_table(one, place, sectors) for one in self.given.values())
        return LayerSeries(
            target, _table(self.source, place, sectors), beside, given, "sector" in self.source.dims
        )


def _named_given(given: Any) -> dict[str, Any]:
    if isinstance(given, xr.DataArray | np.ndarray):
        raise ParameterError("given must be a sequence of signals, or a dict of them by name: pass [signal]")
    if isinstance(given, xr.Dataset):
        raise ParameterError("given is a Dataset: pass a dict of DataArrays by name")
    if isinstance(given, Mapping):
        return {str(name): one for name, one in given.items()}
    if not isinstance(given, Sequence) or isinstance(given, str):
        raise ParameterError(
            f"given must be a sequence of signals, or a dict of them, got {type(given).__name__}"
        )
    names = [str(getattr(one, "name", None) or f"{place}") for place, one in enumerate(given)]
    if len(set(names)) < len(names):
        names = [str(place) for place in range(len(names))]
    return dict(zip(names, given, strict=True))


def _table(series: xr.DataArray, place: int, sectors: int) -> FloatArray:
    """Values (T, S) of one layer."""
    chosen = series.isel(layer=place) if "layer" in series.dims else series
    if "sector" in chosen.dims:
        return np.ascontiguousarray(chosen.transpose("time", "sector").to_numpy(), dtype=np.float64)
    return np.repeat(chosen.to_numpy().astype(np.float64)[:, None], sectors, axis=1)


def _beside(target: FloatArray, numbers: Any, edge_sectors: int | None) -> tuple[FloatArray, ...]:
    """Target of the sectors to both sides, NaN where the edge goes on with a sector that is not there."""
    if edge_sectors is not None and edge_sectors <= numbers.max():
        raise ParameterError(
            f"edge_sectors is {edge_sectors}, but there is a sector {numbers.max()}: pass the number of "
            "sectors of the whole edge"
        )
    ring = WindowRing.of(numbers, edge_sectors)
    around = np.full((len(target), ring.count), np.nan)
    around[:, ring.columns] = target
    sides = tuple(around[:, (ring.columns + step) % ring.count] for step in (-1, 1))
    if len(numbers) == 1:
        return ()
    if len(numbers) == 2:  # each has the other one alone
        return (np.where(np.isnan(sides[0]), sides[1], sides[0]),)
    return sides

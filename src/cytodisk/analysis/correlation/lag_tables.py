"""Correlations of two signals at every lag, series by series, with what surrogates give."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.correlation.cluster_fields import WindowRing
from cytodisk.analysis.correlation.cluster_null import ClusterNull
from cytodisk.analysis.correlation.confidence import effective_share, fisher_interval
from cytodisk.analysis.correlation.lagged import LaggedSeries
from cytodisk.analysis.correlation.pairing import Pair
from cytodisk.analysis.correlation.surrogates import Surrogates
from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.scale import Scale

ALPHA = 0.05
SECTOR = "sector"


class LagTables:
    """Tables of one correlation, filled series by series of `b`."""

    def __init__(self, pair: Pair, lags: IntArray, skipped: BoolArray, min_pairs: int, surrogates: int):
        self._pair, self._lags, self._skipped, self._min_pairs = pair, lags, skipped, min_pairs
        windows = pair.a.shape[1:]
        own = len(pair.own)
        self._correlation, self._count = np.full((2, len(lags), *windows), np.nan)
        self._null = np.full((surrogates, *windows), np.nan)
        self._sector = pair.own.index(SECTOR) if SECTOR in pair.own else None
        if self._sector is not None and surrogates:
            self._merged = tuple(n for k, n in enumerate(windows) if k != self._sector)
            shape = (*self._merged[: own - 1], len(lags), *self._merged[own - 1 :], surrogates)
            self._total, self._known = np.zeros((2, *shape))
        self._clusters: ClusterNull | None = None

    def keep_clusters(self, ring: WindowRing) -> None:
        """Ask for what chance gives for clusters of windows, before the tables are filled."""
        windows = dict(zip(self._pair.dims, self._pair.a.shape[1:], strict=True))
        self._clusters = ClusterNull(len(self._lags), windows, len(self._null), ring)

    def correlate(self, surrogates: Surrogates | None, progress: Callable[[int, int], None] | None) -> None:
        """Fill the tables."""
        own = self._pair.b.shape[1:]
        for done, place in enumerate(np.ndindex(own)):
            lagged = LaggedSeries(self._series(place), self._lags)
            b = self._pair.b[(slice(None), *place)]
            found, count = lagged.correlate(b[:, None], self._min_pairs)
            found[self._skipped] = np.nan
            self._correlation[(slice(None), *place)] = self._unfold(found)[..., 0]
            self._count[(slice(None), *place)] = self._unfold(np.broadcast_to(count, found.shape))[..., 0]
            if surrogates is not None:
                chance = self._by_chance(lagged, surrogates.alone(b))
                self._null[(slice(None), *place)] = np.moveaxis(_largest(chance), -1, 0)
                if self._sector is not None:
                    chance = self._by_chance(lagged, surrogates.together(b))
                    self._add_to_mean(place, chance)
                    if self._clusters is not None:
                        self._clusters.put(place, chance)
            if progress is not None:
                progress(done + 1, int(np.prod(own)))

    def dataset(self, order: list[str], scale: Scale) -> xr.Dataset:
        """The tables with names, windows in a given order of dims."""
        pair, dims = self._pair, self._pair.dims
        b = pair.b.reshape(*pair.b.shape, *[1] * (pair.a.ndim - pair.b.ndim))
        n_effective = self._count * effective_share(pair.a, b)
        low, high = fisher_interval(self._correlation, n_effective, 1.0 - ALPHA)
        by_lag = {
            "correlation": self._correlation,
            "n": self._count,
            "n_effective": n_effective,
            "low": low,
            "high": high,
        }
        data: dict[str, Any] = {name: (("lag", *dims), values) for name, values in by_lag.items()}
        data |= self._chance() | self._cluster_chance(n_effective)
        coords: dict[str, Any] = {"lag": ("lag", self._lags, {"units": "frame"})} | pair.coords
        if scale.frame_interval_s is not None:
            coords["lag_s"] = ("lag", self._lags * scale.frame_interval_s, {"units": "s"})
        found = xr.Dataset(data, coords)
        found = found.transpose("surrogate", "cluster_surrogate", *order, "lag", missing_dims="ignore")
        return with_units(found.assign(n=found["n"].astype(np.int64)))

    def _series(self, place: tuple[Any, ...]) -> FloatArray:
        """Series of `a` that are compared with one of `b`, shape (T, H)."""
        return self._pair.a[(slice(None), *place)].reshape(len(self._pair.a), -1)

    def _unfold(self, table: FloatArray) -> FloatArray:
        """A table (K, H, R) with the dims of H."""
        others = self._pair.a.shape[1 + len(self._pair.own) :]
        return table.reshape(len(table), *others, table.shape[-1])

    def _by_chance(self, lagged: LaggedSeries, series: FloatArray) -> FloatArray:
        chance, _ = lagged.correlate(series, self._min_pairs)
        chance[self._skipped] = np.nan
        return self._unfold(chance)

    def _add_to_mean(self, place: tuple[Any, ...], chance: FloatArray) -> None:
        merged = tuple(k for axis, k in enumerate(place) if axis != self._sector)
        known = np.isfinite(chance)
        self._total[merged] += chance if known.all() else np.where(known, chance, 0.0)
        self._known[merged] += known

    def _chance(self) -> dict[str, Any]:
        """What surrogates gave, of windows and of the mean over sectors."""
        dims = self._pair.dims
        if not len(self._null):
            return {}
        data: dict[str, Any] = {"null": (("surrogate", *dims), self._null)}
        data["threshold"] = (dims, _threshold(self._null))
        if self._sector is not None:
            rest = tuple(dim for dim in dims if dim != SECTOR)
            with np.errstate(invalid="ignore"):
                mean = np.moveaxis(self._total / self._known, len(self._pair.own) - 1, 0)
            null = np.moveaxis(_largest(mean), -1, 0)
            data["mean_null"] = (("surrogate", *rest), null)
            data["mean_threshold"] = (rest, _threshold(null))
        return data

    def _cluster_chance(self, n_effective: FloatArray) -> dict[str, Any]:
        """What surrogates gave, of clusters of windows."""
        if self._clusters is None:
            return {}
        largest, spread = self._clusters.masses(n_effective)
        rest = [dim for dim in self._pair.dims if dim not in ("layer", SECTOR)]
        return {
            "cluster_null": (("cluster_surrogate", *rest), largest),
            "cluster_spread": (self._pair.dims, spread),
        }


def with_units(table: xr.Dataset) -> xr.Dataset:
    """The Dataset with the unit 1 in the attrs of each variable that has none: correlations, counts, p."""
    return table.assign(
        {name: values.assign_attrs({"units": "1"} | values.attrs) for name, values in table.data_vars.items()}
    )


def _largest(curves: FloatArray) -> FloatArray:
    """Largest magnitude along axis 0, NaN left out; NaN where there is nothing."""
    return np.asarray(np.fmax.reduce(np.abs(curves), axis=0))


def _threshold(null: FloatArray) -> FloatArray:
    """Magnitude that a share ALPHA of the null exceeds, along axis 0; NaN without a null."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # windows without a correlation have no null
        return np.asarray(np.nanquantile(null, 1.0 - ALPHA, axis=0, method="higher"))

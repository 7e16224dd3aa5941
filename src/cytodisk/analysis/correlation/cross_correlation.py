"""Correlation of signals in windows with the motion of the edge, or with each other, over lags."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.correlation.confidence import effective_share, fisher_interval
from cytodisk.analysis.correlation.correlation_parameters import CrossCorrelationParameters, PrepareParameters
from cytodisk.analysis.correlation.lagged import LaggedSeries
from cytodisk.analysis.correlation.pairing import Pair, named_series, paired
from cytodisk.analysis.correlation.prepared_series import (
    DRIFTING_SHARE,
    default_frames,
    drifts,
    kpss,
    prepare_series,
)
from cytodisk.analysis.correlation.surrogates import Surrogates
from cytodisk.analysis.correlation.surrogates import surrogates as make_surrogates
from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.checks import whole_number
from cytodisk.errors import ParameterError, StationarityWarning
from cytodisk.taking import takes

ALPHA = 0.05
_SECTOR = "sector"


@takes(CrossCorrelationParameters)
def cross_correlate(
    a: Any,
    b: Any,
    max_lag: int,
    *,
    progress: Callable[[int, int], None] | None = None,
    **settings: Any,
) -> xr.Dataset:
    """Pearson correlation of `a` with `b` at every lag, for every window, and what chance would give.

    Parameters
    ----------
    a : DataArray or array_like with dims (time, …)
        A signal in windows, as the mean of `sample_movie` for one channel. An array without names has the
        dims (time), (time, sector), (time, layer, sector) or (time, channel, layer, sector).
    b : DataArray or array_like with dims (time, …)
        Edge velocity (time, sector), layer 0 of a signal, or anything else that broadcasts against `a` by
        name. Frames are those of `a`.
    max_lag : int
        In frames, to both sides of 0.
    progress : callable, optional
        Called with (series of `b` done, in all).
    **settings
        See `CrossCorrelationParameters`; both series are prepared, see `prepare_series`.

    Returns
    -------
    Dataset with the dims of the windows and lag
        correlation, of a[t] with b[t + lag]: at a positive lag `b` follows `a`; n, pairs; n_effective, what
        they are worth given the autocorrelations; low and high, the 95 % confidence interval by it. With
        surrogates also null, the largest |correlation| of each at any lag, and threshold, which 5 % of them
        exceed; with sectors mean_null and mean_threshold, those of the mean over sectors, for
        `correlation_by_layer`. The coordinate
        lag_s is there when `a` or `b` has time_s. Edge velocity stands at the start of its step, so it is
        half a frame later than its lag says.

    Raises
    ------
    ParameterError
        `a` and `b` do not fit, frames are not consecutive, the lag leaves fewer than `min_pairs` pairs, or an
        option is unknown.

    Warns
    -----
    StationarityWarning
        The level of more than a quarter of the series drifts, so that correlations may be spurious.

    See Also
    --------
    peak_correlation : The peak of each window with its p and q.
    correlation_by_layer : Means over sectors.
    correlate_pairs : All windows with all others, by distance.

    References
    ----------
    u-Unwrap, section 4.3, Fig. 5.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = [[True] * 4]
    >>> signal, velocity = cd.simulate.coupled_series("white", 0, 80, 1, 4, lag_frames=3, windows=windows)
    >>> correlations = cd.cross_correlate(signal, velocity, max_lag=5)
    >>> correlations["correlation"].mean("sector").idxmax("lag").item()  # the edge moves before the signal
    -3.0
    """
    how = CrossCorrelationParameters.of(**settings)
    first, second, interval_s = named_series(a, b)
    lags = lags_within(max_lag, how.min_pairs, first.sizes["time"])
    _check_skipped(how.skip_lags, lags)
    options = how.part(PrepareParameters).changed(detrend_frames=default_frames(how, max_lag)).model_dump()
    first, second = (series.copy(data=prepare_series(series, **options)) for series in (first, second))
    attrs = {name: value for name, value in options.items() if value is not None}
    attrs |= {
        "max_lag": max_lag,
        "min_pairs": how.min_pairs,
        "skip_lags": list(how.skip_lags),
        "null": how.null,
        "seed": how.seed,
    }
    attrs |= drifting_shares(first, second)
    pair = paired(first, second)
    changed = (
        make_surrogates(how.null, len(pair.a), how.surrogates, how.seed, max_lag) if how.surrogates else None
    )
    attrs["surrogates"] = changed.count if changed else 0
    run = _Run(pair, lags, np.isin(lags, how.skip_lags), how.min_pairs, attrs["surrogates"])
    run.correlate(changed, progress)
    order = [str(dim) for dim in (*first.dims, *second.dims) if dim != "time"]
    return run.dataset(list(dict.fromkeys(order)), interval_s).assign_attrs(attrs)


def correlation_by_layer(correlations: xr.Dataset) -> xr.Dataset:
    """Mean over sectors of the correlations, and what chance would give for it.

    Parameters
    ----------
    correlations : Dataset
        Of `cross_correlate`, with sectors.

    Returns
    -------
    Dataset with the dims of the windows but sector, and lag
        correlation, the mean over sectors; lower_quartile and upper_quartile over them. With surrogates also
        threshold and null of the mean, as those of `cross_correlate`, but of surrogates that keep how sectors
        correlate with each other at every lag (`filtered_noise`): neighbours that move together, and waves
        that run around the edge, are not taken for independent.

    Raises
    ------
    ParameterError
        There are no sectors.

    See Also
    --------
    cross_correlate : Makes the correlations.
    peak_correlation : The peak of each window.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = [[True] * 4]
    >>> signal, velocity = cd.simulate.coupled_series("white", 0, 80, 1, 4, lag_frames=3, windows=windows)
    >>> correlations = cd.cross_correlate(signal, velocity, max_lag=5, surrogates=99)
    >>> layers = cd.correlation_by_layer(correlations)
    >>> found = layers.sel(layer=0, lag=-3)  # where the simulation has it
    >>> bool(found["correlation"] > found["threshold"])
    True
    """
    curves = correlations.get("correlation") if isinstance(correlations, xr.Dataset) else None
    if curves is None or _SECTOR not in curves.dims:
        raise ParameterError("correlations must be the Dataset that cross_correlate returns, with sectors")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # lags without a correlation have no quartiles
        quartiles = curves.quantile([0.25, 0.75], dim=_SECTOR)
    data = {
        "correlation": curves.mean(_SECTOR),
        "lower_quartile": quartiles.isel(quantile=0, drop=True),
        "upper_quartile": quartiles.isel(quantile=1, drop=True),
    }
    for name in ("threshold", "null"):
        if f"mean_{name}" in correlations:
            data[name] = correlations[f"mean_{name}"]
    return xr.Dataset(data, attrs=correlations.attrs)


class _Run:
    """Tables of one correlation, filled series by series of `b`."""

    def __init__(self, pair: Pair, lags: IntArray, skipped: BoolArray, min_pairs: int, surrogates: int):
        self._pair, self._lags, self._skipped, self._min_pairs = pair, lags, skipped, min_pairs
        windows = pair.a.shape[1:]
        own = len(pair.own)
        self._correlation, self._count = np.full((2, len(lags), *windows), np.nan)
        self._null = np.full((surrogates, *windows), np.nan)
        self._sector = pair.own.index(_SECTOR) if _SECTOR in pair.own else None
        if self._sector is not None and surrogates:
            self._merged = tuple(n for k, n in enumerate(windows) if k != self._sector)
            shape = (*self._merged[: own - 1], len(lags), *self._merged[own - 1 :], surrogates)
            self._total, self._known = np.zeros((2, *shape))

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
                    self._add_to_mean(place, self._by_chance(lagged, surrogates.together(b)))
            if progress is not None:
                progress(done + 1, int(np.prod(own)))

    def dataset(self, order: list[str], frame_interval_s: float | None) -> xr.Dataset:
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
        data |= self._chance()
        coords: dict[str, Any] = {"lag": ("lag", self._lags, {"units": "frame"})} | pair.coords
        if frame_interval_s is not None:
            coords["lag_s"] = ("lag", self._lags * frame_interval_s, {"units": "s"})
        found = xr.Dataset(data, coords).transpose("surrogate", *order, "lag", missing_dims="ignore")
        return found.assign(n=found["n"].astype(np.int64))

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
            rest = tuple(dim for dim in dims if dim != _SECTOR)
            with np.errstate(invalid="ignore"):
                mean = np.moveaxis(self._total / self._known, len(self._pair.own) - 1, 0)
            null = np.moveaxis(_largest(mean), -1, 0)
            data["mean_null"] = (("surrogate", *rest), null)
            data["mean_threshold"] = (rest, _threshold(null))
        return data


def lags_within(max_lag: int, min_pairs: int, frames: int) -> IntArray:
    """Lags from -max_lag to max_lag; ParameterError when a movie of so many frames is too short for them."""
    max_lag, min_pairs = whole_number("max_lag", max_lag, 0), whole_number("min_pairs", min_pairs, 3)
    if frames - max_lag < min_pairs:
        most = frames - min_pairs
        advice = f"pass at most {most}" if most >= 0 else "that is too short a movie"
        raise ParameterError(
            f"max_lag {max_lag} leaves {max(frames - max_lag, 0)} pairs of {frames} frames, fewer than "
            f"min_pairs {min_pairs}: {advice}"
        )
    return np.arange(-max_lag, max_lag + 1)


def _check_skipped(skipped: Sequence[int], lags: IntArray) -> None:
    unknown = [lag for lag in skipped if lag not in lags]
    if unknown:
        raise ParameterError(f"skip_lags has {unknown[0]!r}: lags run from {lags[0]} to {lags[-1]}")
    if len(set(skipped)) == len(lags):
        raise ParameterError("skip_lags leaves no lag: pass fewer, or a larger max_lag")


def drifting_shares(a: xr.DataArray, b: xr.DataArray) -> dict[str, float]:
    """Share of the series whose level drifts; warns where it is large."""
    shares = {}
    for name, series in (("a", a), ("b", b)):
        known = np.isfinite(kpss(series))
        share = float(drifts(series)[known].mean()) if known.any() else 0.0
        shares[f"drifting_{name}"] = share
        if share > DRIFTING_SHARE:
            warnings.warn(
                f"the level of {share:.0%} of the series of {name} drifts: they "
                "may correlate for that alone; detrend, or take first differences",
                StationarityWarning,
                stacklevel=3,
            )
    return shares


def _largest(curves: FloatArray) -> FloatArray:
    """Largest magnitude along axis 0, NaN left out; NaN where there is nothing."""
    return np.asarray(np.fmax.reduce(np.abs(curves), axis=0))


def _threshold(null: FloatArray) -> FloatArray:
    """Magnitude that a share ALPHA of the null exceeds, along axis 0; NaN without a null."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # windows without a correlation have no null
        return np.asarray(np.nanquantile(null, 1.0 - ALPHA, axis=0, method="higher"))

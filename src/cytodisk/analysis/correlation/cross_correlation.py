"""Correlation of signals in windows with the motion of the edge, or with each other, over lags."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.correlation.cluster_fields import WindowRing
from cytodisk.analysis.correlation.correlation_parameters import CrossCorrelationParameters, PrepareParameters
from cytodisk.analysis.correlation.lag_tables import SECTOR, LagTables, with_units
from cytodisk.analysis.correlation.pairing import Pair, named_series, paired
from cytodisk.analysis.correlation.prepared_series import (
    DRIFTING_SHARE,
    default_frames,
    drifting_share,
    prepare_series,
)
from cytodisk.analysis.correlation.ranks import scored
from cytodisk.analysis.correlation.surrogates import surrogates as make_surrogates
from cytodisk.arrays import IntArray
from cytodisk.checks import whole_number
from cytodisk.errors import ParameterError, StationarityWarning
from cytodisk.taking import takes


@takes(CrossCorrelationParameters)
def cross_correlate(
    a: Any,
    b: Any,
    max_lag: int,
    *,
    progress: Callable[[int, int], None] | None = None,
    **settings: Any,
) -> xr.Dataset:
    """Correlation of `a` with `b` at every lag, for every window, and what chance would give.

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
        `correlation_by_layer`; with `clusters` cluster_null and cluster_spread, for `correlation_clusters`.
        The coordinate lag_s is there when `a` or `b` has time_s. Edge velocity stands at the start of its
        step, so it is half a frame later than its lag says.

        The attrs are the settings; `statistic` says whether values or ranks were correlated.

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
    correlation_clusters : Neighbouring windows that agree.
    correlate_pairs : All windows with all others, by distance.

    References
    ----------
    u-Unwrap, section 4.3, Fig. 5; for ranks Spearman (1904), doi:10.2307/1412159.

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
    first, second, scale = named_series(a, b)
    lags = lags_within(max_lag, how.min_pairs, first.sizes["time"])
    _check_skipped(how.skip_lags, lags)
    options = how.part(PrepareParameters).changed(detrend_frames=default_frames(how, max_lag)).model_dump()
    first, second = (series.copy(data=prepare_series(series, **options)) for series in (first, second))
    attrs = {name: value for name, value in options.items() if value is not None}
    attrs |= {
        "statistic": how.statistic,
        "max_lag": max_lag,
        "min_pairs": how.min_pairs,
        "skip_lags": list(how.skip_lags),
        "null": how.null,
        "seed": how.seed,
    }
    attrs |= drifting_shares(first, second)
    first, second = (series.copy(data=scored(series.to_numpy(), how.statistic)) for series in (first, second))
    pair = paired(first, second)
    changed = (
        make_surrogates(how.null, len(pair.a), how.surrogates, how.seed, max_lag) if how.surrogates else None
    )
    attrs["surrogates"] = changed.count if changed else 0
    run = LagTables(pair, lags, np.isin(lags, how.skip_lags), how.min_pairs, attrs["surrogates"])
    if how.clusters and changed:
        ring = _ring(pair, how.edge_sectors)
        run.keep_clusters(ring)
        attrs["edge_sectors"] = ring.count
    run.correlate(changed, progress)
    order = [str(dim) for dim in (*first.dims, *second.dims) if dim != "time"]
    return run.dataset(list(dict.fromkeys(order)), scale).assign_attrs(attrs)


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
    if curves is None or SECTOR not in curves.dims:
        raise ParameterError("correlations must be the Dataset that cross_correlate returns, with sectors")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # lags without a correlation have no quartiles
        quartiles = curves.quantile([0.25, 0.75], dim=SECTOR)
    data = {
        "correlation": curves.mean(SECTOR),
        "lower_quartile": quartiles.isel(quantile=0, drop=True),
        "upper_quartile": quartiles.isel(quantile=1, drop=True),
    }
    for name in ("threshold", "null"):
        if f"mean_{name}" in correlations:
            data[name] = correlations[f"mean_{name}"]
    return with_units(xr.Dataset(data, attrs=correlations.attrs))


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


def _ring(pair: Pair, edge_sectors: int | None) -> WindowRing:
    """Sectors of two series on the edge."""
    if SECTOR not in pair.own:
        raise ParameterError("clusters need sectors: pass series with the dim sector, or clusters=False")
    sectors = pair.a.shape[1 + pair.own.index(SECTOR)]
    numbers = np.asarray(pair.coords.get(SECTOR, np.arange(sectors)))
    if edge_sectors is not None and edge_sectors <= numbers.max():
        raise ParameterError(
            f"edge_sectors is {edge_sectors}, but there is a sector {numbers.max()}: pass the number of "
            "sectors of the whole edge"
        )
    return WindowRing.of(numbers, edge_sectors)


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
        shares[f"drifting_{name}"] = share = drifting_share(series)
        if share > DRIFTING_SHARE:
            warnings.warn(
                f"the level of {share:.0%} of the series of {name} drifts: they "
                "may correlate for that alone; detrend, or take first differences",
                StationarityWarning,
                stacklevel=3,
            )
    return shares

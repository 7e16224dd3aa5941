"""Correlation of every window of one signal with every window of another, by distance and lag."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from scipy.spatial.distance import cdist

from cytodisk.analysis.correlation.correlation_parameters import DetrendParameters, PairParameters
from cytodisk.analysis.correlation.cross_correlation import drifting_shares, lags_within
from cytodisk.analysis.correlation.lag_tables import ALPHA, with_units
from cytodisk.analysis.correlation.pairing import named_series
from cytodisk.analysis.correlation.prepared_series import default_frames, prepare_series
from cytodisk.analysis.correlation.ranks import scored
from cytodisk.analysis.correlation.surrogates import surrogates as make_surrogates
from cytodisk.analysis.pairs.pair_blocks import DistanceBins, distributions
from cytodisk.analysis.pairs.pair_chance import chance_of_pairs
from cytodisk.analysis.pairs.window_distances import DISTANCE_DIMS, disk_distances
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.scale import Scale
from cytodisk.taking import takes

_FRAMES_FOR_DISTANCE = 20
_WINDOW = ("layer", "sector")


@takes(PairParameters)
def correlate_pairs(
    a: Any,
    b: Any,
    max_lag: int,
    *,
    distances: Any = None,
    progress: Callable[[int, int], None] | None = None,
    **settings: Any,
) -> xr.Dataset:
    """Correlation of all windows of `a` with all windows of `b`, by their distance and the lag.

    Parameters
    ----------
    a, b : DataArray or array_like with dims (time, layer, sector)
        Two signals on the same windows, or one signal twice.
    max_lag : int
        In frames, to both sides of 0.
    distances : Dataset or DataArray of `window_distances`, or array_like of shape (W, W), optional
        Of windows in the order layer, sector. Without it, the straight distance between the windows'
        centroids, averaged over up to 20 frames, when `a` or `b` has the coordinates centroid_y and
        centroid_x, as those of `sample_movie`; else that on the unit disk with layers of equal area. The
        attrs `distance` and `units` say which.
    progress : callable, optional
        Called with (steps done, in all).
    **settings
        See `PairParameters`. Surrogates are those of `correlation_by_layer`, whose means are over many
        windows, too.

    Returns
    -------
    Dataset with dims (distance, lag), and before them `along` for a Dataset of distances
        correlation, the mean over pairs of windows; sd, lower_quartile and upper_quartile over them
        (quartiles to 0.005); n, pairs of windows. With surrogates also null_low and null_high, between which
        95 % of them lie, and threshold, which the mean's magnitude exceeds at some distance and lag in 5 % of
        them (bins with fewer pairs than half the windows left out). Coordinates distance, the middle of its
        bin; lag (frames), lag_s where the interval is known.

    Raises
    ------
    ParameterError
        The series do not fit each other or the distances, or as for `cross_correlate`.

    Warns
    -----
    StationarityWarning
        As for `cross_correlate`.

    See Also
    --------
    cross_correlate : Each window with its own partner only.
    window_distances : Distances in µm or px instead of steps of windows.

    References
    ----------
    u-Unwrap, section 4.3, Fig. S4.

    Notes
    -----
    Correlations are matrix products of 256 windows with all others at one lag, so memory is bounded by
    that and does not grow with the number of lags.

    Examples
    --------
    >>> import cytodisk as cd
    >>> signal, _ = cd.simulate.independent_series("white", 0, 60, 2, 6)
    >>> pairs = cd.correlate_pairs(signal, signal, max_lag=2)
    >>> round(pairs["correlation"].sel(distance=0, lag=0).item(), 6)  # each window with itself
    1.0
    """
    how = PairParameters.of(**settings)
    first, second, scale = named_series(a, b)
    for name, series in (("a", first), ("b", second)):
        if set(series.dims) != {"time", *_WINDOW}:
            raise ParameterError(f"{name} has the dims {list(series.dims)}: pass (time, layer, sector)")
    min_pairs, surrogates = how.min_pairs, how.surrogates
    lags = lags_within(max_lag, min_pairs, first.sizes["time"])
    frames = default_frames(how, max_lag)
    options = how.part(DetrendParameters).changed(detrend_frames=frames).model_dump()
    tables = [prepare_series(_flat(series), **options) for series in (first, second)]
    drifting = drifting_shares(*(xr.DataArray(table) for table in tables))
    tables = [scored(table, how.statistic) for table in tables]
    apart, units, kind = _distances(distances, a, b, (first.sizes["layer"], first.sizes["sector"]))
    edges = _edges(list(apart.values()), how.bins)
    sorted_pairs = [DistanceBins.of(table, edges) for table in apart.values()]
    steps = _Steps(progress, (1 + surrogates) * lags.size)
    found = distributions(tables[0], tables[1], lags, min_pairs, sorted_pairs, steps)
    dims = ("along", "distance", "lag")
    data: dict[str, Any] = {name: (dims, values) for name, values in found.items()}
    if surrogates:
        changed = make_surrogates(how.null, len(tables[1]), surrogates, how.seed, max_lag)
        chance = chance_of_pairs(tables[0], tables[1], changed, lags, min_pairs, sorted_pairs, ALPHA, steps)
        data |= {"null_low": (dims, chance.low), "null_high": (dims, chance.high)}
        data["threshold"] = ("along", chance.threshold)
    coords: dict[str, Any] = {
        "along": list(apart),
        "distance": ("distance", _centres(edges), {"units": units}),
        "lag": ("lag", lags, {"units": "frame"}),
    }
    if scale.frame_interval_s is not None:
        coords["lag_s"] = ("lag", lags * scale.frame_interval_s, {"units": "s"})
    count = changed.count if surrogates else 0
    attrs = {"distance": kind, "units": units, "surrogates": count, "null": how.null, "seed": how.seed}
    attrs["statistic"] = how.statistic
    attrs |= {name: value for name, value in options.items() if value is not None}
    out = xr.Dataset(data, coords, attrs | drifting)
    out = with_units(out.assign(n=out["n"].astype(np.int64)))
    return out if isinstance(distances, xr.Dataset) else out.isel(along=0, drop=True)


class _Steps:
    """Counts lags that are done, for the progress."""

    def __init__(self, progress: Callable[[int, int], None] | None, total: int):
        self._progress, self._total, self._done = progress, total, 0

    def __call__(self) -> None:
        self._done += 1
        if self._progress is not None:
            self._progress(self._done, self._total)


def _flat(series: xr.DataArray) -> FloatArray:
    return np.asarray(series.transpose("time", *_WINDOW).to_numpy().reshape(series.sizes["time"], -1))


def _distances(given: Any, a: Any, b: Any, shape: tuple[int, int]) -> tuple[dict[str, FloatArray], str, str]:
    """Distances by kind, each (W, W), their unit and what they are."""
    windows = shape[0] * shape[1]
    if given is None:
        for series in (a, b):
            if {"centroid_y", "centroid_x"} <= set(getattr(series, "coords", ())):
                unit = Scale.of(series["centroid_y"]).length_unit
                return {"straight": _between_centroids(series)}, unit, "straight"
        return {"disk": disk_distances(*shape)}, "disk radius", "straight on the unit disk"
    tables = (
        given.data_vars if isinstance(given, xr.Dataset) else {getattr(given, "name", None) or "given": given}
    )
    units = getattr(given, "attrs", {}).get("units", "")
    found = {}
    for name, table in tables.items():
        if isinstance(table, xr.DataArray) and set(table.dims) == set(DISTANCE_DIMS):
            table = table.transpose(*DISTANCE_DIMS)
        values = np.asarray(table)
        if values.dtype.kind not in "biuf":
            raise ParameterError(f"distances must be numbers, got dtype {values.dtype}")
        if values.size != windows**2:
            raise ParameterError(
                f"distances have shape {values.shape}: {shape[0]} layers × {shape[1]} sectors need "
                f"{windows} × {windows}, as window_distances gives for the same grid"
            )
        found[str(name)] = values.astype(np.float64).reshape(windows, windows)
        if not np.isfinite(found[str(name)]).all() or (found[str(name)] < 0).any():
            raise ParameterError("distances must be finite and not below 0")
    return found, units, ", ".join(found)


def _between_centroids(series: xr.DataArray) -> FloatArray:
    """Mean over frames of the distances between centroids, in the unit of its scale."""
    yx = np.stack([_flat(series[name]) for name in ("centroid_y", "centroid_x")], axis=-1)
    frames = np.flatnonzero(np.isfinite(yx).all(axis=(1, 2)))
    if not frames.size:
        raise ParameterError("a has no frame in which all windows have a centroid: pass distances")
    chosen = frames[np.unique(np.linspace(0, frames.size - 1, _FRAMES_FOR_DISTANCE).round().astype(int))]
    apart = np.mean([cdist(yx[number], yx[number]) for number in chosen], axis=0)
    return np.asarray(Scale.of(series["centroid_y"]).length(apart))


def _edges(tables: list[FloatArray], bins: int) -> FloatArray:
    longest = max(float(table.max()) for table in tables)
    return np.linspace(0.0, longest or 1.0, bins + 1)


def _centres(edges: FloatArray) -> FloatArray:
    return np.concatenate([[0.0], 0.5 * (edges[:-1] + edges[1:])])

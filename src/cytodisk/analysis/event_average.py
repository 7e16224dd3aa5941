"""A signal around the moments at which the edge starts, or stops, to move."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from scipy.special import ndtr
from scipy.stats import t as student

from cytodisk.analysis.event_average_parameters import EventAverageParameters, Moment, Normalisation
from cytodisk.analysis.events import Kind
from cytodisk.analysis.time_steps import frame_interval, frame_numbers
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.checks import whole_number
from cytodisk.errors import ParameterError
from cytodisk.taking import takes

# What must be known of an event for its moment to be known.
_KNOWN: dict[Moment, str] = {"onset": "onset_known", "peak": "complete", "end": "end_known"}
_LEAST_PATCHES = 5  # with fewer the band is far too narrow
_COLUMNS = ("sector", "kind", "patch")


@takes(EventAverageParameters)
def average_around(
    activity: xr.DataArray,
    events: pd.DataFrame,
    *,
    before: int,
    after: int,
    **settings: Any,
) -> xr.Dataset:
    """Mean of a signal around a moment of protrusion or retraction events, in the sector of each.

    Parameters
    ----------
    activity : DataArray with dims time and sector, and any others
        Such as the mean of `sample_movie`, with its layers, or the edge velocity itself.
    events : DataFrame
        Of `edge_events` on the same cell, frames and sectors.
    before, after : int
        Frames of the window before and after the moment.
    **settings
        See `EventAverageParameters`.

    Returns
    -------
    Dataset with the dims of `activity` but time and sector, and delay
        mean; lower and upper, the band (NaN where fewer than five patches have a value); n and n_patches, the
        events and patches that have a value there: NaN and what lies beyond the movie count for nothing.
        Coordinates delay, in frames, and delay_s where frames are evenly spaced in known time.

    Raises
    ------
    ParameterError
        The arguments do not fit each other, or one is out of its range.

    See Also
    --------
    edge_events : Finds the events.
    cross_correlate : All frames instead of those around events.

    Notes
    -----
    The events of a patch are one protrusion of the cell, and not independent. The band therefore draws
    whole patches, as many as there are, with replacement, and takes percentiles of the means over the
    events of those drawn. With few patches plain percentiles are too narrow: they are taken further out,
    as far as Student's t with one degree of freedom less than there are patches is from the normal
    distribution [1]_. In simulations of independent, normal patches a band of 95 % held the true mean in
    91 % of experiments with 5 patches, 93 % with 6 and 94 % with 10 or 30; with 4 or fewer in 88 % or less,
    which is why there is none. Patches are taken to be independent, which no one cell can show.

    What goes on in the whole movie, such as bleaching, shows as a slope at any moment: take it out before.

    References
    ----------
    .. [1] Hesterberg, "What teachers should know about the bootstrap", 2015, section 5.3,
       doi:10.1080/00031305.2015.1089789

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> import cytodisk as cd
    >>> velocity = xr.DataArray(np.zeros((12, 4)), dims=("time", "sector"), attrs={"units": "px/frame"})
    >>> velocity[4:7, 1] = 1.0
    >>> signal = velocity.shift(time=1, fill_value=0.0)  # a frame later
    >>> around = cd.average_around(signal, cd.edge_events(velocity, threshold=0.5), before=1, after=3)
    >>> around["mean"].to_numpy()
    array([0., 0., 1., 1., 1.])
    """
    how = EventAverageParameters.of(**settings)
    before, after = whole_number("before", before, 0), whole_number("after", after, 0)
    values, dims, shape = _parse(activity)
    chosen = _chosen(events, activity, how.kind, how.at)
    first = frame_numbers(activity, "activity")[0]
    delays = np.arange(-before, after + 1)
    windows = _windows(values, chosen[how.at].to_numpy() - first, _places(chosen, activity), delays)
    windows = _normalised(windows, how.normalise)
    sums, counts, patches = _by_patch(windows, chosen["patch"].to_numpy())
    means = _resampled(sums, counts, how.bootstrap, how.seed)
    lower, upper = _band(means, patches, how.confidence)
    whole = _ratio(sums.sum(axis=0), counts.sum(axis=0))
    tables = {"mean": whole, "lower": lower, "upper": upper, "n": counts.sum(axis=0), "n_patches": patches}
    data = {
        name: ((*dims, "delay"), np.moveaxis(table, 0, -1).reshape(*shape, -1))
        for name, table in tables.items()
    }
    average = xr.Dataset(data, _coordinates(activity, dims, delays))
    for name in ("n", "n_patches"):
        average[name] = average[name].astype(np.int64)
    units = "1" if how.normalise == "sd" else activity.attrs.get("units", "a.u.")
    for name in ("mean", "lower", "upper"):
        average[name].attrs["units"] = units
    return average.assign_attrs(how.model_dump())


def _parse(activity: Any) -> tuple[FloatArray, tuple[str, ...], tuple[int, ...]]:
    """Values of shape (T, S, K), and the other dims with their sizes."""
    if not isinstance(activity, xr.DataArray) or not {"time", "sector"} <= set(activity.dims):
        came = activity.dims if isinstance(activity, xr.DataArray) else type(activity).__name__
        raise ParameterError(
            f"activity must be a DataArray with dims time and sector, got {came}: "
            "pass the mean of sample_movie"
        )
    if activity.dtype.kind not in "biuf" or not activity.size:
        raise ParameterError(
            f"activity must hold numbers, got shape {activity.shape}, dtype {activity.dtype}"
        )
    ordered = activity.transpose("time", "sector", ...)
    values = ordered.to_numpy().astype(np.float64)
    return values.reshape(*values.shape[:2], -1), tuple(map(str, ordered.dims[2:])), values.shape[2:]


def _chosen(events: Any, activity: xr.DataArray, kind: Kind, at: Moment) -> pd.DataFrame:
    wanted = (*_COLUMNS, at, _KNOWN[at])
    if not isinstance(events, pd.DataFrame) or not set(wanted) <= set(events.columns):
        came = list(events.columns) if isinstance(events, pd.DataFrame) else type(events).__name__
        raise ParameterError(f"events must be the table of edge_events, got {came}")
    sectors = events.attrs.get("sectors", activity.sizes["sector"])
    if sectors != activity.sizes["sector"]:
        raise ParameterError(
            f"events are of {sectors} sectors, activity of {activity.sizes['sector']}: sample both alike"
        )
    return events[(events["kind"] == kind) & events[_KNOWN[at]]]


def _places(chosen: pd.DataFrame, activity: xr.DataArray) -> IntArray:
    sectors = chosen["sector"].to_numpy()
    if "sector" not in activity.coords:
        return sectors
    numbers = activity["sector"].to_numpy()
    strange = np.setdiff1d(sectors, numbers)
    if strange.size:
        raise ParameterError(f"events are in sector {strange[0]}, which activity has not: sample both alike")
    order = np.argsort(numbers)
    return np.asarray(order[np.searchsorted(numbers, sectors, sorter=order)], dtype=np.int64)


def _windows(values: FloatArray, moments: IntArray, sectors: IntArray, delays: IntArray) -> FloatArray:
    """Values around each moment, shape (E, D, K); NaN beyond the movie."""
    times = moments[:, None] + delays
    inside = (times >= 0) & (times < len(values))
    taken = values[np.where(inside, times, 0), sectors[:, None]]
    return np.asarray(np.where(inside[..., None] & np.isfinite(taken), taken, np.nan))


def _normalised(windows: FloatArray, normalise: Normalisation) -> FloatArray:
    if normalise == "none":
        return windows
    known = np.isfinite(windows)
    count = known.sum(axis=1, keepdims=True)
    centred = windows - _ratio(np.where(known, windows, 0.0).sum(axis=1, keepdims=True), count)
    if normalise == "mean":
        return centred
    sd = np.sqrt(_ratio((np.where(known, centred, 0.0) ** 2).sum(axis=1, keepdims=True), count))
    high = np.where(known, windows, -np.inf).max(axis=1, keepdims=True, initial=-np.inf)
    low = np.where(known, windows, np.inf).min(axis=1, keepdims=True, initial=np.inf)
    return _ratio(centred, np.where(high > low, sd, 0.0))


def _by_patch(windows: FloatArray, patch: IntArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """Sums and counts of each patch, shape (P, D, K), and how many patches have a value, shape (D, K)."""
    numbers, member = np.unique(patch, return_inverse=True)
    known = np.isfinite(windows)
    sums, counts = (np.zeros((len(numbers), *windows.shape[1:])) for _ in range(2))
    np.add.at(sums, member, np.where(known, windows, 0.0))
    np.add.at(counts, member, known)
    return sums, counts, (counts > 0).sum(axis=0)


def _resampled(sums: FloatArray, counts: FloatArray, bootstrap: int, seed: int) -> FloatArray:
    """Means over the events of patches drawn with replacement, shape (B, D, K)."""
    patches = len(sums)
    if not patches or not bootstrap:
        return np.full((0, *sums.shape[1:]), np.nan)
    drawn = np.random.default_rng(seed).multinomial(patches, np.full(patches, 1.0 / patches), bootstrap)
    weights = drawn.astype(np.float64)
    return _ratio(np.tensordot(weights, sums, axes=1), np.tensordot(weights, counts, axes=1))


def _band(means: FloatArray, patches: IntArray, confidence: float) -> tuple[FloatArray, FloatArray]:
    """Percentiles of the means, expanded for the number of patches; NaN with too few of them."""
    known = np.isfinite(means).sum(axis=0)
    usable = (patches >= _LEAST_PATCHES) & (known > 0)
    degrees = np.maximum(patches - 1, 1)
    tail = ndtr(student.ppf(0.5 * (1.0 - confidence), degrees) * np.sqrt((degrees + 1.0) / degrees))
    ordered = np.sort(np.where(np.isfinite(means), means, np.inf), axis=0)
    bounds = [
        np.where(usable, _at_rank(ordered, share * (known - 1), usable), np.nan)
        for share in (tail, 1.0 - tail)
    ]
    return bounds[0], bounds[1]


def _at_rank(ordered: FloatArray, rank: FloatArray, usable: Any) -> FloatArray:
    """Value at a rank that need not be whole, along the first axis."""
    if not len(ordered):
        return np.full(rank.shape, np.nan)
    rank = np.where(usable, rank, 0.0)
    low, high = np.floor(rank).astype(np.int64), np.ceil(rank).astype(np.int64)
    below, above = (np.take_along_axis(ordered, place[None], axis=0)[0] for place in (low, high))
    below, above = np.where(usable, below, 0.0), np.where(usable, above, 0.0)
    return np.asarray(below + (rank - low) * (above - below))


def _ratio(above: FloatArray, below: Any) -> FloatArray:
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(np.asarray(below) > 0, above / below, np.nan))


def _coordinates(activity: xr.DataArray, dims: tuple[str, ...], delays: IntArray) -> dict[str, Any]:
    coords: dict[str, Any] = {name: activity[name] for name in dims if name in activity.coords}
    coords["delay"] = ("delay", delays, {"units": "frame"})
    interval = frame_interval(activity)
    if interval is not None:
        coords["delay_s"] = ("delay", delays * interval, {"units": "s"})
    return coords

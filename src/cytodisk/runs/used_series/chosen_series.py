"""The part of a cell's activity that a command works on: some frames, some sectors."""

from __future__ import annotations

import xarray as xr

from cytodisk.errors import ParameterError
from cytodisk.runs.used_series.used_parameters import UsedSeriesParameters
from cytodisk.store.activity_reading import EDGE_VARIABLES


def chosen_series(activity: xr.Dataset, settings: UsedSeriesParameters) -> xr.Dataset:
    """Activity of the frames and sectors that settings ask for.

    Parameters
    ----------
    activity : Dataset
        Of one cell of a study.
    settings : UsedSeriesParameters
        Its frames, without_frames and sectors.

    Returns
    -------
    Dataset
        Frames that are left out are NaN, as are steps of the edge from and to them, so that lags stay even;
        steps out of the last frame are NaN.

    Raises
    ------
    ParameterError
        There are no such frames or sectors.
    """
    activity = _without(activity, settings.without_frames)
    if settings.frames is not None:
        first, last = settings.frames
        there = activity["frame"].to_numpy()
        if last < there[0] or first > there[-1]:
            raise ParameterError(f"frames {first}:{last} are not in the movie: it has {there[0]}:{there[-1]}")
        activity = _without_steps(activity.sel(frame=slice(first, last)), [min(last, int(there[-1]))])
    if settings.sectors is not None:
        activity = activity.isel(sector=chosen_sectors(settings, activity.sizes["sector"]))
    return activity


def chosen_sectors(settings: UsedSeriesParameters, count: int) -> list[int]:
    """Numbers of the sectors that settings ask for, of so many; 50:5 goes on over the last.

    Raises
    ------
    ParameterError
        There are no such sectors.
    """
    if settings.sectors is None:
        return list(range(count))
    first, last = settings.sectors
    if not (0 <= first < count and 0 <= last < count):
        raise ParameterError(f"sectors {first}:{last} are not on the edge: it has 0:{count - 1}")
    if first == last + 1:
        raise ParameterError(f"sectors {first}:{last} are the whole edge, or two swapped: leave sectors out")
    around = range(first, last + 1 + (count if last < first else 0))
    return sorted(sector % count for sector in around)


def _without(activity: xr.Dataset, frames: tuple[int, ...]) -> xr.Dataset:
    missing = sorted(set(frames) - set(activity["frame"].to_numpy().tolist()))
    if missing:
        there = activity["frame"].to_numpy()
        raise ParameterError(f"without_frames has {missing[0]}: the movie has {there[0]}:{there[-1]}")
    if not frames:
        return activity
    left, mean = ~activity["frame"].isin(list(frames)), activity["mean"]
    means = activity.assign({"mean": mean.where(left).assign_attrs(mean.attrs)})
    return _without_steps(means, [*frames, *(frame - 1 for frame in frames)])


def _without_steps(activity: xr.Dataset, frames: list[int]) -> xr.Dataset:
    """NaN for the steps of the edge from some frames to the next."""
    left = ~activity["frame"].isin(frames)
    named = [name for name in EDGE_VARIABLES if name in activity and name != "edge_length"]
    return activity.assign(
        {name: activity[name].where(left).assign_attrs(activity[name].attrs) for name in named}
    )

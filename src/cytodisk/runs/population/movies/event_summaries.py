"""The signal around onsets of protrusion in a movie's cell, without what any moment would give."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.analysis.event_average import average_around
from cytodisk.analysis.events import edge_events
from cytodisk.analysis.time_steps import frame_interval
from cytodisk.errors import NoValuesError, ParameterError

LEAST_PATCHES = 3
"""Fewest protrusions of a cell, each of which may have many sectors."""

_KIND = "protrusion"


def around_onsets(activity: xr.Dataset, channels: list[str], reach: int) -> xr.DataArray:
    """Mean of a signal around onsets of protrusion, less its mean around all moments of the same sectors.

    Parameters
    ----------
    activity : Dataset
        Of one cell of a study.
    channels : list of str
    reach : int
        Frames before and after an onset.

    Returns
    -------
    DataArray with dims (channel, layer, lag)
        Lag in seconds, in frames where they are unknown.

    Raises
    ------
    NoValuesError
        The cell has too few protrusions with a known onset, or no velocity.

    Notes
    -----
    Each window of each event loses its own mean over the lags. The control does the same with every frame of
    the sector as onset, each sector as often as it has events: what goes on at any moment, such as bleaching,
    is in both, and drops out.
    """
    signal = activity["mean"].sel(channel=channels).load()
    try:
        events = edge_events(activity["velocity"].load())
    except ParameterError as error:
        raise NoValuesError(f"no events of the edge: {error}") from error
    used = events[(events["kind"] == _KIND) & events["onset_known"]]
    patches = used["patch"].nunique()
    if patches < LEAST_PATCHES:
        raise NoValuesError(
            f"{patches} protrusions with a known onset, the signal around them needs at least {LEAST_PATCHES}"
        )
    found = _mean_around(signal, events, reach) - _at_any_moment(signal, used["sector"], reach)
    interval = frame_interval(activity["velocity"])
    lag = np.arange(-reach, reach + 1) * (1.0 if interval is None else interval)
    found = found.rename(delay="lag").drop_vars("delay_s", errors="ignore")
    found = found.assign_coords(lag=("lag", lag, {"units": "frame" if interval is None else "s"}))
    attrs = {"units": str(activity["mean"].attrs.get("units", "a.u.")), "events": len(used)}
    return found.transpose("channel", "layer", "lag").assign_attrs(attrs | {"patches": int(patches)})


def _mean_around(signal: xr.DataArray, events: pd.DataFrame, reach: int) -> xr.DataArray:
    found = average_around(
        signal, events, before=reach, after=reach, kind=_KIND, normalise="mean", bootstrap=0
    )
    return found["mean"]


def _at_any_moment(signal: xr.DataArray, sectors: pd.Series, reach: int) -> xr.DataArray:
    """The same around every frame, over sectors as often as each has events."""
    first, frames = int(signal["frame"][0]), signal.sizes["time"]
    counts = sectors.value_counts(sort=False)
    parts = []
    for sector in counts.index:
        moments = pd.DataFrame({"sector": sector, "kind": _KIND, "onset": first + np.arange(frames)})
        moments = moments.assign(onset_known=True, patch=np.arange(frames))
        moments.attrs = {"sectors": 1}
        parts.append(_mean_around(signal.sel(sector=[sector]), moments, reach))
    joined = xr.concat(parts, "part")
    return joined.weighted(xr.DataArray(counts.to_numpy(), dims="part")).mean("part")

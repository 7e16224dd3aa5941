"""Correlation at its peak, and its lag, of a movie's cell: from the tables of `cytodisk correlate`."""

from __future__ import annotations

import shlex

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.errors import NoValuesError, PopulationError
from cytodisk.store.correlation_store import Correlation
from cytodisk.store.study import Study

LARGEST_P = 0.05
"""Of a window whose lag counts: without a correlation the lag of its peak is any."""


def correlated_channels(study: Study, channels: list[str], with_: str = "velocity") -> list[str]:
    """Those channels of a study that were correlated.

    Parameters
    ----------
    study : Study
    channels : list of str
    with_ : str

    Raises
    ------
    PopulationError
        None was; the message has the command to type.
    """
    there = {one[0] for one in study.correlations if one[1] == with_ and len(one) == 2}
    if not there & set(channels):
        raise PopulationError(_not_correlated(study, channels[0], with_))
    return [name for name in channels if name in there]


def at_peak(study: Study, cell: int, summary: str, channels: list[str], with_: str) -> xr.DataArray:
    """Correlation at the peak of each window, or the lag of that peak where chance seldom reaches it.

    Parameters
    ----------
    study : Study
    cell : int
    summary : {"peak_correlation", "lag"}
    channels : list of str
    with_ : str

    Returns
    -------
    DataArray with dims (channel, layer, sector)

    Raises
    ------
    PopulationError
        A channel was not correlated.
    NoValuesError
        The cell was refused by `cytodisk correlate`, or no window has p < 0.05, whose lag could count.
    """
    parts = [_of_channel(study, cell, summary, channel, with_) for channel in channels]
    joined = xr.concat(parts, "channel", join="outer").assign_coords(channel=channels)
    return joined.assign_attrs(parts[0].attrs).rename(summary)


def _of_channel(study: Study, cell: int, summary: str, channel: str, with_: str) -> xr.DataArray:
    if channel not in correlated_channels(study, [channel], with_):
        raise PopulationError(_not_correlated(study, channel, with_))
    found = study.correlation(channel, with_)
    windows = found.windows[found.windows["cell"] == cell]
    if windows.empty:
        raise NoValuesError(f"not correlated: {_why(found, cell)}")
    if summary == "peak_correlation":
        return _array(windows, windows["correlation"]).assign_attrs(units="1")
    if int(found.settings["surrogates_made"]) == 0:
        raise PopulationError(
            f"the correlation of {channel!r} in {study.path} has no p, which say whose lag counts: type "
            f"{_command(study, channel, with_)} without --surrogates 0"
        )
    counts = windows["p"] < LARGEST_P
    if not counts.any():
        raise NoValuesError(f"no window of {channel!r} correlates with {with_} at p < {LARGEST_P}")
    seconds = windows["lag_s"].notna().any()
    lag = windows["lag_s" if seconds else "lag"].where(counts)
    return _array(windows, lag).assign_attrs(units="s" if seconds else "frame")


def _array(windows: pd.DataFrame, values: pd.Series) -> xr.DataArray:
    table = values.astype(np.float64).set_axis(pd.MultiIndex.from_frame(windows[["layer", "sector"]]))
    return xr.DataArray.from_series(table)


def _why(found: Correlation, cell: int) -> str:
    rows = found.cells[found.cells["cell"] == cell]
    if rows.empty:
        return f"cytodisk correlate was asked for other cells ({found.path})"
    return str(rows["reason"].iloc[0])


def _not_correlated(study: Study, channel: str, with_: str) -> str:
    return (
        f"study {study.path} has no correlation of {channel!r} with {with_}: type "
        f"{_command(study, channel, with_)}"
    )


def _command(study: Study, channel: str, with_: str) -> str:
    more = "" if with_ == "velocity" else f" --with {shlex.quote(with_)}"
    return f"cytodisk correlate {shlex.quote(str(study.path))} --signal {shlex.quote(channel)}{more}"

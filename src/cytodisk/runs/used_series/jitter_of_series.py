"""Jitter of the masks in what a signal has to do with velocity, and drift that is told elsewhere."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import xarray as xr

from cytodisk.analysis.correlation.correlation_parameters import Detrend
from cytodisk.analysis.correlation.cross_correlation import correlation_by_layer, cross_correlate
from cytodisk.analysis.correlation.jitter_mark import jitter_step
from cytodisk.errors import StationarityWarning

_LEAST_LAG, _LAG = 6, 10


def largest_jitter(
    signal: xr.DataArray,
    velocity: xr.DataArray,
    velocity_share: float,
    *,
    detrend: Detrend = "none",
    min_pairs: int = 10,
) -> float:
    """Largest mark of jitter in any layer.

    Parameters
    ----------
    signal : DataArray with dims (time, layer, sector)
    velocity : DataArray with dims (time, sector)
    velocity_share : float
        Of `velocity_jitter`.
    detrend : {"none", "linear", "median"}
    min_pairs : int
        See `cross_correlate`.

    Returns
    -------
    float
        Of `jitter_step`, the one of largest size; 0 for none; NaN if there are too few frames to know.
    """
    lag = min(_LAG, signal.sizes["time"] - min_pairs)
    if lag < _LEAST_LAG:
        return float("nan")
    found = cross_correlate(signal, velocity, lag, detrend=detrend, min_pairs=min_pairs)
    steps = jitter_step(correlation_by_layer(found), velocity_share=velocity_share).to_numpy()
    return float(steps[np.abs(steps).argmax()])


@contextmanager
def drift_is_told() -> Iterator[None]:
    """No warnings of series that drift: their share is in a table, and is told."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StationarityWarning)
        yield

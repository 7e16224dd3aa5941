"""Correlation with controls regressed out, beside the raw one, and what does not survive that."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.controls.without_controls import FEWEST_FRAMES, without_controls
from cytodisk.analysis.correlation.correlation_parameters import (
    NullParameters,
    PairCorrelationParameters,
    PrepareParameters,
)
from cytodisk.analysis.correlation.cross_correlation import correlation_by_layer, cross_correlate
from cytodisk.analysis.correlation.peaks import peak_correlation
from cytodisk.analysis.correlation.prepared_series import default_frames, prepare_series
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.partial_words import SIGNIFICANT
from cytodisk.runs.run_options import Progress
from cytodisk.runs.used_series.cell_controls import too_few_frames

LEAST_LEFT = 0.5
"""Share of a correlation that must be left at its lag, else it was made by the controls for the most part."""


@dataclass(frozen=True, eq=False)
class Partial:
    """A correlation with controls regressed out.

    Attributes
    ----------
    correlations : Dataset or None
        As `cross_correlate` returns it; None if controls have too few values.
    frames : float
        Frames in which signal and controls have values, median over windows.
    """

    correlations: xr.Dataset | None
    frames: float

    @property
    def too_few(self) -> str:
        """Why there is no correlation; empty if there is."""
        if self.correlations is not None:
            return ""
        words = too_few_frames(self.frames, "outside the largest lag")
        return f"{words}, a smaller max-lag leaves more"


def partial_correlation(
    a: tuple[xr.DataArray, xr.Dataset],
    b: tuple[xr.DataArray, xr.Dataset],
    max_lag: int,
    options: CorrelateParameters,
    progress: Progress | None,
    clusters: Mapping[str, Any],
) -> Partial:
    """Correlate two signals from which controls are taken out, window by window.

    Parameters
    ----------
    a, b : (DataArray, Dataset)
        Each with its controls; a Dataset without variables is none. Both are prepared alike before the
        controls are regressed out.
    max_lag : int
    options : CorrelateParameters
    progress : callable, optional
    clusters : dict
        Parameters of `cross_correlate` about clusters.

    Returns
    -------
    Partial
    """
    first, second = (_left(series, controls, max_lag, options) for series, controls in (a, b))
    frames = min(float(series.count("time").median()) for series in (first, second))
    if frames < FEWEST_FRAMES:
        return Partial(None, frames)
    how = dict(options.part(NullParameters)) | {"statistic": options.statistic} | dict(clusters)
    found = cross_correlate(first, second, max_lag, skip_lags=options.skip_lags, progress=progress, **how)
    return Partial(found, frames)


def _left(
    series: xr.DataArray, controls: xr.Dataset, max_lag: int, options: CorrelateParameters
) -> xr.DataArray:
    how = options.part(PairCorrelationParameters)
    settings = PrepareParameters(
        detrend=how.detrend, detrend_frames=default_frames(how, max_lag), difference=how.difference
    ).model_dump()

    def prepared(values: xr.DataArray) -> xr.DataArray:
        by_time: xr.DataArray = values.transpose("time", ...)
        return by_time.copy(data=prepare_series(by_time, **settings))

    if not len(controls):
        return prepared(series)
    return without_controls(prepared(series), [prepared(one) for one in controls.data_vars.values()])


def with_partial(raw: xr.Dataset, curves: xr.Dataset | None, options: CorrelateParameters) -> xr.Dataset:
    """Peaks with those of the partial correlation beside them.

    Parameters
    ----------
    raw : Dataset
        Peaks of the raw correlations.
    curves : Dataset or None
        Partial correlations by lag, of the same windows or layers; None where they could not be made.
    options : CorrelateParameters

    Returns
    -------
    Dataset
        With correlation_partial and lag_partial, at the peak of the partial correlation; with surrogates also
        p_partial, q_partial, and geometry: whether a significant correlation does not survive.
    """
    names = ["correlation", "lag", *(name for name in ("p", "q") if name in raw)]
    empty = xr.full_like(raw["correlation"], np.nan, dtype=np.float64)
    if curves is None:
        peaks = dict.fromkeys(names, empty)
    else:
        found = peak_correlation(curves, rule=options.rule)
        peaks = {name: found[name].transpose(*raw["correlation"].dims) for name in names}
    data = {
        f"{name}_partial": values.assign_attrs(units=raw[name].attrs.get("units", "1"))
        for name, values in peaks.items()
    }
    if "q" in raw:
        there = empty if curves is None else _at_lag(curves["correlation"], raw["lag"])
        lost = does_not_survive(
            *(values.to_numpy() for values in (raw["correlation"], raw["q"], there, data["q_partial"]))
        )
        data["geometry"] = raw["q"].copy(data=lost).assign_attrs(units="")
    return raw.assign(data)


def does_not_survive(
    correlation: FloatArray, q: FloatArray, left: FloatArray, q_partial: FloatArray
) -> BoolArray:
    """Whether a significant correlation is gone, or mostly gone, once controls are regressed out.

    Parameters
    ----------
    correlation, q : ndarray
        Of the raw correlation at its peak.
    left : ndarray
        The partial correlation at the same lag.
    q_partial : ndarray
        Of the partial correlation at its own peak.

    Returns
    -------
    ndarray of dtype bool
        q < 0.05 and either q_partial ≥ 0.05, or less than half of the correlation left at its lag: what is
        still significant then is something else. False where there is no partial correlation.
    """
    gone = (q_partial >= SIGNIFICANT) | (left * np.sign(correlation) < LEAST_LEFT * np.abs(correlation))
    return np.asarray((q < SIGNIFICANT) & np.isfinite(q_partial) & gone)


def _at_lag(curves: xr.DataArray, lag: xr.DataArray) -> xr.DataArray:
    """Value of each curve at its own lag; NaN where there is no lag."""
    known = lag.fillna(0).astype(np.int64)
    found: xr.DataArray = curves.sel(lag=known, drop=True).where(lag.notnull())
    return found.transpose(*lag.dims)


def with_curve(correlations: xr.Dataset, partial: xr.Dataset | None) -> xr.Dataset:
    """Correlations by lag with the partial ones beside them, NaN where they could not be made."""
    raw = correlations["correlation"]
    beside = xr.full_like(raw, np.nan) if partial is None else partial["correlation"].transpose(*raw.dims)
    return correlations.assign(correlation_partial=beside.assign_attrs(raw.attrs))


def curves_of(partial: xr.Dataset | None) -> tuple[xr.Dataset | None, xr.Dataset | None]:
    """Partial correlations by lag, of windows and of layers."""
    return (None, None) if partial is None else (partial, correlation_by_layer(partial))

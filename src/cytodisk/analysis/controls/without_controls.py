"""`without_controls`: series of windows with what controls explain taken out."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import ParameterError

FEWEST_FRAMES = 20
"""Frames in which series and controls must all have a value; with fewer, nothing is taken out."""

_MOST_CONTROLS = 8  # all subsets are tried
_SINGULAR = 1e-9  # determinant of the correlations of controls below which they say the same
_CONSTANT = 1e-12  # share of the mean square that a variance must reach, else it is rounding


def without_controls(values: Any, controls: Any) -> xr.DataArray:
    """Regress controls out of series, window by window, with coefficients that are never negative.

    Parameters
    ----------
    values : DataArray with dims (time, …)
        A signal in windows, as the mean of `sample_movie` for one channel; NaN is left out.
    controls : Dataset, DataArray, or sequence of DataArray
        As `geometry_controls` returns them, or any other series that fit by the names of their dims, such as
        another channel in the same windows; at most eight.

    Returns
    -------
    DataArray with the dims of `values`
        values - Σ b (control - its mean), with the b ≥ 0 of least squares. NaN in frames in which any of the
        controls is, and in windows with fewer than 20 frames that have all.

    Raises
    ------
    ParameterError
        There are no controls or too many, or they do not fit the series.

    See Also
    --------
    geometry_controls : Controls made from the movie itself.
    cross_correlate : Correlates what is left.

    Notes
    -----
    In a cell that stands still its mean in the lab without the frames nearby is a constant minus the moving
    sum of the signal itself. A free coefficient, which would be negative, would take the slow part of a true
    signal with it; what a pattern under the cell adds to a signal is never negative. Non-negative least
    squares is solved exactly: of all subsets of controls whose coefficients come out ≥ 0, that which explains
    most.

    References
    ----------
    Lawson & Hanson (1974), "Solving least squares problems", chapter 23.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> import cytodisk as cd
    >>> rng = np.random.default_rng(0)
    >>> volume = xr.DataArray(rng.normal(size=(60, 4)), dims=("time", "sector"))
    >>> signal = 3.0 * volume + 0.1 * xr.DataArray(rng.normal(size=(60, 4)), dims=("time", "sector"))
    >>> cd.without_controls(signal, volume).std("time").round(1).to_numpy()
    array([0.1, 0.1, 0.1, 0.1])
    """
    if not isinstance(values, xr.DataArray) or "time" not in values.dims:
        raise ParameterError("values must be a DataArray with time, as sample_movie returns them")
    series: xr.DataArray = values.astype(np.float64).transpose("time", ...)
    fitted = np.stack([_like(series, control) for control in _listed(controls)])
    columns = series.to_numpy().reshape(series.sizes["time"], -1)
    found = _residuals(columns, fitted.reshape(-1, *columns.shape))
    return series.copy(data=found.reshape(series.shape)).transpose(*values.dims)


def _listed(controls: Any) -> list[xr.DataArray]:
    if isinstance(controls, xr.Dataset):
        controls = [controls[name] for name in controls.data_vars]
    listed = [controls] if isinstance(controls, xr.DataArray) else list(controls)
    if not 0 < len(listed) <= _MOST_CONTROLS:
        raise ParameterError(f"controls must be 1 to {_MOST_CONTROLS} series, got {len(listed)}")
    return listed


def _like(series: xr.DataArray, control: Any) -> FloatArray:
    """A control laid out as the series."""
    if not isinstance(control, xr.DataArray) or not {"time"} <= set(control.dims) <= set(series.dims):
        shown = list(control.dims) if isinstance(control, xr.DataArray) else type(control).__name__
        raise ParameterError(f"controls must be series by time and the dims {list(series.dims)}, got {shown}")
    other = control.reset_coords(drop=True)
    try:
        plain, laid = xr.align(series.reset_coords(drop=True), other, join="exact")
    except (xr.AlignmentError, ValueError) as error:
        raise ParameterError(f"controls do not have the frames and windows of values: {error}") from error
    return np.asarray(laid.broadcast_like(plain).transpose(*series.dims).to_numpy(), dtype=np.float64)


def _residuals(columns: FloatArray, controls: FloatArray) -> FloatArray:
    """Columns (T, W) without controls (K, T, W)."""
    usable: BoolArray = np.isfinite(columns) & np.isfinite(controls).all(axis=0)
    usable &= usable.sum(axis=0) >= FEWEST_FRAMES
    count = np.maximum(usable.sum(axis=0), 1)
    around = [_centred(one, usable, count) for one in (columns, *controls)]
    y, parts = around[0], np.stack(around[1:])
    size = np.sqrt((parts**2).sum(axis=1))
    parts = parts / np.where(size > 0, size, 1.0)[:, None]
    gram = np.einsum("ktw,ltw->wkl", parts, parts)
    gram[:, np.arange(len(parts)), np.arange(len(parts))] = 1.0
    coefficients = non_negative(gram, np.einsum("ktw,tw->wk", parts, y))
    fit = np.einsum("wk,ktw->tw", coefficients, parts)
    return np.where(usable, columns - fit, np.nan)


def _centred(columns: FloatArray, usable: BoolArray, count: Any) -> FloatArray:
    """Usable values minus their mean, 0 elsewhere; a constant up to rounding is 0."""
    known = np.where(usable, columns, 0.0)
    around = np.where(usable, known - known.sum(axis=0) / count, 0.0)
    constant = (around**2).sum(axis=0) <= _CONSTANT * (known**2).sum(axis=0)
    return np.where(constant, 0.0, around)


def non_negative(gram: FloatArray, moments: FloatArray) -> FloatArray:
    """Coefficients ≥ 0 of least squares, for many problems at once.

    Parameters
    ----------
    gram : ndarray of shape (W, K, K) and dtype float
        Products of the controls with each other, 1 on the diagonal.
    moments : ndarray of shape (W, K) and dtype float
        Products of the controls with the series.

    Returns
    -------
    ndarray of shape (W, K) and dtype float
        Controls that say the same as others, or nothing, have 0.
    """
    windows, count = moments.shape
    best, explained = np.zeros((windows, count)), np.zeros(windows)
    for size in range(1, count + 1):
        for chosen in combinations(range(count), size):
            part = gram[:, chosen][:, :, chosen]
            apart = np.linalg.det(part) > _SINGULAR
            solved = np.linalg.solve(
                np.where(apart[:, None, None], part, np.eye(size)), moments[:, chosen, None]
            )[..., 0]
            gain = (solved * moments[:, chosen]).sum(axis=1)
            better = apart & (solved >= 0).all(axis=1) & (gain > explained)
            explained = np.where(better, gain, explained)
            filled = np.zeros((windows, count))
            filled[:, chosen] = solved
            best = np.where(better[:, None], filled, best)
    return best

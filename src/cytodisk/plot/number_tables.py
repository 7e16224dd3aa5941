"""Numbers by frame, layer and sector that are drawn, checked and in the order of their dims."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError


def number_table(values: Any, name: str, dims: tuple[str, ...]) -> FloatArray:
    """Numbers as an array whose axes are in the order of `dims`.

    Parameters
    ----------
    values : array_like or DataArray
        A DataArray with these dims may have them in any order.
    name : str
        Name of the argument, for the error.
    dims : tuple of str

    Returns
    -------
    ndarray of dtype float

    Raises
    ------
    ParameterError
        It has other dims, is empty, or holds no numbers.
    """
    if isinstance(values, xr.DataArray) and set(values.dims) == set(dims):
        values = values.transpose(*dims)
    array = np.asarray(values)
    if array.ndim != len(dims) or not array.size or array.dtype.kind not in "biuf":
        raise ParameterError(
            f"{name} must hold numbers by {', '.join(dims)}, got shape {array.shape} and dtype {array.dtype}"
        )
    return array.astype(np.float64)


def named_table(values: Any, name: str, dims: tuple[str, ...]) -> FloatArray:
    """As `number_table`, of a DataArray with just these dims.

    Raises
    ------
    ParameterError
        It is no DataArray, or has other dims.
    """
    if not isinstance(values, xr.DataArray) or set(values.dims) != set(dims):
        came = values.dims if isinstance(values, xr.DataArray) else type(values).__name__
        remedy = f": select one, as in {name}.sel(channel=…)" if "channel" in came else ""
        raise ParameterError(f"{name} must be a DataArray with dims {' and '.join(dims)}, got {came}{remedy}")
    return number_table(values, name, dims)

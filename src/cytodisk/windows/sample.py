"""Signal in windows: mean, spread, extremes and quantiles."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numba import njit
from scipy import sparse

from cytodisk.arrays import AnyArray, FloatArray, Int32Array
from cytodisk.checks import instance_of
from cytodisk.errors import ParameterError, SignalError
from cytodisk.taking import takes
from cytodisk.windows.grid_parameters import SampleParameters
from cytodisk.windows.layer_coords import layer_coords
from cytodisk.windows.on_cell import WindowsOnCell


@takes(SampleParameters)
def sample(
    windows: WindowsOnCell,
    signal: Any,
    *,
    quantiles: Sequence[float] = (),
    **settings: Any,
) -> xr.Dataset:
    """Statistics of a signal in each window, read from the raw pixels.

    Parameters
    ----------
    windows : WindowsOnCell
        Windows on one cell, polar, edge-based or rings. An empty one has n_pixels 0 and no other statistics.
    signal : array_like of shape (H, W) or (C, H, W), or DataArray with dims (channel,) y, x
        Image to measure, of the shape of the mask.
    quantiles : sequence of float
        Weighted quantiles to add, each 0 to 1.
    **settings
        See `SampleParameters`. Pixels that are left out are counted in `n_nan`.

    Returns
    -------
    Dataset with dims (layer, sector), before them channel if the signal has it
        mean, sd (of the pixels, weighted), min, max (over pixels with any share in the window), n_pixels (sum
        of pixel shares that were sampled, so Σ n_pixels · mean is the intensity of all that lies in windows:
        the whole cell, but for edge windows of a given depth), n_nan (sum of pixel shares that are NaN or
        infinite), area (square pixels); depth, depth_p5 and depth_p95: median, 5th and 95th percentile of the
        distance of the window's subpixels to the cell's edge (µm, or px without a scale); on request quantile
        with its own dim. With a nucleus nucleus_distance, …_p5 and …_p95, the same to the nuclear outline
        from either side of it, and the coordinate compartment along layer.

    Raises
    ------
    SignalError
        The signal does not fit the mask or is not numeric, or two of its channels have one name.
    ParameterError
        `windows` are no windows on a cell, a quantile is outside 0 to 1, or `nan` is unknown.

    See Also
    --------
    sample_movie : All frames of a movie.
    window_measures : Area and form of the windows themselves.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.disk(20)
    >>> windows = cd.polar_windows(layers=3, sectors=8).on(cd.map_to_disk(mask))
    >>> signal = cd.simulate.ring_signal(mask, peak=100.0)  # bright at the edge
    >>> cd.sample(windows, signal)["mean"].mean("sector").astype(int).to_numpy()
    array([76, 39, 14])
    """
    nan = SampleParameters.of(**settings).nan
    order = "the order is sample(windows, signal)"
    instance_of("windows", windows, WindowsOnCell, "windows on a cell, as grid.on(disk) returns them", order)
    _check_quantiles(quantiles)
    placed = windows.placed_mask
    values, channels = _parse_signal(signal, placed.image_shape)
    pixels = np.stack([image[placed.box] for image in placed.cut_out_of(values)])
    arrays = sampled_pixels(windows, pixels.astype(np.float64, copy=False), tuple(quantiles), nan)
    shape = (len(values), *windows.areas.shape)
    dims = ("channel", "layer", "sector")
    data: dict[str, Any] = {name: (dims, arrays[name], {"units": unit}) for name, unit in _UNITS.items()}
    if quantiles:
        data["quantile"] = ((*dims, "q"), arrays["quantile"], {"units": "a.u."})
    data["area"] = (("layer", "sector"), windows.areas, {"units": "px²"})
    for name, depth in windows.depth_columns.items():
        data[name] = (("layer", "sector"), windows.scale.length(depth), {"units": windows.scale.length_unit})
    coords: dict[str, Any] = layer_coords(windows.grid) | {"sector": np.arange(shape[2])}
    if quantiles:
        coords["q"] = list(quantiles)
    if channels is not None:
        coords["channel"] = channels
    dataset = xr.Dataset(data, coords, attrs=windows.scale.attrs)
    return dataset.isel(channel=0) if channels is None else dataset


def sampled_pixels(
    windows: WindowsOnCell, pixels: FloatArray, quantiles: tuple[float, ...] = (), nan: str = "propagate"
) -> dict[str, FloatArray]:
    """The statistics of `sample` from the values of the cell's pixels alone.

    Parameters
    ----------
    windows : WindowsOnCell
    pixels : ndarray of shape (C, P) and dtype float
        Of each pixel of the mask, in row-major order.
    quantiles : tuple of float
    nan : {"propagate", "omit"}

    Returns
    -------
    dict of str to ndarray of shape (C, layers, sectors), or (C, layers, sectors, Q) for "quantile"
    """
    tables = [_statistics(windows.weights, row, quantiles, nan) for row in pixels]
    shape = (len(pixels), *windows.areas.shape)
    return {
        name: np.stack([table[name] for table in tables]).reshape(*shape, *values.shape[1:])
        for name, values in tables[0].items()
    }


_UNITS = {"mean": "a.u.", "sd": "a.u.", "n_pixels": "px²", "n_nan": "px²", "min": "a.u.", "max": "a.u."}


def _check_quantiles(quantiles: Sequence[float]) -> None:
    try:
        inside = all(0 <= q <= 1 for q in quantiles)
    except TypeError:
        inside = False
    if not inside:
        raise ParameterError(f"quantiles must be a sequence of numbers 0 to 1, got {quantiles!r}")


def check_channel_names(signal: str, names: Sequence[str]) -> None:
    """Check that the names of channels tell these apart.

    Raises
    ------
    SignalError
        Two have one name.
    """
    if len(set(names)) < len(names):
        raise SignalError(f"{signal}: two channels have one name, got {tuple(names)}: rename one of them")


def _parse_signal(signal: Any, shape: tuple[int, ...]) -> tuple[AnyArray, list[str] | None]:
    """Values of shape (C, H, W), and the channels' names if the signal has such a dim."""
    names: list[str] | None = None
    if isinstance(signal, xr.DataArray):
        extra = [str(dim) for dim in signal.dims if dim not in ("channel", "y", "x")]
        if extra:
            raise SignalError(f"signal has the dims {extra} beside channel, y, x: pass one frame")
        if not {"y", "x"} <= set(signal.dims):
            raise SignalError(f"signal has the dims {list(signal.dims)}: it needs y and x")
        signal = signal.transpose("channel", "y", "x", missing_dims="ignore")
        if "channel" in signal.dims:
            names = [str(name) for name in signal["channel"].to_numpy()]
            check_channel_names("signal", names)
    array = np.asarray(signal)
    if np.ma.isMaskedArray(signal):
        array = np.ma.filled(signal.astype(np.float64), np.nan)
    if array.dtype.kind not in "biuf":
        raise SignalError(f"signal must be numeric, got dtype {array.dtype}")
    if array.ndim not in (2, 3) or array.shape[-2:] != shape or not array.size:
        raise SignalError(
            f"signal has shape {array.shape}, mask {shape}: pass (H, W) or (channel, H, W) of that size"
        )
    if array.ndim == 3 and names is None:
        names = [str(number) for number in range(len(array))]
    return array.reshape(-1, *shape), names


def _statistics(
    weights: sparse.csr_array, values: FloatArray, quantiles: tuple[float, ...], nan: str
) -> dict[str, FloatArray]:
    found = np.empty((6, weights.shape[0]))
    _by_window(weights.indptr, weights.indices, weights.data, values, found)
    table = dict(zip(("mean", "sd", "min", "max"), found, strict=False))
    n_pixels, n_nan = found[4:]
    if quantiles:
        table["quantile"] = _quantiles(weights, values, quantiles)
    lost = (n_pixels == 0) | ((n_nan > 0) & (nan == "propagate"))
    for column in table.values():
        column[lost] = np.nan
    return table | {"n_pixels": n_pixels, "n_nan": n_nan}


@njit(cache=True, error_model="numpy")
def _by_window(
    start: Int32Array, pixel: Int32Array, weight: FloatArray, values: FloatArray, found: FloatArray
) -> None:
    """Mean, standard deviation, least and greatest value; areas with and without a finite value."""
    for window in range(len(start) - 1):
        area = lost = total = squares = 0.0
        low, high = np.inf, -np.inf
        for entry in range(start[window], start[window + 1]):
            value, share = values[pixel[entry]], weight[entry]
            if math.isfinite(value):
                area += share
                total += share * value
                low, high = min(low, value), max(high, value)
            else:
                lost += share
        mean = total / area
        for entry in range(start[window], start[window + 1]):
            value = values[pixel[entry]]
            if math.isfinite(value):
                squares += weight[entry] * (value - mean) ** 2
        found[0, window], found[1, window] = mean, math.sqrt(squares / area)
        found[2, window], found[3, window] = low, high
        found[4, window], found[5, window] = area, lost


def _quantiles(weights: sparse.csr_array, values: FloatArray, quantiles: tuple[float, ...]) -> FloatArray:
    """Smallest value at which a window's cumulated weight reaches the quantile, shape (windows, Q)."""
    window = np.repeat(np.arange(weights.shape[0]), np.diff(weights.indptr))
    held = values[weights.indices]
    known = np.isfinite(held)
    window, held, weight = window[known], held[known], weights.data[known]
    order = np.lexsort((held, window))
    running = np.concatenate([[0.0], np.cumsum(weight[order])])
    ends = np.searchsorted(window, np.arange(weights.shape[0] + 1))
    first, last = ends[:-1], ends[1:]
    out = np.full((weights.shape[0], len(quantiles)), np.nan)
    filled = last > first
    total = running[last] - running[first]
    for column, quantile in enumerate(quantiles):
        wanted = running[first] + quantile * total * (1.0 - 1e-12)
        place = np.clip(np.searchsorted(running[1:], wanted, side="left"), first, np.maximum(last - 1, 0))
        out[filled, column] = held[order][place[filled]]
    return out

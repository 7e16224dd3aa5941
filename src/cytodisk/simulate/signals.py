"""Signals whose value at every pixel is known, and one whole cell with them."""

from dataclasses import dataclass

import numpy as np
import shapely
import xarray as xr
from scipy import ndimage

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import number_between, whole_number
from cytodisk.errors import ParameterError
from cytodisk.simulate.drawing import half_covered
from cytodisk.simulate.random_cells import migrating
from cytodisk.simulate.resting_shapes import lobed

_CHANNELS = ["edge", "perinuclear"]
_PIXEL_SIZE_UM = 0.16
_MARGIN = 10  # px of background around a cell with a cortex


def linear_signal(
    shape: tuple[int, int], gradient_yx: tuple[float, float] = (0.0, 1.0), offset: float = 0.0
) -> FloatArray:
    """Image that grows linearly: its mean over any region is its value at the region's centroid.

    Parameters
    ----------
    shape : (int, int)
        Rows and columns.
    gradient_yx : (float, float)
        Growth per pixel along y and along x.
    offset : float
        Value at pixel (0, 0).

    Returns
    -------
    ndarray of shape (H, W) and dtype float

    Raises
    ------
    ParameterError
        `shape` or `gradient_yx` is not a pair.

    See Also
    --------
    ring_signal : Bright at the edge.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cd.simulate.linear_signal((2, 4), gradient_yx=(0.0, 1.0), offset=5.0)
    array([[5., 6., 7., 8.],
           [5., 6., 7., 8.]])
    """
    if np.shape(shape) != (2,) or min(shape) < 1:
        raise ParameterError(f"shape must be two positive numbers (rows, columns), got {shape!r}")
    if np.shape(gradient_yx) != (2,):
        raise ParameterError(f"gradient_yx must be two numbers (along y, along x), got {gradient_yx!r}")
    row, column = np.indices(shape)
    return np.asarray(offset + gradient_yx[0] * row + gradient_yx[1] * column, dtype=np.float64)


def ring_signal(
    mask: BoolArray, *, peak: float = 1.0, decay_px: float = 6.0, background: float = 0.0
) -> FloatArray:
    """Signal that is highest at the cell's edge and decays exponentially with depth.

    Parameters
    ----------
    mask : ndarray of shape (H, W) and dtype bool
    peak : float
        Height above the background at depth 0.
    decay_px : float
        Depth at which 1/e of the peak is left, in pixels, above 0.
    background : float
        Value outside the cell, and deep inside.

    Returns
    -------
    ndarray of shape (H, W) and dtype float

    Raises
    ------
    ParameterError
        `mask` is not 2D or `decay_px` is not above 0.

    See Also
    --------
    linear_signal : Brighter along one direction.
    cell_with_signal : A cell with two channels.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.disk(10)
    >>> signal = cd.simulate.ring_signal(mask, peak=10.0, decay_px=3.0)
    >>> bool(signal[mask].max() > 8.0), float(signal[18, 18].round(2))  # at the edge, and in the middle
    (True, 0.41)
    """
    number_between("decay_px", decay_px, 1e-6)
    return np.asarray(background + peak * np.where(mask, np.exp(-depth(mask) / decay_px), 0.0))


def depth(mask: BoolArray) -> FloatArray:
    """Distance of each pixel centre in a cell from its edge, half a pixel before the nearest background.

    Parameters
    ----------
    mask : ndarray of shape (H, W) and dtype bool

    Returns
    -------
    ndarray of shape (H, W) and dtype float
        In pixels, at least 0.5 inside, 0 outside; outside the image counts as background.

    Raises
    ------
    ParameterError
        `mask` is not 2D.
    """
    if np.ndim(mask) != 2:
        raise ParameterError(f"mask must be 2D, got shape {np.shape(mask)}: pass one frame")
    distance = ndimage.distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1]
    return np.asarray(np.maximum(distance - 0.5, 0.0))


@dataclass(frozen=True, eq=False)
class SimulatedCell:
    """One cell with its signal and the answers.

    Attributes
    ----------
    mask : ndarray of shape (H, W) and dtype bool
    signal : DataArray with dims (channel, y, x) and dtype uint16
        What a camera would count, with Poisson noise; attrs `pixel_size_um` and `frame_interval_s`.
    truth : DataArray with dims (channel, y, x) and dtype float
        The expected counts: the signal without noise.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_signal(0)
    >>> cell.mask.shape == cell.signal.shape[1:]
    True
    """

    mask: BoolArray
    signal: xr.DataArray
    truth: xr.DataArray


def cell_with_signal(seed: int = 0) -> SimulatedCell:
    """A migrating cell of about 15 000 pixels with an edge-enriched and a perinuclear channel.

    Parameters
    ----------
    seed : int
        The same seed gives the same cell and the same noise.

    Returns
    -------
    SimulatedCell
        Channels "edge" (like VASP: bright at the leading edge, dim at the tail) and "perinuclear" (like the
        endoplasmic reticulum: bright around a dark nucleus), both on a background of 20 counts.

    Raises
    ------
    ParameterError
        `seed` is not a number of at least 0.

    See Also
    --------
    movie : The same through time.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_signal(0)
    >>> cell.signal.dims, cell.signal["channel"].to_numpy().tolist()
    (('channel', 'y', 'x'), ['edge', 'perinuclear'])
    """
    number_between("seed", seed, 0)
    mask = migrating(seed)
    expected = np.stack([_leading_edge(mask), _around_nucleus(mask)]) + 20.0
    counts = np.random.default_rng([seed, 1]).poisson(expected).astype(np.uint16)
    signal, truth = (_image(values, _CHANNELS, _PIXEL_SIZE_UM) for values in (counts, expected))
    return SimulatedCell(mask, signal, truth)


def cell_with_cortex(
    radius_um: float = 8.0, seed: int = 0, *, decay_um: float = 1.0, pixel_size_um: float = 0.16
) -> SimulatedCell:
    """A round cell with one cortex: cells of any size have the same signal at the same depth.

    Parameters
    ----------
    radius_um : float
        Of the disk of the same area, above 10 pixels.
    seed : int
        Shallow lobes of the outline, and noise.
    decay_um : float
        Depth at which 1/e of the cortex is left.
    pixel_size_um : float

    Returns
    -------
    SimulatedCell
        Channel "cortex": 100 counts at the edge that decay exponentially with depth, without background.

    Raises
    ------
    ParameterError
        A number out of its range.

    See Also
    --------
    cell_with_signal : A migrating cell.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_cortex(4.0)
    >>> cell.signal.dims, cell.signal.attrs["pixel_size_um"]
    (('channel', 'y', 'x'), 0.16)
    """
    seed = whole_number("seed", seed, 0)
    pixel_size_um = number_between("pixel_size_um", pixel_size_um, 1e-6)
    radius = number_between("radius_um", radius_um, 10.0 * pixel_size_um) / pixel_size_um
    decay = number_between("decay_um", decay_um, 1e-6) / pixel_size_um
    outline = lobed(np.random.default_rng([seed, 2]), radius, 0.03)
    outline = outline - np.floor(outline.min(axis=0)) + _MARGIN
    height, width = np.ceil(outline.max(axis=0)).astype(int) + _MARGIN + 1
    mask = half_covered(outline, (int(height), int(width)))
    pixels = np.argwhere(mask).astype(np.float64)
    expected = np.zeros((1, *mask.shape))
    away = shapely.distance(shapely.LinearRing(outline), shapely.points(pixels))
    expected[0, mask] = 100.0 * np.exp(-away / decay)
    counts = np.random.default_rng([seed, 1]).poisson(expected).astype(np.uint16)
    signal, truth = (_image(values, ["cortex"], pixel_size_um) for values in (counts, expected))
    return SimulatedCell(mask, signal, truth)


def _leading_edge(mask: BoolArray) -> FloatArray:
    columns = np.flatnonzero(mask.any(axis=0))
    forward = np.clip((np.arange(mask.shape[1]) - columns[0]) / np.ptp(columns), 0.0, 1.0)
    return np.asarray(np.where(mask, 60.0, 0.0) + ring_signal(mask, peak=300.0, decay_px=5.0) * forward**2)


def _around_nucleus(mask: BoolArray) -> FloatArray:
    inward = depth(mask)
    nucleus = np.unravel_index(inward.argmax(), mask.shape)
    row, column = np.indices(mask.shape)
    away = np.hypot(row - nucleus[0], (column - nucleus[1]) / 1.2)
    ring = 250.0 * np.exp(-0.5 * ((away - 20.0) / 8.0) ** 2)
    return np.asarray(np.where(mask, 40.0 + ring, 0.0))


def _image(
    values: np.ndarray[tuple[int, ...], np.dtype[np.generic]], channels: list[str], pixel_size_um: float
) -> xr.DataArray:
    return xr.DataArray(
        values,
        dims=("channel", "y", "x"),
        coords={"channel": channels},
        attrs={"pixel_size_um": pixel_size_um, "frame_interval_s": None},
    )

"""Closed polygons: area, centroid, arc length, smoothing."""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from cytodisk.arrays import FloatArray

# benchmarks/arc_length.py prints what other values give.
_DIRECTION_PX = 5.0  # over which the outline's direction is smoothed
_SPREAD_PX = 3.0  # over which the counted length is evened out
_WHOLE_PX = 80.0  # a shorter outline is smoothed less, in proportion
_LEAST_SHARE = 0.2  # of an edge's own length: a shorter arc would squeeze its triangle
_TINY = 1e-12  # px, of a step that has no direction


def signed_area(outline_yx: FloatArray) -> float:
    """Area of a closed polygon, positive when it runs from +x towards +y.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        Closed polygon, (row, column) in pixels; the last point is not repeated.

    Returns
    -------
    float
        In square pixels.
    """
    y, x = (outline_yx - outline_yx[0]).T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def centroid(outline_yx: FloatArray) -> FloatArray:
    """Centre of mass of the inside of a closed polygon.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        Closed polygon of non-zero area, (row, column) in pixels.

    Returns
    -------
    ndarray of shape (2,) and dtype float
        (row, column) in pixels.
    """
    origin = outline_yx[0]
    here = outline_yx - origin
    there = np.roll(here, -1, axis=0)
    cross = here[:, 1] * there[:, 0] - here[:, 0] * there[:, 1]
    moment: FloatArray = ((here + there) * cross[:, None]).sum(axis=0)
    return np.asarray(moment / (3.0 * cross.sum()) + origin)


def edges(outline_yx: FloatArray) -> FloatArray:
    """Step of each edge of a closed polygon, from point i to point i + 1.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        Closed polygon, (row, column) in pixels.

    Returns
    -------
    ndarray of shape (N, 2) and dtype float
        (along rows, along columns) in pixels.
    """
    return np.diff(outline_yx, axis=0, append=outline_yx[:1])


def edge_lengths(outline_yx: FloatArray) -> FloatArray:
    """Length of each edge of a closed polygon, edge i from point i to point i + 1.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        Closed polygon, (row, column) in pixels.

    Returns
    -------
    ndarray of shape (N,) and dtype float
        In pixels.
    """
    steps = edges(outline_yx)
    return np.hypot(steps[:, 0], steps[:, 1])


def smooth_closed(outline_yx: FloatArray, sigma_px: float) -> FloatArray:
    """Gaussian smoothing of a closed polygon along itself.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        Closed polygon with roughly even spacing, (row, column) in pixels.
    sigma_px : float
        Standard deviation of the kernel along the outline, in pixels.

    Returns
    -------
    ndarray of shape (N, 2) and dtype float
        One smoothed point for each point.
    """
    return smooth_along(outline_yx, outline_yx, sigma_px)


def smooth_along(values: FloatArray, outline_yx: FloatArray, sigma_px: float) -> FloatArray:
    """Gaussian smoothing, along a closed polygon, of what is given at each of its points or edges.

    Parameters
    ----------
    values : ndarray of shape (N, ...) and dtype float
        One row for each point, or for each edge.
    outline_yx : ndarray of shape (N, 2) and dtype float
        Closed polygon with roughly even spacing, (row, column) in pixels.
    sigma_px : float
        Standard deviation of the kernel along the outline, in pixels.

    Returns
    -------
    ndarray of shape (N, ...) and dtype float
    """
    sigma_points = sigma_px / edge_lengths(outline_yx).mean()
    smoothed: FloatArray = gaussian_filter1d(values, sigma_points, axis=0, mode="wrap")
    return smoothed


def arc_lengths(
    outline_yx: FloatArray,
    direction_px: float = _DIRECTION_PX,
    spread_px: float = _SPREAD_PX,
    least_share: float = _LEAST_SHARE,
) -> FloatArray:
    """Length of each edge of an outline as far as it goes the outline's way.

    An edge counts by its component along the smoothed outline. So the stair steps of pixels, which make an
    outline up to 8 % too long, and the sides of a spike of one pixel, which lead away from the outline and
    back, count little, while a thin protrusion, whose sides have a direction of their own, keeps its length:
    only directions come from the smoothed outline, which itself would be shorter at each tip. What an edge
    lacks is shared with its neighbours, so that no points crowd on the circle.

    Parameters
    ----------
    outline_yx : ndarray of shape (B, 2) and dtype float
        Closed polygon, (row, column) in pixels.
    direction_px : float
        Standard deviation of the kernel that smooths the outline's direction, in pixels.
    spread_px : float
        Standard deviation of the kernel that evens out the counted length, in pixels.
    least_share : float
        Least counted length of an edge over its own length.

    Returns
    -------
    ndarray of shape (B,) and dtype float
        In pixels, all positive.
    """
    raw = edge_lengths(outline_yx)
    small = min(1.0, raw.sum() / _WHOLE_PX)
    way = edges(smooth_closed(outline_yx, small * direction_px))
    steps = edges(outline_yx)
    along = (steps * way).sum(axis=1) / np.maximum(np.hypot(way[:, 0], way[:, 1]), _TINY)
    counted, whole = smooth_along(np.column_stack([along, raw]), outline_yx, small * spread_px).T
    return np.asarray(raw * np.maximum(counted / whole, least_share))

"""Closed polygons: area, centroid, arc length, smoothing."""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from cytodisk.arrays import FloatArray


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

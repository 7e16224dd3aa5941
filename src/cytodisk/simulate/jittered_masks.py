"""Jitter of an outline, as a segmentation makes it."""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from cytodisk.arrays import FloatArray
from cytodisk.geometry.polygon import edge_lengths


def jittered(
    outlines_yx: FloatArray, jitter_px: float, length_px: float, random: np.random.Generator
) -> FloatArray:
    """Outlines displaced along their normals by noise, smooth along the edge, anew in each frame.

    Parameters
    ----------
    outlines_yx : ndarray of shape (T, N, 2) and dtype float
        Closed polygons, (row, column) in pixels.
    jitter_px : float
        Standard deviation of the noise, in pixels.
    length_px : float
        Length along the edge over which its correlation falls to exp(-1/2), in pixels.
    random : Generator

    Returns
    -------
    ndarray of shape (T, N, 2) and dtype float
        Points evenly spaced before the displacement: not those of `outlines_yx`.
    """
    if not jitter_px:
        return outlines_yx
    return np.stack([_displaced(outline, jitter_px, length_px, random) for outline in outlines_yx])


def evenly_spaced(outline_yx: FloatArray, count: int) -> FloatArray:
    """Points at equal distances along a closed outline, the first at its first point, shape (count, 2)."""
    arc = np.concatenate([[0.0], np.cumsum(edge_lengths(outline_yx))])
    closed = np.concatenate([outline_yx, outline_yx[:1]])
    at = np.linspace(0.0, arc[-1], count, endpoint=False)
    return np.column_stack([np.interp(at, arc, closed[:, 0]), np.interp(at, arc, closed[:, 1])])


def _displaced(
    outline_yx: FloatArray, jitter_px: float, length_px: float, random: np.random.Generator
) -> FloatArray:
    even = evenly_spaced(outline_yx, len(outline_yx))
    width = length_px / np.sqrt(2.0) / edge_lengths(even).mean()  # a filter of width w correlates over √2 w
    noise = gaussian_filter1d(random.normal(size=len(even)), width, mode="wrap")
    noise *= jitter_px * np.sqrt(2.0 * width * np.sqrt(np.pi))  # what the filter takes of the deviation
    along = np.roll(even, -1, axis=0) - np.roll(even, 1, axis=0)
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(along[:, 0], along[:, 1])[:, None]
    return np.asarray(even + noise[:, None] * normal)

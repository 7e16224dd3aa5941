"""Draw masks on a pixel grid from strokes, radii and outlines."""

from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import number_between


def pixel_grid(half_height: float, half_width: float) -> tuple[FloatArray, FloatArray]:
    """Row and column of every pixel, counted from the central one."""
    rows, columns = int(np.floor(half_height + 1e-9)), int(np.floor(half_width + 1e-9))
    y, x = np.mgrid[-rows : rows + 1, -columns : columns + 1].astype(np.float64)
    return y, x


def all_angles() -> FloatArray:
    """Every half degree of a turn, both ends included, in radians."""
    return np.linspace(-np.pi, np.pi, 721)


def inside_radius(radius_of_angle: FloatArray, margin: int) -> BoolArray:
    """Pixels nearer to the centre than a radius given at `all_angles()`."""
    number_between("margin", margin, 0)
    reach = radius_of_angle.max() + margin
    y, x = pixel_grid(reach, reach)
    return np.asarray(np.hypot(y, x) <= np.interp(np.arctan2(y, x), all_angles(), radius_of_angle))


def dot(y: float, x: float, radius: float) -> tuple[float, float, float, float, float]:
    """Stroke of no length: a round dot."""
    return y, x, y, x, radius


def paint(strokes: FloatArray, margin: int) -> BoolArray:
    """Pixels within a stroke's half width of its segment; rows (y, x, end y, end x, half width).

    Pixel centres are at integers; the origin of the strokes is a pixel centre. Strokes are at least as wide
    as it takes to stay 8-connected.
    """
    number_between("margin", margin, 0)
    half = np.maximum(strokes[:, 4], 0.5 * np.sqrt(2.0))
    points = np.concatenate([strokes[:, :2], strokes[:, 2:4]])
    reach = np.concatenate([half, half])[:, None]
    low = np.floor((points - reach).min(axis=0)).astype(int) - margin
    high = np.ceil((points + reach).max(axis=0)).astype(int) + margin
    mask = np.zeros(high - low + 1, dtype=bool)
    for (y, x, end_y, end_x, _), width in zip(strokes, half, strict=True):
        start = np.floor(np.minimum((y, x), (end_y, end_x)) - width).astype(int)
        stop = np.ceil(np.maximum((y, x), (end_y, end_x)) + width).astype(int) + 1
        row, column = np.mgrid[start[0] : stop[0], start[1] : stop[1]]
        window = mask[start[0] - low[0] : stop[0] - low[0], start[1] - low[1] : stop[1] - low[1]]
        window |= _distance_to_segment(row, column, (y, x), (end_y, end_x)) <= width + 1e-9
    return mask


def _distance_to_segment(
    row: Any, column: Any, start: tuple[float, float], stop: tuple[float, float]
) -> FloatArray:
    step_y, step_x = stop[0] - start[0], stop[1] - start[1]
    square = step_y**2 + step_x**2
    share = (
        ((row - start[0]) * step_y + (column - start[1]) * step_x) / square if square else np.zeros(row.shape)
    )
    share = np.clip(share, 0.0, 1.0)
    return np.asarray(np.hypot(row - start[0] - share * step_y, column - start[1] - share * step_x))


def half_covered(outline_yx: FloatArray, shape: tuple[int, int]) -> BoolArray:
    """Pixels of which an outline covers half or more; shape (H, W)."""
    return np.asarray(coverage(outline_yx, shape) >= 0.5)


def coverage(outline_yx: FloatArray, shape: tuple[int, int]) -> FloatArray:
    """Share of each pixel's area that lies inside an outline, exactly.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        Closed polygon that does not cross itself, (row, column) in pixels, pixel centres at integers; it may
        leave the image.
    shape : (int, int)
        Rows and columns.

    Returns
    -------
    ndarray of shape (H, W) and dtype float

    Notes
    -----
    The outline is cut where it passes from a pixel to the next. By Green's theorem each part adds its height
    to all pixels right of it, and a share of it to its own.
    """
    start = _cut(_cut(outline_yx + 0.5, 0), 1)
    stop = np.roll(start, -1, axis=0)
    height = stop[:, 0] - start[:, 0]
    row, column = np.floor(0.5 * (start + stop)).astype(np.int64).T
    share = 0.5 * (start + stop)[:, 1] - column
    share[column < 0], column[column < 0] = 0.0, 0
    shown = (row >= 0) & (row < shape[0]) & (column < shape[1])
    place, height, share = (row * (shape[1] + 1) + column)[shown], height[shown], share[shown]
    total = np.bincount(place, height * (1.0 - share), shape[0] * (shape[1] + 1) + 1)
    total[1:] += np.bincount(place, height * share, shape[0] * (shape[1] + 1))[: total.size - 1]
    return np.asarray(np.abs(total[:-1].reshape(shape[0], shape[1] + 1).cumsum(axis=1)[:, :-1]))


def _cut(outline_yx: FloatArray, axis: int) -> FloatArray:
    """The same closed polygon with a point wherever a coordinate passes a whole number."""
    step = np.roll(outline_yx, -1, axis=0) - outline_yx
    start, stop = outline_yx[:, axis], np.roll(outline_yx[:, axis], -1)
    first = np.floor(np.minimum(start, stop)) + 1.0
    count = np.maximum(np.ceil(np.maximum(start, stop)) - first, 0.0).astype(np.int64)
    edge = np.repeat(np.arange(len(start)), count)
    whole = first[edge] + np.arange(edge.size) - np.repeat(np.cumsum(count) - count, count)
    share = (whole - start[edge]) / step[edge, axis]
    points = outline_yx[edge] + share[:, None] * step[edge]
    points[:, axis] = whole
    order = np.argsort(np.concatenate([np.arange(float(len(start))), edge + share]), kind="stable")
    return np.concatenate([outline_yx, points])[order]

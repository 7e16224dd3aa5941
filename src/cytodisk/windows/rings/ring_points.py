"""Points of rings that are interpolated between two outlines, and which of their triangles turn over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.geometry.polygon import edge_lengths
from cytodisk.windows.rings.nucleus_edges import NucleusEdges


@dataclass(frozen=True)
class RingCounts:
    """How many rings and points there are.

    Attributes
    ----------
    cytoplasm, nucleus : int
        Layers between rings.
    points : int
        Of each ring.
    harmonics : int or None
        Of the outlines that are kept.
    """

    cytoplasm: int
    nucleus: int
    points: int
    harmonics: int | None = None


def ring_points(edges: NucleusEdges, counts: RingCounts) -> FloatArray:
    """Points of all rings, from the outline of the cell to that of the nucleus and on to its centroid.

    Parameters
    ----------
    edges : NucleusEdges
    counts : RingCounts

    Returns
    -------
    ndarray of shape (layers + 1, points, 2) and dtype float
        (row, column) in pixels.
    """
    outer, inner = (
        outline_points(outline, edges.centre_yx, counts.points, counts.harmonics)
        for outline in (edges.cell.outline_yx, edges.nucleus.outline_yx)
    )
    centre = np.broadcast_to(edges.centre_yx, inner.shape)
    share = np.linspace(0.0, 1.0, counts.cytoplasm + 1)[:, None, None]
    cytoplasm = outer + share * (inner - outer)
    share = np.linspace(0.0, 1.0, counts.nucleus + 1)[1:, None, None]
    return np.concatenate([cytoplasm, inner + share * (centre - inner)])


def outline_points(
    outline_yx: FloatArray, centre_yx: FloatArray, count: int, harmonics: int | None = None
) -> FloatArray:
    """Points at equal distances along an outline, the first at +x from a centre.

    Parameters
    ----------
    outline_yx : ndarray of shape (B, 2) and dtype float
        Closed polygon, (row, column) in pixels.
    centre_yx : ndarray of shape (2,) and dtype float
        Of several points of the outline in its +x direction the furthest is taken.
    count : int
    harmonics : int, optional
        Fourier harmonics of the points that are kept, on either side of the mean.

    Returns
    -------
    ndarray of shape (count, 2) and dtype float
    """
    along = np.concatenate([[0.0], np.cumsum(edge_lengths(outline_yx))])
    start = _place_at_x(outline_yx, centre_yx, along)
    places = np.mod(start + np.arange(count) * along[-1] / count, along[-1])
    closed = np.concatenate([outline_yx, outline_yx[:1]])
    found = np.column_stack([np.interp(places, along, closed[:, axis]) for axis in (0, 1)])
    if harmonics is None or 2 * harmonics + 1 >= count:
        return found
    kept = np.fft.fft(found, axis=0)
    kept[harmonics + 1 : count - harmonics] = 0.0
    return np.asarray(np.fft.ifft(kept, axis=0).real)


def _place_at_x(outline_yx: FloatArray, centre_yx: FloatArray, along: FloatArray) -> float:
    """Distance along an outline to its furthest point at +x of a centre, or to that nearest in angle."""
    down, aside = (outline_yx - centre_yx).T
    next_down, next_aside = np.roll(down, -1), np.roll(aside, -1)
    crosses = (down <= 0.0) != (next_down <= 0.0)
    share = np.where(crosses, -down / np.where(crosses, next_down - down, 1.0), 0.0)
    at = aside + share * (next_aside - aside)
    ahead = np.flatnonzero(crosses & (at > 0.0))
    if not len(ahead):  # the outline does not go around the centre on that side
        return float(along[np.abs(np.arctan2(down, aside)).argmin()])
    edge = ahead[at[ahead].argmax()]
    return float(along[edge] + share[edge] * (along[edge + 1] - along[edge]))


def ring_triangles(points_yx: FloatArray) -> FloatArray:
    """The two triangles of each quadrilateral between neighbouring rings and points.

    Parameters
    ----------
    points_yx : ndarray of shape (layers + 1, points, 2) and dtype float

    Returns
    -------
    ndarray of shape (layers, points, 2, 3, 2) and dtype float
        Their corners; on rings that go from +x towards +y all go that way around unless turned over. The
        second one of the innermost layer, whose ring is a point, has no area.
    """
    outer, inner = points_yx[:-1], points_yx[1:]
    beyond_outer, beyond_inner = np.roll(outer, -1, axis=1), np.roll(inner, -1, axis=1)
    first = np.stack([outer, beyond_outer, inner], axis=2)
    second = np.stack([beyond_outer, beyond_inner, inner], axis=2)
    return np.stack([first, second], axis=2)


def twice_areas(triangles: FloatArray) -> FloatArray:
    """Twice the area of each triangle, below 0 where it is turned over, shape (layers, points, 2)."""
    start, first, second = np.moveaxis(triangles, -2, 0)
    (dy, dx), (ey, ex) = np.moveaxis(first - start, -1, 0), np.moveaxis(second - start, -1, 0)
    return np.asarray(dx * ey - dy * ex)


def turned_over(points_yx: FloatArray) -> BoolArray:
    """Which triangles between rings are turned over or have no area, shape (layers, points, 2).

    Parameters
    ----------
    points_yx : ndarray of shape (layers + 1, points, 2) and dtype float
        The last ring is a point; its triangles without area are not counted.
    """
    turned = twice_areas(ring_triangles(points_yx)) <= 0.0
    turned[-1, :, 1] = False
    return np.asarray(turned)


def window_of_triangles(layers: int, points: int, sectors: int) -> IntArray:
    """Number of the window of each triangle, shape (layers, points, 2); sectors have equally many points."""
    layer, point = np.arange(layers)[:, None], np.arange(points)
    return np.repeat((layer * sectors + point * sectors // points)[..., None], 2, axis=2)

"""One cell as all groups of features see it: mask, outlines, hull and depth, each made once."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy import ndimage
from scipy.spatial import ConvexHull

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import MaskError
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.polygon import edge_lengths, signed_area, smooth_closed

LEAST_AREA_PX = 16
LEAST_SMOOTHING_PX = 3.0  # that takes the stair steps out of curvature
_LIGHT_PX = 1.0  # takes the stair steps out of lengths, as everywhere in cytodisk
_POINTS = 512  # of an outline with even steps; a power of 2, for the Fourier transform


@dataclass(frozen=True)
class CellShape:
    """The shape of one cell.

    Attributes
    ----------
    mask : ndarray of shape (H, W) and dtype bool
        One piece without holes, cropped, with a margin of at least one pixel on each side.
    notes : list of str
        What was measured in another way than usual; the groups of features add to it.
    """

    mask: BoolArray
    notes: list[str] = field(default_factory=list)

    @cached_property
    def area(self) -> float:
        """In pixels."""
        return float(self.mask.sum())

    @property
    def diameter(self) -> float:
        """Diameter of the disk of the same area, in pixels: the size that scale-free features refer to."""
        return float(np.sqrt(4.0 * self.area / np.pi))

    @property
    def radius(self) -> float:
        """Radius of the disk of the same area, in pixels."""
        return 0.5 * self.diameter

    @cached_property
    def traced(self) -> FloatArray:
        """The pixel outline from the point farthest from the centroid, shape (N, 2), (row, column) in pixels.

        So it begins at the same place of a cell that is turned by a right angle or mirrored.
        """
        outline = trace_outline(self.mask)
        away = outline - np.argwhere(self.mask).mean(axis=0)
        return np.roll(outline, -int((away**2).sum(axis=1).round(6).argmax()), axis=0)

    @cached_property
    def outline(self) -> FloatArray:
        """The lightly smoothed outline, shape (N, 2), (row, column) in pixels."""
        return smooth_closed(self.traced, _LIGHT_PX)

    @cached_property
    def outline_area(self) -> float:
        """Area within the lightly smoothed outline, in pixels, for ratios to lengths along it."""
        return signed_area(self.outline)

    @cached_property
    def perimeter(self) -> float:
        """Length of the lightly smoothed outline, in pixels."""
        return float(edge_lengths(self.outline).sum())

    @cached_property
    def curve(self) -> FloatArray:
        """The lightly smoothed outline in 512 even steps, shape (512, 2), (row, column) in pixels."""
        return even_steps(self.outline, _POINTS)

    def smoothed_curve(self, share: float) -> FloatArray:
        """The outline after stronger smoothing, at 512 points with even steps.

        Parameters
        ----------
        share : float
            Standard deviation of the kernel along the outline over the equivalent diameter. It is 3 px at
            least, so a small cell is smoothed more than the same shape drawn larger.

        Returns
        -------
        ndarray of shape (512, 2) and dtype float
            (row, column) in pixels.
        """
        # Finer than the result, so that no two of its points lie on one edge: it would be straight there.
        fine = even_steps(self.traced, max(2 * _POINTS, len(self.traced)))
        return even_steps(smooth_closed(fine, max(LEAST_SMOOTHING_PX, share * self.diameter)), _POINTS)

    @cached_property
    def pixels(self) -> FloatArray:
        """Centres of the cell's pixels relative to their centroid, shape (A, 2), (row, column) in pixels."""
        centres = np.argwhere(self.mask).astype(np.float64)
        return np.asarray(centres - centres.mean(axis=0))

    @cached_property
    def depth(self) -> FloatArray:
        """Distance of each pixel's centre from the cell's edge in pixels, shape (H, W), 0 outside."""
        inside: FloatArray = ndimage.distance_transform_edt(self.mask)
        return np.maximum(inside - 0.5, 0.0)

    @cached_property
    def hull(self) -> Hull:
        """The convex hull of the lightly smoothed outline."""
        return hull_of(self.outline)


@dataclass(frozen=True)
class Hull:
    """Convex hull of an outline, and how wide it is in each direction of its edges. Lengths in pixels.

    Attributes
    ----------
    points_yx : ndarray of shape (K, 2) and dtype float
    area, perimeter : float
    along, across : ndarray of shape (K,) and dtype float
        Extent of the hull along each of its edges and across it.
    """

    points_yx: FloatArray
    area: float
    perimeter: float
    along: FloatArray
    across: FloatArray


def crop_shape(mask: BoolArray) -> CellShape:
    """Shape of a cell, from a mask of any extent.

    Parameters
    ----------
    mask : ndarray of shape (H, W) and dtype bool
        One 8-connected piece without holes, as `clean_mask` returns it.

    Returns
    -------
    CellShape

    Raises
    ------
    MaskError
        The cell has too few pixels to speak of a shape.
    """
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    crop = mask[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    pixels = int(crop.sum())
    if pixels < LEAST_AREA_PX:
        raise MaskError(
            f"mask has {pixels} px, too few to speak of a shape: {LEAST_AREA_PX} px are the least; "
            "leave the cell out or use a larger image"
        )
    return CellShape(np.pad(crop, 1))


def even_steps(outline_yx: FloatArray, points: int) -> FloatArray:
    """Points with even steps along a closed polygon, beginning at its first point.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        (row, column) in pixels, last point not repeated.
    points : int

    Returns
    -------
    ndarray of shape (points, 2) and dtype float
    """
    travelled = np.concatenate([[0.0], np.cumsum(edge_lengths(outline_yx))])
    closed = np.concatenate([outline_yx, outline_yx[:1]])
    at = np.linspace(0.0, travelled[-1], points, endpoint=False)
    return np.column_stack([np.interp(at, travelled, closed[:, axis]) for axis in (0, 1)])


def hull_of(outline_yx: FloatArray) -> Hull:
    """Convex hull of an outline.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
        (row, column) in pixels, not all on one line.

    Returns
    -------
    Hull
    """
    found = ConvexHull(outline_yx)
    points = outline_yx[found.vertices]
    edges = np.diff(points, axis=0, append=points[:1])
    along = edges / np.hypot(*edges.T)[:, None]
    across = np.column_stack([-along[:, 1], along[:, 0]])
    return Hull(
        points,
        float(found.volume),  # SciPy's name for the area in two dimensions
        float(found.area),
        np.ptp(points @ along.T, axis=0),
        np.ptp(points @ across.T, axis=0),
    )

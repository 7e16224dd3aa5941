"""Size of a cell: areas and lengths."""

import numpy as np
from scipy.spatial.distance import pdist

from cytodisk.analysis.shape.cell_shape import CellShape
from cytodisk.analysis.shape.feature import FeatureGroup, area, length
from cytodisk.arrays import FloatArray

_PIXEL_VARIANCE = 1.0 / 12.0  # of positions within one pixel, so that axes do not shrink with few pixels


def ellipse_axes(shape: CellShape) -> FloatArray:
    """Full axes of the ellipse with the cell's second moments, longest first, shape (2,), in pixels."""
    variances = np.linalg.eigvalsh(shape.pixels.T @ shape.pixels / shape.area) + _PIXEL_VARIANCE
    return np.asarray(4.0 * np.sqrt(variances[::-1]))


def rectangle_sides(shape: CellShape) -> FloatArray:
    """Sides of the smallest rectangle around the cell, longest first, shape (2,), in pixels."""
    hull = shape.hull
    best = int(np.argmin(hull.along * hull.across))
    return np.sort([hull.along[best], hull.across[best]])[::-1]


def measure_size(shape: CellShape) -> dict[str, float]:
    """Areas and lengths of a cell.

    Parameters
    ----------
    shape : CellShape

    Returns
    -------
    dict of str to float
        By name, see `SIZE`; in pixels.
    """
    axes, sides = ellipse_axes(shape), rectangle_sides(shape)
    return {
        "area": shape.area,
        "perimeter": shape.perimeter,
        "equivalent_diameter": shape.diameter,
        "convex_area": shape.hull.area,
        "convex_perimeter": shape.hull.perimeter,
        "feret_max": float(pdist(shape.hull.points_yx).max()),
        "feret_min": float(shape.hull.across.min()),
        "major_axis": float(axes[0]),
        "minor_axis": float(axes[1]),
        "rectangle_length": float(sides[0]),
        "rectangle_width": float(sides[1]),
    }


SIZE = FeatureGroup(
    "size",
    (
        area("area", "Area of the cell; holes count, unless they are excluded"),
        length("perimeter", "Length of the outline, smoothed over 1 px"),
        length("equivalent_diameter", "Diameter of the disk of the same area"),
        area("convex_area", "Area of the convex hull"),
        length("convex_perimeter", "Perimeter of the convex hull"),
        length("feret_max", "Longest distance between two points of the outline"),
        length("feret_min", "Smallest distance between two parallel lines that hold the cell"),
        length("major_axis", "Long axis of the ellipse with the same second moments"),
        length("minor_axis", "Short axis of the ellipse with the same second moments"),
        length("rectangle_length", "Long side of the smallest rectangle around the cell"),
        length("rectangle_width", "Short side of the smallest rectangle around the cell"),
    ),
    measure_size,
)

"""Form of a cell: ratios of lengths and areas."""

import numpy as np
from scipy.spatial.distance import pdist

from cytodisk.analysis.shape.cell_shape import LEAST_SMOOTHING_PX, CellShape
from cytodisk.analysis.shape.feature import FeatureGroup, plain
from cytodisk.analysis.shape.size import ellipse_axes, rectangle_sides
from cytodisk.geometry.polygon import edge_lengths

_COARSE_SHARE = 0.05  # of the equivalent diameter: smoothing of the outline without its detail
_RESOLVED_PX = LEAST_SMOOTHING_PX / _COARSE_SHARE


def measure_form(shape: CellShape) -> dict[str, float]:
    """Ratios of a cell's lengths and areas.

    Parameters
    ----------
    shape : CellShape

    Returns
    -------
    dict of str to float
        By name, see `FORM`.
    """
    axes, sides, hull = ellipse_axes(shape), rectangle_sides(shape), shape.hull
    feret = float(pdist(hull.points_yx).max())
    return {
        "circularity": 4.0 * np.pi * shape.outline_area / shape.perimeter**2,
        "solidity": shape.outline_area / hull.area,
        "convexity": hull.perimeter / shape.perimeter,
        "eccentricity": float(np.sqrt(1.0 - (axes[1] / axes[0]) ** 2)),
        "aspect_ratio": float(axes[0] / axes[1]),
        "extent": float(shape.outline_area / sides.prod()),
        "rectangle_aspect": float(sides[0] / sides[1]),
        "feret_aspect": feret / float(hull.across.min()),
        "roundness": 4.0 * shape.outline_area / (np.pi * feret**2),
        "hull_circularity": 4.0 * np.pi * hull.area / hull.perimeter**2,
        "roughness": shape.perimeter / _coarse_perimeter(shape),
        **_around_centroid(shape),
        "outside_ellipse": _outside_ellipse(shape),
    }


def _coarse_perimeter(shape: CellShape) -> float:
    return float(edge_lengths(shape.smoothed_curve(_COARSE_SHARE)).sum())


def _around_centroid(shape: CellShape) -> dict[str, float]:
    centroid = np.argwhere(shape.mask).mean(axis=0)
    radii = np.hypot(*(shape.curve - centroid).T)
    offset = np.hypot(*(shape.curve.mean(axis=0) - centroid))
    return {
        "radius_variation": float(radii.std() / radii.mean()),
        "radius_max": float(radii.max() / shape.radius),
        "radius_min": float(radii.min() / shape.radius),
        "outline_offset": float(offset / shape.radius),
    }


def _outside_ellipse(shape: CellShape) -> float:
    """Share of the cell outside of the ellipse with its second moments: within it, x' V⁻¹ x ≤ 4."""
    variance = shape.pixels.T @ shape.pixels / shape.area + np.eye(2) / 12.0
    reach = np.einsum("ni,ij,nj->n", shape.pixels, np.linalg.inv(variance), shape.pixels)
    return float((reach > 4.0).mean())


FORM = FeatureGroup(
    "form",
    (
        plain("circularity", "4π area / perimeter²; 1 for a disk"),
        plain("solidity", "Area / area of the convex hull; 1 for a convex cell"),
        plain("convexity", "Perimeter of the convex hull / perimeter; 1 for a convex cell"),
        plain("eccentricity", "Of the ellipse with the same second moments; 0 for a disk"),
        plain("aspect_ratio", "Long / short axis of the ellipse with the same second moments"),
        plain("extent", "Area / area of the smallest rectangle around the cell; 1 for a rectangle"),
        plain("rectangle_aspect", "Long / short side of the smallest rectangle around the cell"),
        plain("feret_aspect", "Longest / smallest Feret diameter"),
        plain("roundness", "Area / area of the disk as wide as the longest Feret diameter"),
        plain("hull_circularity", "4π area / perimeter² of the convex hull"),
        plain(
            "roughness",
            f"Perimeter / perimeter after smoothing over {_COARSE_SHARE:.0%} of the equivalent diameter, "
            f"{LEAST_SMOOTHING_PX:g} px at least; depends on the resolution below {_RESOLVED_PX:.0f} px",
        ),
        plain("radius_variation", "sd / mean of the outline's distance from the centroid"),
        plain("radius_max", "Longest distance of the outline from the centroid / equivalent radius"),
        plain("radius_min", "Smallest distance of the outline from the centroid / equivalent radius"),
        plain("outline_offset", "Distance from the outline's mean to the centroid / equivalent radius"),
        plain("outside_ellipse", "Share of the cell outside of the ellipse with the same second moments"),
    ),
    measure_form,
)

"""Depth inside the cell: how far its pixels are from the edge, and how much of it is thin."""

import numpy as np
from scipy import ndimage

from cytodisk.analysis.shape.cell_shape import CellShape
from cytodisk.analysis.shape.feature import FeatureGroup, length, plain

_PERCENTILES = (10, 25, 50, 75, 90)
_THIN = (10, 20, 40)  # percent of the equivalent radius


def measure_depth(shape: CellShape) -> dict[str, float]:
    """Statistics of the distance to the edge.

    Parameters
    ----------
    shape : CellShape

    Returns
    -------
    dict of str to float
        By name, see `DEPTH`; lengths in pixels.
    """
    inside = shape.depth[shape.mask]
    quantiles = np.percentile(inside, _PERCENTILES) / shape.radius
    return {
        "inscribed_radius": float(inside.max()),
        "mean_depth": float(inside.mean()),
        "depth_max": float(inside.max() / shape.radius),
        "depth_mean": float(inside.mean() / shape.radius),
        "depth_sd": float(inside.std() / shape.radius),
        **{f"depth_p{p}": float(value) for p, value in zip(_PERCENTILES, quantiles, strict=True)},
        **{f"thin_{percent}": _thin_share(shape, percent / 100.0 * shape.radius) for percent in _THIN},
    }


def _thin_share(shape: CellShape, radius_px: float) -> float:
    """Share of the cell that no disk of this radius covers which fits into the cell."""
    centres = shape.depth >= radius_px
    if not centres.any():
        return 1.0
    to_centres = ndimage.distance_transform_edt(~centres)
    # Half a pixel more: pixels at the rim of a disk reach that far beyond their centres.
    return float((to_centres[shape.mask] > radius_px + 0.5).mean())


DEPTH = FeatureGroup(
    "depth",
    (
        length("inscribed_radius", "Radius of the largest disk inside the cell"),
        length("mean_depth", "Mean distance of the cell's pixels from its edge"),
        plain("depth_max", "Radius of the largest disk inside / equivalent radius; 1 for a disk"),
        plain("depth_mean", "Mean distance from the edge / equivalent radius; 1/3 for a disk"),
        plain("depth_sd", "sd of the distance from the edge / equivalent radius"),
        *(
            plain(f"depth_p{p}", f"Percentile {p} of the distance from the edge / equivalent radius")
            for p in _PERCENTILES
        ),
        *(
            plain(
                f"thin_{percent}",
                f"Share of the cell where no disk fits whose radius is {percent} % of the equivalent radius",
            )
            for percent in _THIN
        ),
    ),
    measure_depth,
)

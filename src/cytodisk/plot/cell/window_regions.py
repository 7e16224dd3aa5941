"""Regions that windows cover together: one line around neighbours, none between them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.path import Path
from shapely import Polygon, get_parts, unary_union

from cytodisk.arrays import FloatArray

_ROUNDING = 1e-10  # of the disk or of pixels: the last sector ends where the first begins


def region(polygons_xy: Sequence[FloatArray]) -> Path:
    """What windows cover together, with a line around neighbours and none between them."""
    rings = [
        ring
        for part in pieces_of(polygons_xy)
        for ring in (part.exterior, *part.interiors)
        if not ring.is_empty
    ]
    return Path.make_compound_path(*(Path(np.asarray(ring.coords), closed=True) for ring in rings))


def pieces_of(polygons_xy: Sequence[FloatArray]) -> list[Polygon]:
    """The pieces of what windows cover together."""
    covered = unary_union([Polygon(polygon).buffer(0) for polygon in polygons_xy], grid_size=_ROUNDING)
    return [part for part in get_parts(covered) if isinstance(part, Polygon)]

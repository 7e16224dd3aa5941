"""The field of view that the frames of a movie share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from matplotlib.axes import Axes

from cytodisk.arrays import FloatArray

Extent: TypeAlias = tuple[float, float, float, float]

_MARGIN = 0.04  # of the field's longer side


def field_of_view(outlines_yx: Sequence[FloatArray], margin: float = _MARGIN) -> Extent:
    """The field that holds all outlines of a movie with a small margin.

    Parameters
    ----------
    outlines_yx : sequence of ndarray of shape (N, 2) and dtype float
        (row, column) in pixels.
    margin : float
        On each side, over the longer side of the field.

    Returns
    -------
    (float, float, float, float)
        Top, bottom, left and right in pixels.
    """
    points = np.concatenate([np.asarray(outline).reshape(-1, 2) for outline in outlines_yx])
    low, high = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
    room = margin * float((high - low).max())
    (top, left), (bottom, right) = (low - room).tolist(), (high + room).tolist()
    return top, bottom, left, right


def frame_field(ax: Axes, extent_yx: Extent) -> None:
    """Fit the axes to a field of view and hide them.

    Parameters
    ----------
    ax : Axes
    extent_yx : (float, float, float, float)
        Top, bottom, left and right in pixels.
    """
    top, bottom, left, right = extent_yx
    ax.set_aspect("equal")
    ax.set_xlim(left, right)
    ax.set_ylim(bottom, top)
    ax.set_axis_off()

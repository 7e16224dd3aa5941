"""Draw how a map changes areas: by place in the cell, and how much of the cell's area it concerns."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize

from cytodisk.checks import positive_number
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.distortion import Distortion
from cytodisk.plot.cell.cell_axes import draw_outline, frame_cell
from cytodisk.plot.style import DIVERGING_COLOURS, colour_map
from cytodisk.scale import Scale

DISTORTION_LABEL = "disk area / cell area, log2"

_DISTORTION_SHARE = 0.99  # of the cell's area whose colours are not cut off
_LEAST_LIMIT = 0.1  # log2, so that a perfect map does not show rounding errors in full colour


def draw_area_distortion(
    ax: Axes, disk: DiskMap, *, scale: Scale | None = None, limit: float | None = None
) -> PolyCollection:
    """Fill each triangle of the cell with the colour of log2 λ, its share of the disk over that of the cell.

    Parameters
    ----------
    ax : Axes
    disk : DiskMap
    scale : Scale, optional
        By default that of the map; without a pixel size the scale bar is in px.
    limit : float, optional
        Colours go from -limit to limit, white at 0; by default as far as 99 % of the cell's area goes.

    Returns
    -------
    PolyCollection
        One polygon a triangle; its label, for a colour bar, is "disk area / cell area, log2".

    Raises
    ------
    ParameterError
        The limit is not a positive number.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> disk = cd.map_to_disk(cd.simulate.ellipse((8, 16)))
    >>> figure, ax = plt.subplots()
    >>> triangles = cd.plot.draw_area_distortion(ax, disk)
    >>> triangles.get_label()
    'disk area / cell area, log2'
    """
    top = distortion_limit(disk.distortion) if limit is None else positive_number("limit", limit)
    corners = disk.vertices_yx[disk.triangles][:, :, ::-1]
    drawn = PolyCollection(
        list(corners),
        cmap=colour_map(DIVERGING_COLOURS),
        edgecolors="face",
        linewidths=0.1,
        label=DISTORTION_LABEL,
    )
    drawn.set_array(np.log2(disk.distortion.triangle_area_ratio))
    drawn.set_clim(-top, top)
    ax.add_collection(drawn, autolim=False)
    draw_outline(ax, disk, color="0.5", linewidth=0.25)
    frame_cell(ax, disk, scale=scale)
    return drawn


def draw_area_spread(ax: Axes, disk: DiskMap) -> None:
    """Draw how much of the cell's area has which log2 λ, in the colours of `draw_area_distortion`.

    Parameters
    ----------
    ax : Axes
    disk : DiskMap

    See Also
    --------
    draw_area_distortion : Where in the cell it is.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> cd.plot.draw_area_spread(ax, cd.map_to_disk(cd.simulate.disk(12)))
    """
    top = distortion_limit(disk.distortion)
    edges = np.linspace(-top, top, 32)
    ratio = np.clip(np.log2(disk.distortion.triangle_area_ratio), -top, top)
    share, _ = np.histogram(ratio, edges, weights=100.0 * disk.distortion.area_share)
    middle = 0.5 * (edges[:-1] + edges[1:])
    colours = mpl.colormaps[DIVERGING_COLOURS](Normalize(-top, top)(middle))
    ax.bar(middle, share, np.diff(edges), color=colours, edgecolor="0.4", linewidth=0.25)
    ax.set(xlim=(-top, top), xlabel=DISTORTION_LABEL, ylabel="cell's area (%)")


def distortion_limit(distortion: Distortion) -> float:
    """The |log2 λ| that all but 1 % of the cell's area stays below, at least 0.1.

    Parameters
    ----------
    distortion : Distortion

    Returns
    -------
    float
    """
    size = np.abs(np.log2(distortion.triangle_area_ratio))
    order = np.argsort(size)
    below = np.cumsum(distortion.area_share[order])
    at = min(int(np.searchsorted(below, _DISTORTION_SHARE * below[-1])), len(order) - 1)
    return max(float(size[order[at]]), _LEAST_LIMIT)

"""Draw cells beside each other at one scale and in the same colours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import Colormap
from matplotlib.image import AxesImage
from matplotlib.patches import Rectangle

from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError
from cytodisk.plot.cell.cell_axes import draw_cell
from cytodisk.plot.cell.window_polygons import draw_window_means
from cytodisk.plot.style import MISSING_COLOUR, SIGNAL_COLOURS, scale_bar, signal_limits
from cytodisk.plot.units import scale_for
from cytodisk.windows.polar_windows import CellWindows

BEYOND_NAME = "beyond the image"

_MARGIN = 1.06  # of the largest cell


def draw_gallery(
    axes: Sequence[Axes],
    disks: Sequence[DiskMap],
    images: Sequence[Any],
    *,
    names: Sequence[str] = (),
    cmap: str | Colormap = "gray",
    limits: tuple[float, float] | None = None,
) -> list[AxesImage]:
    """Draw the signal of cells with their outlines, all at one scale and in the same colours.

    Parameters
    ----------
    axes : sequence of Axes
        One a cell, of one size. The first has the scale bar.
    disks : sequence of DiskMap
    images : sequence of array_like of shape (H, W)
        One channel, each of the shape of the cell's mask.
    names : sequence of str
        Titles of the cells.
    cmap : str or Colormap
    limits : (float, float), optional
        Limits of the colours; by default the percentiles 1 and 99.5 of all cells together.

    Returns
    -------
    list of AxesImage

    Raises
    ------
    ParameterError
        Axes, maps and images are not as many.
    SignalError
        An image has another shape than the mask.

    See Also
    --------
    draw_cell : One cell.
    draw_window_gallery : Means of windows instead, where there are no images.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> masks = [cd.simulate.disk(10), cd.simulate.disk(14)]
    >>> figure, axes = plt.subplots(1, 2)
    >>> images = [cd.simulate.ring_signal(mask) for mask in masks]
    >>> drawn = cd.plot.draw_gallery(axes, [cd.map_to_disk(mask) for mask in masks], images, names=["a", "b"])
    >>> axes[1].get_title()
    'b'
    """
    _check(axes, disks, images, "images")
    if limits is None:
        inside = [
            np.asarray(image, dtype=np.float64)[disk.mask_without_holes]
            for image, disk in zip(images, disks, strict=True)
        ]
        limits = signal_limits(np.concatenate(inside))
    drawn = [
        draw_cell(ax, image, disk, cmap=cmap, limits=limits)
        for ax, image, disk in zip(axes, images, disks, strict=True)
    ]
    _one_scale(axes, disks, names, beyond=True)
    return drawn


def draw_window_gallery(
    axes: Sequence[Axes],
    windows: Sequence[CellWindows],
    values: Sequence[Any],
    *,
    names: Sequence[str] = (),
    cmap: str | Colormap = SIGNAL_COLOURS,
    limits: tuple[float, float] | None = None,
) -> list[PolyCollection]:
    """Draw the means of windows in cells, all at one scale and in the same colours.

    Parameters
    ----------
    axes : sequence of Axes
        One a cell, of one size. The first has the scale bar.
    windows : sequence of CellWindows
    values : sequence of array_like of shape (layers, sectors)
    names : sequence of str
        Titles of the cells.
    cmap : str or Colormap
    limits : (float, float), optional
        Limits of the colours; by default the percentiles 1 and 99.5 of all values.

    Returns
    -------
    list of PolyCollection

    Raises
    ------
    ParameterError
        Axes, windows and values are not as many.

    See Also
    --------
    draw_gallery : The signal itself.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> mask = cd.simulate.disk(12)
    >>> windows = cd.polar_windows(layers=3, sectors=8).on(cd.map_to_disk(mask))
    >>> means = cd.sample(windows, cd.simulate.ring_signal(mask))["mean"]
    >>> figure, ax = plt.subplots()
    >>> (drawn,) = cd.plot.draw_window_gallery([ax], [windows], [means], names=["cell 3"])
    """
    _check(axes, windows, values, "values")
    limits = limits or signal_limits(np.concatenate([np.ravel(one) for one in values]))
    drawn = [
        draw_window_means(ax, one, table, cmap=cmap, limits=limits)
        for ax, one, table in zip(axes, windows, values, strict=True)
    ]
    _one_scale(axes, [one.disk for one in windows], names)
    return drawn


def _check(axes: Sequence[Axes], cells: Sequence[Any], values: Sequence[Any], name: str) -> None:
    if not len(axes) == len(cells) == len(values) or not len(axes):
        raise ParameterError(
            f"got {len(axes)} axes, {len(cells)} cells and {len(values)} {name}: pass one of each a cell"
        )


def _one_scale(
    axes: Sequence[Axes], disks: Sequence[DiskMap], names: Sequence[str], *, beyond: bool = False
) -> None:
    """Fields of one size around the middle of each cell, grey beyond its image; a bar below the first."""
    scales = [scale_for(disk) for disk in disks]
    pixel = [scale.pixel_size_um or 1.0 for scale in scales]
    known = all(scale.pixel_size_um for scale in scales)
    sides = [
        float(np.ptp(disk.outline_yx, axis=0).max()) * (size if known else 1.0)
        for disk, size in zip(disks, pixel, strict=True)
    ]
    field = _MARGIN * max(sides)
    for number, (ax, disk) in enumerate(zip(axes, disks, strict=True)):
        half = 0.5 * field / (pixel[number] if known else 1.0)
        y, x = 0.5 * (disk.outline_yx.min(axis=0) + disk.outline_yx.max(axis=0))
        ax.set(xlim=(x - half, x + half), ylim=(y + half, y - half))
        if beyond:
            corner = (x - half, y - half)
            style: Any = {"facecolor": MISSING_COLOUR, "linewidth": 0.0}
            ax.add_patch(Rectangle(corner, 2 * half, 2 * half, zorder=-1.0, gid=BEYOND_NAME, **style))
        line, text = scale_bar(ax, scales[number])
        if number:
            line.remove()
            text.remove()
        if number < len(names):
            ax.set_title(names[number], parse_math=False)

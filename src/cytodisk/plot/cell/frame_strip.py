"""Draw windows on a cell through time: frames side by side, to one scale and in one field of view."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import Colormap

from cytodisk.errors import ParameterError
from cytodisk.plot.cell.cell_axes import fitting_image
from cytodisk.plot.cell.sector_marks import draw_sectors, note_sector
from cytodisk.plot.field_of_view import Extent, field_of_view, frame_field
from cytodisk.plot.style import colour_map, scale_bar, signal_limits
from cytodisk.plot.units import scale_for
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows


def draw_strip(
    axes: Sequence[Axes],
    windows: Sequence[CellWindows],
    titles: Sequence[str],
    *,
    extent_yx: Extent | None = None,
    scale: Scale | None = None,
    signal: Sequence[Any] | None = None,
    cmap: str | Colormap = "gray",
    limits: tuple[float, float] | None = None,
) -> list[PolyCollection]:
    """Draw the windows of a few frames of a movie; six fit the width of a page.

    Without a signal the windows of the outermost layer are filled with the colours of their sectors; over a
    signal, which they would hide, it is the cell's edge that has them.

    Parameters
    ----------
    axes : sequence of Axes
        One a frame.
    windows : sequence of CellWindows
    titles : sequence of str
        One a frame, such as `time_stamp` gives.
    extent_yx : (float, float, float, float), optional
        Field of view: top, bottom, left and right in pixels; by default `field_of_view` of the cells.
    scale : Scale, optional
        By default that of the windows; without a pixel size the scale bar is in px.
    signal : sequence of array_like of shape (H, W), optional
        One channel, one image a frame.
    cmap : str or Colormap
        Of the signal.
    limits : (float, float), optional
        Limits of the signal's colours; by default percentiles 1 and 99.5 inside the cells of all frames.

    Returns
    -------
    list of PolyCollection
        The windows of each frame, one polygon a window, by window number.

    Raises
    ------
    ParameterError
        There is no frame, or not one of everything a frame.
    SignalError
        An image has another shape than its mask.

    See Also
    --------
    draw_sectors : One frame.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> movie = cd.map_movie(cd.simulate.movie("growing", frames=3, radius_px=12.0).masks)
    >>> grid = cd.polar_windows(layers=3, sectors=8)
    >>> figure, axes = plt.subplots(1, 2)
    >>> drawn = cd.plot.draw_strip(axes, [grid.on(movie[0]), grid.on(movie[2])], ["frame 0", "frame 2"])
    >>> len(drawn)
    2
    """
    images: list[Any] = [None] * len(windows) if signal is None else list(signal)
    counts = {"axes": len(axes), "titles": len(titles), "signal": len(images)}
    if not windows or any(count != len(windows) for count in counts.values()):
        raise ParameterError(f"windows has {len(windows)} frames, but there are {counts}: pass one a frame")
    if signal is not None:
        pairs = [
            (fitting_image(image, frame.mask, "signal"), frame.mask_without_holes)
            for image, frame in zip(signal, windows, strict=True)
        ]
        images = [image for image, _ in pairs]
        limits = limits or signal_limits(np.concatenate([image[mask] for image, mask in pairs]))
    extent = extent_yx or field_of_view([frame.disk.outline_yx for frame in windows])
    drawn = []
    for ax, frame, title, image in zip(axes, windows, titles, images, strict=True):
        if image is not None:
            low, high = limits or (0.0, 1.0)
            ax.imshow(image, cmap=colour_map(cmap), vmin=low, vmax=high)
        drawn.append(draw_sectors(ax, frame, over_signal=image is not None))
        frame_field(ax, extent)
        ax.set_title(title, parse_math=False)
    scale_bar(axes[0], scale_for(windows[0], scale))
    note_sector(axes[-1])
    return drawn

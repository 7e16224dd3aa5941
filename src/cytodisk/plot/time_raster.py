"""Draw numbers by frame and place as an image: time to the right, places upwards."""

from __future__ import annotations

from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.image import AxesImage

from cytodisk.arrays import FloatArray
from cytodisk.plot.style import MM_PER_INCH, colour_map
from cytodisk.plot.time_axis import FrameTimes

Extend = Literal["neither", "both", "min", "max"]

_BAR_WIDTH_MM, _BAR_GAP_MM = 2.0, 1.5


def draw_time_raster(
    ax: Axes,
    table: FloatArray,
    times: FrameTimes,
    span: tuple[float, float],
    limits: tuple[float, float],
    cmap: str,
    interpolation: str | None = None,
) -> AxesImage:
    """Draw a table as an image, and set the axis of time.

    Parameters
    ----------
    ax : Axes
    table : ndarray of shape (T, N) and dtype float
        NaN is drawn light grey.
    times : FrameTimes
    span : (float, float)
        Ends of the places on y.
    limits : (float, float)
        Of the colours.
    cmap : str
    interpolation : str, optional
        By default Matplotlib's own choice.

    Returns
    -------
    AxesImage
        Its array has shape (N, T).
    """
    times.set_axis(ax)
    return ax.imshow(
        np.ma.masked_invalid(table.T),
        cmap=colour_map(cmap),
        vmin=limits[0],
        vmax=limits[1],
        origin="lower",
        aspect="auto",
        interpolation=interpolation,
        extent=(*ax.get_xlim(), *span),
    )


def cut_off(values: FloatArray, limits: tuple[float, float]) -> Extend:
    """At which ends of the colours values are cut off, for the colour bar's `extend`."""
    below, above = bool((values < limits[0]).any()), bool((values > limits[1]).any())
    return "both" if below and above else "min" if below else "max" if above else "neither"


def bar_beside(*axes: Axes) -> Axes:
    """Axes for a colour bar to the right of one picture, or of several from top to bottom."""
    first, last = axes[0], axes[-1]
    box, top = last.get_window_extent(), first.get_window_extent().y1
    width = box.width / last.figure.dpi * MM_PER_INCH
    return last.inset_axes(
        (1.0 + _BAR_GAP_MM / width, 0.0, _BAR_WIDTH_MM / width, (top - box.y0) / box.height)
    )

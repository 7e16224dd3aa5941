"""Lines of layers through time, dark for the edge and light for the centre."""

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.style import LAYER_COLOURS
from cytodisk.plot.time_axis import TICK_STEPS, stands_alone, time_axis

_LIGHTEST = 0.85  # share of the colours that can be seen on white


def draw_by_layer(
    ax: Axes,
    values: Any,
    layers: Sequence[int],
    label: str,
    *,
    frame_interval_s: float | None = None,
    first_frame: int = 0,
) -> list[Line2D]:
    """Draw a measure of some layers through time, dark for the edge and light for the centre.

    Parameters
    ----------
    ax : Axes
    values : array_like of shape (T, L)
        One number a frame and layer; NaN is a gap.
    layers : sequence of int
        Those to draw.
    label : str
        Label of the measure, with its unit.
    frame_interval_s : float, optional
        Seconds between frames; without it time is in frames.
    first_frame : int
        Number of the first frame, where the time axis starts.

    Returns
    -------
    list of Line2D
        One a layer.

    Raises
    ------
    ParameterError
        The values are no table with these layers, or the interval is not a positive number.

    References
    ----------
    u-Unwrap, Fig. 4C and D.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> lines = cd.plot.draw_by_layer(ax, np.random.default_rng(0).random((20, 4)), [0, 3], "correlation")
    >>> len(lines)
    2
    """
    table = np.asarray(values, dtype=np.float64)
    if table.ndim != 2 or not len(table) or not all(0 <= layer < table.shape[1] for layer in layers):
        raise ParameterError(f"values has shape {table.shape}: pass (frames, layers) for layers {layers}")
    time = time_axis(ax, len(table), frame_interval_s, first_frame)
    lines = []
    for layer, colour in zip(layers, layer_colours(layers), strict=True):
        values = table[:, layer]
        dots: Any = {"marker": ".", "markersize": 3.0, "markevery": stands_alone(values)}
        lines += ax.plot(time, values, color=colour, linewidth=0.9, clip_on=False, **dots)
    ax.set_ylabel(label)
    ax.yaxis.set_major_locator(MaxNLocator(4, steps=TICK_STEPS))
    return lines


def layer_colours(layers: Sequence[int]) -> FloatArray:
    """Colours of lines on white, from dark for the first layer to light for the last.

    Parameters
    ----------
    layers : sequence of int

    Returns
    -------
    ndarray of shape (N, 4) and dtype float
        Red, green, blue and opacity.
    """
    return np.asarray(mpl.colormaps[LAYER_COLOURS](np.linspace(0.0, _LIGHTEST, len(layers))))

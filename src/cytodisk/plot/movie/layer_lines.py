"""Lines of layers through time, dark for the edge and light for the centre."""

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.errors import ParameterError
from cytodisk.plot.layer_looks import cytoplasm_layers_of, layer_colours, layer_dashes
from cytodisk.plot.number_tables import number_table
from cytodisk.plot.time_axis import TICK_STEPS, FrameTimes, stands_alone
from cytodisk.plot.units import unit_of, with_unit
from cytodisk.scale import Scale


def draw_by_layer(
    ax: Axes, values: Any, layers: Sequence[int], label: str, *, scale: Scale | None = None
) -> list[Line2D]:
    """Draw a measure of some layers through time, dark for the edge and light for the centre.

    Parameters
    ----------
    ax : Axes
    values : array_like or DataArray of shape (T, L)
        One number a frame and layer; NaN is a gap. A DataArray brings its unit and its times, and with the
        coordinate compartment which layers are in the nucleus: blue.
    layers : sequence of int
        Those to draw.
    label : str
        Label of the measure; the unit follows if the values say theirs.
    scale : Scale, optional
        Of plain numbers: the time between frames. Unknown, time is in frames.

    Returns
    -------
    list of Line2D
        One a layer.

    Raises
    ------
    ParameterError
        The values are no table with these layers, or their frames are not at even steps.

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
    table = number_table(values, "values", ("time", "layer"))
    if not all(0 <= layer < table.shape[1] for layer in layers):
        raise ParameterError(f"values has shape {table.shape}: pass (frames, layers) for layers {layers}")
    time = FrameTimes.of(values, "values", scale).set_axis(ax)
    lines = []
    colours = layer_colours(layers, cytoplasm_layers_of(values))
    for layer, colour, dashes in zip(layers, colours, layer_dashes(layers), strict=True):
        one = table[:, layer]
        dots: Any = {"marker": ".", "markersize": 3.0, "markevery": stands_alone(one)}
        lines += ax.plot(time, one, color=colour, linewidth=0.9, linestyle=dashes, clip_on=False, **dots)
    ax.set_ylabel(with_unit(label, unit_of(values)))
    ax.yaxis.set_major_locator(MaxNLocator(4, steps=TICK_STEPS))
    return lines

"""Draw the power of waves by their number around the cell and by frequency, for both directions."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.ticker import MaxNLocator

from cytodisk.plot.style import LINE_COLOUR, colour_map
from cytodisk.plot.time_axis import TICK_STEPS
from cytodisk.plot.waves.mode_power import wave_rows

_COLUMNS = {"mode", "frequency", "power"}
_COLOURS = "magma_r"
_MILLI = 1000.0


def draw_wave_spectrum(
    ax: Axes,
    spectrum: pd.DataFrame,
    *,
    chosen: tuple[int, float] | None = None,
    seconds: bool = True,
) -> QuadMesh:
    """Draw power by mode and frequency: anticlockwise waves to the left, clockwise ones to the right.

    Parameters
    ----------
    ax : Axes
    spectrum : DataFrame
        Rows of one cell and layer of a study's `waves.spectrum`: mode, positive for waves that run towards
        higher sectors, which is clockwise in the cell's image; frequency; power, its share.
    chosen : (int, float), optional
        Mode and frequency of the wave that was found, which a ring marks.
    seconds : bool
        Frequencies are per second, and are shown in mHz; else they are per frame.

    Returns
    -------
    QuadMesh
        For a colour bar. Mode 0, the whole cell at once, is in the middle.

    Raises
    ------
    ParameterError
        The table lacks a column, has no rows, or those of several cells or layers.

    See Also
    --------
    draw_mode_power : Over all frequencies.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> rows = [(mode, frequency, 0.1) for mode in (-1, 0, 1) for frequency in (0.01, 0.02)]
    >>> figure, ax = plt.subplots()
    >>> mesh = cd.plot.draw_wave_spectrum(ax, pd.DataFrame(rows, columns=["mode", "frequency", "power"]))
    >>> mesh.get_array().shape
    (2, 3)
    """
    rows = wave_rows(spectrum, "spectrum", _COLUMNS)
    table = rows.pivot_table(index="frequency", columns="mode", values="power")
    factor = _MILLI if seconds else 1.0
    modes, frequencies = table.columns.to_numpy(dtype=np.float64), factor * table.index.to_numpy(np.float64)
    values = 100.0 * table.to_numpy(dtype=np.float64)
    mesh = ax.pcolormesh(
        modes, frequencies, values, cmap=colour_map(_COLOURS), vmin=0.0, shading="nearest", rasterized=True
    )
    for side in (-0.5, 0.5):
        ax.axvline(side, color="0.6", linewidth=0.4, linestyle=(0, (4, 3)))
    if chosen is not None:
        ax.plot(
            [chosen[0]],
            [factor * chosen[1]],
            "o",
            markersize=7.0,
            markerfacecolor="none",
            markeredgecolor="#0072B2",
            markeredgewidth=1.0,
            clip_on=False,
        )
    ax.set(xlabel="← anticlockwise · mode · clockwise →", ylabel=f"frequency ({_unit(seconds)})")
    ax.xaxis.set_major_locator(MaxNLocator(9, integer=True, steps=TICK_STEPS))
    ax.xaxis.set_major_formatter(lambda value, _: f"{abs(value):.0f}")
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    ax.tick_params(color=LINE_COLOUR)
    return mesh


def _unit(seconds: bool) -> str:
    return "mHz" if seconds else "1/frame"

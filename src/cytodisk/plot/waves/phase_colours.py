"""The phase of waves in pictures: its colours, its key, and where the crests are."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Normalize

from cytodisk.arrays import FloatArray
from cytodisk.plot.style import colour_map

PHASE_COLOURS = "twilight"
"""Cyclic: light where the wave is lowest, dark at its crest, blue on the way up and red on the way down."""

PHASE_LIMITS = (-np.pi, np.pi)
_PLACES = {-np.pi: "lowest", -np.pi / 2: "rising", 0.0: "crest", np.pi / 2: "falling", np.pi: "lowest"}


def phase_key(into: Axes, *, upright: bool = True) -> Colorbar:
    """Draw the key of the colours of phases, in words.

    Parameters
    ----------
    into : Axes
        Filled by the key.
    upright : bool
        Or from left to right.

    Returns
    -------
    Colorbar

    See Also
    --------
    draw_phase_on_disk : What it belongs to.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> key = cd.plot.phase_key(ax)
    """
    colours = ScalarMappable(Normalize(*PHASE_LIMITS), colour_map(PHASE_COLOURS))
    bar = into.figure.colorbar(colours, cax=into, orientation="vertical" if upright else "horizontal")
    bar.set_ticks(list(_PLACES), labels=list(_PLACES.values()))
    bar.outline.set_linewidth(0.4)
    bar.ax.tick_params(width=0.4, length=2)
    return bar


def crest_mask(phase: FloatArray) -> FloatArray:
    """The sine of phases where they are near a crest, else NaN: it is 0 on the crests.

    Parameters
    ----------
    phase : ndarray of shape (T, S) and dtype float
        In radians, 0 at a crest.

    Returns
    -------
    ndarray of shape (T, S + 2) and dtype float
        The last sector stands before the first, and the first behind the last, as they are neighbours.
    """
    around = np.concatenate([phase[:, -1:], phase, phase[:, :1]], axis=1)
    return np.where(np.cos(around) > 0.0, np.sin(around), np.nan)

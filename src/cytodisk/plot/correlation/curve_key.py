"""What the lines, bands and marks of correlation curves look like, and their legend."""

from __future__ import annotations

from typing import Any

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from cytodisk.plot.layer_looks import layer_colours
from cytodisk.plot.style import CHANCE_COLOUR, CHANCE_LINE

BAND_OPACITY = 0.3
PARTIAL_LOOK: Any = {"linewidth": 0.6, "linestyle": (0, (3, 1.2))}
LOST_LOOK: Any = {"marker": "x", "markersize": 4.5, "markeredgewidth": 1.2}
JITTER_LOOK: Any = {"marker": "D", "markersize": 3.5, "markeredgewidth": 0.8}
ALPHA = 0.05
"""Share of false discoveries that is accepted."""


def curve_key(
    *,
    peaks: bool = True,
    chance: bool = True,
    partial: str = "",
    lost: bool = False,
    jittered: bool = False,
    cytoplasm_layers: int | None = None,
) -> list[Any]:
    """Handles of a legend for `draw_correlation_curves`.

    Parameters
    ----------
    peaks, chance : bool
        Whether they are drawn.
    partial : str
        What the thin line is, such as "without geometry"; empty for none.
    lost : bool
        Whether a peak does not survive.
    jittered : bool
        Whether jitter makes the lag of a peak.
    cytoplasm_layers : int, optional
        How many layers are not in the nucleus, where cells have one: the curves have other colours.

    Returns
    -------
    list of Artist

    See Also
    --------
    draw_correlation_curves : Draws the curves.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> legend = figure.legend(handles=cd.plot.curve_key())
    """
    dark = tuple(layer_colours([0], cytoplasm_layers)[0])
    band = (*dark[:3], BAND_OPACITY)
    handles: list[Any] = [
        Line2D([], [], color=dark, linewidth=1.0, label="mean of sectors"),
        Patch(color=band, linewidth=0, label="quartiles of sectors"),
    ]
    if partial:
        handles.insert(1, Line2D([], [], color=dark, label=partial, **PARTIAL_LOOK))
    if chance:
        handles.append(
            Patch(
                facecolor=CHANCE_COLOUR,
                edgecolor=CHANCE_LINE,
                linewidth=0.4,
                label="chance (95 %, each layer alone)",
            )
        )
    if peaks:
        words = f"peak, q < {ALPHA:g} (○ q ≥ {ALPHA:g})" if chance else "peak"
        handles.append(Line2D([], [], color=dark, marker="o", markersize=3.5, linewidth=0, label=words))
    if lost:
        handles.append(Line2D([], [], color=dark, linewidth=0, label=f"lost {partial}", **LOST_LOOK))
    if jittered:
        words = "jitter makes this lag"
        handles.append(
            Line2D([], [], color=dark, linewidth=0, label=words, markerfacecolor="white", **JITTER_LOOK)
        )
    return handles

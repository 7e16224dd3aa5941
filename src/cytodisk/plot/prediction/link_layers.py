"""Draw in which layers one signal predicts another, a row a link."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from cytodisk.plot.prediction.drawn_links import LINK_COLUMNS
from cytodisk.plot.prediction.link_looks import (
    ALPHA,
    FAINT_COLOUR,
    LESS_COLOUR,
    MORE_COLOUR,
    arrow_words,
    lost_in,
    of_pair,
    pairs_in,
    percent,
    rows_of,
)

_FULL = 30.0  # percent of error from which a square is full
_LEAST, _MOST = 0.28, 0.86  # sides of squares
_MOST_TICKS = 12


def draw_link_layers(
    ax: Axes,
    links: pd.DataFrame,
    *,
    cell: int = 0,
    names: Mapping[str, str] | None = None,
) -> list[Rectangle]:
    """Draw each link as a row, and in each layer a square as large as the error that it takes away.

    Parameters
    ----------
    ax : Axes
    links : DataFrame
        `links` of a study's prediction, as for `draw_network`.
    cell : int
    names : mapping of str to str, optional
        What signals are called.

    Returns
    -------
    list of Rectangle
        Where q < 0.05: vermilion where more of the source is followed by more of the target, blue by less; a
        grey outline where it does not count, as geometry or noise of measurement alone may have made it. A
        dot is a layer in which nothing was found; one that could not be tested is empty.

    Raises
    ------
    ParameterError
        The table lacks columns or the cell.

    See Also
    --------
    draw_network : The same as arrows.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> row = {"cell": 0, "source": "Rac1", "target": "velocity", "layer": 0}
    >>> links = pd.DataFrame([row | {"gain": 0.05, "q": 0.01, "effect": 0.2}])
    >>> figure, ax = plt.subplots()
    >>> squares = cd.plot.draw_link_layers(ax, links)
    """
    rows = rows_of(links, cell, LINK_COLUMNS, "links")
    pairs = pairs_in(rows)
    squares = []
    for place, pair in enumerate(pairs):
        own = of_pair(rows, pair)
        for row in own.assign(lost=lost_in(own)).to_dict("records"):
            if not np.isfinite(row["gain"]):
                continue
            if not row["q"] < ALPHA:
                ax.plot(row["layer"], place, marker=".", markersize=1.5, color=FAINT_COLOUR)
                continue
            squares.append(_square(row, place))
            ax.add_patch(squares[-1])
    layers = np.unique(rows["layer"].to_numpy())
    ax.set(xlim=(layers.min() - 0.5, layers.max() + 0.5), ylim=(len(pairs) - 0.5, -0.5))
    ax.set_aspect("equal", adjustable="box", anchor="NW")
    ax.set_yticks(range(len(pairs)), [arrow_words(pair, names) for pair in pairs], parse_math=False)
    ax.set_xticks(layers[:: -(-len(layers) // _MOST_TICKS)])
    ax.set_xlabel("layer (0: edge)")
    ax.tick_params(length=0)
    for side in ("left", "bottom"):
        ax.spines[side].set_visible(False)
    for line in np.arange(len(pairs) + 1) - 0.5:
        ax.axhline(line, color="0.9", linewidth=0.4, zorder=0)
    return squares


def _square(row: Mapping[Any, Any], place: int) -> Rectangle:
    share = float(np.clip(percent(row["gain"]) / _FULL, 0.0, 1.0))
    side = _LEAST + (_MOST - _LEAST) * np.sqrt(share)
    colour = MORE_COLOUR if row["effect"] > 0 else LESS_COLOUR
    look: Any = {"facecolor": colour, "edgecolor": "none"}
    if row["lost"]:
        look = {"facecolor": "none", "edgecolor": FAINT_COLOUR, "linewidth": 0.8}
    return Rectangle((float(row["layer"]) - 0.5 * side, place - 0.5 * side), side, side, **look)

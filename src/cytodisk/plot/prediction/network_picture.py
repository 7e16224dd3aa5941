"""Draw which signals of a cell predict which: arrows between their names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import FancyArrowPatch

from cytodisk.errors import ParameterError
from cytodisk.plot.prediction.drawn_links import DrawnLink, drawn_links, layers_words
from cytodisk.plot.prediction.link_looks import (
    FAINT_COLOUR,
    LESS_COLOUR,
    MORE_COLOUR,
    NOT_COUNTED,
    percent,
    percent_words,
)
from cytodisk.plot.style import LINE_COLOUR, NUMBER_SIZE, TEXT_SIZE

_BEND = 0.25  # of an arrow, so that there and back lie beside each other
_THIN, _THICK = 0.8, 3.2  # points
_WEAK, _STRONG = 1.0, 40.0  # percent of error, of the thinnest and the thickest arrow
_ROOM = 2.5  # points between a name and an arrow
_WIDE = 1.3  # of the circle
_FEW = 4  # links whose layers are written beside them
_SHARE_OF_MANY = 0.42  # of the way, where numbers stand: in the middle arrows cross


def draw_network(
    ax: Axes,
    links: pd.DataFrame,
    signals: Sequence[str],
    *,
    cell: int = 0,
    names: Mapping[str, str] | None = None,
) -> list[FancyArrowPatch]:
    """Draw signals around a circle, and an arrow from each that predicts another.

    Parameters
    ----------
    ax : Axes
        Its lines are taken away.
    links : DataFrame
        `links` of a study's prediction: cell, source, target, layer, gain, q and effect; geometry and weaker
        where they are known.
    signals : sequence of str
        Two or more, in their order around the circle; the last, usually velocity, stands at the bottom.
    cell : int
    names : mapping of str to str, optional
        What signals are called.

    Returns
    -------
    list of FancyArrowPatch
        A link that ends in a point: more of the source is followed by more of the target; in a bar: by less.
        The thicker, the more error it takes away; on it stands how much, and of four links or fewer in which
        layers. A thin broken grey line is a link that does not count: geometry, or noise of measurement
        alone, may have made it.

    Raises
    ------
    ParameterError
        There are fewer than two signals, or the table lacks columns or the cell.

    See Also
    --------
    network_key : Says what the arrows are.
    draw_link_layers : The same by layer.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> row = {"cell": 0, "source": "Rac1", "target": "velocity", "layer": 0}
    >>> links = pd.DataFrame([row | {"gain": 0.05, "q": 0.01, "effect": 0.2}])
    >>> figure, ax = plt.subplots()
    >>> arrows = cd.plot.draw_network(ax, links, ["Rac1", "RhoA", "velocity"])
    """
    if len(signals) < 2:
        raise ParameterError(f"signals must be two or more, got {len(signals)}")
    places, shown, boxes = _places(signals), names or {}, {}
    box: Any = {"boxstyle": "round,pad=0.35", "facecolor": "0.95", "edgecolor": "0.5", "linewidth": 0.5}
    style: Any = {"ha": "center", "va": "center", "fontsize": TEXT_SIZE, "weight": "bold"}
    for name, (x, y) in places.items():
        words = shown.get(name, name)
        text = ax.text(x, y, words, color=LINE_COLOUR, parse_math=False, zorder=5, bbox=box, **style)
        boxes[name] = text.get_bbox_patch()
    found = drawn_links(links, cell=cell)
    arrows = [_draw_arrow(ax, link, places, boxes) for link in found]
    for link in found:
        _label(ax, link, places, crowded=len(found) > _FEW)
    high = max(y for _, y in places.values())
    low = min(y for _, y in places.values())
    room = 0.55 if high == low else 0.3
    ax.set(xlim=(-_WIDE - 0.4, _WIDE + 0.4), ylim=(low - room, high + room), aspect="equal")
    ax.set_axis_off()
    return arrows


def network_key(*, doubtful: bool = False) -> list[Any]:
    """Handles of a legend for `draw_network` and `draw_link_layers`.

    Parameters
    ----------
    doubtful : bool
        Whether there are links that do not count.

    Returns
    -------
    list of Artist

    See Also
    --------
    draw_network : Draws the arrows.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> legend = figure.legend(handles=cd.plot.network_key())
    """
    handles: list[Any] = [
        Line2D([], [], color=MORE_COLOUR, marker=">", markersize=4, label="more is followed by more"),
        Line2D([], [], color=LESS_COLOUR, marker="|", markersize=7, label="more is followed by less"),
    ]
    if doubtful:
        look: Any = {"color": FAINT_COLOUR, "linestyle": (0, (3, 1.5))}
        handles.append(Line2D([], [], label=NOT_COUNTED, **look))
    return handles


def _places(signals: Sequence[str]) -> dict[str, tuple[float, float]]:
    """Where names stand: around an ellipse, the last one at the bottom; two beside each other."""
    if len(signals) == 2:
        return {signals[0]: (-_WIDE, 0.0), signals[1]: (_WIDE, 0.0)}
    turns = -0.5 * np.pi - 2.0 * np.pi * (np.arange(len(signals)) + 1) / len(signals)
    around = zip(signals, turns.tolist(), strict=True)
    return {name: (_WIDE * float(np.cos(turn)), float(np.sin(turn))) for name, turn in around}


def _draw_arrow(
    ax: Axes, link: DrawnLink, places: Mapping[str, tuple[float, float]], boxes: Mapping[str, Any]
) -> FancyArrowPatch:
    more = link.effect > 0
    share = np.log(percent(link.gain) / _WEAK) / np.log(_STRONG / _WEAK)
    arrow = FancyArrowPatch(
        places[link.pair[0]],
        places[link.pair[1]],
        arrowstyle="-|>,head_length=3.2,head_width=1.9" if more else "|-|,widthA=0,widthB=2.6",
        connectionstyle=f"arc3,rad={_BEND}",
        linewidth=_THIN + (_THICK - _THIN) * float(np.clip(0.0 if link.doubtful else share, 0.0, 1.0)),
        linestyle=(0, (3, 1.5)) if link.doubtful else "-",
        color=FAINT_COLOUR if link.doubtful else MORE_COLOUR if more else LESS_COLOUR,
        patchA=boxes[link.pair[0]],
        patchB=boxes[link.pair[1]],
        shrinkA=_ROOM,
        shrinkB=_ROOM,
        capstyle="butt",
        joinstyle="miter",
        zorder=6,  # behind the names in time: their boxes have a size when they are drawn
    )
    ax.add_patch(arrow)
    return arrow


def _label(ax: Axes, link: DrawnLink, places: Mapping[str, tuple[float, float]], *, crowded: bool) -> None:
    """How much error a link takes away, on its arrow; in which layers, where there is room."""
    start, end = (np.array(places[name]) for name in link.pair)
    way = end - start
    bent = 0.5 * (start + end) + _BEND * np.array([way[1], -way[0]])
    share = _SHARE_OF_MANY if crowded else 0.5
    x, y = (1 - share) ** 2 * start + 2 * share * (1 - share) * bent + share**2 * end
    words = percent_words(link.gain)
    if not crowded:
        words += f"\n{layers_words(link.layers)}"
    box: Any = {"boxstyle": "square,pad=0.12", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
    style: Any = {"ha": "center", "va": "center", "fontsize": NUMBER_SIZE, "linespacing": 1.0}
    ax.text(x, y, words, color=LINE_COLOUR, zorder=7, bbox=box, **style)

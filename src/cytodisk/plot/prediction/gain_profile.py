"""Draw how much one signal tells of another by layer, both directions, with what chance gives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from cytodisk.arrays import FloatArray
from cytodisk.number_words import rounded
from cytodisk.plot.correlation.curve_key import LOST_LOOK
from cytodisk.plot.prediction.link_looks import (
    ALPHA,
    BACK_COLOUR,
    NOT_COUNTED,
    THERE_COLOUR,
    arrow_words,
    lost_in,
    of_pair,
    pairs_in,
    percent,
    rows_of,
)

LEAST_PERCENT = 0.1
"""Smaller gains are drawn there."""

_COLUMNS = {"gain"}
_LOOKS = ((THERE_COLOUR, "o"), (BACK_COLOUR, "s"))
_SIDE = 0.06  # of the step between layers, by which the two directions are moved apart
PARTIAL_LOOK: Any = {"marker": "_", "markersize": 6.0, "markeredgewidth": 1.0, "linewidth": 0}
_BAND = 0.12  # opacity of what chance gives
_MOST_TICKS = 12


def draw_gain_profile(
    ax: Axes,
    links: pd.DataFrame,
    *,
    cell: int = 0,
    pairs: Sequence[tuple[str, str]] | None = None,
    depths: xr.DataArray | None = None,
    top: float | None = None,
) -> list[Line2D]:
    """Draw by how many percent a source makes the error of predicting a target smaller, by layer.

    Parameters
    ----------
    ax : Axes
    links : DataFrame
        `links` of a study's prediction: cell, source, target, layer and gain; threshold, q, gain_partial,
        geometry and weaker where they are known.
    cell : int
    pairs : sequence of (source, target), optional
        Two at most; by default the first two of the table, which are both directions of one pair.
    depths : DataArray with the dim layer, optional
        As `activity["depth"]`: the median over all other dims is written below each layer.
    top : float, optional
        Where the axis ends, in percent.

    Returns
    -------
    list of Line2D
        One a pair. A mark is full where q < 0.05, open where it is not, a cross where it does not count, as
        geometry or noise of measurement alone may have made it. The band below the dotted line is where 95 %
        of shifted sources lie. A bar from a full mark ends where the gain stands without geometry.

    Raises
    ------
    ParameterError
        The table lacks columns, the cell or a pair.

    See Also
    --------
    gain_key : Says what lines and marks are.
    draw_network : All signals of a cell.

    Notes
    -----
    The axis is logarithmic, as links differ by orders of magnitude. Gains below 0.1 % are drawn there.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> series = cd.simulate.predicting_series("white", 0, 80, 2, 6)
    >>> found = cd.predict(series["source"], series["target"], surrogates=39)
    >>> table = found[["gain", "threshold", "q"]].to_dataframe().reset_index()
    >>> figure, ax = plt.subplots()
    >>> lines = cd.plot.draw_gain_profile(ax, table.assign(cell=0, source="Rac1", target="velocity"))
    """
    rows = rows_of(links, cell, _COLUMNS, "links")
    chosen = list(pairs_in(rows) if pairs is None else pairs)[: len(_LOOKS)]
    layers = np.unique(rows["layer"].to_numpy())
    lines = []
    for place, (pair, (colour, mark)) in enumerate(zip(chosen, _LOOKS, strict=False)):
        side = (place - 0.5 * (len(chosen) - 1)) * 2.0 * _SIDE
        lines.append(_draw_pair(ax, of_pair(rows, pair), side, colour, mark))
    _axes(ax, layers, depths, top)
    return lines


def gain_key(
    pairs: Sequence[tuple[str, str]],
    *,
    names: Mapping[str, str] | None = None,
    chance: bool = True,
    partial: str = "",
    lost: bool = False,
) -> list[Any]:
    """Handles of a legend for `draw_gain_profile`.

    Parameters
    ----------
    pairs : sequence of (source, target)
        Two at most, as they were drawn.
    names : mapping of str to str, optional
        What signals are called.
    chance : bool
        Whether shifted sources were made.
    partial : str
        What the bars are, such as "without geometry"; empty for none.
    lost : bool
        Whether there are links that do not count.

    Returns
    -------
    list of Artist

    See Also
    --------
    draw_gain_profile : Draws them.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> legend = figure.legend(handles=cd.plot.gain_key([("Rac1", "velocity"), ("velocity", "Rac1")]))
    """
    handles: list[Any] = [
        Line2D([], [], color=colour, marker=mark, markersize=3.5, label=arrow_words(pair, names))
        for pair, (colour, mark) in zip(pairs, _LOOKS, strict=False)
    ]
    grey: Any = {"color": "0.35", "linewidth": 0}
    if chance:
        look: Any = {"marker": "o", "markersize": 3.5, "markerfacecolor": "white"}
        handles.append(Line2D([], [], label="open: q ≥ 0.05", **grey, **look))
        handles.append(Patch(facecolor="0.5", alpha=2 * _BAND, label="95 % of chance"))
    if partial:
        handles.append(Line2D([], [], color="0.35", label=partial, **PARTIAL_LOOK))
    if lost:
        handles.append(Line2D([], [], label=NOT_COUNTED, **grey, **LOST_LOOK))
    return handles


def _draw_pair(ax: Axes, rows: pd.DataFrame, side: float, colour: str, mark: str) -> Line2D:
    places = rows["layer"].to_numpy(dtype=np.float64) + side
    gain = _shown(rows["gain"])
    if "threshold" in rows and rows["threshold"].notna().any():
        edge = _shown(rows["threshold"])
        ax.fill_between(places, 0.5 * LEAST_PERCENT, edge, color=colour, alpha=_BAND, linewidth=0)
        ax.plot(places, edge, color=colour, linewidth=0.5, linestyle=(0, (1.5, 1.2)))
    (line,) = ax.plot(places, gain, color=colour, linewidth=1.0)
    lost = lost_in(rows).to_numpy()
    sure = (rows["q"] < ALPHA).to_numpy() if "q" in rows else np.zeros(len(rows), dtype=bool)
    if "gain_partial" in rows and rows.loc[sure, "gain_partial"].notna().any():
        _draw_partial(ax, places[sure], gain[sure], _shown(rows.loc[sure, "gain_partial"]), colour)
    full: Any = {"marker": mark, "markersize": 3.8, "markerfacecolor": colour}
    for which, look in (
        (sure & ~lost, full),
        (~sure, full | {"markerfacecolor": "white"}),
        (sure & lost, LOST_LOOK),
    ):
        if which.any():
            ax.plot(places[which], gain[which], color=colour, linewidth=0, zorder=4, clip_on=False, **look)
    return line


def _draw_partial(ax: Axes, places: FloatArray, gain: FloatArray, partial: FloatArray, colour: str) -> None:
    """From each significant mark to where the gain stands without geometry."""
    ax.vlines(places, gain, partial, color=colour, linewidth=0.7)
    ax.plot(places, partial, color=colour, **PARTIAL_LOOK)


def _shown(gain: Any) -> FloatArray:
    return np.maximum(percent(gain), LEAST_PERCENT)


def _axes(ax: Axes, layers: Any, depths: xr.DataArray | None, top: float | None) -> None:
    ax.set_yscale("log")
    drawn = np.concatenate([np.asarray(line.get_ydata(), dtype=np.float64) for line in ax.lines])
    most = min(1.6 * float(np.nanmax(drawn, initial=1.0)), 100.0) if top is None else top
    ax.set_ylim(LEAST_PERCENT, most)
    ax.yaxis.set_major_locator(LogLocator(10.0))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.tick_params(which="minor", width=0.4, length=1.2)
    ax.set_ylabel("less error (%)")
    ticks = layers[:: -(-len(layers) // _MOST_TICKS)]
    words, label = [f"{layer:g}" for layer in ticks], "layer (0: edge)"
    if depths is not None:
        medians = depths.median([str(dim) for dim in depths.dims if dim != "layer"])
        deep = [rounded(float(medians.sel(layer=layer)), 2) for layer in ticks]
        words = [f"{word}\n{depth}" for word, depth in zip(words, deep, strict=True)]
        label = f"layer (0: edge), and its median depth ({depths.attrs.get('units', 'px')})"
    ax.set_xticks(ticks, words)
    ax.set_xlim(layers.min() - 0.4, layers.max() + 0.4)
    ax.set_xlabel(label)

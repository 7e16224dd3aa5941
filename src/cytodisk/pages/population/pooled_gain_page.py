"""The figure of pooled predictions: gain by layer of each link, with what is beyond chance."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from cytodisk.pages.drawn_correlation import VELOCITY_NAMES
from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.pooled_figure import save_pooled
from cytodisk.pages.population.pooled_heading import pooled_heading
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.correlation.curve_key import PARTIAL_LOOK
from cytodisk.plot.population.condition_looks import condition_colours
from cytodisk.plot.population.condition_profiles import condition_key, draw_condition_profiles
from cytodisk.plot.style import LINE_COLOUR, SINGLE_COLUMN_MM, WIDE_MM
from cytodisk.population.significance import LEVEL
from cytodisk.runs.channel_names import shortened, shown_name
from cytodisk.runs.population.predictions.gain_words import predicts
from cytodisk.store.populations.pooled_prediction import PooledPrediction

FIGURE = "gains"
MOST_LINKS = 12
"""Links that have a panel, those with the largest gain first; the tables have all."""

_LEFT, _GAP, _TALL, _STEP, _LINE = 15.5, 3.0, 28.0, 41.0, 3.6  # mm
_DOT_STEP = 0.07  # of the axis, from condition to condition
_BEYOND, _PARTIAL = "beyond chance", "partial"
_LONGEST = 18


def write_pooled_gains(pooled: PooledPrediction, *, formats: Sequence[str] = ("png",)) -> list[Path]:
    """Draw the pooled gains into the folder `figures` of the prediction.

    Parameters
    ----------
    pooled : PooledPrediction
        As of `run_batch_predict`.
    formats : sequence of {"png", "pdf", "svg"}

    Returns
    -------
    list of Path

    Raises
    ------
    ParameterError
        A format is unknown.
    StudyError
        The folder cannot be written.

    See Also
    --------
    write_pooled_waves : Waves of a batch.

    Examples
    --------
    >>> import cytodisk as cd
    >>> pooled = cd.open_pooled_prediction("all", "Rac1", "velocity")  # doctest: +SKIP
    >>> cd.pages.write_pooled_gains(pooled)  # doctest: +SKIP
    """
    return save_pooled(pooled.path, FIGURE, lambda: gain_page(pooled), formats)


def gain_page(pooled: PooledPrediction) -> Sheet:
    """Gain beyond chance by layer, a panel a link: experiments, and the mean of each condition.

    Parameters
    ----------
    pooled : PooledPrediction

    Returns
    -------
    Sheet
        Two panels abreast on 85 mm, three on 119 mm where there are more than four links. Dots at the top
        mark layers in which the source predicts the target, hollow ones those in which noise of measurement
        alone may make it seem so.
    """
    links = shown_links(pooled.pooled)
    columns = 2 if len(links) <= 4 else 3
    width = SINGLE_COLUMN_MM if columns == 2 else WIDE_MM
    heading = pooled_heading(_title(pooled), pooled.cells, pooled.conditions, width)
    key = _key(pooled)
    first = heading.height_mm + _LINE * ((len(key) + 1) // 2) + 6.0
    rows = -(-len(links) // columns)
    known = pooled.pooled[["source", "target"]].drop_duplicates().shape[0]
    high = first + rows * _STEP - 2.0
    sheet = Sheet(high + _LINE * (known > len(links)), width)
    heading.write(sheet)
    if known > len(links):
        words = f"{len(links)} of {known} links, with the largest gains; pooled.parquet has all"
        sheet.text(LEFT_MM, high + 1.0, words, color="0.3")
    panel = (width - _GAP) / columns - _LEFT
    limits = _limits(pooled, links)
    for number, link in enumerate(links):
        row, column = divmod(number, columns)
        left = column * (panel + _LEFT) + _LEFT
        ax = sheet.axes(left, first + row * _STEP, panel - 1.0, _TALL)
        _draw_link(ax, pooled, link)
        ax.set_ylim(*limits)
        _draw_beyond(ax, pooled, link)
        ax.set_title(_link_words(link), loc="left", y=1.0, pad=2.5, parse_math=False)
        if column:
            ax.set_ylabel("")
    sheet.key(LEFT_MM, heading.height_mm - 1.0, key, 2, borderaxespad=0.0, handlelength=1.6)
    return sheet


def shown_links(pooled: pd.DataFrame) -> list[tuple[str, str]]:
    """Links that have a panel, in the order of the table."""
    raw = pooled[pooled["kind"] == "raw"]
    largest = raw.groupby(["source", "target"], sort=False)["gain_excess"].max()
    kept = set(largest.sort_values(ascending=False, kind="stable").index[:MOST_LINKS])
    return [(str(source), str(target)) for source, target in largest.index if (source, target) in kept]


def _title(pooled: PooledPrediction) -> str:
    if not pooled.source:
        return "Which signal predicts which"
    return f"Prediction: {_name(pooled.source)} and {_name(pooled.target)}"


def _name(name: str) -> str:
    return VELOCITY_NAMES.get(name) or shown_name(name, _LONGEST)


def _link_words(link: tuple[str, str]) -> str:
    return f"{_name(link[0])} → {_name(link[1])}"


def _draw_link(ax: Axes, pooled: PooledPrediction, link: tuple[str, str]) -> None:
    """Profiles of one link."""
    own = _of(pooled.experiments, link)
    order = {name: place for place, name in enumerate(pooled.conditions)}
    rows = own[own["kind"] == "raw"].rename(columns={"gain_excess": "value"})
    rows = rows.sort_values("condition", key=lambda names: names.map(order), kind="stable")
    ax.axhline(0.0, color="0.6", linewidth=0.4, zorder=0.5)
    draw_condition_profiles(ax, rows, label="gain beyond chance (nat)")
    for words in list(ax.texts):  # of the ends, for which small panels have no room: the axis says it
        words.remove()
    means = _of(pooled.pooled, link)
    layers = sorted(means["layer"].unique())
    place = {layer: len(layers) - 0.5 - k for k, layer in enumerate(layers)}
    for name, colour in condition_colours(list(pooled.conditions)).items():
        one = means[means["condition"] == name].sort_values("layer")
        partial = one[one["kind"] == "partial"]
        if len(partial):
            (line,) = ax.plot(
                partial["layer"].map(place), partial["gain_excess"], color=colour, **PARTIAL_LOOK
            )
            line.set_gid(_PARTIAL)


def _draw_beyond(ax: Axes, pooled: PooledPrediction, link: tuple[str, str]) -> None:
    """Dots at the top, over the layers in which the source predicts the target."""
    raw = _of(pooled.pooled[pooled.pooled["kind"] == "raw"], link)
    layers = sorted(raw["layer"].unique())
    place = {layer: len(layers) - 0.5 - k for k, layer in enumerate(layers)}
    low, high = ax.get_ylim()
    for row, (name, colour) in enumerate(condition_colours(list(pooled.conditions)).items()):
        own = raw[(raw["condition"] == name) & predicts(raw)]
        height = high - (0.04 + _DOT_STEP * row) * (high - low)
        for weaker, some in own.groupby("weaker"):
            x = some["layer"].map(place).to_numpy()
            (dots,) = ax.plot(x, np.full(len(some), height), color=colour, **_dot_look(bool(weaker)))
            dots.set(gid=_BEYOND, zorder=4.0)


def _dot_look(weaker: bool) -> dict[str, Any]:
    """Dots of layers beyond chance; hollow where noise of measurement alone may make them."""
    return {
        "marker": "o",
        "markersize": 2.2,
        "markeredgewidth": 0.6,
        "linewidth": 0,
        "fillstyle": "none" if weaker else "full",
    }


def _of(table: pd.DataFrame, link: tuple[str, str]) -> pd.DataFrame:
    return table[(table["source"] == link[0]) & (table["target"] == link[1])]


def _limits(pooled: PooledPrediction, links: Sequence[tuple[str, str]]) -> tuple[float, float]:
    """One axis for all panels, so that both directions can be compared."""
    raw = pooled.experiments[pooled.experiments["kind"] == "raw"]
    means = pooled.pooled[pooled.pooled["kind"] == "raw"]
    shown = pd.concat([_of(raw, link)["gain_excess"] for link in links])
    ends = pd.concat([_of(means, link)[end] for link in links for end in ("gain_excess", "low", "high")])
    low, high = min(shown.min(), ends.min(), 0.0), max(shown.max(), ends.max(), 0.0)
    room = high - low or 1.0
    top = 0.08 + _DOT_STEP * len(pooled.conditions)  # where dots stand
    return float(low - 0.08 * room), float(high + top * room)


def _key(pooled: PooledPrediction) -> list[Any]:
    colours = condition_colours(list(pooled.conditions))
    lines = [
        Line2D([], [], color=colour, linewidth=1.6, label=shortened(name, _LONGEST))
        for name, colour in colours.items()
    ]
    handles = condition_key(lines)
    raw = pooled.pooled[pooled.pooled["kind"] == "raw"]
    if len(raw) < len(pooled.pooled):
        handles.append(Line2D([], [], color=LINE_COLOUR, label="without geometry", **PARTIAL_LOOK))
    words = {False: f"beyond chance (p ≤ {LEVEL:g})", True: "the same, but may be noise"}
    for weaker in sorted(raw.loc[predicts(raw), "weaker"].unique()):
        look = _dot_look(bool(weaker))
        handles.append(Line2D([], [], color=LINE_COLOUR, label=words[bool(weaker)], **look))
    return handles

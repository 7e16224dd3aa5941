"""The pages of a cell's prediction: what goes where on paper."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.prediction.drawn_prediction import DrawnPrediction
from cytodisk.pages.sheet import Sheet, broken_lines
from cytodisk.plot.prediction.drawn_links import drawn_links
from cytodisk.plot.prediction.gain_profile import draw_gain_profile, gain_key
from cytodisk.plot.prediction.lag_coefficients import coefficient_reach, draw_lag_coefficients
from cytodisk.plot.prediction.link_layers import draw_link_layers
from cytodisk.plot.prediction.link_looks import (
    ALPHA,
    BACK_COLOUR,
    FAINT_COLOUR,
    LESS_COLOUR,
    MORE_COLOUR,
    THERE_COLOUR,
    arrow_words,
    of_pair,
    percent,
)
from cytodisk.plot.prediction.network_picture import draw_network, network_key
from cytodisk.plot.style import SINGLE_COLUMN_MM

_KEY_STYLE: Any = {"borderaxespad": 0.0, "handlelength": 1.8, "columnspacing": 1.2, "labelspacing": 0.3}
_LINE = 3.6  # mm
_LEFT, _RIGHT = 16.0, 4.0  # mm
_PROFILE, _PROFILE_OF_MANY, _PROFILE_GAP = 36.0, 24.0, 7.0  # mm
_MOST_PROFILES = 6
_PANEL, _PANEL_HEIGHT, _PANEL_GAP = 28.0, 17.0, 10.0  # mm
_PANEL_LETTERS = 21  # that have room above a panel
_STEP, _STEP_WITH_NAMES = 25.0, 29.0  # mm
_MOST_PANELS = 8
_NETWORK, _NETWORK_OF_TWO = 46.0, 22.0  # mm
_ROW = 4.2  # mm, of a link in the table of layers
_NOT_COUNTED = "not counted: geometry, or noise of measurement, may make it"
_NAMES_MM = 41.0


def network_page(one: DrawnPrediction) -> Sheet | None:
    """Who predicts whom, and in which layers; None where nothing was compared with chance."""
    if one.links["q"].isna().all():
        return None
    signals = list(one.prediction.signals)
    heading = one.heading(SINGLE_COLUMN_MM, "which signal predicts which")
    high = _NETWORK if len(signals) > 2 else _NETWORK_OF_TWO
    key = network_key(doubtful=one.lost)
    top = heading.height_mm + high + 2.0
    rows, layers = one.links[["source", "target"]].drop_duplicates().shape[0], one.links["layer"].nunique()
    room = SINGLE_COLUMN_MM - _NAMES_MM - _RIGHT
    step = min(_ROW, room / layers)
    below = top + rows * step + 10.5
    notes = [
        "number at an arrow, size of a square: how much smaller the",
        "squared error is with the source's past (full square: 30 %)",
    ]
    if not drawn_links(one.links, cell=one.cell):
        notes = ["No signal predicts another beyond chance."]
    notes += [_NOT_COUNTED] * one.lost
    first_note = below + _LINE * -(-len(key) // 2) + 2.5
    sheet = Sheet(first_note + _LINE * len(notes) - 1.5, SINGLE_COLUMN_MM)
    heading.write(sheet)
    ax = sheet.axes(LEFT_MM, heading.height_mm - 2.0, SINGLE_COLUMN_MM - 2 * LEFT_MM, high)
    draw_network(ax, one.links, signals, cell=one.cell, names=one.names)
    table = sheet.axes(_NAMES_MM, top, layers * step, rows * step)
    draw_link_layers(table, one.links, cell=one.cell, names=one.names)
    sheet.key(LEFT_MM, below, key, 2, **_KEY_STYLE)
    for number, words in enumerate(notes):
        sheet.text(LEFT_MM, first_note + _LINE * number, words, color="0.3")
    return sheet


def profile_page(one: DrawnPrediction) -> Sheet:
    """How much error is taken away in each layer, both directions, pair by pair."""
    pairs = _strongest_pairs(one)
    several = len(one.pairs) > 1
    names = one.names
    what = "who predicts whom, by layer" if several else f"{arrow_words(pairs[0][0], names)}, and back"
    heading = one.heading(SINGLE_COLUMN_MM, what)
    named = (("first", "second"), ("second", "first")) if several else pairs[0]
    chance = bool(one.links["threshold"].notna().any())
    key = gain_key(named, names=names, chance=chance, partial=one.partial_words, lost=one.lost)
    first = heading.height_mm + _LINE * (-(-len(key) // 2) + one.lost) + 2.0 + 3.0 * several
    high, gap = (_PROFILE, 0.0) if not several else (_PROFILE_OF_MANY, _PROFILE_GAP)
    step = high + gap
    fewer = len(one.pairs) > len(pairs)
    below = first + step * len(pairs) - gap + 12.5
    sheet = Sheet(below + _LINE * fewer, SINGLE_COLUMN_MM)
    most = percent(one.links[["gain", "threshold", "gain_partial"]])
    top = min(1.6 * float(np.nanmax(most, initial=1.0)), 100.0)
    heading.write(sheet)
    sheet.key(LEFT_MM, heading.height_mm - 2.0, key, 2, **_KEY_STYLE)
    if one.lost:
        sheet.text(LEFT_MM, heading.height_mm + _LINE * -(-len(key) // 2) + 0.5, _NOT_COUNTED, color="0.3")
    if fewer:
        sheet.text(LEFT_MM, below + 1.0, _left_out(len(pairs), len(one.pairs), "pairs"), color="0.3")
    for number, both in enumerate(pairs):
        ax = sheet.axes(_LEFT, first + number * step, SINGLE_COLUMN_MM - _LEFT - _RIGHT, high)
        depths = one.movie.depths if both == pairs[-1] else None
        draw_gain_profile(ax, one.links, cell=one.cell, pairs=both, depths=depths, top=top)
        if both != pairs[-1]:
            ax.tick_params(labelbottom=False)
            ax.set_xlabel("")
        if several:
            words = f"first: {names[both[0][0]]}, second: {names[both[0][1]]}"
            ax.set_title(words, loc="left", y=1.0, pad=3.0, parse_math=False)
    return sheet


def lags_page(one: DrawnPrediction) -> Sheet | None:
    """Coefficients of the source's past by lag; None where no model has one."""
    lags = one.rows(one.prediction.lags)
    panels = _panels(one)
    if lags.empty or not panels:
        return None
    heading = one.heading(SINGLE_COLUMN_MM, "which past of the source counts")
    names = {pair: _panel_title(arrow_words(pair, one.names)) for pair, _, _ in panels}
    broken = _LINE * any("\n" in words for words in names.values())
    several = len(one.pairs) > 1
    first = heading.height_mm + 4.0 + broken
    rows, step = -(-len(panels) // 2), _STEP_WITH_NAMES + broken if several else _STEP
    foot = "coefficients for series of standard deviation 1, with 95 % intervals; open: q ≥ 0.05"
    notes = broken_lines(foot.split(" "), " ", SINGLE_COLUMN_MM - 2 * LEFT_MM)
    links = len(drawn_links(one.links, cell=one.cell))
    if len(one.pairs) > 1 and links > len(panels):
        notes.append(_left_out(len(panels), links, "links"))
    below = first + rows * step + 5.5
    sheet = Sheet(below + _LINE * len(notes) - 1.0, SINGLE_COLUMN_MM)
    heading.write(sheet)
    for number, (pair, layer, colour) in enumerate(panels):
        row, column = divmod(number, 2)
        left = _LEFT + column * (_PANEL + _PANEL_GAP)
        ax = sheet.axes(left, first + row * step, _PANEL, _PANEL_HEIGHT)
        own = lags[(lags["source"] == pair[0]) & (lags["target"] == pair[1])]
        title = one.layer_name(layer)
        if number < 2 or several:
            title = f"{names[pair]}\n{title}"
        ax.set_title(title, loc="left", y=1.0, pad=2.0, parse_math=False, linespacing=1.05)
        if own.empty:
            ax.set_axis_off()
            ax.text(0.5, 0.5, "no past of the source", ha="center", transform=ax.transAxes)
            continue
        look: Any = {"cell": one.cell, "colour": colour, "reach": coefficient_reach(own)}
        draw_lag_coefficients(ax, lags, pair, layer, sure=_is_sure(one.links, pair, layer), **look)
        if row < rows - 1:
            ax.set_xlabel("")
        if column == 0:
            ax.set_ylabel("coefficient")
    for number, words in enumerate(notes):
        sheet.text(LEFT_MM, below + _LINE * number, words, color="0.3")
    return sheet


def _panels(one: DrawnPrediction) -> list[tuple[tuple[str, str], int, str]]:
    """Source and target, layer and colour of each panel: of a pair both directions beside each other."""
    if len(one.pairs) == 1:
        (there, back) = one.pairs[0]
        sides = ((there, THERE_COLOUR), (back, BACK_COLOUR))
        return [(pair, layer, colour) for layer in one.shown_layers for pair, colour in sides]
    links = drawn_links(one.links, cell=one.cell)
    strongest = sorted(links, key=lambda link: (link.doubtful, -link.gain))[:_MOST_PANELS]
    found = []
    for link in (link for link in links if link in strongest):
        rows = of_pair(one.links, link.pair)
        best = rows[rows["layer"].isin(link.layers)].sort_values("gain")["layer"].iloc[-1]
        colour = MORE_COLOUR if link.effect > 0 else LESS_COLOUR
        found.append((link.pair, int(best), FAINT_COLOUR if link.doubtful else colour))
    return found


def _strongest_pairs(one: DrawnPrediction) -> list[tuple[tuple[str, str], tuple[str, str]]]:
    """Pairs that have a profile, in the order of the table: those with the largest gain."""
    gains = one.links.groupby(["source", "target"])["gain"].max().fillna(-np.inf).to_dict()
    largest = {both: max(gains.get(pair, -np.inf) for pair in both) for both in one.pairs}
    kept = sorted(one.pairs, key=lambda both: -largest[both])[:_MOST_PROFILES]
    return [both for both in one.pairs if both in kept]


def _left_out(shown: int, known: int, what: str) -> str:
    return f"{shown} of {known} {what}, with the largest gains; links.parquet has all"


def _panel_title(words: str) -> str:
    """Source and target in two lines where one is wider than a panel."""
    return words if len(words) <= _PANEL_LETTERS else words.replace(" → ", "\n→ ", 1)


def _is_sure(links: pd.DataFrame, pair: tuple[str, str], layer: int) -> bool:
    rows = of_pair(links, pair)
    return bool((rows.loc[rows["layer"] == layer, "q"] < ALPHA).any())

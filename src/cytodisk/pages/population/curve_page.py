"""Page of curves over lags, such as the signal around events, by layer and condition."""

from __future__ import annotations

from typing import Any

from matplotlib.lines import Line2D

from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.sheet import Sheet, broken_lines
from cytodisk.plot.layer_looks import cytoplasm_layers_of, layer_word, shown_layers
from cytodisk.plot.population.condition_profiles import condition_key
from cytodisk.plot.population.difference_map import ALPHA, corrected_column
from cytodisk.plot.population.experiment_lines import fit_to_lines
from cytodisk.plot.population.mean_curves import draw_mean_curves
from cytodisk.plot.style import LINE_COLOUR, SINGLE_COLUMN_MM

_LEFT, _RIGHT, _TALL, _TITLE, _GAP, _BELOW, _LINE = 15.5, 5.0, 22.0, 4.5, 2.0, 9.0, 3.6  # mm
_KEY_STYLE: Any = {"handlelength": 1.6, "labelspacing": 0.35, "columnspacing": 1.2}
_EVENTS = "around_events"
_MOST_BAND = 1.0  # of the range of the means, that bands may reach beyond it


def curves_page(one: DrawnPopulation, channel: str) -> Sheet:
    """Mean curves of conditions by layer, with their intervals, and lags at which they differ."""
    atlas = one.study.atlas_arrays.sel(channel=channel)
    found = {name: one.study.window_arrays(name).sel(channel=channel) for name in one.compared}
    p_names = {name: corrected_column(windows) for name, windows in found.items()}
    differs = {name: found[name][p] <= ALPHA for name, p in p_names.items() if p in found[name]}
    any_differs = any(bool(one_of.any()) for one_of in differs.values())
    layers = shown_layers(atlas.sizes["layer"], cytoplasm_layers_of(atlas["mean"]))
    title = f"{one.channel_words(channel)} by condition"
    if one.study.parameters.get("summary") == _EVENTS:
        title = f"{one.channel_words(channel)} around onsets of protrusion"
    heading = one.heading(SINGLE_COLUMN_MM, title)
    room = SINGLE_COLUMN_MM - 2 * LEFT_MM
    told = [one.comparison_words(name) for name in one.compared]
    if differs and not any_differs:
        told.append(f"no lag with p ≤ {ALPHA:g} ({one.correction})")
    lines = [line for words in told for line in broken_lines(words.split(" "), " ", room)]
    key_rows = -(-(len(one.conditions) + int(one.repeated) + int(any_differs)) // 2)
    first = heading.height_mm + 4.0 * key_rows + 1.0
    step = _TITLE + _TALL + _GAP
    foot = first + len(layers) * step + _BELOW
    sheet = Sheet(foot + _LINE * len(lines) + 1.0, SINGLE_COLUMN_MM)
    heading.write(sheet)
    axes = []
    for number, layer in enumerate(layers):
        top = first + number * step + _TITLE
        ax = sheet.axes(_LEFT, top, SINGLE_COLUMN_MM - _LEFT - _RIGHT, _TALL)
        of_layer = {name: marks.sel(layer=layer).to_numpy() for name, marks in differs.items()}
        drawn = draw_mean_curves(ax, atlas.sel(layer=layer, condition=one.conditions), of_layer)
        ax.set_title(layer_word(layer, atlas.sizes["layer"]), loc="left", pad=2.0)
        ax.set_ylabel("")
        axes.append(ax)
    fit_to_lines(axes, _MOST_BAND)
    for ax in axes:
        ax.tick_params(labelbottom=ax is axes[-1])
    middle = first + 0.5 * (foot - first - _BELOW)
    label = {"rotation": 90, "ha": "left", "va": "center"}
    sheet.text(2.0, middle, one.value_label(channel), **label)
    axes[-1].set_xlabel(lag_label(one))
    key = [handle for handle in condition_key(drawn, experiments=one.repeated) if _is_drawn(handle)]
    if any_differs:
        words = f"differs, p ≤ {ALPHA:g} ({one.correction})"
        key.append(Line2D([], [], color=LINE_COLOUR, marker=".", markersize=3.0, linewidth=0, label=words))
    sheet.key(LEFT_MM, heading.height_mm - 2.0, key, 2, borderaxespad=0.0, **_KEY_STYLE)
    for number, words in enumerate(lines):
        sheet.text(LEFT_MM, foot + _LINE * number + 1.5, words, color="0.3")
    return sheet


def _is_drawn(handle: Any) -> bool:
    """Lines of single experiments are not."""
    return str(handle.get_label()) != "one experiment"


def lag_label(one: DrawnPopulation) -> str:
    """What runs along the curves, with its unit."""
    unit = one.lag_unit or "frames"
    words = "time after the onset" if one.study.parameters.get("summary") == _EVENTS else "lag"
    return f"{words} ({unit})"

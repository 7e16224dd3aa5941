"""Pages of scalars: SuperPlots of the most important ones, and the effect sizes of all."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.ticker import MaxNLocator

from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.drawn_population import DrawnPopulation, in_two_lines
from cytodisk.pages.sheet import Sheet, broken_lines
from cytodisk.plot.population.condition_looks import condition_colours
from cytodisk.plot.population.difference_map import corrected_column
from cytodisk.plot.population.effect_sizes import draw_effect_sizes
from cytodisk.plot.population.experiment_key import experiment_key
from cytodisk.plot.population.super_plot import draw_super_plot
from cytodisk.plot.style import SINGLE_COLUMN_MM, WIDE_MM
from cytodisk.plot.time_axis import TICK_STEPS
from cytodisk.plot.units import with_unit

MOST_PANELS = 6
MOST_ROWS = 44

_MOST_ABREAST, _FEWEST_ROWS, _AXIS = 2, 14, 13.0  # conditions, scalars, mm below a panel of effect sizes

_LEFT, _STEP, _LEAST, _GAP, _TALL, _ABOVE, _BELOW = 12.5, 16.0, 26.0, 3.0, 29.0, 9.5, 9.0  # mm
_ABOVE_BARE = 4.0  # mm, where no test is written above
_NAMES, _ROW, _P_ROOM, _LINE = 40.0, 3.7, 9.0, 3.6  # mm
LAYER = re.compile(r"layer_\d+_")
_KEY_STYLE: Any = {"handlelength": 1.4, "labelspacing": 0.35, "columnspacing": 1.2}
_WORDS = {
    "mean": "mean of {}",
    "edge_to_centre": "edge to centre of {}",
    "nucleus_to_cytoplasm": "nucleus to cytoplasm of {}",
    "polarity": "polarity of {}",
}


def scalars_page(one: DrawnPopulation) -> Sheet | None:
    """SuperPlots of the scalars that differ most; None where there is no scalar."""
    names = chosen_scalars(one)
    if not names:
        return None
    count = len(one.conditions)
    panel = max(_LEAST, _STEP * count + 4.0)
    columns, width = 2, SINGLE_COLUMN_MM
    if columns * (panel + _LEFT) + 2 * _GAP > width:
        width = WIDE_MM
        columns = max(1, int((width - 2 * _GAP) / (panel + _LEFT)))
    columns = min(columns, max(len(names), 2))
    panel = (width - 2 * _GAP) / columns - _LEFT
    cells = one.used
    key = experiment_key(cells, one.conditions, paired=one.paired)
    shown, last = key[:-2], key[-2:]
    longest = max((len(str(handle.get_label())) for handle in shown), default=0)
    abreast = max(1, int((width - 2 * LEFT_MM) / (1.4 * longest + 8.3)))
    key_height = _LINE * (-(-len(shown) // abreast) + 1) + 3.0
    heading = one.heading(width, "Scalars, cell by cell", *_notes(one, names))
    rows = -(-len(names) // columns)
    above = _ABOVE + (3.2 if count > 2 else 0.0) if one.has_tested_scalars else _ABOVE_BARE
    first = heading.height_mm + key_height
    sheet = Sheet(first + rows * (above + _TALL + _BELOW), width)
    heading.write(sheet)
    if shown:
        along_rows = [one for column in range(abreast) for one in shown[column::abreast]]
        sheet.key(LEFT_MM, heading.height_mm - 2.0, along_rows, abreast, borderaxespad=0.0, **_KEY_STYLE)
    below = heading.height_mm - 2.0 + _LINE * -(-len(shown) // abreast) + 0.4
    sheet.key(LEFT_MM, below, last, 2, borderaxespad=0.0, **_KEY_STYLE)
    for number, name in enumerate(names):
        row, column = divmod(number, columns)
        left = _GAP + column * (panel + _LEFT) + _LEFT - 1.0
        ax = sheet.axes(left, first + row * (above + _TALL + _BELOW) + above, panel - 1.0, _TALL)
        tests = _tests_of(one, name)
        label = scalar_label(one, name)
        draw_super_plot(
            ax, cells, name, conditions=one.conditions, tests=tests, label=label, paired=one.paired
        )
        shown_names = [in_two_lines(words, (panel - 1.0) / count) for words in one.conditions]
        ax.set_xticks(range(count), shown_names, parse_math=False)
    return sheet


def effects_page(one: DrawnPopulation) -> Sheet | None:
    """Effect sizes of all scalars, a column for each condition; None where nothing was compared."""
    scalars = one.study.scalars
    known = scalars[np.isfinite(scalars["effect_size"].to_numpy(dtype=np.float64))]
    treated = [name for name in one.compared if (known["condition"] == name).any()]
    if not treated:
        return None
    blocks = -(-len(treated) // _MOST_ABREAST)
    largest = known.assign(size=known["effect_size"].abs()).groupby("scalar", sort=False)["size"].max()
    order = list(largest.index)
    most = max(MOST_ROWS // blocks, _FEWEST_ROWS)
    if len(order) > most:
        kept = set(largest.sort_values(ascending=False, kind="stable").index[:most])
        order = [name for name in order if name in kept]
    note = "" if len(order) == len(largest) else f"{len(order)} of {len(largest)}, the largest effect sizes"
    abreast = min(len(treated), _MOST_ABREAST)
    width = SINGLE_COLUMN_MM if abreast == 1 else WIDE_MM
    panel = (width - _NAMES - abreast * _P_ROOM - 2.0) / abreast
    heading = one.heading(width, "Effect sizes of scalars", *([note] if note else []))
    lines = [
        line
        for name in treated
        for line in broken_lines(one.comparison_words(name).split(" "), " ", width - 2 * LEFT_MM)
    ]
    meaning = f"filled: p ≤ 0.05; on the right: p, corrected for all scalars ({one.correction})"
    lines += broken_lines(meaning.split(" "), " ", width - 2 * LEFT_MM)
    titles = [in_two_lines(f"{name} − {one.study.control}", panel + _P_ROOM) for name in treated]
    above = 3.5 + _LINE * any("\n" in title for title in titles)
    tall = _ROW * len(order) + 2.0
    foot = heading.height_mm + blocks * (above + tall + _AXIS)
    sheet = Sheet(foot + _LINE * len(lines), width)
    heading.write(sheet)
    colours = condition_colours(one.conditions)
    for number, name in enumerate(treated):
        row, column = divmod(number, abreast)
        own = known[known["condition"] == name].set_index("scalar").reindex(order).reset_index()
        own["scalar"] = [scalar_words(one, scalar) for scalar in order]
        top = heading.height_mm + row * (above + tall + _AXIS) + above
        ax = sheet.axes(_NAMES + column * (panel + _P_ROOM), top, panel, tall)
        draw_effect_sizes(ax, own, color=colours[name])
        ax.set_title(titles[number], parse_math=False)
        ax.tick_params(labelleft=column == 0)
        ax.xaxis.set_major_locator(MaxNLocator(4, steps=TICK_STEPS, symmetric=True))
        ax.set_xlabel("effect size (Hedges g)")
    for number, words in enumerate(lines):
        sheet.text(LEFT_MM, foot + _LINE * number, words, color="0.3")
    return sheet


def chosen_scalars(one: DrawnPopulation) -> list[str]:
    """Scalars with a SuperPlot: those with the smallest p, then the largest effects, in the table's order.

    Where nothing was tested, those whose conditions are farthest apart. Layers have a page of their own.
    """
    names = [name for name in one.study.scalar_names if name in one.used and not LAYER.match(name)]
    names = [name for name in names if one.used[name].notna().any()]
    found = one.study.scalars
    if not one.has_tested_scalars:
        sizes = {name: _apart(one, name) for name in names}
        largest = sorted(names, key=lambda name: -sizes[name])[:MOST_PANELS]
        return [name for name in names if name in largest]
    known = found.assign(least=found[corrected_column(found)], size=-found["effect_size"].abs())
    by_scalar = known.groupby("scalar")[["least", "size"]].min()
    ranked = by_scalar.reindex(names).fillna({"least": 1.0, "size": 0.0})
    order = ranked.sort_values(["least", "size"], kind="stable").index[:MOST_PANELS]
    return [name for name in names if name in set(order)]


def _apart(one: DrawnPopulation, name: str) -> float:
    """Largest distance between means of cells of two conditions, in standard deviations of cells."""
    cells = one.used[["condition", name]].assign(value=pd.to_numeric(one.used[name], errors="coerce"))
    groups = cells.groupby("condition", observed=True)["value"]
    spread = float(np.sqrt(groups.var().mean()))
    return float(np.ptp(groups.mean().dropna())) / spread if spread > 0.0 and groups.ngroups > 1 else 0.0


def scalar_words(one: DrawnPopulation, name: str) -> str:
    """A scalar in words, as "polarity of Rac1"."""
    for channel in sorted(one.channels, key=len, reverse=True):
        if name.endswith(f"_{channel}"):
            kind, shown = name.removesuffix(f"_{channel}"), one.channel_words(channel)
            if kind.startswith("layer_"):
                return f"layer {kind.removeprefix('layer_')} of {shown}"
            return _WORDS.get(kind, kind.replace("_", " ") + " of {}").format(shown)
    return name.replace("_", " ")


def scalar_label(one: DrawnPopulation, name: str) -> str:
    """A scalar in words with its unit."""
    units: dict[str, str] = one.study.cells.attrs.get("units", {})
    return with_unit(scalar_words(one, name), units.get(name, ""))


def _tests_of(one: DrawnPopulation, name: str) -> pd.DataFrame | None:
    if not one.has_tested_scalars:
        return None
    rows = one.study.scalars
    own = rows[rows["scalar"] == name]
    return None if own.empty else own.assign(p=own[corrected_column(own)])


def _notes(one: DrawnPopulation, names: list[str]) -> list[str]:
    notes = []
    everyone = [name for name in one.study.scalar_names if not LAYER.match(name)]
    if len(names) < len(everyone):
        how = "smallest p" if one.has_tested_scalars else "conditions farthest apart"
        notes.append(f"{len(names)} of {len(everyone)} scalars: {how}")
    if one.has_tested_scalars:
        notes.append(f"p corrected for all scalars ({one.correction})")
        notes.append("g: Hedges g with its 95 % interval")
    return notes

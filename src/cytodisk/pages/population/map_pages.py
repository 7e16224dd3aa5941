"""Pages of the windows of conditions and of their differences, on the disk and on a representative cell."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.drawn_population import CHARACTER_MM, DrawnPopulation
from cytodisk.pages.sheet import Sheet, broken_lines
from cytodisk.plot.population.difference_map import DifferenceMap
from cytodisk.plot.population.population_maps import difference_key, draw_atlas, draw_difference
from cytodisk.plot.style import (
    DIVERGING_COLOURS,
    SIGNAL_COLOURS,
    SINGLE_COLUMN_MM,
    WIDE_MM,
    colour_bar,
    nice_length,
    signal_limits,
)
from cytodisk.runs.channel_names import shortened
from cytodisk.windows.polar_windows import CellWindows, PolarGrid

_MOST_ABREAST = 4  # conditions of a row
_WIDEST = 42.0  # mm, of a disk with its numbers
_TALLEST = 1.35  # of a cell, height over width
_TITLE, _BELOW, _BAR, _BAR_BELOW, _LINE = 6.5, 11.5, 2.2, 9.5, 3.6  # mm
_UNKNOWN = 3.2  # mm, of the third line below a condition: experiments unknown
_GAP = 3.0
_KEY_STYLE: Any = {"handlelength": 1.6, "labelspacing": 0.35, "columnspacing": 1.2}


def atlas_page(one: DrawnPopulation, channel: str) -> Sheet:
    """The mean of each condition on the disk, and what differs from the control."""
    title = f"{one.channel_words(channel)} by condition"
    return _maps_page(one, channel, one.grid, title, [one.sources.note])


def cell_atlas_page(one: DrawnPopulation, channel: str) -> Sheet | None:
    """The same carried onto the cell with the most usual shape; None where no map was kept."""
    row = one.sources.representative
    if row is None:
        return None
    windows = one.sources.windows(row)
    if windows.grid.layers != one.grid.layers:
        return None  # the edge alone, such as its velocity, has no windows inside a cell
    title = f"{one.channel_words(channel)} by condition, carried onto a cell"
    notes = [f"the cell with the most usual shape: {one.sources.name(row)}"]
    return _maps_page(one, channel, windows, title, notes, first=one.sources.shift(row))


def _maps_page(
    one: DrawnPopulation,
    channel: str,
    on: PolarGrid | CellWindows,
    title: str,
    notes: Sequence[str],
    first: int = 0,
) -> Sheet:
    names = one.conditions
    rows = [names[first_of : first_of + _MOST_ABREAST] for first_of in range(0, len(names), _MOST_ABREAST)]
    found = {name: one.difference(name, channel) for name in one.compared}
    abreast = max(map(len, rows))
    beside = len(rows) == 1 and abreast == 2 and len(found) == 1
    places = abreast + int(beside)
    width = SINGLE_COLUMN_MM if places <= 3 else WIDE_MM
    panel = min((width - 2 * LEFT_MM - (places - 1) * _GAP) / places, _WIDEST)
    height = panel * _share(on)
    heading = one.heading(width, title, *(note for note in notes if note))
    keys = _KeyLines(one, found, width)
    row_height = _TITLE + height + _BELOW + (0.0 if one.are_known else _UNKNOWN)
    blocks = len(rows) * (1 if beside else 1 + bool(found))
    bars = _BAR + _BAR_BELOW
    top = heading.height_mm
    foot = top + blocks * row_height + bars
    sheet = Sheet(foot + keys.height_mm + 2.0, width)
    heading.write(sheet)
    page = _Maps(one, sheet, channel, on, first, panel, height)
    limits = _limits(one, one.atlas(channel)["mean"].sel(condition=one.conditions))
    for number, names in enumerate(rows):
        page.conditions(names, top + number * row_height * (1 if beside else 1 + bool(found)), limits)
    at = [(2, top)] if beside else []
    if not beside:
        for number, names in enumerate(rows):
            below = top + (2 * number + 1) * row_height
            at += [(column, below) for column, name in enumerate(names) if name in found]
    page.differences(found, at)
    page.bars(top + blocks * row_height, beside, bool(found))
    keys.write(sheet, foot)
    return sheet


class _Maps:
    """Panels of a page, at even steps from its left border."""

    def __init__(
        self,
        one: DrawnPopulation,
        sheet: Sheet,
        channel: str,
        on: PolarGrid | CellWindows,
        first: int,
        panel: float,
        height: float,
    ) -> None:
        self.one, self.sheet, self.channel, self.on, self.first = one, sheet, channel, on, first
        self.panel, self.height = panel, height
        self.mean: Any = None
        self.change: Any = None
        self.extend = "neither"

    def _axes(self, column: int, top: float) -> Axes:
        left = LEFT_MM + column * (self.panel + _GAP)
        return self.sheet.axes(left, top + _TITLE, self.panel, self.height)

    def _fitted(self, name: str) -> str:
        """A name in one line or two, with its middle left out where it is longer than both."""
        room = max(int((self.panel + _GAP) / CHARACTER_MM), 8)
        first, between, last = name.rpartition(" − ")
        if len(name) <= room or not between:
            return shortened(name, room)
        return f"{shortened(first, room)}\n{shortened(f'− {last}', room)}"

    def conditions(self, names: Sequence[str], top: float, limits: tuple[float, float]) -> None:
        axes = [self._axes(column, top) for column in range(len(names))]
        atlas = self.one.atlas(self.channel).sel(condition=list(names))
        colours = DIVERGING_COLOURS if self.one.is_signed else SIGNAL_COLOURS
        drawn = draw_atlas(axes, atlas, self.on, cmap=colours, limits=limits, first=self.first)
        for ax in axes:
            ax.set_title(self._fitted(ax.get_title()), parse_math=False)
        self.mean = drawn[0]

    def differences(self, found: dict[str, DifferenceMap], at: Sequence[tuple[int, float]]) -> None:
        limit = max((one.limit for one in found.values()), default=1.0)
        for (name, shown), (column, top) in zip(found.items(), at, strict=True):
            ax = self._axes(column, top)
            self.change = draw_difference(ax, shown, self.on, limit=limit, first=self.first)
            ax.set_title(self._fitted(f"{name} − {self.one.study.control}"), parse_math=False)
            self.extend = "both" if shown.cut_off != "neither" else self.extend

    def bars(self, top: float, beside: bool, compared: bool) -> None:
        """A bar below the conditions, and one below the differences, or both beside each other."""
        label = self.one.value_label(self.channel)
        unit = self.one.unit
        change = f"difference ({unit})" if unit not in ("", "1") else "difference"
        step = self.panel + _GAP
        if beside:
            lefts = (LEFT_MM + 0.15 * step, LEFT_MM + 2 * step + 0.06 * step)
            wide = (1.7 * step, 0.8 * step)
        else:
            room = self.sheet.width_mm - 2 * LEFT_MM
            lefts, wide = (LEFT_MM + 2.0, LEFT_MM + 0.54 * room), (0.4 * room, 0.4 * room)
        bar = self.sheet.axes(lefts[0], top, wide[0], _BAR)
        colour_bar(self.mean, bar, label, extend="both", upright=False)
        if compared:
            bar = self.sheet.axes(lefts[1], top, wide[1], _BAR)
            drawn = colour_bar(self.change, bar, change, extend=self.extend, upright=False)
            end = nice_length(self.change.get_clim()[1])
            drawn.set_ticks([-end, 0.0, end], labels=[f"−{end:g}", "0", f"{end:g}"])


class _KeyLines:
    """How conditions were compared, and what lines and hatch mean, below the panels."""

    def __init__(self, one: DrawnPopulation, found: dict[str, DifferenceMap], width: float) -> None:
        room = width - 2 * LEFT_MM
        self.lines: list[str] = []
        for name in found:
            words = one.comparison_words(name)
            if found[name].tested.any() and not found[name].is_different:
                words += f"; no window and no cluster with p ≤ {found[name].alpha:g}"
            self.lines += broken_lines(words.split(" "), " ", room)
        self.handles = _shared_key(list(found.values()))
        self.columns = 1 if width < WIDE_MM else 2
        self.rows = -(-len(self.handles) // self.columns)

    @property
    def height_mm(self) -> float:
        return _LINE * len(self.lines) + 4.2 * self.rows

    def write(self, sheet: Sheet, top: float) -> None:
        for number, words in enumerate(self.lines):
            sheet.text(LEFT_MM, top + _LINE * number + 2.4, words, color="0.3")
        if self.handles:
            below = top + _LINE * len(self.lines)
            sheet.key(LEFT_MM, below, self.handles, self.columns, borderaxespad=0.4, **_KEY_STYLE)


def _shared_key(found: Sequence[DifferenceMap]) -> list[Any]:
    """Handles of all differences, each look once; the counts are told where there is one difference."""
    if len(found) == 1:
        return difference_key(found[0])
    handles: dict[str, Any] = {}
    for one in found:
        for handle in difference_key(one):
            words = str(handle.get_label()).split(":")[0]
            handle.set_label(words)
            handles.setdefault(words, handle)
    return list(handles.values())


def _limits(one: DrawnPopulation, values: Any) -> tuple[float, float]:
    """Ends of the colours of conditions, with 0 in their middle where values lie on both sides of it."""
    low, high = signal_limits(values)
    end = max(abs(low), abs(high))
    return (-end, end) if one.is_signed else (low, high)


def _share(on: PolarGrid | CellWindows) -> float:
    """Height over width of a panel."""
    if not isinstance(on, CellWindows):
        return 1.0
    high, wide = np.ptp(on.disk.outline_yx, axis=0).tolist()
    return float(np.clip(high / wide, 0.6, _TALLEST))

"""Page of cells: the nearest to the mean of each condition, and the farthest from it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from cytodisk.arrays import AnyArray, FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import CytodiskError
from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.population.cell_gallery import draw_gallery, draw_window_gallery
from cytodisk.plot.style import WIDE_MM, colour_bar
from cytodisk.runs.channel_names import shortened
from cytodisk.windows.polar_windows import CellWindows

PLACES = ("nearest", "farthest")

_GAP, _TITLE, _BELOW, _SIDE, _BAR = 1.5, 8.0, 5.5, 9.0, 15.0  # mm
_CHARACTER, _BOLD = 1.28, 1.6  # mm, of names
_WIDEST, _BETWEEN = 24.0, 3.0  # mm, of a cell, and between conditions


@dataclass(frozen=True)
class _Shown:
    row: int
    name: str
    windows: CellWindows
    values: FloatArray
    image: AnyArray | None
    disk: DiskMap


def gallery_page(one: DrawnPopulation, channel: str) -> Sheet | None:
    """Cells of each condition with their signal, or window means without images; None without maps."""
    table = one.study.gallery
    table = table[table["channel"] == channel]
    found = {
        (condition, place): _shown(one, table, condition, place, channel)
        for condition in one.conditions
        for place in PLACES
    }
    cells = [cell for row in found.values() for cell in row]
    if not cells:
        return None
    images = all(cell.image is not None for cell in cells)
    columns = max(len(row) for row in found.values())
    room = WIDE_MM - LEFT_MM - _SIDE - _BAR - (columns - 1) * _GAP
    size = min(room / columns, _WIDEST)
    notes = [] if images else [f"means of windows: {one.sources.image_fault or 'images are not there'}"]
    words = (
        f"{one.channel_words(channel)}: cells nearest to the mean of their condition, and farthest from it"
    )
    heading = one.heading(WIDE_MM, words, *notes)
    step = _TITLE + size + 3.5
    block = len(PLACES) * step + _BETWEEN
    sheet = Sheet(heading.height_mm + len(one.conditions) * block + _BELOW)
    heading.write(sheet)
    axes: list[Axes] = []
    for number, condition in enumerate(one.conditions):
        first = heading.height_mm + number * block
        name = shortened(condition, int((block - _TITLE) / _BOLD))
        side: Any = {"rotation": 90, "ha": "left", "va": "center"}
        sheet.text(LEFT_MM, first + 0.5 * (block + _TITLE) - 3.0, name, weight="bold", **side)
        for row, place in enumerate(PLACES):
            top = first + row * step + _TITLE
            sheet.text(LEFT_MM + 4.0, top + 0.5 * size, place, **side)
            lefts = [
                LEFT_MM + _SIDE + column * (size + _GAP) for column in range(len(found[condition, place]))
            ]
            axes += [sheet.axes(left, top, size, size) for left in lefts]
    drawn = _draw(axes, cells, images)
    ending = common_ending([cell.name.rpartition(", ")[0] for cell in cells])
    for ax, cell in zip(axes, cells, strict=True):
        ax.set_title(
            _two_lines(cell.name, ending, int(size / _CHARACTER)),
            pad=2.0,
            linespacing=1.0,
            parse_math=False,
        )
    left = LEFT_MM + _SIDE + columns * (size + _GAP) + 1.0
    bar = sheet.axes(left, heading.height_mm + _TITLE, 2.2, min(size * 1.2, 26.0))
    label = one.value_label(channel)
    if images:
        label = f"{one.channel_words(channel)} ({'× cell mean' if one.is_by_cell else 'a.u.'})"
    colour_bar(drawn, bar, label, extend="both")
    return sheet


def _draw(axes: list[Axes], cells: list[_Shown], images: bool) -> Any:
    if images:
        return draw_gallery(axes, [cell.disk for cell in cells], [cell.image for cell in cells])[0]
    windows, values = [cell.windows for cell in cells], [cell.values for cell in cells]
    return draw_window_gallery(axes, windows, values)[0]


def _shown(
    one: DrawnPopulation, table: pd.DataFrame, condition: str, place: str, channel: str
) -> list[_Shown]:
    own = table[(table["condition"] == condition) & (table["place"] == place)]
    shown = []
    for _, cell in own.sort_values("rank", kind="stable").groupby("rank", sort=False):
        row = int(cell["row"].iloc[0])
        try:
            windows = one.sources.windows(row)
        except CytodiskError:
            continue  # the page tells how many are shown by showing them
        values = np.full(windows.areas.shape, np.nan)
        values[cell["layer"].to_numpy(), cell["sector"].to_numpy()] = cell["value"].to_numpy(dtype=np.float64)
        values = np.roll(values, one.sources.shift(row), axis=1)
        disk, image = one.sources.image(row, channel, windows.disk)
        if image is not None and one.is_by_cell:
            image = _by_its_mean(image, disk)
        shown.append(_Shown(row, one.sources.name(row), windows, values, image, disk))
    return shown


def _by_its_mean(image: AnyArray, disk: DiskMap) -> FloatArray:
    """The image over its mean in the cell; nothing of a cell whose mean is not above 0."""
    placed, values = disk.placed_mask, image.astype(np.float64)
    mean = float(np.nanmean(values[placed.slices][placed.box]))
    return values / (mean if mean > 0 else np.nan)


def _two_lines(name: str, ending: str, longest: int) -> str:
    """Name of a cell in two lines: file, without what all have at its end, and which cell of it."""
    first, _, last = name.rpartition(", ")
    first = first.removesuffix(ending)
    return f"{shortened(first, longest)}\n{last}" if first else shortened(last, longest)


def common_ending(names: Sequence[str]) -> str:
    """How all names end, from a sign between words on, as "_cp_masks.tif"; at least a letter stays."""
    least = min(map(len, names), default=0)
    same = (len({name[-length:] for name in names}) == 1 for length in range(1, least))
    length = sum(takewhile(bool, same))
    shared = names[0][len(names[0]) - length :] if length else ""
    found = re.search(r"[\W_].*", shared)
    return found[0] if found else ""

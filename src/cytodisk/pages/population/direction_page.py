"""Page of directions of cells by condition."""

from __future__ import annotations

import numpy as np

from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.drawn_population import DrawnPopulation, in_two_lines
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.population.condition_looks import condition_colours
from cytodisk.plot.population.directions import FEWEST_IN_ROSE, MOST_DOTS, draw_directions
from cytodisk.plot.style import SINGLE_COLUMN_MM, WIDE_MM
from cytodisk.runs.population.cells_of_study import BRIGHTEST_SIDE

_MAPPED, _AXIS = "disk_direction_", "axis"  # an axis has two ends: it is no direction
_MOST_ABREAST = 5
_WIDEST, _TITLE, _LINE, _BELOW, _SIDE, _GAP = 36.0, 5.0, 3.2, 14.0, 8.0, 6.0  # mm


def directions_page(one: DrawnPopulation) -> Sheet | None:
    """Roses of the brightest sides of channels, or of directions; None where no cell has one."""
    kinds = [name for name in _columns(one) if np.isfinite(one.used[name].to_numpy(dtype=np.float64)).any()]
    if not kinds:
        return None
    names = one.conditions
    blocks = [names[first : first + _MOST_ABREAST] for first in range(0, len(names), _MOST_ABREAST)]
    abreast = max(map(len, blocks))
    width = SINGLE_COLUMN_MM if abreast <= 2 else WIDE_MM
    panel = min((width - 2 * LEFT_MM - _SIDE - (abreast - 1) * _GAP) / abreast, _WIDEST)
    counts = one.used["condition"].value_counts()
    notes = ["a dot: a cell"] if int(counts.min()) <= MOST_DOTS else []
    notes += ["area of a wedge: share of the cells"] if int(counts.max()) >= FEWEST_IN_ROSE else []
    notes += ["arrow: resultant of an experiment (thin), mean (thick)", "1 at the rim"]
    of_signal = not kinds[0].startswith(_MAPPED)
    title = (
        "Where around the cell the signal is brightest" if of_signal else "Directions of cells in the disk"
    )
    heading = one.heading(width, title, *notes)
    titles = {name: in_two_lines(name, panel + _GAP) for name in names}
    above = _TITLE + _LINE * any("\n" in title for title in titles.values())
    step = above + panel + _BELOW
    sheet = Sheet(heading.height_mm + len(kinds) * len(blocks) * step, width)
    heading.write(sheet)
    colours = condition_colours(names)
    places = [(kind, block) for kind in kinds for block in blocks]
    for number, (kind, block) in enumerate(places):
        top = heading.height_mm + number * step + above
        words = _words(one, kind)
        sheet.text(LEFT_MM, top + 0.5 * panel, words, rotation=90, ha="left", va="center")
        for column, name in enumerate(block):
            left = LEFT_MM + _SIDE + column * (panel + _GAP)
            ax = sheet.axes(left, top, panel, panel)
            own = one.used[one.used["condition"] == name]
            draw_directions(
                ax, own[kind].to_numpy(np.float64), experiments=own["experiment"], color=colours[name]
            )
            ax.set_title(titles[name], parse_math=False)
    return sheet


def _columns(one: DrawnPopulation) -> list[str]:
    """The signal's directions after the alignment, or what the maps tell of the cells."""
    of_signal = [BRIGHTEST_SIDE.format(channel) for channel in one.drawn_channels]
    found = [name for name in of_signal if name in one.used]
    mapped = [str(name) for name in one.used if str(name).startswith(_MAPPED)]
    return found or [name for name in mapped if name != f"{_MAPPED}{_AXIS}"]


def _words(one: DrawnPopulation, kind: str) -> str:
    for channel in one.channels:
        if kind == BRIGHTEST_SIDE.format(channel):
            return f"brightest side of {one.channel_words(channel)}"
    return kind.removeprefix(_MAPPED).replace("_", " ")

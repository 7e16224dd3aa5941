"""Page of directions of cells by condition."""

from __future__ import annotations

import numpy as np

from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.population.condition_looks import condition_colours
from cytodisk.plot.population.directions import draw_directions
from cytodisk.plot.style import DOUBLE_COLUMN_MM, SINGLE_COLUMN_MM

DIRECTION_OF = "polarity_direction_"
_MAPPED = "disk_direction_"
_MOST_ABREAST, _WIDEST, _TITLE, _BELOW, _SIDE, _GAP = 5, 36.0, 5.0, 11.0, 8.0, 3.5  # mm but for the first


def directions_page(one: DrawnPopulation) -> Sheet | None:
    """Roses of the directions of cells, a row for each kind; None where no cell has a direction."""
    kinds = [name for name in _columns(one) if np.isfinite(one.used[name].to_numpy(dtype=np.float64)).any()]
    if not kinds:
        return None
    names = one.conditions
    blocks = [names[first : first + _MOST_ABREAST] for first in range(0, len(names), _MOST_ABREAST)]
    abreast = max(map(len, blocks))
    width = SINGLE_COLUMN_MM if abreast <= 2 else DOUBLE_COLUMN_MM
    panel = min((width - 2 * LEFT_MM - _SIDE - (abreast - 1) * _GAP) / abreast, _WIDEST)
    notes = ["a dot: a cell", "arrow: resultant of an experiment (thin), mean (thick)", "1 at the rim"]
    heading = one.heading(width, "Directions of cells in the disk", *notes)
    step = _TITLE + panel + _BELOW
    sheet = Sheet(heading.height_mm + len(kinds) * len(blocks) * step, width)
    heading.write(sheet)
    colours = condition_colours(names)
    places = [(kind, block) for kind in kinds for block in blocks]
    for number, (kind, block) in enumerate(places):
        top = heading.height_mm + number * step + _TITLE
        words = _words(one, kind)
        sheet.text(LEFT_MM, top + 0.5 * panel, words, rotation=90, ha="left", va="center")
        for column, name in enumerate(block):
            left = LEFT_MM + _SIDE + column * (panel + _GAP)
            ax = sheet.axes(left, top, panel, panel)
            own = one.used[one.used["condition"] == name]
            draw_directions(
                ax, own[kind].to_numpy(np.float64), experiments=own["experiment"], color=colours[name]
            )
            ax.set_title(name, parse_math=False)
    return sheet


def _columns(one: DrawnPopulation) -> list[str]:
    """The signal's directions after the alignment, or what the maps tell of the cells."""
    of_signal = [f"{DIRECTION_OF}{channel}" for channel in one.channels]
    found = [name for name in of_signal if name in one.used]
    return found or [str(name) for name in one.used if str(name).startswith(_MAPPED)]


def _words(one: DrawnPopulation, kind: str) -> str:
    if kind.startswith(DIRECTION_OF):
        return f"brightest side of {one.channel_words(kind.removeprefix(DIRECTION_OF))}"
    return kind.removeprefix(_MAPPED).replace("_", " ")

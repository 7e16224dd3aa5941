"""What must hold for every page that is written: all is seen, nothing lies on other text, all can be read."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from unittest.mock import patch

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from cytodisk.plot.style import SINGLE_COLUMN_MM

SMALLEST_PT = 5.0
"""Least size of text when the page is as wide as a column of print."""

_TOUCHING = 0.18  # of a line's height: room above and below letters, which may be shared
_UNIT = re.compile(r"\((?:px|µm|s|min|h|frames?|a\.u\.|%|µm²|px²|µm/s|µm/min|px/frame)\)")


@dataclass(frozen=True)
class Written:
    """A text that was drawn, and the box that it fills, in points from the lower left corner."""

    words: str
    size: float
    box: Bbox

    def overlaps(self, other: Written) -> bool:
        """Whether letters lie over letters."""
        own, its = self._letters(), other._letters()
        return own.x0 < its.x1 and its.x0 < own.x1 and own.y0 < its.y1 and its.y0 < own.y1

    def _letters(self) -> Bbox:
        spare = _TOUCHING * min(self.box.width, self.box.height)
        spare = min(spare, 0.3 * self.size)
        return Bbox([[self.box.x0 + spare, self.box.y0 + spare], [self.box.x1 - spare, self.box.y1 - spare]])


def written(figure: Figure) -> list[Written]:
    """Every text that is drawn, none that is hidden or lies outside an axis."""
    drawn: list[Text] = []
    draw = Text.draw

    def note(text: Text, renderer: object) -> None:
        if text.get_visible() and text.get_text().strip() and not getattr(renderer, "_raster_depth", 0):
            drawn.append(text)
        draw(text, renderer)  # type: ignore[arg-type]

    with patch.object(Text, "draw", note):
        figure.draw_without_rendering()
    to_points = 72.0 / figure.dpi
    found = []
    for text in dict.fromkeys(drawn):
        box = text.get_window_extent()
        points = Bbox([[box.x0 * to_points, box.y0 * to_points], [box.x1 * to_points, box.y1 * to_points]])
        found.append(Written(text.get_text(), float(text.get_fontsize()), points))
    return found


def faults(figure: Figure) -> list[str]:
    """What is wrong with a page, in words; empty if nothing is."""
    wide, high = (72.0 * size for size in figure.get_size_inches())
    smaller = min(1.0, SINGLE_COLUMN_MM / 25.4 * 72.0 / wide)
    texts = written(figure)
    found = [
        f"{one.words!r} is {one.size * smaller:.1f} pt in one column"
        for one in texts
        if one.size * smaller < SMALLEST_PT - 1e-6
    ]
    found += [f"{one.words!r} leaves the page" for one in texts if not _within(one.box, wide, high)]
    for one, other in combinations(texts, 2):
        if one.overlaps(other):
            found.append(f"{one.words!r} lies on {other.words!r}")
    return found + [f"{label!r} has its unit twice" for label in _labels(figure.axes) if _repeats(label)]


def assert_readable(figures: Sequence[Figure]) -> None:
    """Fail with the faults of all pages."""
    found = [f"page {number}: {fault}" for number, one in enumerate(figures) for fault in faults(one)]
    assert not found, "\n".join(found)


def _within(box: Bbox, wide: float, high: float) -> bool:
    spare = 0.2
    return box.x0 >= -spare and box.y0 >= -spare and box.x1 <= wide + spare and box.y1 <= high + spare


def _labels(axes: Sequence[Axes]) -> list[str]:
    return [label for ax in axes for label in (ax.get_xlabel(), ax.get_ylabel()) if label]


def _repeats(label: str) -> bool:
    units = _UNIT.findall(label)
    return len(units) != len(set(units))

"""A page on which axes and text are placed in millimetres."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Annotation, Text

from cytodisk.files import replacing
from cytodisk.plot.style import DPI, HEADING, MM_PER_INCH, TITLE_SIZE, WIDE_MM

CHARACTER_MM, BOLD_MM = 1.28, 1.9
"""Mean width of a character at 7 points, and bold at 8."""


class Sheet:
    """A figure of known width and height.

    Parameters
    ----------
    height_mm : float
    width_mm : float

    Attributes
    ----------
    figure : Figure
    """

    def __init__(self, height_mm: float, width_mm: float = WIDE_MM) -> None:
        self.height_mm, self.width_mm = height_mm, width_mm
        self.figure = Figure(figsize=(width_mm / MM_PER_INCH, height_mm / MM_PER_INCH))

    def axes(self, left: float, top: float, width: float, height: float) -> Axes:
        """Axes at a place counted from the page's upper left corner, in millimetres."""
        bottom = self.height_mm - top - height
        return self.figure.add_axes(
            (left / self.width_mm, bottom / self.height_mm, width / self.width_mm, height / self.height_mm)
        )

    def text(self, left: float, top: float, words: str, **style: Any) -> Text:
        """Text at a place counted from the page's upper left corner, in millimetres; a dollar sign is one."""
        options: dict[str, Any] = {"va": "baseline", "parse_math": False} | style
        return self.figure.text(left / self.width_mm, 1.0 - top / self.height_mm, words, **options)

    def title(self, left: float, top: float, words: str) -> Text:
        """What a page is of, bold."""
        return self.text(left, top, words, **HEADING)

    def panel_title(self, left: float, top: float, words: str, **style: Any) -> Text:
        """What stands above panels, as titles of axes do."""
        return self.text(left, top, words, fontsize=TITLE_SIZE, **style)

    def key(self, left: float, top: float, handles: list[Any], columns: int, **style: Any) -> Legend:
        """A legend at a place counted from the page's upper left corner, in millimetres."""
        place = left / self.width_mm, 1.0 - top / self.height_mm
        options: dict[str, Any] = {"loc": "upper left", "frameon": False, "borderpad": 0.0, "ncols": columns}
        key = self.figure.legend(handles=handles, bbox_to_anchor=place, **options | style)
        _as_written(key)
        return key

    def save(self, path: Path, dpi: int = DPI, **options: Any) -> Path:
        """Write the page whole or not at all.

        Raises
        ------
        WriteError
            The folder does not exist or cannot be written.
        """
        _as_written(self.figure)
        with replacing(path) as temporary:
            self.figure.savefig(temporary, dpi=dpi, **options)
        return path


def _as_written(artist: Artist) -> None:
    """Words of keys and notes as they are: a name with dollar signs is no formula."""
    keys = [text for key in artist.findobj(Legend) if isinstance(key, Legend) for text in key.get_texts()]
    notes = [text for text in artist.findobj(Annotation) if isinstance(text, Annotation)]
    for text in (*keys, *notes):
        text.set_parse_math(False)


def broken_lines(
    parts: Sequence[str], between: str, room_mm: float, character_mm: float = CHARACTER_MM
) -> list[str]:
    """Parts joined into lines that fit into the room, if the parts themselves do.

    Parameters
    ----------
    parts : sequence of str
    between : str
        Put between parts on a line.
    room_mm, character_mm : float
        Length of a line, and of a character.

    Returns
    -------
    list of str
    """
    lines = [parts[0]]
    for part in parts[1:]:
        if len(lines[-1]) + len(between) + len(part) <= int(room_mm / character_mm):
            lines[-1] += between + part
        else:
            lines.append(part)
    return lines

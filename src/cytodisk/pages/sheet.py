"""A page on which axes and text are placed in millimetres."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text

from cytodisk.files import replacing
from cytodisk.plot.style import DOUBLE_COLUMN_MM, DPI, MM_PER_INCH


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

    def __init__(self, height_mm: float, width_mm: float = DOUBLE_COLUMN_MM) -> None:
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

    def key(self, left: float, top: float, handles: list[Any], columns: int, **style: Any) -> Legend:
        """A legend at a place counted from the page's upper left corner, in millimetres."""
        place = left / self.width_mm, 1.0 - top / self.height_mm
        options: dict[str, Any] = {"loc": "upper left", "frameon": False, "borderpad": 0.0, "ncols": columns}
        return self.figure.legend(handles=handles, bbox_to_anchor=place, **options | style)

    def save(self, path: Path, dpi: int = DPI, **options: Any) -> Path:
        """Write the page whole or not at all.

        Raises
        ------
        WriteError
            The folder does not exist or cannot be written.
        """
        with replacing(path) as temporary:
            self.figure.savefig(temporary, dpi=dpi, **options)
        return path

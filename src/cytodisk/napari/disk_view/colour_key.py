"""`ColourKey`: a colour bar with its name, unit and ends."""

from __future__ import annotations

from typing import Any

import numpy as np
from qtpy.QtCore import QRectF, Qt
from qtpy.QtGui import QColor, QImage, QPainter
from qtpy.QtWidgets import QWidget

from cytodisk.napari.disk_view.disk_pixels import colours_of
from cytodisk.number_words import rounded

_BAR = 8  # pixels high
_STEPS = 256


class ColourKey(QWidget):
    """A colour bar from left to right, its name above it, its ends below it.

    Parameters
    ----------
    parent : QWidget, optional
    """

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.words, self.limits, self.colours = "", (0.0, 1.0), ""
        self.text_colour = QColor("black")

    def set_key(self, words: str, limits: tuple[float, float], colours: str) -> None:
        """Show other colours.

        Parameters
        ----------
        words : str
            With the unit.
        limits : (float, float)
        colours : str
            Name of a colour map.
        """
        if (words, limits, colours) != (self.words, self.limits, self.colours):
            self.words, self.limits, self.colours = words, limits, colours
            self.setFixedHeight(2 * self.fontMetrics().height() + _BAR + 4)
            self.setToolTip(words)
            self.update()

    @property
    def ticks(self) -> list[tuple[float, str]]:
        """Shares of the bar's length, and the numbers below them."""
        low, high = self.limits
        values = [low, 0.0, high] if low == -high else [low, 0.5 * (low + high), high]
        return [(n / 2, rounded(value, 3).replace("-", "−")) for n, value in enumerate(values)]

    def paintEvent(self, event: Any) -> None:
        """Paint it."""
        painter = QPainter(self)
        painter.setPen(self.text_colour)
        metrics, width = self.fontMetrics(), self.width()
        words = metrics.elidedText(self.words, Qt.TextElideMode.ElideRight, width)
        painter.drawText(0, metrics.ascent(), words)
        if self.colours:
            row = colours_of(np.linspace(0.0, 1.0, _STEPS), (0.0, 1.0), self.colours)
            image = QImage(row.tobytes(), _STEPS, 1, 4 * _STEPS, QImage.Format.Format_RGB32)
            painter.drawImage(QRectF(0, metrics.height() + 1, width, _BAR), image)
        top = metrics.height() + _BAR + 2 + metrics.ascent()
        for share, number in self.ticks:
            room = metrics.horizontalAdvance(number)
            painter.drawText(round(share * (width - room)), top, number)
        painter.end()

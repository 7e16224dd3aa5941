"""Parts of a dock that scroll, so that a small window stays as high as it is."""

from __future__ import annotations

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QFrame, QLabel, QScrollArea, QWidget

_FEWEST, _MOST = 2, 7  # lines of words that are seen at once


def scrolled(body: QWidget) -> QScrollArea:
    """An area of a dock's width in which a widget scrolls up and down.

    Parameters
    ----------
    body : QWidget
    """
    area = QScrollArea()
    area.setWidgetResizable(True)
    area.setFrameShape(QFrame.Shape.NoFrame)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setWidget(body)
    return area


class ScrolledWords(QLabel):
    """Words of any length that can be selected.

    Attributes
    ----------
    area : QScrollArea
        In which they scroll; put this one into a layout.
    """

    def __init__(self) -> None:
        super().__init__()
        self.setWordWrap(True)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.area = scrolled(self)
        line = self.fontMetrics().lineSpacing()
        self.area.setMinimumHeight(_FEWEST * line)
        self.area.setMaximumHeight(_MOST * line)

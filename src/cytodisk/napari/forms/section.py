"""A part of a form under a heading, which a click opens and folds."""

from __future__ import annotations

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QSizePolicy, QToolButton, QVBoxLayout, QWidget


class Section(QWidget):
    """A heading with a body below it.

    Parameters
    ----------
    heading : str
    body : QWidget
    is_open : bool
        Whether the body is shown at first.
    """

    def __init__(self, heading: str, body: QWidget, is_open: bool = False):
        super().__init__()
        self.body = body
        self.button = QToolButton()
        self.button.setText(heading)
        self.button.setAccessibleName(heading)
        self.button.setToolButtonStyle(Qt.ToolButtonTextBesideIcon)
        self.button.setSizePolicy(QSizePolicy.Expanding, QSizePolicy.Fixed)
        self.button.setStyleSheet("QToolButton { border: none; text-align: left; padding: 3px; }")
        self.button.setCheckable(True)
        self.button.toggled.connect(self._show)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.button)
        layout.addWidget(body)
        self.button.setChecked(is_open)
        self._show(is_open)

    @property
    def heading(self) -> str:
        """What stands on the button."""
        return str(self.button.text())

    @property
    def is_open(self) -> bool:
        """Whether the body is shown."""
        return bool(self.button.isChecked())

    def open(self) -> None:
        """Show the body."""
        self.button.setChecked(True)

    def _show(self, is_open: bool) -> None:
        self.button.setArrowType(Qt.DownArrow if is_open else Qt.RightArrow)
        self.body.setVisible(is_open)

"""How far work beside the viewer is: a bar, words, and a button that cancels."""

from __future__ import annotations

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QHBoxLayout, QLabel, QProgressBar, QPushButton, QVBoxLayout, QWidget

from cytodisk.runs.told.speed_words import PERCENT


class WorkBar(QWidget):
    """A bar with words below it; nothing of it is seen while there is nothing to say.

    Attributes
    ----------
    cancel_wanted : Signal
        Emitted when the button is clicked.
    """

    cancel_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.bar = QProgressBar()
        self.bar.setTextVisible(False)
        self.bar.setMaximumHeight(14)
        self.cancel_button = QPushButton("Cancel")
        self.cancel_button.clicked.connect(self._cancel)
        self.label = QLabel()
        self.label.setWordWrap(True)
        self.label.setTextFormat(Qt.PlainText)
        row = QHBoxLayout()
        row.addWidget(self.bar, stretch=1)
        row.addWidget(self.cancel_button)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addLayout(row)
        layout.addWidget(self.label)
        self.end("")

    def begin(self, words: str) -> None:
        """Show that work has begun, of which it is not known yet how much there is."""
        self.bar.setRange(0, 0)
        self.bar.setAccessibleDescription(words)
        self.label.setText(words)
        self.cancel_button.setEnabled(True)
        for part in (self.bar, self.cancel_button, self.label):
            part.setVisible(True)

    def show_done(self, done: int, total: int, unit: str, more: str = "") -> None:
        """Show how much is done, as "12 of 200 frames, 40 s left"."""
        if not self.cancel_button.isEnabled():
            return
        self.bar.setRange(0, 1000)
        self.bar.setValue(round(1000 * done / total) if total else 0)
        count = f"{100 * done / total:.0f} %" if unit == PERCENT and total else f"{done} of {total} {unit}"
        self.label.setText(", ".join(filter(None, [count, more])))

    def end(self, words: str) -> None:
        """Hide the bar; words stay."""
        self.bar.hide()
        self.cancel_button.hide()
        self.label.setText(words)
        self.label.setVisible(bool(words))

    def _cancel(self) -> None:
        self.cancel_button.setEnabled(False)
        self.label.setText("Cancelling: the part that is being done ends first.")
        self.cancel_wanted.emit()

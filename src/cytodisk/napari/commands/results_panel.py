"""What came out of a run, in words, and what can be done with it."""

from __future__ import annotations

from collections.abc import Sequence

from qtpy.QtCore import Qt, Signal
from qtpy.QtGui import QGuiApplication
from qtpy.QtWidgets import (
    QGridLayout,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from cytodisk.napari.forms.section import Section

_LINE_HEIGHT = 64


class ResultsPanel(QWidget):
    """Words on results, and buttons: save, report, the same as a command; nothing is seen before a run.

    Attributes
    ----------
    buttons : QWidget
        They stand where the widget puts them, so that they are seen however long the words are.
    save_wanted, report_wanted, next_wanted : Signal
        Emitted when a button is clicked.
    """

    save_wanted = Signal()
    report_wanted = Signal()
    next_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.words.setTextFormat(Qt.PlainText)
        self.words.setAlignment(Qt.AlignTop)
        self.words.setTextInteractionFlags(Qt.TextSelectableByMouse)
        self.words.setMargin(4)
        self.save_button = QPushButton("Save as a study…")
        self.save_button.setToolTip("Keep tables, maps and the layers that they came from in a folder.")
        self.save_button.clicked.connect(self.save_wanted)
        self.report_button = QPushButton("Open report")
        self.report_button.setToolTip("Write the page report.html, and open it in the browser.")
        self.report_button.clicked.connect(self.report_wanted)
        self.next_button = QPushButton("Correlate…")
        self.next_button.setToolTip("Does a signal rise before the edge moves?")
        self.next_button.clicked.connect(self.next_wanted)
        self.next_button.hide()
        self.line = QPlainTextEdit()
        self.line.setReadOnly(True)
        self.line.setMaximumHeight(_LINE_HEIGHT)
        self.line.setAccessibleName("The same as a command")
        self.note = QLabel()
        self.note.setWordWrap(True)
        self.copy_button = QPushButton("Copy")
        self.copy_button.clicked.connect(self._copy)
        self.command = Section("The same as a command", self._command_body())
        self.buttons = QWidget()
        buttons = QGridLayout(self.buttons)
        buttons.setContentsMargins(0, 0, 0, 0)
        buttons.setSpacing(3)
        buttons.addWidget(self.save_button, 0, 0)
        buttons.addWidget(self.report_button, 0, 1)
        buttons.addWidget(self.next_button, 1, 0, 1, 2)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(3)
        layout.addWidget(self.words)
        layout.addWidget(self.command)
        self.hide()
        self.buttons.hide()

    def show_words(self, lines: Sequence[str]) -> None:
        """Show lines in the place of those that were shown."""
        self.words.setText("\n".join(lines))
        self.show()
        self.buttons.show()

    def show_command(self, line: str, note: str = "") -> None:
        """Show what to type, with a note below it."""
        self.line.setPlainText(line)
        self.note.setText(note)
        self.note.setVisible(bool(note))

    def _command_body(self) -> QWidget:
        body = QWidget()
        layout = QVBoxLayout(body)
        layout.setContentsMargins(12, 0, 0, 0)
        layout.setSpacing(3)
        layout.addWidget(self.line)
        layout.addWidget(self.note)
        layout.addWidget(self.copy_button, alignment=Qt.AlignLeft)
        return body

    def _copy(self) -> None:
        QGuiApplication.clipboard().setText(self.line.toPlainText())

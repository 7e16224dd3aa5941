"""`DiskParts`: the widgets of the dock, and what is written in them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

from qtpy.QtCore import QSignalBlocker
from qtpy.QtGui import QColor
from qtpy.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from cytodisk.napari.disk_view.colour_key import ColourKey
from cytodisk.napari.disk_view.disk_choices import DiskChoice
from cytodisk.napari.disk_view.disk_picture import DiskPicture
from cytodisk.napari.disk_view.disk_state import DiskState, KeyWords
from cytodisk.napari.disk_view.pointing import Pointed
from cytodisk.napari.disk_view.time_trace import TimeTrace
from cytodisk.napari.qt_fault import warn_of_qt
from cytodisk.napari.scrolled import scrolled
from cytodisk.plot.cell.sector_marks import SECTOR_NOTE
from cytodisk.plot.layer_looks import layer_word

HINT = "Move the cursor over the cell or over the disk."
UNDER_CURSOR = "under the cursor"

Row = TypeVar("Row")

_LINES = 3  # of words about a window
_SIGNAL_LINE, _VELOCITY_LINE = "#009E73", "#CC79A7"


class DiskParts:
    """The widgets, laid out in a dock.

    Parameters
    ----------
    dock : QWidget
    """

    def __init__(self, dock: QWidget):
        warn_of_qt()
        self.studies, self.cells, self.choices = QComboBox(), QComboBox(), QComboBox()
        self.grid = QCheckBox("window grid")
        self.note = QLabel(SECTOR_NOTE)
        self.picture = DiskPicture()
        self.key, self.ring_key = ColourKey(), ColourKey()
        self.words = QLabel(HINT)
        self.trace = TimeTrace(_SIGNAL_LINE)
        self.velocity_trace = TimeTrace(_VELOCITY_LINE)
        self._form = QFormLayout()
        # by row; as data of Qt's items None would lose a reference each time
        self._studies: list[Any] = []
        self._cells: list[int | None] = []
        self._choices: list[DiskChoice] = []
        self._traced: Any = None
        self._lay_out(dock)
        self.list_cells(None)
        self.list_choices([], None)

    def _lay_out(self, dock: QWidget) -> None:
        for combo, tip in (
            (self.studies, "The study whose disk is shown."),
            (self.cells, "The cell whose disk is shown: the one under the cursor, or always the same."),
            (self.choices, "What the disk is coloured by."),
        ):
            combo.setToolTip(tip)
            combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
            combo.setMinimumContentsLength(8)
        for name, combo in (("study", self.studies), ("cell", self.cells), ("colour", self.choices)):
            self._form.addRow(name, combo)
        self.grid.setChecked(True)
        self.note.setToolTip(
            "Sectors are numbered from here, clockwise in the image. The ring is in the cell, too."
        )
        self.words.setWordWrap(True)
        self.words.setMinimumHeight(_LINES * self.words.fontMetrics().lineSpacing() + 4)
        below = QHBoxLayout()
        below.addWidget(self.grid)
        below.addStretch()
        below.addWidget(self.note)
        inner = QWidget()
        column = QVBoxLayout(inner)
        column.setContentsMargins(6, 6, 6, 6)
        column.addLayout(self._form)
        for part in (
            self.picture,
            below,
            self.key,
            self.ring_key,
            self.words,
            self.trace,
            self.velocity_trace,
        ):
            column.addLayout(part) if part is below else column.addWidget(part)
        column.addStretch()
        outer = QVBoxLayout(dock)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.addWidget(scrolled(inner))
        dock.setMinimumWidth(260)
        dock.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Expanding)

    def set_text_colour(self, colour: QColor) -> None:
        """Take the colour that the viewer's theme has for text."""
        for part in (self.picture, self.key, self.ring_key, self.trace, self.velocity_trace):
            part.text_colour = colour
            part.update()

    def show_grid(self, shown: bool) -> None:
        """Draw the lines between windows, or not."""
        self.picture.with_grid = shown
        self.picture.update()

    # Lists

    @property
    def study(self) -> Any:
        """The study that is chosen; None without one."""
        return _chosen(self._studies, self.studies)

    @property
    def cell(self) -> int | None:
        """The cell that is chosen; None for the one under the cursor."""
        return _chosen(self._cells, self.cells)

    @property
    def choice(self) -> DiskChoice | None:
        """What the disk is coloured by; None without a study."""
        return _chosen(self._choices, self.choices)

    def list_studies(self, studies: Sequence[Any], chosen: Any) -> None:
        """List the open studies; the chosen one stays chosen if it is open."""
        with QSignalBlocker(self.studies):
            self.studies.clear()
            self._studies = list(studies)
            for shown in studies:
                self.studies.addItem(", ".join(filter(None, [shown.study.path.name, shown.source])))
            places = [place for place, shown in enumerate(studies) if shown is chosen]
            self.studies.setCurrentIndex(places[0] if places else len(studies) - 1)
        self._form.setRowVisible(self.studies, len(studies) > 1)

    def list_cells(self, shown: Any) -> None:
        """List the cells of a study."""
        with QSignalBlocker(self.cells):
            self.cells.clear()
            self._cells = []
            if shown is not None:
                numbers = shown.cells.numbers
                self._cells = [*([None] if len(numbers) > 1 else []), *numbers]
                self.cells.addItems(
                    [UNDER_CURSOR if cell is None else f"cell {cell}" for cell in self._cells]
                )
        self._form.setRowVisible(self.cells, self.cells.count() > 1)

    def may_show(self, cell: int) -> bool:
        """Whether the disk of a cell is shown when the cursor is over it."""
        return self.cell in (None, cell)

    def list_choices(self, choices: Sequence[DiskChoice], chosen: DiskChoice | None) -> None:
        """List what the disk can be coloured by."""
        with QSignalBlocker(self.choices):
            self.choices.clear()
            self._choices = list(choices)
            self.choices.addItems([choice.label for choice in choices])
        self._form.setRowVisible(self.choices, len(choices) > 0)
        for part in (self.grid, self.note):
            part.setVisible(len(choices) > 0)
        if chosen in choices:
            self.choose(chosen)

    def choose(self, choice: DiskChoice | None) -> None:
        """Choose what the disk is coloured by, without telling it to others."""
        with QSignalBlocker(self.choices):
            if choice in self._choices:
                self.choices.setCurrentIndex(self._choices.index(choice))

    # What is shown

    def show_keys(self, windows: KeyWords | None, ring: KeyWords | None) -> None:
        """Show the colour bars; one that is None is hidden."""
        for bar, key in ((self.key, windows), (self.ring_key, ring)):
            bar.setVisible(key is not None)
            if key is not None:
                bar.set_key(key.words, key.limits, key.colours)

    def show_cell(self, state: DiskState) -> None:
        """Show the frame in the lines through time."""
        for trace in (self.trace, self.velocity_trace):
            trace.set_now(state.frame)

    def point_at(
        self, state: DiskState | None, pointed: Pointed | None, pinned: tuple[int, int] | None
    ) -> None:
        """Mark in the disk what is pointed at, and what was clicked."""
        if state is None or state.windows is None:
            self.picture.point_at(None, None)
            return
        sectors = state.windows.sectors
        numbers = [
            None if window is None or window[0] >= state.windows.layers else window[0] * sectors + window[1]
            for window in (None if pointed is None else pointed.window, pinned)
        ]
        self.picture.point_at(None if pointed is None else pointed.uv, *numbers)

    def show_window(self, state: DiskState | None, window: tuple[int, int] | None) -> None:
        """Say what a window is, and draw it through time."""
        words = [] if state is None or window is None else state.words(window)
        self.words.setText("\n".join(words) if words else HINT if state is not None else "")
        self._show_traces(state, window)

    def _show_traces(self, state: DiskState | None, window: tuple[int, int] | None) -> None:
        with_time = state is not None and state.numbers.is_movie
        channel = "" if state is None else state.channel
        self.trace.setVisible(with_time and bool(channel))
        self.velocity_trace.setVisible(with_time)
        if state is None or not with_time:
            self._traced = None
            return
        asked = id(state.numbers), channel, window
        if asked == self._traced:
            return
        self._traced = asked
        if window is None:
            self.trace.clear("")
            self.velocity_trace.clear("")
            return
        (layer, sector), numbers, outer = window, state.numbers, state.cytoplasm_layers
        if channel:
            place = f"{layer_word(layer, numbers.grid.layers, outer)}, sector {sector}"
            unit = state.shown.unit(channel)
            values = numbers.mean_through_time(channel, layer, sector)
            self.trace.show_line(
                f"{DiskChoice('mean', (channel,)).label} ({unit}), {place}", numbers.times, values
            )
        velocity = numbers.velocity_through_time(sector)
        title = f"edge velocity ({numbers.speed_unit.name}), sector {sector}"
        self.velocity_trace.show_line(title, numbers.times, velocity, with_zero=True)


def _chosen(rows: Sequence[Row], combo: QComboBox) -> Row | None:
    row = combo.currentIndex()
    return rows[row] if 0 <= row < len(rows) else None

"""The widget "Open results": choose a study's folder, the file of masks, and the channel that is shown."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from qtpy.QtWidgets import (
    QComboBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from cytodisk.errors import CytodiskError
from cytodisk.napari.docks import join_docks
from cytodisk.napari.napari_versions import plain_viewer
from cytodisk.napari.qt_fault import warn_of_qt
from cytodisk.napari.scrolled import scrolled
from cytodisk.napari.study_layers.activity_layers import activity_layers
from cytodisk.napari.study_layers.shown_cells import sources_of
from cytodisk.napari.study_layers.shown_study import ShownStudy, right_of, show_study, shown_studies
from cytodisk.napari.viewer_parts import Layer, show_error
from cytodisk.number_words import counted
from cytodisk.store.study import Study, open_study
from cytodisk.store.study_kind import ACTIVITY

_WIDTH = 260
_MOST_TOLD = 4  # cells without a map


class OpenResults(QWidget):
    """Opens studies, and says what is shown of them.

    Parameters
    ----------
    napari_viewer : Viewer

    Attributes
    ----------
    viewer : Viewer
    """

    def __init__(self, napari_viewer: Any):
        super().__init__()
        warn_of_qt()
        self.viewer = viewer = plain_viewer(napari_viewer)
        self.study: Study | None = None
        self._there: list[ShownStudy] = []
        self._folder, self._source, self._channel = QLineEdit(), QComboBox(), QComboBox()
        self._shown, self._words = QComboBox(), QLabel()
        self._words.setWordWrap(True)
        self._folder.setPlaceholderText("folder of a study, such as out")
        self._folder.editingFinished.connect(self._look)
        self._source.setToolTip("The file of masks whose cells are shown.")
        self._channel.setToolTip("The channel whose means are painted into the windows.")
        self._open, self._activity = QPushButton("Show"), QPushButton("Show over time")
        self._activity.setToolTip("Signal and velocity by sector and frame, as pictures of their own.")
        self._lay_out()
        self._open.clicked.connect(self.show_results)
        self._activity.clicked.connect(self.show_activity)
        self._shown.activated.connect(self._tell)
        self._channel.textActivated.connect(self._choose_channel)
        for event in (viewer.layers.events.inserted, viewer.layers.events.removed):
            event.connect(self._follow)
        self.destroyed.connect(lambda *_: self._let_go())
        self._look()
        self._follow()

    def showEvent(self, event: Any) -> None:
        """Lie behind the other docks of cytodisk, as a tab."""
        super().showEvent(event)
        join_docks(self)

    def _lay_out(self) -> None:
        choose = QPushButton("Choose…")
        choose.clicked.connect(self._choose)
        row = QHBoxLayout()
        row.addWidget(self._folder)
        row.addWidget(choose)
        form = QFormLayout()
        form.addRow("Folder", row)
        form.addRow("File", self._source)
        buttons = QHBoxLayout()
        buttons.addWidget(self._open)
        buttons.addWidget(self._activity)
        form.addRow(buttons)
        form.addRow("Shown", self._shown)
        form.addRow("Channel", self._channel)
        inside = QWidget()
        column = QVBoxLayout(inside)
        column.addLayout(form)
        column.addWidget(self._words)
        column.addStretch()
        self.setMinimumWidth(_WIDTH)
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(scrolled(inside))

    def _choose(self) -> None:
        found = QFileDialog.getExistingDirectory(self, "Folder of a study", self._folder.text())
        if found:
            self.choose_folder(found)

    def choose_folder(self, folder: str) -> None:
        """Take a folder, as if it were typed."""
        self._folder.setText(folder)
        self._look()

    def choose_source(self, name: str) -> None:
        """Choose a file of masks of the study."""
        self._source.setCurrentText(name)

    @property
    def words(self) -> str:
        """What it says of the frame under the slider."""
        return str(self._words.text())

    def _look(self) -> None:
        """Open the study of the folder, and list its files of masks."""
        text = self._folder.text().strip()
        if self.study is None or Path(text) != self.study.path:
            self.study = None
            self._source.clear()
            if text:
                try:
                    self.study = open_study(text)
                    self._source.addItems(sources_of(self.study))
                except CytodiskError as error:
                    show_error(str(error))
        study = self.study
        self._source.setEnabled(study is not None and self._source.count() > 1)
        self._open.setEnabled(study is not None)
        self._activity.setEnabled(study is not None and study.is_movie)

    def show_results(self) -> None:
        """Add the layers of the chosen study."""
        if self.study is None:
            return
        try:
            shown = show_study(self.viewer, self.study, source=self._source.currentText())
        except CytodiskError as error:
            show_error(str(error))
            return
        self._follow()
        if shown in self._there:
            self._shown.setCurrentIndex(self._there.index(shown))
        self._tell()

    def show_activity(self) -> None:
        """Add pictures of the signal over time."""
        if self.study is None:
            return
        try:
            layers = activity_layers(self.study.path / ACTIVITY, left=right_of(self.viewer.layers))
        except CytodiskError as error:
            show_error(str(error))
            return
        for data in layers:
            self.viewer.add_layer(Layer.create(*data))

    @property
    def shown(self) -> ShownStudy | None:
        """The study that is chosen among those in the viewer."""
        row = self._shown.currentIndex()
        return self._there[row] if 0 <= row < len(self._there) else None

    def _follow(self, event: Any = None) -> None:
        """List the studies that are in the viewer."""
        there, before = shown_studies(self.viewer), self.shown
        for one in self._there:
            if one not in there:
                one.changed.disconnect(self._tell, missing_ok=True)
        for one in there:
            if one not in self._there:
                one.changed.connect(self._tell)
        self._there = there
        self._shown.clear()
        self._shown.addItems([", ".join(filter(None, [one.study.path.name, one.source])) for one in there])
        if before in there:
            self._shown.setCurrentIndex(there.index(before))
        self._tell()

    def _let_go(self) -> None:
        for event in (self.viewer.layers.events.inserted, self.viewer.layers.events.removed):
            event.disconnect(self._follow)
        for one in self._there:
            one.changed.disconnect(self._tell, missing_ok=True)

    def _choose_channel(self, name: str) -> None:
        if self.shown is not None:
            self.shown.channel = name

    def _tell(self, *_: Any) -> None:
        """Show the channels of the study, and what is missing in the frame."""
        shown = self.shown
        channels = () if shown is None else shown.channels
        if [self._channel.itemText(k) for k in range(self._channel.count())] != list(channels):
            self._channel.clear()
            self._channel.addItems(list(channels))
        self._channel.setEnabled(len(channels) > 1)
        if shown is not None and channels:
            self._channel.setCurrentText(shown.channel)
        self._words.setText("" if shown is None else frame_words(shown))


def frame_words(shown: ShownStudy) -> str:
    """What is in the frame under the slider, and what is not, with the reason."""
    if not shown.channels:
        signal = "The study has no signal: windows have a place, a depth and an area."
    else:
        signal = ""
    frame = shown.frame
    if not shown.cells.mapped:
        return f"{shown.cells.missing_words}."
    if frame is None:
        return f"There is no frame of the study here. {signal}".strip()
    missing = shown.cells.missing.get(frame, [])
    told = [f"Cell {cell} has no map: {words}." for cell, words in missing[:_MOST_TOLD]]
    if len(missing) > _MOST_TOLD:
        told.append(f"{counted(len(missing) - _MOST_TOLD, 'more cell')} without a map.")
    told += [words for (_, other), words in shown.painted.faults.items() if other == frame]
    count = len(shown.painted.shown(frame))
    cells = f"{counted(count, 'cell')} with windows"
    where = f"Frame {frame}: {cells}." if shown.cells.is_stack else f"{cells}."
    return "\n".join([where, *filter(None, [signal]), *told])

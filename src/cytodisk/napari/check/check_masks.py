"""The widget "Check masks": what is wrong with masks that are open, before anything is mapped."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QFormLayout, QLabel, QLineEdit, QPushButton, QScrollArea, QVBoxLayout, QWidget

from cytodisk.napari.check.checked_layers import CheckedLayers, check_layers, command_words
from cytodisk.napari.check.flag_points import FlagGround, FlagMarks
from cytodisk.napari.check.flag_table import FlagTable
from cytodisk.napari.check.found_flags import FlagPlace
from cytodisk.napari.forms.command_line import command_line
from cytodisk.napari.forms.parameter_form import ParameterForm
from cytodisk.napari.given.chosen_layers import ChosenLayers
from cytodisk.napari.given.layer_axes import time_axis
from cytodisk.napari.given.layer_choice import LayerChoice
from cytodisk.napari.given.layer_kinds import MASKS, NUCLEI, SIGNALS
from cytodisk.napari.napari_versions import plain_viewer
from cytodisk.napari.qt_fault import warn_of_qt
from cytodisk.napari.viewer_parts import show_error
from cytodisk.napari.work.background import Work, run_in_background
from cytodisk.napari.work.work_bar import WorkBar
from cytodisk.runs.cells.cell_parameters import CheckParameters

_NO_FILE = "Some layers have no file of their own: save them (File, Save) to type this in a terminal."


class CheckMasks(QWidget):
    """Look at the masks of a layer; a click on what is wrong leads there.

    Parameters
    ----------
    napari_viewer : Viewer
        Named so that napari passes it.
    """

    def __init__(self, napari_viewer: Any):
        super().__init__()
        warn_of_qt()
        self.viewer = viewer = plain_viewer(napari_viewer)
        self.work: Work | None = None
        self.found: CheckedLayers | None = None
        self.marks: FlagMarks | None = None
        self._folder: Any = TemporaryDirectory(prefix="cytodisk_", ignore_cleanup_errors=True)
        self._runs = 0
        self.masks = LayerChoice(viewer, MASKS)
        self.signal = LayerChoice(viewer, SIGNALS, optional=True)
        self.nuclei = LayerChoice(viewer, NUCLEI, optional=True)
        self.form = ParameterForm(CheckParameters)
        for section in self.form.sections:
            section.button.setChecked(False)
        self.button = QPushButton("Check masks")
        self.button.clicked.connect(self.run)
        self.bar = WorkBar()
        self.table = FlagTable(self._go)
        self.table.show_flags((), "Choose masks, and press Check masks.")
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.command = QLineEdit()
        self.command.setReadOnly(True)
        self.command.setToolTip("The same as a command, to be typed in a terminal")
        self.command.hide()
        self._arrange()
        self.destroyed.connect(lambda *_, folder=self._folder: folder.cleanup())

    def _arrange(self) -> None:
        choices = QFormLayout()
        for name, choice in {"masks": self.masks, "signal": self.signal, "nuclei": self.nuclei}.items():
            choices.addRow(name, choice)
        scroll = QScrollArea()
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QScrollArea.Shape.NoFrame)
        scroll.setWidget(self.form)
        scroll.setMinimumHeight(110)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(2, 2, 2, 2)
        rows.addLayout(choices)
        rows.addWidget(scroll, 1)
        for part in (self.button, self.bar):
            rows.addWidget(part)
        rows.addWidget(self.table, 3)
        for part in (self.words, self.command):
            rows.addWidget(part)

    def run(self) -> None:
        """Look at the chosen masks, in a thread."""
        masks = self.masks.layer
        if masks is None:
            show_error("masks: no layer is chosen: open a label image, or draw labels or shapes")
            return
        chosen = ChosenLayers(masks, self.signal.layers, self.nuclei.layer)
        values, flags = self.form.values(), self.form.flags
        self._runs += 1
        folder = Path(self._folder.name) / str(self._runs)
        ground = FlagGround.of(masks, time_axis(masks))
        self.button.setEnabled(False)

        def show(found: CheckedLayers) -> None:
            self.button.setEnabled(True)
            self.show_found(found, ground)

        self.work = run_in_background(
            self.bar,
            lambda report: check_layers(chosen, folder, values, flags, report),
            done=show,
            failed=lambda: self.button.setEnabled(True),
            unit="cells",
        )

    def show_found(self, found: CheckedLayers, ground: FlagGround) -> None:
        """List what is wrong, and mark it in the viewer, in the place of what was marked before."""
        if self.marks is not None:
            self.marks.remove()
        mark = {"cell": None, "masks": str(found.files.masks)}
        self.marks = FlagMarks(self.viewer, found.flags, ground, mark)
        self.found = found
        self.table.show_flags(found.flags)
        self.words.setText("\n".join([*found.lines, *found.notes]))
        files = found.files
        others = [("--signal", files.signal), ("--nuclei", files.nuclei)]
        self.command.setText(command_line("check", command_words(files, others), found.values))
        self.command.setVisible(not files.written)
        if files.written:
            self.words.setText(self.words.text() + "\n" + _NO_FILE)

    def _go(self, place: FlagPlace) -> bool:
        return self.marks is not None and self.marks.go(place)

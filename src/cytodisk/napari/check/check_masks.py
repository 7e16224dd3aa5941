"""The widget "Check masks": what is wrong with masks that are open, before anything is mapped."""

from __future__ import annotations

from typing import Any

from qtpy.QtWidgets import QFormLayout, QLineEdit, QPushButton, QVBoxLayout, QWidget

from cytodisk.napari.check.checked_layers import CheckedLayers, check_layers, command_words
from cytodisk.napari.check.flag_points import FlagGround, FlagMarks
from cytodisk.napari.check.flag_table import FlagTable
from cytodisk.napari.check.found_flags import FlagPlace
from cytodisk.napari.docks import join_docks
from cytodisk.napari.forms.command_line import command_line
from cytodisk.napari.forms.parameter_form import ParameterForm
from cytodisk.napari.given.chosen_layers import ChosenLayers
from cytodisk.napari.given.layer_axes import time_axis
from cytodisk.napari.given.layer_choice import LayerChoice
from cytodisk.napari.given.layer_kinds import MASKS, NUCLEI, SIGNALS
from cytodisk.napari.napari_versions import plain_viewer
from cytodisk.napari.qt_fault import warn_of_qt
from cytodisk.napari.scrolled import ScrolledWords, scrolled
from cytodisk.napari.viewer_parts import show_error
from cytodisk.napari.work.background import Work, run_in_background
from cytodisk.napari.work.work_bar import WorkBar
from cytodisk.napari.work.work_folder import WorkFolder
from cytodisk.runs.cells.cell_parameters import CheckParameters

_WIDTH = 260
_NO_FILE = (
    "Some layers have no file, so there is no command that does the same: save the layers first "
    "(File, Save Selected Layers…), open what you saved, and check again."
)


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
        self._folder: WorkFolder | None = None
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
        self.words = ScrolledWords()
        self.command = QLineEdit()
        self.command.setReadOnly(True)
        self.command.setToolTip("The same as a command, to be typed in a terminal")
        self.command.hide()
        self.setMinimumWidth(_WIDTH)
        self._arrange()
        self.destroyed.connect(lambda *_: self._let_go())

    def showEvent(self, event: Any) -> None:
        """Lie behind the other docks of cytodisk, as a tab."""
        super().showEvent(event)
        join_docks(self)

    def _let_go(self) -> None:
        for choice in (self.masks, self.signal, self.nuclei):
            choice.close_down()

    def _arrange(self) -> None:
        inside = QWidget()
        column, choices = QVBoxLayout(inside), QFormLayout()
        column.setContentsMargins(0, 0, 0, 0)
        for name, choice in {"masks": self.masks, "signal": self.signal, "nuclei": self.nuclei}.items():
            choices.addRow(name, choice)
        column.addLayout(choices)
        column.addWidget(self.form)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(2, 2, 2, 2)
        rows.addWidget(scrolled(inside), 2)
        for part in (self.button, self.bar):
            rows.addWidget(part)
        rows.addWidget(self.table, 3)
        for part in (self.words.area, self.command):
            rows.addWidget(part)

    def run(self) -> None:
        """Look at the chosen masks, in a thread."""
        masks = self.masks.layer
        if masks is None:
            show_error("masks: no layer is chosen: open a label image, or draw labels or shapes")
            return
        chosen = ChosenLayers(masks, self.signal.layers, self.nuclei.layer)
        values, flags = self.form.values(), self.form.flags
        folder = WorkFolder()
        ground = FlagGround.of(masks, time_axis(masks))
        self.button.setEnabled(False)

        def show(found: CheckedLayers) -> None:
            self.button.setEnabled(True)
            self._folder = folder  # that of the last run goes
            self.show_found(found, ground)

        self.work = run_in_background(
            self.bar,
            lambda report: check_layers(chosen, folder.inputs, values, flags, report),
            done=show,
            failed=lambda: self.button.setEnabled(True),
            unit="cells",
        )

    def show_found(self, found: CheckedLayers, ground: FlagGround) -> None:
        """List what is wrong, and mark it in the viewer, in the place of what was marked before."""
        if self.marks is not None:
            self.marks.remove()
        mark = {"cell": None, "masks": str(found.files.masks)}
        self.marks = FlagMarks(self.viewer, found.flags, ground, mark, name="faults of masks")
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

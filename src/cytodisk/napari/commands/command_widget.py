"""What the widgets that run commands share: what is chosen, a form, a button, progress, results."""

from __future__ import annotations

import webbrowser
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from qtpy.QtWidgets import (
    QCheckBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from cytodisk.napari.commands.made_study import MadeStudy
from cytodisk.napari.commands.open_widgets import layers_of
from cytodisk.napari.commands.results_panel import ResultsPanel
from cytodisk.napari.docks import join_docks, soon
from cytodisk.napari.forms.parameter_form import ParameterForm
from cytodisk.napari.given.layer_kinds import MARK
from cytodisk.napari.napari_versions import plain_viewer
from cytodisk.napari.qt_fault import warn_of_qt
from cytodisk.napari.scrolled import scrolled
from cytodisk.napari.study_layers.shown_study import ShownStudy
from cytodisk.napari.viewer_parts import show_error, show_info
from cytodisk.napari.work.background import Reporter, Work, run_in_background
from cytodisk.napari.work.work_bar import WorkBar
from cytodisk.store.study import Study

NOT_SAVED = "Not saved yet: the results go when you close the viewer."
SAVE_FIRST = "Save as a study first: files of this line go when you close the viewer."

_WIDTH = 260


class CommandWidget(QWidget):
    """A widget that runs a command.

    Parameters
    ----------
    viewer : Viewer
    form : ParameterForm
    run_words : str
        What stands on the button.
    """

    def __init__(self, viewer: Any, form: ParameterForm, run_words: str):
        super().__init__()
        warn_of_qt()
        self.viewer, self.form = plain_viewer(viewer), form
        self.work: Work | None = None
        self.choices = QFormLayout()
        self.choices.setContentsMargins(4, 4, 4, 0)
        self.choices.setFieldGrowthPolicy(QFormLayout.ExpandingFieldsGrow)
        self.run_button = QPushButton(run_words)
        self.run_button.clicked.connect(self.run)
        self.replace_box = QCheckBox("replace last")
        self.replace_box.setToolTip("Remove the layers of the last run. Without it they stay.")
        self.replace_box.setChecked(True)
        self.bar = WorkBar()
        self.results = ResultsPanel()
        self.results.save_wanted.connect(self.ask_where_to_save)
        self.results.report_wanted.connect(self.open_report)
        self._scroll_soon = soon(self, self._scroll)  # once their place is known
        self.setMinimumWidth(_WIDTH)
        self._arrange()

    def showEvent(self, event: Any) -> None:
        """Lie behind the other docks of cytodisk, as a tab."""
        super().showEvent(event)
        join_docks(self)

    def run(self) -> None:
        """Start what the button says."""
        raise TypeError("a widget must say what it runs")

    def shown_result(self) -> Study | None:
        """The study whose report can be opened; None if there is none."""
        raise TypeError("a widget must say which study it shows")

    def savable(self) -> tuple[MadeStudy, ShownStudy | None] | None:
        """The study that can be saved, and its layers; None if there is none."""
        raise TypeError("a widget must say what can be saved")

    def ask_where_to_save(self) -> None:
        """Ask for a folder, and save there."""
        found = self.savable()
        if found is None:
            return
        usual = str(found[0].usual_target)
        path, _ = QFileDialog.getSaveFileName(self, "Save as a study: name of a new folder", usual)
        if path:
            self.save(Path(path))

    def save(self, target: Path) -> None:
        """Save the study in a folder; layers that show it follow."""
        found = self.savable()
        if found is None or found[0].work is None:
            return
        made, shown = found
        work, before = found[0].work, made.study.path

        def save(report: Reporter) -> None:
            report.stage("Saving")
            made.save(target)

        def saved(_: None) -> None:
            if shown is not None:
                shown.move_to(made.study)
            for layer in layers_of(self.viewer, before):
                layer.metadata[MARK]["study"] = str(made.study.path)
            work.remove()
            made.saved.emit()
            show_info(f"saved: {made.study.path}")

        self.start(save, saved, of=made)

    def open_report(self) -> None:
        """Write the page of the study, and open it in the browser."""
        study = self.shown_result()
        if study is None:
            return

        def write(report: Reporter) -> Path:
            from cytodisk.pages.report.page import write_report

            report.stage("Writing the report", "frames" if study.is_movie else "cells")
            return write_report(study, progress=report)

        found = self.savable()
        of = None if found is None else found[0]
        self.start(write, lambda page: webbrowser.open(page.absolute().as_uri()), of=of)

    def start(
        self, function: Any, done: Any, *, of: MadeStudy | None = None, unit: str = "cells", words: str = ""
    ) -> None:
        """Do something in a thread; meanwhile nothing else can be started here, nor with the same study."""
        if of is not None and of.is_in_use:
            show_error("another widget works with this study: wait until it is done, or cancel it there")
            return
        self._lock(True)

        def finish(result: Any) -> None:
            self._lock(False)
            done(result)

        self.work = run_in_background(
            self.bar, function, done=finish, failed=lambda: self._lock(False), unit=unit, words=words
        )
        if of is not None:
            of.last_work = self.work

    def _lock(self, is_busy: bool) -> None:
        for button in self.buttons:
            button.setEnabled(not is_busy)
        if self.savable() is None:
            self.results.save_button.setEnabled(False)

    @property
    def buttons(self) -> Sequence[QPushButton]:
        """Those that start something."""
        return self.run_button, self.results.save_button, self.results.report_button

    def show_results(self) -> None:
        """Scroll to the results."""
        self._scroll_soon.start()

    def _scroll(self) -> None:
        self.scroll.verticalScrollBar().setValue(self.form.geometry().bottom())

    def _arrange(self) -> None:
        inside = QWidget()
        self.inner = QVBoxLayout(inside)
        self.inner.setContentsMargins(0, 0, 0, 0)
        self.inner.setSpacing(4)
        self.inner.addLayout(self.choices)
        self.inner.addWidget(self.form)
        self.inner.addWidget(self.results)
        self.inner.addStretch()
        self.scroll = scrolled(inside)
        row = QHBoxLayout()
        row.addWidget(self.run_button, stretch=1)
        row.addWidget(self.replace_box)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(2, 2, 2, 2)
        rows.setSpacing(4)
        rows.addWidget(self.scroll, stretch=1)
        rows.addLayout(row)
        rows.addWidget(self.bar)
        rows.addWidget(self.results.buttons)

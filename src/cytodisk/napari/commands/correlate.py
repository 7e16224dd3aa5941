"""The widget "Correlate"."""

from __future__ import annotations

from typing import Any

from qtpy.QtWidgets import QComboBox, QLabel, QSizePolicy

from cytodisk.errors import CytodiskError
from cytodisk.napari.commands.command_widget import NOT_SAVED, SAVE_FIRST, CommandWidget
from cytodisk.napari.commands.correlation_run import MadeCorrelation, run_correlation
from cytodisk.napari.commands.lag_plot import LagPlot
from cytodisk.napari.commands.made_study import MadeStudy, made_of
from cytodisk.napari.commands.open_widgets import show_flags_of
from cytodisk.napari.commands.peak_layers import add_peak_layers
from cytodisk.napari.forms.command_line import command_line
from cytodisk.napari.forms.parameter_form import ParameterForm
from cytodisk.napari.study_layers.shown_study import ShownStudy, shown_studies
from cytodisk.napari.viewer_parts import show_error
from cytodisk.number_words import counted
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.run_options import TableOptions
from cytodisk.runs.told.correlation_words import earlier_settings, replaced_words
from cytodisk.runs.told.speed_words import PERCENT
from cytodisk.store.study import Study, open_study

_NOTHING = "follow cells first, or open the study of a movie"


class Correlate(CommandWidget):
    """Correlate a signal of a study that is open with the motion of the edge, as `cytodisk correlate` does.

    Parameters
    ----------
    napari_viewer : Viewer
    """

    def __init__(self, napari_viewer: Any):
        form = ParameterForm(CorrelateParameters, TableOptions, main=("max_lag",), beside=("with",))
        super().__init__(napari_viewer, form, "Correlate")
        self.made: MadeCorrelation | None = None
        self._of: ShownStudy | None = None
        self.layers: list[Any] = []
        self._studies: list[ShownStudy] = []
        self.study, self.signal, self.with_ = (QComboBox() for _ in range(3))
        for name, box in (("study", self.study), ("signal", self.signal), ("with", self.with_)):
            box.setSizePolicy(QSizePolicy.Expanding, QSizePolicy.Fixed)
            box.setSizeAdjustPolicy(QComboBox.AdjustToMinimumContentsLengthWithIcon)
            box.setMinimumContentsLength(12)
            self.choices.addRow(name, box)
        self.warning = QLabel()
        self.warning.setWordWrap(True)
        self.warning.hide()
        self.choices.addRow(self.warning)
        self.plot = LagPlot()
        self.inner.insertWidget(self.inner.indexOf(self.results), self.plot)
        self.study.currentIndexChanged.connect(lambda _: self._list_channels())
        for box in (self.signal, self.with_):
            box.currentIndexChanged.connect(lambda _: self._warn())
        form.changed.connect(self._warn)
        for event in (self.viewer.layers.events.inserted, self.viewer.layers.events.removed):
            event.connect(self._list_studies)
        self.destroyed.connect(lambda *_: self._let_go())
        self._list_studies()

    @property
    def shown(self) -> ShownStudy | None:
        """The study that is chosen."""
        place = self.study.currentIndex()
        return self._studies[place] if 0 <= place < len(self._studies) else None

    def shown_result(self) -> Study | None:
        """The study with the last correlation."""
        return None if self.made is None else self.made.study

    def run(self) -> None:
        """Correlate what is chosen, in a thread."""
        shown = self.shown
        if shown is None:
            show_error(f"study: none of a movie with a signal is open: {_NOTHING}")
            return
        try:
            for model in (CorrelateParameters, TableOptions):
                self.form.model(model)
        except CytodiskError as fault:
            show_error(str(fault))
            return
        names = self.signal.currentText(), self.with_.currentText()
        values, flags, study = self.form.values(), self.form.flags, shown.study
        self.start(
            lambda report: run_correlation(study, names, values, flags, report),
            lambda made: self.show_made(made, shown),
            of=made_of(shown),
            unit=PERCENT,
        )

    def show_made(self, made: MadeCorrelation, shown: ShownStudy) -> None:
        """Show a correlation: peaks of windows, curves of layers, what it says."""
        if self.replace_box.isChecked():
            self._remove_last()
        self.made, self.layers = made, []
        if shown.viewer is not None and "windows" in shown.layers:
            self.layers = add_peak_layers(self.viewer, shown, made.found)
            show_flags_of(self.viewer, shown, made.study, made.flags)
        self._of = shown
        if (of := made_of(shown)) is not None:
            of.saved.connect(self._follow_study)
        self.plot.show_curves(made.found, made.cells)
        self._tell()
        self.show_results()

    def savable(self) -> tuple[MadeStudy, ShownStudy | None] | None:
        """The study that was correlated last, if a widget made it and it is not saved."""
        made = None if self._of is None else made_of(self._of)
        return None if made is None or made.is_saved else (made, self._of)

    def _follow_study(self) -> None:
        """Go on with the study where it was saved."""
        if self.made is not None and self._of is not None:
            found = self.made.found
            self.made.study = open_study(self._of.study.path)
            self.made.found = self.made.study.correlation(found.signal, found.with_, found.name)
            self._tell()

    def _tell(self) -> None:
        made = self.made
        if made is None:
            return
        unsaved = self.savable() is not None
        flags = counted(len(made.flags), "kind") + " of QC flags: see the table under the image"
        where = NOT_SAVED if unsaved else f"results: {made.found.path}"
        self.results.show_words([*made.lines, flags if made.flags else "no QC flags", where])
        self.results.show_command(self.command_line(made), SAVE_FIRST if unsaved else "")
        self.results.save_button.setEnabled(unsaved)

    def command_line(self, made: MadeCorrelation) -> str:
        """The line for a shell that does the same."""
        found = made.found
        arguments = [str(made.study.path), "--signal", found.signal, "--with", found.with_]
        return command_line("correlate", arguments, found.settings["given"])

    def _list_studies(self, event: Any = None) -> None:
        before = self.shown
        self._studies = [one for one in shown_studies(self.viewer) if one.study.is_movie and one.channels]
        self.study.blockSignals(True)
        self.study.clear()
        for one in self._studies:
            made = made_of(one)
            unsaved = "" if made is None or made.is_saved else f"{made.usual_target.name} (not saved)"
            self.study.addItem(unsaved or one.study.path.name)
        if not self._studies:
            self.study.addItem(_NOTHING)
        if before in self._studies:
            self.study.setCurrentIndex(self._studies.index(before))
        self.study.blockSignals(False)
        if self.shown is not before or before is None:
            self._list_channels()

    def _list_channels(self) -> None:
        shown = self.shown
        channels = [] if shown is None else list(shown.channels)
        for box, names in (
            (self.signal, channels),
            (self.with_, [*VELOCITIES, *channels] if channels else []),
        ):
            box.blockSignals(True)
            box.clear()
            box.addItems(names)
            box.blockSignals(False)
        self._warn()

    def _warn(self) -> None:
        """Say what will be replaced, before it is."""
        shown, words = self.shown, ""
        if shown is not None and self.signal.currentText():
            name = str(self.form.values().get("name", ""))
            before = earlier_settings(shown.study, self.signal.currentText(), self.with_.currentText(), name)
            now = CorrelateParameters().model_dump() | self.form.values()
            if replaced := replaced_words(before, now):
                words = f"{replaced}. To keep both, type a name under Results."
        self.warning.setText(words)
        self.warning.setVisible(bool(words))

    def _remove_last(self) -> None:
        for layer in self.layers:
            if layer in self.viewer.layers:
                self.viewer.layers.remove(layer)

    def _let_go(self) -> None:
        for event in (self.viewer.layers.events.inserted, self.viewer.layers.events.removed):
            event.disconnect(self._list_studies)
        of = None if self._of is None else made_of(self._of)
        if of is not None:
            of.saved.disconnect(self._follow_study, missing_ok=True)

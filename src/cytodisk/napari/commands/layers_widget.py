"""What "Map cells" and "Follow cells" share: layers to choose, and a study with its layers as the result."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cytodisk.errors import CytodiskError
from cytodisk.napari.check.study_flags import remove_flags
from cytodisk.napari.commands.command_widget import NOT_SAVED, SAVE_FIRST, CommandWidget
from cytodisk.napari.commands.correlate import Correlate
from cytodisk.napari.commands.made_study import MadeStudy, keep_with, made_of
from cytodisk.napari.commands.open_widgets import layers_of, open_once, show_flags_of
from cytodisk.napari.forms.parameter_form import ParameterForm
from cytodisk.napari.given.chosen_layers import ChosenLayers
from cytodisk.napari.given.layer_choice import LayerChoice
from cytodisk.napari.given.layer_kinds import MASKS, NUCLEI, SIGNALS, TRACKS, is_picture
from cytodisk.napari.study_layers.shown_study import ShownStudy, show_study, shown_studies
from cytodisk.napari.viewer_parts import show_error, show_warning
from cytodisk.napari.work.background import Reporter
from cytodisk.number_words import counted
from cytodisk.parameters import Parameters
from cytodisk.store.study import Study

Run = Callable[[ChosenLayers, Mapping[str, Any], Mapping[str, str], Reporter], MadeStudy]


class LayersWidget(CommandWidget):
    """Choose layers, and make a study of them.

    Parameters
    ----------
    viewer : Viewer
    models : tuple of type of Parameters
        Of the command.
    run_words : str
        What stands on the button.
    without : tuple of str
        Parameters that are not asked.
    run : callable
        What is done in a thread.

    Attributes
    ----------
    command : str
        Its name on the command line.
    """

    command = ""

    def __init__(
        self,
        viewer: Any,
        models: tuple[type[Parameters], ...],
        run_words: str,
        without: tuple[str, ...],
        run: Run,
    ):
        form = ParameterForm(*models, main=("layers", "sectors"), without=without)
        super().__init__(viewer, form, run_words)
        self._models, self._run = models, run
        self.made: MadeStudy | None = None
        self.shown: ShownStudy | None = None
        self.masks = LayerChoice(self.viewer, MASKS)
        self.signal = LayerChoice(self.viewer, SIGNALS, several=True)
        self.nuclei = LayerChoice(self.viewer, NUCLEI, optional=True)
        self.tracks = LayerChoice(self.viewer, TRACKS, optional=True) if "tracks" in without else None
        for name, choice in self._layer_choices.items():
            self.choices.addRow(name, choice)
        self._signal_touched = False
        self._choose_layers()
        self.signal.changed.connect(self._touch_signal)
        for event in (self.viewer.layers.events.inserted, self.viewer.layers.events.removed):
            event.connect(self._choose_layers)
        self.destroyed.connect(lambda *_: self._let_go())
        self.results.next_wanted.connect(self.correlate)
        self._take_over()

    @property
    def _layer_choices(self) -> dict[str, LayerChoice]:
        found = {"masks": self.masks, "signal": self.signal, "nuclei": self.nuclei}
        return found if self.tracks is None else found | {"tracks": self.tracks}

    def shown_result(self) -> Study | None:
        """The study of the last run."""
        return None if self.made is None else self.made.study

    def run(self) -> None:
        """Make a study of the chosen layers, in a thread."""
        masks = self.masks.layer
        if masks is None:
            show_error("masks: no layer is chosen: open a label image, or draw labels or shapes")
            return
        try:
            for model in self._models:
                self.form.model(model)
        except CytodiskError as fault:
            show_error(str(fault))
            return
        tracks = None if self.tracks is None else self.tracks.layer
        chosen = ChosenLayers(masks, self.signal.layers, self.nuclei.layer, tracks)
        values, flags = self.form.values(), self.form.flags
        self.start(lambda report: self._run(chosen, values, flags, report), self.show_made)

    def show_made(self, made: MadeStudy) -> None:
        """Show a study: its layers, what it says, what is wrong with it."""
        if self.replace_box.isChecked():
            self._remove_last()
        self.made, self.shown = made, None
        made.saved.connect(self._tell)
        if made.warnings:
            show_warning("\n".join(made.warnings))
        if made.fault:
            show_error(made.fault)
        else:
            self.shown = show_study(self.viewer, made.study)
            keep_with(self.shown, made)
            show_flags_of(self.viewer, self.shown, made.study, made.flags)
        self._tell()
        self.show_results()

    def savable(self) -> tuple[MadeStudy, ShownStudy | None] | None:
        """The study of the last run until it is saved."""
        return None if self.made is None or self.made.is_saved else (self.made, self.shown)

    def correlate(self) -> None:
        """Open the widget "Correlate", or bring it to the front."""
        open_once(self.viewer, Correlate, "Correlate")

    def _take_over(self) -> None:
        """Go on with what another widget of this kind made, whose layers are still shown."""
        for shown in shown_studies(self.viewer):
            made = made_of(shown)
            if made is not None and made.command == self.command:
                self.made, self.shown = made, shown
                made.saved.connect(self._tell)
                self._tell()

    def _tell(self) -> None:
        made = self.made
        if made is None:
            return
        flags = counted(len(made.flags), "kind") + " of QC flags: see the table under the image"
        first = [flags if made.flags else "no QC flags"] if self.shown is not None else []
        where = f"results: {made.study.path}" if made.is_saved else NOT_SAVED
        self.results.show_words(
            [*made.lines[:1], *first, *made.losses, *made.lines[1:], *made.files.notes, where]
        )
        self.results.show_command(made.command_line, SAVE_FIRST if made.needs_saving else "")
        self.results.save_button.setEnabled(self.savable() is not None)
        self.results.next_button.setVisible(self.shown is not None and made.command == "movie")

    def _remove_last(self) -> None:
        if self.shown is not None:
            remove_flags(self.shown)
        if self.made is not None:
            for layer in layers_of(self.viewer, self.made.study.path):
                self.viewer.layers.remove(layer)

    def _touch_signal(self) -> None:
        self._signal_touched = True

    def _choose_layers(self, event: Any = None) -> None:
        """Take all images but the masks as the signal until the user chooses."""
        if self._signal_touched:
            return
        masks = self.masks.layer
        fitting = [layer for layer in self.signal.fitting() if layer is not masks and not is_picture(layer)]
        self.signal.blockSignals(True)
        self.signal.choose(*fitting)
        self.signal.blockSignals(False)

    def _let_go(self) -> None:
        for event in (self.viewer.layers.events.inserted, self.viewer.layers.events.removed):
            event.disconnect(self._choose_layers)
        for choice in self._layer_choices.values():
            choice.close_down()
        if self.made is not None:
            self.made.saved.disconnect(self._tell, missing_ok=True)

"""A form for the parameters of a command, from the models that the command line has its flags from."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from pydantic.fields import FieldInfo
from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QFormLayout, QLabel, QVBoxLayout, QWidget

from cytodisk.errors import CytodiskError
from cytodisk.napari.forms.editors import editor_for
from cytodisk.napari.forms.own_values import with_own
from cytodisk.napari.forms.section import Section
from cytodisk.parameter_words import flag_of, help_words, unit_of
from cytodisk.parameters import Group, Parameters
from cytodisk.runs.told.flag_headings import grouped
from cytodisk.taking import fields_of

MAIN = "Main settings"
"""Heading of the parameters that are asked first."""

_UNITS = ("um", "px", "px2", "s")  # at the end of a flag


class ParameterForm(QWidget):
    """An editor for each parameter, under the headings of the command's help; the first part is open.

    An editor that is empty stands for the default, which it shows in grey.

    Parameters
    ----------
    *models : type of Parameters
        Of a field that several have, the first counts.
    main : sequence of str
        Names of the parameters that are asked first, under a heading of their own.
    without : collection of str
        Names of parameters that are not asked, such as those that layers decide.
    beside : sequence of str
        Flags of the command that no model has and that decide its headings, such as `with`.

    Attributes
    ----------
    changed : Signal
        Emitted when an editor changes.
    sections : list of Section
    editors : dict of str to QWidget
        By name of the parameter.
    """

    changed = Signal()

    def __init__(
        self,
        *models: type[Parameters],
        main: Sequence[str] = (),
        without: Collection[str] = (),
        beside: Sequence[str] = (),
    ):
        super().__init__()
        self._models = models
        self._fields = {name: field for name, field in fields_of(models).items() if name not in without}
        self.flags = {name: flag_of(name, field) for name, field in self._fields.items()}
        self.editors: dict[str, Any] = {}
        self._faults: dict[str, QLabel] = {}
        self.sections: list[Section] = []
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        for place, (heading, names) in enumerate(self._parts(main, beside)):
            section = Section(heading, self._body(names), is_open=place == 0)
            self.sections.append(section)
            layout.addWidget(section)
        layout.addStretch()

    def values(self) -> dict[str, Any]:
        """The parameters that differ from their defaults, by name; texts that are no such value as typed."""
        found = {name: editor.value() for name, editor in self.editors.items()}
        return {name: value for name, value in found.items() if value is not None}

    def set_values(self, values: Mapping[str, Any]) -> None:
        """Show values of parameters by name; all others get their defaults."""
        for name, editor in self.editors.items():
            value = values.get(name)
            editor.set_value(None if value == self._fields[name].default else value)

    def model(self, model: type[Group]) -> Group:
        """The parameters of a model with what was chosen.

        Raises
        ------
        ParameterError
            A value is wrong, or two exclude each other; the message has their flags, as the tooltips have.
        """
        return with_own(model, self.values(), self.flags)

    def fault_words(self, name: str) -> str:
        """What is wrong with the value of a parameter by itself, as it stands below its editor."""
        return str(self._faults[name].text())

    def _parts(self, main: Sequence[str], beside: Sequence[str]) -> list[tuple[str, list[str]]]:
        """Headings with the names of their parameters, those asked first in front."""
        names = {flag.removeprefix("--"): name for name, flag in self.flags.items() if name not in main}
        parts = [
            (heading, [names[flag] for flag in flags if flag in names])
            for heading, flags in (grouped([*names, *beside]))
        ]
        first = [(MAIN, list(main))] if main else []
        return [*first, *((heading, found) for heading, found in parts if found)]

    def _body(self, names: Sequence[str]) -> QWidget:
        body = QWidget()
        layout = QFormLayout(body)
        layout.setContentsMargins(12, 0, 4, 4)
        layout.setVerticalSpacing(3)
        layout.setFieldGrowthPolicy(QFormLayout.ExpandingFieldsGrow)
        for name in names:
            field = self._fields[name]
            editor, label = self._editor(name, field), QLabel(self._label(name, field))
            label.setToolTip(editor.toolTip())
            label.setBuddy(editor)
            layout.addRow(label, editor)
            self._faults[name] = _fault_label()
            layout.addRow(self._faults[name])
        return body

    def _editor(self, name: str, field: FieldInfo) -> Any:
        editor = editor_for(field)
        editor.setToolTip(f"<p>{help_words(field)}</p><p><tt>{self.flags[name]}</tt></p>")
        editor.setAccessibleName(self._label(name, field))
        editor.setMinimumWidth(60)
        self.editors[name] = editor
        editor.changed.connect(lambda: self._judge(name))
        return editor

    def _label(self, name: str, field: FieldInfo) -> str:
        unit = unit_of(field)
        words = self.flags[name].removeprefix("--").split("-")
        words = words[:-1] if unit and words[-1] in _UNITS else words
        return f"{' '.join(words)} ({unit})" if unit else " ".join(words)

    def _judge(self, name: str) -> None:
        """Say below an editor what is wrong with its value by itself."""
        model = next(model for model in self._models if name in model.model_fields)
        value, words = self.editors[name].value(), ""
        if value is not None:
            try:
                model.called({name: value}, self.flags)
            except CytodiskError as fault:
                words = str(fault)
        self._faults[name].setText(words)
        self._faults[name].setVisible(bool(words))
        self.changed.emit()


def _fault_label() -> QLabel:
    label = QLabel()
    label.setWordWrap(True)
    label.setTextFormat(Qt.PlainText)
    label.setStyleSheet("color: #e0a030;")
    label.hide()
    return label

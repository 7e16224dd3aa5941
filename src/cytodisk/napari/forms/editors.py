"""The editor of one parameter, by what the parameter may be."""

from __future__ import annotations

from typing import Any, Protocol, cast

from pydantic.fields import FieldInfo
from qtpy.QtCore import QEvent, QObject, Qt, Signal
from qtpy.QtWidgets import QCheckBox, QComboBox, QLineEdit, QSizePolicy, QWidget

from cytodisk.napari.forms.number_box import NumberBox
from cytodisk.parameter_words import choices, default_words, kinds, range_words, value_of_text

_WIDEST_PLACEHOLDER = 34


class Editor(Protocol):
    """What editors of all kinds have in common, beside what every widget has."""

    changed: Any

    def value(self) -> Any:
        """What was chosen; None for the default."""

    def set_value(self, value: Any) -> None:
        """Show a value; None for the default."""


def editor_for(field: FieldInfo) -> Any:
    """The editor of a parameter: an `Editor` and a QWidget.

    Parameters
    ----------
    field : FieldInfo
        Of a model of parameters.

    Returns
    -------
    QWidget
        Switch, choice, number with arrows, or text.
    """
    wanted, words = kinds(field.annotation), choices(field.annotation)
    made: Any
    if bool in wanted:
        made = _Choice(field, {"yes": True, "no": False}) if type(None) in wanted else _Switch(field)
    elif words and wanted <= {str, type(None)}:
        made = _Choice(field, {word: word for word in words})
    elif words:
        made = _OpenChoice(field, words)
    else:
        made = _Number(field) if wanted <= {int, float, type(None)} else _Text(field)
    if not isinstance(made, QLineEdit):
        quiet_wheel(made)
    if isinstance(made, QComboBox):
        made.setSizeAdjustPolicy(QComboBox.AdjustToMinimumContentsLengthWithIcon)
        made.setMinimumContentsLength(8)
        made.setSizePolicy(QSizePolicy.Expanding, QSizePolicy.Fixed)
    return made


def text_of(value: Any) -> str:
    """A value as one types it: 10:80 for the first and the last, else with commas between."""
    if value is None:
        return ""
    if isinstance(value, tuple | list):
        return ",".join(text_of(one) for one in value)
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def quiet_wheel(widget: QWidget) -> None:
    """Let the wheel scroll the form over a widget, and not change its value."""
    widget.setFocusPolicy(Qt.StrongFocus)
    widget.installEventFilter(_NoWheel(widget))


class _NoWheel(QObject):
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Wheel and not cast(Any, watched).hasFocus():
            event.ignore()
            return True
        return False


class _Switch(QCheckBox):
    changed = Signal()

    def __init__(self, field: FieldInfo):
        super().__init__()
        self._default = bool(field.default)
        self.setChecked(self._default)
        self.toggled.connect(lambda _: self.changed.emit())

    def value(self) -> bool | None:
        chosen = bool(self.isChecked())
        return None if chosen == self._default else chosen

    def set_value(self, value: bool | None) -> None:
        self.setChecked(self._default if value is None else value)


class _Choice(QComboBox):
    """One of some words; the default is the first."""

    changed = Signal()

    def __init__(self, field: FieldInfo, values: dict[str, Any]):
        super().__init__()
        first = default_words(field)
        self._values = {first or "automatic": None} | {
            word: value for word, value in values.items() if word != first
        }
        self.addItems(list(self._values))
        self.currentIndexChanged.connect(lambda _: self.changed.emit())

    def value(self) -> Any:
        return self._values[str(self.currentText())]

    def set_value(self, value: Any) -> None:
        words = [word for word, one in self._values.items() if one == value]
        self.setCurrentText(words[0] if words else next(iter(self._values)))


class _Typed:
    """What editors share in which a text is typed; empty for the default."""

    field: FieldInfo

    def typed(self) -> Any:
        """The line in which it is typed."""
        raise TypeError("an editor must say where its text is")

    def value(self) -> Any:
        text = str(self.typed().text()).strip()
        found = value_of_text(self.field, text) if text else None
        return None if found == self.field.default else found

    def set_value(self, value: Any) -> None:
        separator = ":" if value is not None and ":" in range_words(self.field) else ","
        self.typed().setText(text_of(value).replace(",", separator))

    def explain(self) -> None:
        """Show the default, or what may be typed, in grey while nothing is."""
        words = default_words(self.field)
        if not words:
            may_be = range_words(self.field)
            words = may_be.rpartition("such as ")[2] if "such as " in may_be else ""
            words = f"none, or {words}" if words else "automatic"
        self.typed().setPlaceholderText(words[:_WIDEST_PLACEHOLDER])


class _Number(_Typed, NumberBox):
    def __init__(self, field: FieldInfo):
        NumberBox.__init__(self, field)
        self.field = field
        self.explain()

    def typed(self) -> Any:
        return self.lineEdit()


class _Text(_Typed, QLineEdit):
    changed = Signal()

    def __init__(self, field: FieldInfo):
        QLineEdit.__init__(self)
        self.field = field
        self.explain()
        self.textChanged.connect(lambda _: self.changed.emit())

    def typed(self) -> Any:
        return self


class _OpenChoice(_Typed, QComboBox):
    """One of some words, or something else that is typed."""

    changed = Signal()

    def __init__(self, field: FieldInfo, words: tuple[str, ...]):
        QComboBox.__init__(self)
        self.field = field
        self.setEditable(True)
        self.addItems(list(words))
        self.setCurrentIndex(-1)
        self.explain()
        self.editTextChanged.connect(lambda _: self.changed.emit())

    def typed(self) -> Any:
        return self.lineEdit()

"""A box for a number that may stay empty: its default then stands in it in grey."""

from __future__ import annotations

import math

from pydantic.fields import FieldInfo
from qtpy.QtCore import Signal
from qtpy.QtGui import QValidator
from qtpy.QtWidgets import QAbstractSpinBox

from cytodisk.parameter_words import kinds

_LIMITS = ("ge", "gt", "le", "lt")


class NumberBox(QAbstractSpinBox):
    """A number with arrows that keep to its range; any text can be typed, and is judged by the model.

    Parameters
    ----------
    field : FieldInfo
        Of a model of parameters.
    """

    changed = Signal()

    def __init__(self, field: FieldInfo):
        super().__init__()
        self._is_whole = float not in kinds(field.annotation)
        self._default = field.default
        self._limits = {
            name: getattr(part, name) for part in field.metadata for name in _LIMITS if hasattr(part, name)
        }
        self.lineEdit().textChanged.connect(self.changed)

    def validate(self, text: str, position: int) -> tuple[QValidator.State, str, int]:
        """Let any text pass: the model has the words for what is wrong with it."""
        return QValidator.State.Acceptable, text, position

    def stepEnabled(self) -> QAbstractSpinBox.StepEnabled:
        """Both arrows work."""
        return QAbstractSpinBox.StepUpEnabled | QAbstractSpinBox.StepDownEnabled

    def stepBy(self, steps: int) -> None:
        """Go up or down, from the default where the box is empty; stop where the range ends."""
        try:
            value = float(self.lineEdit().text() or self._default or self._limits.get("ge", 0))
        except ValueError:
            return
        size = 1.0 if self._is_whole else 10.0 ** (math.floor(math.log10(abs(value))) if value else 0)
        if not self._is_whole and steps < 0 and math.isclose(abs(value), size):
            size /= 10  # from 0.01 down to 0.009, not to 0
        wanted = value + steps * size
        wanted = min(max(wanted, self._limits.get("ge", wanted)), self._limits.get("le", wanted))
        if wanted > self._limits.get("gt", -math.inf):
            self.lineEdit().setText(f"{wanted:.0f}" if self._is_whole else f"{wanted:.6g}")

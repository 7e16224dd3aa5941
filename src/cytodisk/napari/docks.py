"""Docks of cytodisk lie behind each other as tabs, so that the window does not grow with each of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from weakref import WeakSet

from qtpy.QtCore import QTimer
from qtpy.QtWidgets import QDockWidget, QMainWindow, QWidget

_JOINED: WeakSet[QWidget] = WeakSet()
_OURS = __name__.rpartition(".")[0]


def join_docks(widget: QWidget) -> None:
    """Put the dock of a widget onto the other ones of cytodisk at its side of the window, as a tab in front.

    Parameters
    ----------
    widget : QWidget
        Call it in its `showEvent`: it is done the first time, then the dock stays where the user puts it.
    """
    if widget not in _JOINED:
        _JOINED.add(widget)
        soon(widget, lambda: _join(widget)).start()


def soon(widget: QWidget, function: Callable[[], None]) -> QTimer:
    """A timer that, once started, calls a function when Qt has laid out what is new.

    Parameters
    ----------
    widget : QWidget
        The timer goes with it.
    function : callable
    """
    timer = QTimer(widget)
    timer.setSingleShot(True)
    timer.timeout.connect(function)
    return timer


def _join(widget: QWidget) -> None:
    dock, window = dock_of(widget), widget.window()
    if dock is None or dock.isFloating() or not isinstance(window, QMainWindow):
        return
    side = window.dockWidgetArea(dock)
    for other in window.findChildren(QDockWidget):
        beside = other is not dock and not other.isFloating() and window.dockWidgetArea(other) == side
        if beside and _is_ours(other) and (other.isVisible() or window.tabifiedDockWidgets(other)):
            if other not in window.tabifiedDockWidgets(dock):
                window.tabifyDockWidget(other, dock)
            dock.raise_()
            return


def dock_of(widget: QWidget) -> QDockWidget | None:
    """The dock that a widget is in, None if it is in none.

    Parameters
    ----------
    widget : QWidget
    """
    found: Any = widget
    while found is not None and not isinstance(found, QDockWidget):
        found = found.parentWidget()
    return found


def _is_ours(dock: QDockWidget) -> bool:
    """Whether a widget of cytodisk is in a dock."""
    return any(type(child).__module__.startswith(_OURS) for child in dock.findChildren(QWidget))

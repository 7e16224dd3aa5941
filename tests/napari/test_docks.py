"""Docks of cytodisk lie behind each other."""

from collections.abc import Callable
from typing import Any

import pytest

pytestmark = pytest.mark.slow
pytest.importorskip("cytodisk.napari.viewer_parts")


def test_docks_of_cytodisk_are_tabs_and_a_dock_of_others_stays(
    make_viewer: Callable[..., Any], qtbot: Any
) -> None:
    from qtpy.QtWidgets import QLabel, QWidget

    from cytodisk.napari.docks import dock_of, join_docks

    class Ours(QLabel):
        """A widget that could be one of cytodisk's."""

        def showEvent(self, event: Any) -> None:
            """Join the others."""
            join_docks(self)

    Ours.__module__ = "cytodisk.napari.of_a_test"
    viewer = make_viewer(show=True)
    widgets: list[Any] = [QLabel("another's"), Ours("first"), Ours("second"), Ours("third")]
    for number, widget in enumerate(widgets):
        viewer.window.add_dock_widget(widget, name=str(number), area="right")
        qtbot.wait(20)

    window = widgets[0].window()
    docks = [dock_of(widget) for widget in widgets]
    assert window.tabifiedDockWidgets(docks[0]) == []
    assert set(window.tabifiedDockWidgets(docks[1])) == set(docks[2:])
    assert dock_of(QWidget()) is None

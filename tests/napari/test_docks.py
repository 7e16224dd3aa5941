"""Docks of cytodisk lie behind each other."""

from collections.abc import Callable
from typing import Any

import pytest

pytestmark = pytest.mark.slow
pytest.importorskip("napari.viewer")


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


def test_all_docks_fit_a_small_screen(make_viewer: Callable[..., Any], qtbot: Any) -> None:
    from cytodisk.napari.check.flag_table import FlagTable

    viewer = make_viewer(show=True)
    window = viewer.window._qt_window
    window.resize(1366, 768)
    flags = FlagTable(lambda place: True)
    flags.setMinimumHeight(150)
    viewer.window.add_dock_widget(flags, name="flags", area="bottom")
    if window.height() > 768:
        pytest.skip("napari alone is higher than 768 pixels on this screen")

    names = ("Check masks", "Map cells", "Follow cells", "Correlate", "Disk", "Open results")
    widgets = []
    for name in names:
        widgets.append(viewer.window.add_plugin_dock_widget("cytodisk", name)[1])
        qtbot.wait(50)
    widgets[0].words.setText("What is wrong, in many words. " * 40)
    qtbot.wait(50)

    assert window.height() == 768

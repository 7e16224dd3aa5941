"""Widgets and layers of cytodisk that are open in a viewer."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from qtpy.QtWidgets import QApplication

from cytodisk.napari.check.study_flags import remove_flags, show_flags
from cytodisk.napari.docks import dock_of
from cytodisk.napari.given.layer_kinds import MARK
from cytodisk.napari.study_layers.shown_study import ShownStudy
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.store.study import Study


def open_once(viewer: Any, widget: type[Any], name: str) -> Any:
    """Open a widget at the right of a viewer, or bring the one to the front that is open.

    Parameters
    ----------
    viewer : Viewer
    widget : type of QWidget
        Made with the viewer, which is its attribute.
    name : str
        Of its dock.

    Returns
    -------
    QWidget
    """
    open_ones = [one for top in QApplication.topLevelWidgets() for one in top.findChildren(widget)]
    inner = next((one for one in open_ones if one.viewer is viewer), None)
    if inner is None:
        inner = widget(viewer)
        viewer.window.add_dock_widget(inner, name=name, area="right", tabify=True)
    dock = dock_of(inner)
    if dock is not None:
        dock.show()
        dock.raise_()
    return inner


def layers_of(viewer: Any, study: Path) -> list[Any]:
    """Layers that cytodisk made of a study.

    Parameters
    ----------
    viewer : Viewer
    study : Path
        Its folder.
    """
    return [layer for layer in viewer.layers if layer.metadata.get(MARK, {}).get("study") == str(study)]


def show_flags_of(viewer: Any, shown: ShownStudy, study: Study, flags: Sequence[QCFlag]) -> None:
    """Show the QC flags of a study in the place of those that were shown; nothing where there are none.

    Parameters
    ----------
    viewer : Viewer
    shown : ShownStudy
    study : Study
        As it is now.
    flags : sequence of QCFlag
    """
    if flags:
        show_flags(viewer, study, shown, flags)
    else:
        remove_flags(shown)

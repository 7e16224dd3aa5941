"""`ViewerLink`: what the dock hears from the viewer, and can stop to hear."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cytodisk.napari.disk_view.cell_marks import CellMarks
from cytodisk.napari.disk_view.viewer_canvas import scene_of


class ViewerLink:
    """Marks on the canvas, and calls when something changes there.

    Parameters
    ----------
    viewer : Viewer
    cursor, layers, look : callable
        Called when the cursor has moved or left, when layers come or go, when the theme or the number of
        dimensions that are shown has changed.
    mouse : callable
        Called with the viewer and the event when the mouse is pressed, as napari's mouse callbacks are.

    Attributes
    ----------
    marks : CellMarks
    """

    def __init__(self, viewer: Any, cursor: Any, layers: Any, look: Any, mouse: Callable[..., Any]):
        self.marks = CellMarks(scene_of(viewer))
        self._viewer, self._mouse = viewer, mouse
        self._heard = [
            (viewer.cursor.events.position, cursor),
            (viewer.events.mouse_over_canvas, cursor),
            (viewer.layers.events.inserted, layers),
            (viewer.layers.events.removed, layers),
            (viewer.events.theme, look),
            (viewer.dims.events.ndisplay, look),
        ]
        for event, called in self._heard:
            event.connect(called)
        viewer.mouse_drag_callbacks.append(mouse)

    def end(self) -> None:
        """Leave the viewer as it was."""
        for event, called in self._heard:
            event.disconnect(called)
        self._viewer.mouse_drag_callbacks.remove(self._mouse)
        self.marks.remove()

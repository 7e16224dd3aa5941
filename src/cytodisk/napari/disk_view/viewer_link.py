"""`ViewerLink`: what the dock hears from the viewer, and can stop to hear."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from cytodisk.napari.disk_view.cell_marks import CellMarks
from cytodisk.napari.napari_versions import scene_of

_STILL = 3.0  # pixels of the canvas that a click may move


class ViewerLink:
    """Marks on the canvas, and calls when something changes there.

    Parameters
    ----------
    viewer : Viewer
    cursor, layers, look : callable
        Called when the cursor has moved or left, when layers come or go, when the theme or the number of
        dimensions that are shown has changed.
    clicked : callable
        Called after a click on the canvas that did not drag it.

    Attributes
    ----------
    marks : CellMarks
    """

    def __init__(self, viewer: Any, cursor: Any, layers: Any, look: Any, clicked: Any):
        self.marks = CellMarks(scene_of(viewer))
        self._viewer, self._clicked = viewer, clicked
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
        viewer.mouse_drag_callbacks.append(self._press)

    def _press(self, viewer: Any, event: Any) -> Iterator[None]:
        """What napari calls when the mouse is pressed, and again until it is released."""
        start = tuple(event.pos)
        yield
        while event.type == "mouse_move":
            yield
        if math.dist(tuple(event.pos), start) <= _STILL:
            self._clicked()

    def end(self) -> None:
        """Leave the viewer as it was."""
        for event, called in self._heard:
            event.disconnect(called)
        self._viewer.mouse_drag_callbacks.remove(self._press)
        self.marks.remove()

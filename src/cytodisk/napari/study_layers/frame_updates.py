"""Bring layers to the frame under the slider: those that are visible, without events that are not needed."""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import QTimer

from cytodisk.napari.study_layers.feature_table import window_features
from cytodisk.napari.study_layers.frame_lines import FrameLines
from cytodisk.napari.study_layers.painted_frames import PaintedFrames

_REST_MS = 300  # that the slider stands still before tables are told


class FrameUpdates:
    """Sets what layers hold of one frame alone.

    Parameters
    ----------
    painted : PaintedFrames
    lines : FrameLines
    top_speed : float
        At the ends of the colours of velocity.
    """

    def __init__(self, painted: PaintedFrames, lines: FrameLines, top_speed: float):
        self._painted, self._lines, self._top_speed = painted, lines, top_speed
        self._shown: dict[str, int] = {}  # frame by role
        self._untold: Any = None  # layer with other features than its listeners know of
        self._rest = QTimer()
        self._rest.setSingleShot(True)
        self._rest.setInterval(_REST_MS)
        self._rest.timeout.connect(self._tell_features)

    def show(self, role: str, layer: Any, frame: int) -> None:
        """Bring a layer to a frame, if it is visible and of another one.

        Parameters
        ----------
        role : str
        layer : Layer
        frame : int
        """
        if not layer.visible or self._shown.get(role) == frame:
            return
        if role == "windows":
            with layer.events.features.blocker():  # a table of 600 windows takes napari seconds
                layer.features = window_features(self._painted, frame)
            self._untold = layer
            self._rest.start()
        elif role == "outlines":
            set_data(layer, self._lines.windows(frame))
        elif role == "sector 0":
            set_data(layer, self._lines.sector_0(frame))
        elif role == "nuclei":
            set_data(layer, self._lines.nuclei(frame))
        elif role == "velocity":
            lines, colours = self._lines.edge(frame, self._top_speed)
            set_data(layer, lines)
            if len(colours):  # napari refuses none, and makes all white
                layer.edge_color = colours
        elif role == "points":
            points, features = self._lines.points(frame)
            set_data(layer, points)
            if len(layer.features) != len(points) or (layer.features["cell"] != features["cell"]).any():
                layer.features = features
        else:
            return
        self._shown[role] = frame

    def _tell_features(self) -> None:
        """Let tables of features know of a frame at which the slider rests."""
        layer, self._untold = self._untold, None
        if layer is not None:
            layer.events.features()

    def load(self, frame: int) -> None:
        """Read what is shown of a frame, and keep it."""
        self._painted.shown(frame)
        self._lines.windows(frame)
        self._lines.points(frame)
        if self._painted.windows.grid.nucleus_layers:
            self._lines.nuclei(frame)
        if self._painted.cells.study.is_movie:
            self._lines.edge(frame, self._top_speed)


def set_data(layer: Any, data: Any) -> None:
    """Give a layer other data, of which the viewer need not know: what it covers is in another layer, too."""
    with layer.events.data.blocker():
        layer.data = data

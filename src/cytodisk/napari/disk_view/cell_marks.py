"""`CellMarks`: lines over the image that are no layers, so that nothing of the user's is touched."""

from __future__ import annotations

from typing import Any

import numpy as np
from vispy.scene.visuals import Line, Markers

from cytodisk.arrays import FloatArray

_ON_TOP = 1_000_000  # drawn after all layers
POINTED, PINNED = "#00E5FF", "#FFD400"
"""Colours of a window under the cursor, and of one that was clicked; in the disk too."""

_DARK = "#000000"
_WIDTHS = (4.0, 2.0)  # of the dark line, and of the one in it


class CellMarks:
    """Outlines of windows, a cross, and the ring of sector 0, on the scene of a canvas.

    Parameters
    ----------
    scene : SceneNode
        Of vispy.
    """

    def __init__(self, scene: Any):
        self._lines = {
            name: [
                Line(parent=scene, color=_DARK, width=_WIDTHS[0]),
                Line(parent=scene, color=colour, width=_WIDTHS[1]),
            ]
            for name, colour in (("pinned", PINNED), ("pointed", POINTED))
        }
        self._cross = [Markers(parent=scene) for _ in _WIDTHS]
        self._zero = Markers(parent=scene)
        for order, visual in enumerate(self.visuals):
            visual.order = _ON_TOP + order
            visual.set_gl_state("translucent", depth_test=False)
            visual.interactive = False
            visual.visible = False

    @property
    def visuals(self) -> list[Any]:
        """All that is drawn, from below."""
        return [*self._lines["pinned"], *self._lines["pointed"], *self._cross, self._zero]

    def outline(self, name: str, points_xy: FloatArray | None) -> None:
        """Show an outline, or none.

        Parameters
        ----------
        name : {"pointed", "pinned"}
        points_xy : ndarray of shape (N, 2) and dtype float, or None
            On the scene; the last point is not repeated.
        """
        for line in self._lines[name]:
            if points_xy is not None and len(points_xy):
                line.set_data(pos=np.concatenate([points_xy, points_xy[:1]]).astype(np.float32))
            line.visible = points_xy is not None and len(points_xy) > 0

    def cross(self, point_xy: FloatArray | None) -> None:
        """Show the cross at a point, shape (1, 2), or none."""
        for marker, shade, size in zip(self._cross, (_DARK, POINTED), (15.0, 12.0), strict=True):
            if point_xy is not None:
                marker.set_data(
                    pos=point_xy.astype(np.float32),
                    symbol="cross",
                    size=size,
                    face_color=shade,
                    edge_width=0.0,
                )
            marker.visible = point_xy is not None

    def sector_0(self, point_xy: FloatArray | None) -> None:
        """Show the ring that marks sector 0 at a point, shape (1, 2), or none."""
        if point_xy is not None:
            place = point_xy.astype(np.float32)
            look = {"face_color": "white", "edge_color": "black", "edge_width": 2.0}
            self._zero.set_data(pos=place, symbol="disc", size=10.0, **look)
        self._zero.visible = point_xy is not None

    def clear(self) -> None:
        """Show nothing."""
        for visual in self.visuals:
            visual.visible = False

    def remove(self) -> None:
        """Take them off the canvas."""
        for visual in self.visuals:
            visual.parent = None

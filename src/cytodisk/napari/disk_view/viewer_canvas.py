"""What the dock needs of the viewer's canvas that napari gives no layer for."""

from __future__ import annotations

from typing import Any

from cytodisk.napari.viewer_parts import get_theme


def scene_of(viewer: Any) -> Any:
    """The scene of the canvas, in world coordinates: what is drawn there is no layer.

    Parameters
    ----------
    viewer : Viewer
    """
    return viewer.window._qt_viewer.canvas.view.scene


def text_colour_of(viewer: Any) -> str:
    """Colour of text in the viewer's theme, as "#ffffff".

    Parameters
    ----------
    viewer : Viewer
    """
    return str(get_theme(viewer.theme).text.as_hex(format="long"))

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


def camera_of(viewer: Any) -> Any:
    """The camera, which is the scene's from napari 0.9 on.

    Parameters
    ----------
    viewer : Viewer
    """
    scene = getattr(viewer, "scene", None)
    return viewer.camera if scene is None else scene.camera


def text_colour_of(viewer: Any) -> str:
    """Colour of text in the viewer's theme, as "#ffffff".

    Parameters
    ----------
    viewer : Viewer
    """
    return str(get_theme(viewer.theme).text.as_hex(format="long"))

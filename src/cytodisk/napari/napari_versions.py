"""What differs between versions of napari (0.6 to 0.9), or is private there: asked here alone."""

from __future__ import annotations

from typing import Any


def plain_viewer(viewer: Any) -> Any:
    """The viewer without the wrapping that each widget of a plugin gets a new one of.

    Widgets find what others made by the viewer that it is in, and two wrappings are not the same.

    Parameters
    ----------
    viewer : Viewer
    """
    return getattr(viewer, "__wrapped__", viewer)


def camera_of(viewer: Any) -> Any:
    """The camera of a viewer, which napari keeps in another place since 0.9.

    Parameters
    ----------
    viewer : Viewer
    """
    scene = getattr(viewer, "scene", None)
    return viewer.camera if scene is None else scene.camera


def scene_of(viewer: Any) -> Any:
    """The scene of the canvas, in world coordinates: what is drawn there is no layer.

    Parameters
    ----------
    viewer : Viewer
    """
    return viewer.window._qt_viewer.canvas.view.scene


def text_colour_of(viewer: Any) -> tuple[int, int, int]:
    """Red, green and blue of text in the viewer's theme, from 0 to 255.

    Parameters
    ----------
    viewer : Viewer
    """
    from cytodisk.napari.viewer_parts import get_theme  # the rest needs no napari to be imported

    red, green, blue = get_theme(viewer.theme).text.as_rgb_tuple(alpha=False)
    return red, green, blue


def without_thumbnail(layer: Any) -> None:
    """Draw no small picture of lines: napari makes it of each line by itself, at every change of frame.

    Parameters
    ----------
    layer : Layer
    """
    if hasattr(layer, "_max_vectors_thumbnail"):
        layer._max_vectors_thumbnail = 0

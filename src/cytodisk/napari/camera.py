"""The camera of a viewer, which napari keeps in another place since 0.9."""

from __future__ import annotations

from typing import Any


def camera_of(viewer: Any) -> Any:
    """The camera of a viewer.

    Parameters
    ----------
    viewer : Viewer
    """
    scene = getattr(viewer, "scene", None)
    return viewer.camera if scene is None else scene.camera

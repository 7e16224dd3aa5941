"""The viewer itself, where napari hands its plugins one in a wrapping."""

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

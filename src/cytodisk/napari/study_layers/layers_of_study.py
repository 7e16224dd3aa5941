"""The layers of a study, as napari takes them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from cytodisk.napari.study_layers.feature_table import window_features
from cytodisk.napari.study_layers.frame_stack import FrameStack
from cytodisk.napari.study_layers.study_in_viewer import ShownStudy
from cytodisk.napari.study_layers.study_place import MARK, StudyPlace
from cytodisk.plot.style import SIGNAL_COLOURS

LayerData = tuple[Any, dict[str, Any], str]

_LINE_COLOUR = "white"
_LINES, _EDGES, _POINTS = 600.0, 100.0, 80.0  # thin lines, coloured edges and points: in a cell so many


def layer_data(shown: ShownStudy, place: StudyPlace) -> list[LayerData]:
    """Layers of a study, from the lowest to the uppermost.

    Parameters
    ----------
    shown : ShownStudy
    place : StudyPlace
        Where they lie.

    Returns
    -------
    list of (data, settings, kind)
        Empty for a study without maps.
    """
    return list(_layers(shown, place)) if shown.cells.mapped else []


def _layers(shown: ShownStudy, place: StudyPlace) -> Iterator[LayerData]:
    first = min(shown.cells.mapped)
    painted, size = shown.painted, shown.cells.diameter_px

    def settings(role: str, name: str, **more: Any) -> dict[str, Any]:
        mark = {"study": str(shown.study.path), "role": role, "cell": None, "shown": shown}
        return place.settings | {"name": name, "metadata": {MARK: mark}} | more

    def stack(frame: Any, dtype: Any) -> Any:
        if not shown.cells.is_stack:
            return frame(first)
        return FrameStack(frame, (shown.cells.n_frames, *painted.shape), dtype)

    if shown.channels:
        yield (
            stack(lambda frame: painted.painted(frame, shown.channel), np.float32),
            settings(
                "values",
                f"means of {shown.channel}",
                colormap=SIGNAL_COLOURS,
                contrast_limits=shown.limits(shown.channel),
                visible=not place.beside,
            ),
            "image",
        )
    points, features = shown.lines.points(first)
    yield (
        points,
        settings("points", "points of the edge", features=features, size=size / _POINTS, visible=False),
        "points",
    )
    look = {"edge_width": size / _LINES, "edge_color": _LINE_COLOUR, "vector_style": "line", "opacity": 0.7}
    yield shown.lines.windows(first), settings("outlines", "borders of windows", **look), "vectors"
    if shown.study.is_movie:
        lines, colours = shown.lines.edge(first, shown.top_speed)
        look = {"edge_width": size / _EDGES, "edge_color": colours, "vector_style": "line", "opacity": 1.0}
        yield lines, settings("velocity", _velocity_name(shown), **look), "vectors"
    yield (
        stack(painted.labels, painted.dtype),
        settings("windows", "windows", features=window_features(painted, first), opacity=0.0),
        "labels",
    )


def _velocity_name(shown: ShownStudy) -> str:
    top = f"{shown.top_speed:.2g} {shown.unit('velocity')}"
    return f"velocity of the edge (red out, blue in, to {top})"

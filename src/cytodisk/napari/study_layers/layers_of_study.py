"""The layers of a study, as napari takes them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from cytodisk.napari.given.layer_kinds import MARK
from cytodisk.napari.study_layers.feature_table import window_features
from cytodisk.napari.study_layers.frame_stack import FrameStack
from cytodisk.napari.study_layers.study_in_viewer import ShownStudy
from cytodisk.napari.study_layers.study_place import StudyPlace
from cytodisk.plot.style import SIGNAL_COLOURS

LayerData = tuple[Any, dict[str, Any], str]

LINE_LOOK = {"edge_color": "#b4b4b4", "vector_style": "line", "opacity": 0.8}
"""Of lines between windows: they show on a black canvas and on a white one."""
_MARK_ON_SCREEN = 9  # of the screen's points
_NUCLEUS_COLOUR, _NUCLEI = "cyan", 2.0  # times as wide as lines
_MARK_LOOK: dict[str, Any] = {
    "size": _MARK_ON_SCREEN,
    "canvas_size_limits": (_MARK_ON_SCREEN, _MARK_ON_SCREEN),
    "face_color": "white",
    "border_color": "black",
    "border_width": 0.15,
}
_EDGES, _POINTS = 100.0, 80.0  # coloured edges, and points, that side by side are as wide as a cell
_LINES_ON_SCREEN, _FINEST_LINES, _WIDEST_LINES = 900.0, 600.0, 150.0


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
    look: dict[str, Any] = LINE_LOOK | {"edge_width": line_width(size, painted.shape)}
    borders = shown.lines.windows(first)
    name = "outlines (too many windows for lines)" if first in shown.lines.crowded else "borders of windows"
    yield borders, settings("outlines", name, **look), "vectors"
    if painted.windows.grid.nucleus_layers:
        look |= {"edge_width": _NUCLEI * look["edge_width"], "edge_color": _NUCLEUS_COLOUR}
        yield shown.lines.nuclei(first), settings("nuclei", "outlines of nuclei", **look), "vectors"
    if shown.study.is_movie:
        lines, colours = shown.lines.edge(first, shown.top_speed)
        look = {"edge_width": size / _EDGES, "edge_color": colours, "vector_style": "line", "opacity": 1.0}
        yield lines, settings("velocity", _velocity_name(shown), **look), "vectors"
    points, features = shown.lines.points(first)
    look = {"features": features, "size": size / _POINTS, "visible": False}
    yield points, settings("points", "points of the edge", **look), "points"
    yield shown.lines.sector_0(first), settings("sector 0", "sector 0", **_MARK_LOOK), "points"
    yield (
        stack(painted.labels, painted.dtype),
        settings("windows", "windows", features=window_features(painted, first), opacity=0.0),
        "labels",
    )


def line_width(diameter_px: float, shape: tuple[int, int]) -> float:
    """Width of a line in pixels of an image, that can be seen when the whole of it is on the screen.

    Parameters
    ----------
    diameter_px : float
        Of a cell, in which lines stay thin.
    shape : (int, int)
        Of the image.
    """
    wide = max(shape) / _LINES_ON_SCREEN
    return float(np.clip(wide, diameter_px / _FINEST_LINES, diameter_px / _WIDEST_LINES))


def _velocity_name(shown: ShownStudy) -> str:
    unit = shown.study.scale.shown_velocity(shown.top_speed, shown.cells.n_frames)
    return f"velocity of the edge (red out, blue in, to {shown.top_speed * unit.factor:.2g} {unit.name})"

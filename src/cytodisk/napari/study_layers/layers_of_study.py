"""The layers of a study, as napari takes them, and how they get into a viewer."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from cytodisk.napari.study_layers.edge_points import edge_points
from cytodisk.napari.study_layers.feature_table import window_features
from cytodisk.napari.study_layers.frame_stack import FrameStack
from cytodisk.napari.study_layers.layer_places import MARK, LayerPlace, place_of
from cytodisk.napari.study_layers.shown_study import ShownStudy
from cytodisk.napari.study_layers.window_lines import edge_lines, window_lines
from cytodisk.napari.viewer_parts import Layer, show_warning
from cytodisk.plot.style import SIGNAL_COLOURS
from cytodisk.store.study import Study

LayerData = tuple[Any, dict[str, Any], str]

_LINE_COLOUR = "white"
_LINES, _EDGES, _POINTS = 600.0, 100.0, 80.0  # thin lines, coloured edges and points: in a cell so many


def show_study(viewer: Any, study: Study, *, source: str | None = None) -> ShownStudy:
    """Add a study's results to a viewer.

    Parameters
    ----------
    viewer : Viewer
    study : Study
    source : str, optional
        The file of masks whose cells are shown, of a study of many; by default the first.

    Returns
    -------
    ShownStudy

    Raises
    ------
    ParameterError
        The study has no such source.
    """
    shown = ShownStudy(study, source)
    for data in layer_data(shown, place_of(shown.cells, viewer.layers)):
        layer = Layer.create(*data)
        viewer.add_layer(layer)
        shown.bind(viewer, layer)
    if words := shown.cells.missing_words:
        show_warning(words)
    return shown


def shown_studies(viewer: Any) -> list[ShownStudy]:
    """Studies whose layers are open in a viewer, in the order of the layers.

    Parameters
    ----------
    viewer : Viewer

    Returns
    -------
    list of ShownStudy
    """
    found: dict[int, ShownStudy] = {}
    for layer in viewer.layers:
        shown = layer.metadata.get(MARK, {}).get("shown")
        if shown is not None and shown.viewer is viewer:
            found[id(shown)] = shown
    return list(found.values())


def layer_data(shown: ShownStudy, place: LayerPlace) -> list[LayerData]:
    """Layers of a study, from the lowest to the uppermost.

    Parameters
    ----------
    shown : ShownStudy
    place : LayerPlace
        Where they lie.

    Returns
    -------
    list of (data, settings, kind)
        Empty for a study without maps.
    """
    return list(_layers(shown, place)) if shown.cells.mapped else []


def _layers(shown: ShownStudy, place: LayerPlace) -> Iterator[LayerData]:
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
    points, features = edge_points(painted, first)
    yield (
        points,
        settings("points", "points of the edge", features=features, size=size / _POINTS, visible=False),
        "points",
    )
    lines, features = window_lines(painted, first)
    look = {"edge_width": size / _LINES, "edge_color": _LINE_COLOUR, "vector_style": "line", "opacity": 0.7}
    yield lines, settings("outlines", "borders of windows", features=features, **look), "vectors"
    if shown.study.is_movie:
        lines, colours = edge_lines(painted, first, shown.top_speed)
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

"""Correlations of windows as layers: peaks as colours, and the outline of those that are significant."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.napari.study_layers.frame_stack import FrameStack
from cytodisk.napari.study_layers.shown_study import ShownStudy
from cytodisk.napari.study_layers.study_place import MARK
from cytodisk.plot.style import DIVERGING_COLOURS
from cytodisk.store.correlation_store import Correlation, titled

_SIGNIFICANT = 0.05
_OUTLINE = "black"


def add_peak_layers(viewer: Any, shown: ShownStudy, found: Correlation) -> list[Any]:
    """Add the peaks of a correlation by window, and outline the windows whose q is below 0.05.

    Parameters
    ----------
    viewer : Viewer
    shown : ShownStudy
        The study, in that viewer.
    found : Correlation

    Returns
    -------
    list of Layer
        Colours, then outlines; no outlines where no window is significant.
    """
    selected = set(viewer.layers.selection)
    peaks = by_window(found, "correlation")
    largest = max((float(np.nanmax(np.abs(one), initial=0.0)) for one in peaks.values()), default=0.0)
    limit = max(0.1, np.ceil(10 * largest) / 10)
    name = titled(found.signal, found.with_, found.name)
    added = [
        viewer.add_image(
            _stack(shown, lambda frame: _painted(shown, frame, peaks), np.float32),
            **_settings(shown, f"{name}: peak r (red +, blue −, to {limit:g})", "correlation"),
            colormap=DIVERGING_COLOURS,
            contrast_limits=(-limit, limit),
        )
    ]
    significant = {cell: q < _SIGNIFICANT for cell, q in by_window(found, "q").items()}
    if any(one.any() for one in significant.values()):
        layer = viewer.add_labels(
            _stack(shown, lambda frame: _marked(shown, frame, significant), np.uint8),
            **_settings(shown, f"{name}: q < {_SIGNIFICANT}", "significant"),
            colormap={None: "transparent", 0: "transparent", 1: _OUTLINE},
            opacity=1.0,
        )
        layer.contour = 1
        layer.editable = False
        added.append(layer)
    viewer.layers.move_multiple([viewer.layers.index(one) for one in added], _above_values(viewer, shown))
    viewer.layers.selection = selected  # what the status bar tells stays
    return added


def _above_values(viewer: Any, shown: ShownStudy) -> int:
    """The place below the borders of windows, and what lies above them."""
    upper = [layer for role, layer in shown.layers.items() if role not in ("values", "signal")]
    return min(int(viewer.layers.index(layer)) for layer in upper)


def by_window(found: Correlation, column: str) -> dict[int, FloatArray]:
    """A column of the table of windows by cell, each of shape (layers, sectors); empty if there is none."""
    if column not in found.windows:
        return {}
    shown: dict[int, FloatArray] = {}
    for cell, rows in found.windows.groupby("cell"):
        layers, sectors = int(rows["layer"].max()) + 1, int(rows["sector"].max()) + 1
        values = np.full((layers, sectors), np.nan)
        values[rows["layer"], rows["sector"]] = rows[column]
        shown[int(str(cell))] = values
    return shown


def _stack(shown: ShownStudy, frame: Callable[[int], Any], dtype: Any) -> Any:
    return FrameStack(frame, (shown.cells.n_frames, *shown.painted.shape), dtype)


def _painted(shown: ShownStudy, frame: int, values: Mapping[int, FloatArray]) -> Any:
    """Values of windows in the pixels of a frame; NaN elsewhere."""
    return _in_windows(shown, frame, values, np.float32(np.nan))


def _marked(shown: ShownStudy, frame: int, marks: Mapping[int, Any]) -> Any:
    """1 in the windows that are marked, 0 elsewhere."""
    return _in_windows(shown, frame, marks, np.uint8(0))


def _in_windows(shown: ShownStudy, frame: int, values: Mapping[int, Any], nothing: Any) -> Any:
    painted, grid = shown.painted, shown.painted.windows.grid
    colours = np.full(1 + shown.cells.most_places * painted.n_windows, nothing)
    for cell in shown.cells.mapped.get(frame, ()):
        if cell in values:
            own = np.full((grid.layers, grid.sectors), nothing)
            layers, sectors = values[cell].shape
            own[:layers, :sectors] = values[cell]
            first = painted.first_label(cell, frame)
            colours[first : first + own.size] = own.ravel()
    return colours[painted.labels(frame)]


def _settings(shown: ShownStudy, name: str, role: str) -> dict[str, Any]:
    mark = {"study": str(shown.study.path), "role": role, "cell": None}
    like = shown.layers["windows"]
    place = {"scale": like.scale, "translate": like.translate, "units": like.units}
    return place | {"name": name, "metadata": {MARK: mark}}

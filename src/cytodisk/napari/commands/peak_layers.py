"""Correlations of windows as layers: peaks as colours, and the outline of those that are significant."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from cytodisk.napari.given.layer_kinds import MARK
from cytodisk.napari.study_layers.frame_stack import FrameStack
from cytodisk.napari.study_layers.shown_study import ShownStudy
from cytodisk.napari.study_layers.window_peaks import window_peaks
from cytodisk.plot.style import DIVERGING_COLOURS
from cytodisk.store.correlation_store import Correlation, titled
from cytodisk.windows.study_grid import polar_grid_of

_OUTLINE = "black"


def add_peak_layers(viewer: Any, shown: ShownStudy, found: Correlation) -> list[Any]:
    """Add the peaks of a correlation by window, and outline the windows where it is significant.

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
    grid = polar_grid_of(shown.study.provenance)
    peaks = {cell: window_peaks(found, cell, grid) for cell in shown.cells.numbers}
    known = {cell: one for cell, one in peaks.items() if one is not None}
    limit = max((one.limit("correlation") for one in known.values()), default=1.0)
    name = titled(found.signal, found.with_, found.name)
    values = {cell: one.correlation for cell, one in known.items()}
    added = [
        viewer.add_image(
            _stack(shown, values, np.float32(np.nan)),
            **_settings(shown, f"{name}: peak r (red +, blue −, to {limit:g})", "correlation"),
            colormap=DIVERGING_COLOURS,
            contrast_limits=(-limit, limit),
        )
    ]
    significant = {cell: one.significant for cell, one in known.items() if one.significant is not None}
    if any(one.any() for one in significant.values()):
        alpha = next(iter(known.values())).alpha
        layer = viewer.add_labels(
            _stack(shown, significant, np.uint8(0)),
            **_settings(shown, f"{name}: q < {alpha:g}", "significant"),
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


def _stack(shown: ShownStudy, values: Mapping[int, Any], nothing: Any) -> FrameStack:
    """Numbers of windows in the pixels of each frame."""
    shape = (shown.cells.n_frames, *shown.painted.shape)
    return FrameStack(
        lambda frame: shown.painted.of_windows(frame, values.get, nothing), shape, nothing.dtype
    )


def _settings(shown: ShownStudy, name: str, role: str) -> dict[str, Any]:
    mark = {"study": str(shown.study.path), "role": role, "cell": None}
    like = shown.layers["windows"]
    place = {"scale": like.scale, "translate": like.translate, "units": like.units}
    return place | {"name": name, "metadata": {MARK: mark}}

"""A shapes layer written as the outlines of cells (GeoJSON)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.errors import MaskError
from cytodisk.napari.given.places_in_pixels import in_pixels

_CORNER = 0.5  # the file counts from the corner of the first pixel
_AROUND = 64  # points of an ellipse
_WITH_AREA = ("polygon", "rectangle", "ellipse")


def write_shapes(path: Path, layer: Any, image: Any | None) -> list[str]:
    """Write the shapes of a layer, each the outline of a cell.

    Parameters
    ----------
    path : Path
    layer : napari.layers.Shapes
        Of (y, x), or of (t, y, x).
    image : napari.layers.Layer or None
        The layer in whose pixels places are written.

    Returns
    -------
    list of str
        What was left out, in words.

    Raises
    ------
    MaskError
        It holds no shape with an area.
    """
    features, left = [], []
    for number, (kind, points) in enumerate(zip(layer.shape_type, layer.data, strict=True), start=1):
        if kind not in _WITH_AREA:
            left.append(f"{number} ({kind})")
            continue
        points = in_pixels(layer, np.asarray(points, dtype=float), image)
        features.append(_feature(number, _ellipse(points) if kind == "ellipse" else points))
    if not features:
        raise MaskError(
            f"masks: layer {layer.name} holds no polygon, rectangle or ellipse: draw the outline of each cell"
        )
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="utf-8")
    return [f"layer {layer.name}: shapes without an area left out: {', '.join(left)}"] if left else []


def _feature(number: int, points: FloatArray) -> dict[str, Any]:
    ring = (points[:, [-1, -2]] + _CORNER).round(4).tolist()
    frame = round(float(points[:, 0].mean())) if points.shape[1] > 2 else 0
    geometry = {"type": "Polygon", "coordinates": [[*ring, ring[0]]], "plane": {"c": -1, "z": 0, "t": frame}}
    return {"type": "Feature", "geometry": geometry, "properties": {"name": f"shape {number}"}}


def _ellipse(corners: FloatArray) -> FloatArray:
    """Points on the ellipse within four corners."""
    angle = np.linspace(0, 2 * np.pi, _AROUND, endpoint=False)[:, None]
    middle, one, other = corners.mean(axis=0), corners[1] - corners[0], corners[3] - corners[0]
    return np.asarray(middle + np.cos(angle) * one / 2 + np.sin(angle) * other / 2)

"""GeoJSON with outlines of cells, as QuPath exports it."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.errors import ReadError
from cytodisk.images.formats.outlined.outline_file import open_outlines
from cytodisk.images.formats.outlined.outline_set import Outline, OutlineSet
from cytodisk.images.frame_file import FileChoice, FrameFile

_CORNER = 0.5  # QuPath counts from the corner of the first pixel
_CELLS = ("cell", "detection")  # kinds of objects that are cells, where a file has annotations as well
_REGIONS = ("annotation", "tma_core", "tile", "root")


def open_geojson(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at outlines in GeoJSON as label images; see `cytodisk.images.frames.open_frames`."""
    return open_outlines(file, read_geojson, choice)


def read_geojson(path: Path) -> OutlineSet:
    """The outlines of a GeoJSON file.

    Parameters
    ----------
    path : Path

    Returns
    -------
    OutlineSet
        Of a file with cells or detections of QuPath, those alone: its annotations are regions around them.

    Raises
    ------
    ReadError
        The file is no GeoJSON, is damaged, or holds no polygon.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise ReadError(f"{path} is no GeoJSON, or is cut short ({error}): export it again") from error
    found: list[tuple[str, Outline]] = []
    without_area: Counter[str] = Counter()
    for number, (geometry, properties) in enumerate(_features(path, content), start=1):
        place = f"{path}: feature {number}"
        rings = _rings(place, geometry)
        if not rings:
            without_area[str(geometry.get("type"))] += 1
            continue
        frame, slice_ = _plane(place, geometry, properties)
        found.append((_kind(properties), Outline(tuple(rings), _name(properties, number), frame, slice_)))
    remarks = []
    if without_area:
        kinds = ", ".join(f"{number} × {kind}" for kind, number in without_area.items())
        remarks.append(f"objects without an area left out: {kinds}")
    cells = [one for kind, one in found if kind in _CELLS]
    regions = [one for kind, one in found if kind in _REGIONS]
    if cells and regions:
        remarks.append(
            f"{len(regions)} annotation{'s' if len(regions) > 1 else ''} left out beside {len(cells)} cells "
            "or detections: they are taken for regions; export them alone to measure them"
        )
        found = [(kind, one) for kind, one in found if kind not in _REGIONS]
    if not found:
        raise ReadError(f"{path} holds no polygon: {'; '.join(remarks) or 'it is empty'}")
    return OutlineSet(tuple(one for _, one in found), tuple(remarks))


def _features(path: Path, content: Any) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """Geometry and properties of each object."""
    if isinstance(content, list):
        for one in content:
            yield from _features(path, one)
        return
    kind = content.get("type") if isinstance(content, dict) else None
    if kind == "FeatureCollection":
        yield from _features(path, content.get("features") or [])
    elif kind == "Feature":
        geometry, properties = content.get("geometry"), content.get("properties")
        if isinstance(geometry, dict):
            yield geometry, properties if isinstance(properties, dict) else {}
    elif kind == "GeometryCollection":
        yield from _features(path, content.get("geometries") or [])
    elif isinstance(content, dict) and "coordinates" in content:
        yield content, {}
    else:
        raise ReadError(f"{path} is no GeoJSON: it holds {type(content).__name__} where a feature is due")


def _rings(place: str, geometry: dict[str, Any]) -> list[FloatArray]:
    """Closed polygons of a geometry; none if it has no area."""
    kind, coordinates = geometry.get("type"), geometry.get("coordinates")
    if kind == "GeometryCollection":
        parts = geometry.get("geometries")
        return [ring for part in parts or [] if isinstance(part, dict) for ring in _rings(place, part)]
    if kind not in ("Polygon", "MultiPolygon"):
        return []
    polygons = [coordinates] if kind == "Polygon" else coordinates
    if not isinstance(polygons, list) or not all(isinstance(one, list) for one in polygons):
        raise ReadError(f"{place} has no list of coordinates: export the file again")
    return [_ring(place, ring) for polygon in polygons for ring in polygon]


def _ring(place: str, ring: Any) -> FloatArray:
    try:
        points = np.array([(point[0], point[1]) for point in ring]).reshape(-1, 2)
    except (TypeError, ValueError, IndexError, KeyError) as error:
        raise ReadError(
            f"{place} has coordinates that are no points (x, y): export the file again"
        ) from error
    if points.dtype.kind not in "iuf" or not np.isfinite(points).all():
        raise ReadError(f"{place} has coordinates that are no finite numbers: export the file again")
    return np.asarray(points[:, ::-1] - _CORNER, dtype=float)


def _plane(place: str, geometry: dict[str, Any], properties: dict[str, Any]) -> tuple[int | None, int | None]:
    """Frame and slice, from 0; objects without a plane stand in the first one."""
    plane = geometry.get("plane") or properties.get("plane") or {}
    if not isinstance(plane, dict):
        raise ReadError(f"{place} has the plane {plane!r}, not one with c, z and t: export the file again")
    numbers = [plane.get(axis, 0) for axis in "tz"]
    if not all(type(number) is int and 0 <= number < 2**31 for number in numbers):
        raise ReadError(f"{place} has the plane {plane!r}: t and z must be whole numbers from 0")
    return numbers[0], numbers[1]


def _kind(properties: dict[str, Any]) -> str:
    kind = properties.get("objectType", properties.get("object_type", ""))
    return str(kind).lower()


def _name(properties: dict[str, Any], number: int) -> str:
    name = properties.get("name")
    return name if isinstance(name, str) and name else f"feature {number}"

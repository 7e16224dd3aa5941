"""GEFF, the Graph Exchange File Format for tracks, read by its specification through zarr."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import zarr

from cytodisk.arrays import AnyArray, FloatArray, IntArray
from cytodisk.errors import ReadError
from cytodisk.images.reading import reading
from cytodisk.images.spots.spots import PIXEL, Spots
from cytodisk.images.spots.track_units import frame_interval_s, length_unit, pixel_size_um
from cytodisk.scale import Scale

_METADATA = "geff"
_LABELS = "seg_id"  # how a property is called that holds labels, unless the file says otherwise
_MOST_BYTES = 2**31
_MOST_FOR_A_BYTE = 4096  # bytes that a stored one can stand for


@dataclass(frozen=True)
class _Axis:
    name: str
    unit: str
    scale: float | None


def read_geff(path: Path, interval_s: float | None = None) -> Spots:
    """The tracks of a GEFF.

    Parameters
    ----------
    path : Path
        Folder of the zarr group, or of one that holds it.
    interval_s : float, optional
        Seconds between frames, to tell frames from times.

    Returns
    -------
    Spots

    Raises
    ------
    ReadError
        The folder is no GEFF, is damaged, or lacks what is needed of it.
    """
    with reading(path, "its graph"):
        group, about = _graph(path)
        ids = _array(path, group, "nodes/ids")
        ends = _array(path, group, "edges/ids")
        if not len(ids):
            raise ReadError(f"{path} holds no node: export tracks")
        links = _links(path, ids, ends)
        time, row, column, more = _axes(path, group, about)
        props = {axis.name: _numbers(path, group, axis.name, len(ids)) for axis in (time, row, column, *more)}
        frame, remark = _frames(path, props[time.name], time.unit, interval_s)
        remarks = [remark] if remark else []
        if any(np.ptp(props[axis.name]) > 0 for axis in more):
            remarks.append(f"positions along {more[0].name} are left out: the movie has two dimensions")
        names, linked = _tracklets(path, group, about, len(ids)), _linked(len(ids), links)
        alone = len(ids) - int(linked.sum())
        if alone:
            remarks.append(f"{alone} of {len(ids)} nodes have no link: each is a track of one frame")
        labels = _labels(path, group, about, len(ids))
    known = row.scale is not None and column.scale is not None and row.unit == PIXEL
    scale = column.scale if known and np.isclose(row.scale or 0, column.scale or 1, rtol=0.01) else None
    return Spots(
        path,
        frame,
        np.column_stack([props[row.name], props[column.name]]),
        _radius(path, group, about, len(ids)),
        names,
        links,
        (None,) * len(ids),
        labels,
        unit=row.unit,
        scale=Scale(scale, None),
        remarks=tuple(remarks),
    )


def _graph(path: Path) -> tuple[zarr.Group, Mapping[str, Any]]:
    """The group of the graph, and its metadata."""
    root = zarr.open_group(str(path), mode="r")
    if isinstance(root.attrs.get(_METADATA), dict):
        return root, root.attrs[_METADATA]  # type: ignore[return-value]
    held = {name: part for name, part in root.groups() if isinstance(part.attrs.get(_METADATA), dict)}
    if len(held) == 1:
        part = next(iter(held.values()))
        return part, part.attrs[_METADATA]  # type: ignore[return-value]
    if held:
        raise ReadError(f"{path} holds several graphs: pass one of them, as {path / sorted(held)[0]}")
    raise ReadError(f"{path} is no GEFF: the zarr group has no attribute 'geff'; export the tracks again")


def _array(path: Path, group: zarr.Group, name: str) -> AnyArray:
    """An array of the graph, whose size is compared with what is stored."""
    if name not in group:
        raise ReadError(f"{path} has no array {name}: export the tracks again")
    array = group[name]
    if not isinstance(array, zarr.Array):
        raise ReadError(f"{path}: {name} is a group where an array is due: export the tracks again")
    stored = array.nbytes_stored()
    if array.nbytes > min(_MOST_BYTES, (stored + 2**12) * _MOST_FOR_A_BYTE):
        raise ReadError(
            f"{path}: {name} claims {array.nbytes} bytes of {stored} that are stored: it is damaged"
        )
    return np.asarray(array[...])


def _numbers(path: Path, group: zarr.Group, name: str, count: int) -> FloatArray:
    """A property that every node must have."""
    values = _array(path, group, f"nodes/props/{name}/values")
    if values.shape != (count,) or values.dtype.kind not in "iuf":
        raise ReadError(
            f"{path}: {name} has shape {values.shape} and dtype {values.dtype}, not {count} numbers: "
            "export the tracks again"
        )
    if not np.isfinite(values).all() or _is_missing(path, group, name).any():
        raise ReadError(
            f"{path}: {name} is missing, or no finite number, for some nodes: export the tracks again"
        )
    return values.astype(float)


def _is_missing(path: Path, group: zarr.Group, name: str) -> AnyArray:
    place = f"nodes/props/{name}/missing"
    return _array(path, group, place).astype(bool) if place in group else np.zeros(1, dtype=bool)


def _whole_numbers(path: Path, group: zarr.Group, name: Any, count: int) -> IntArray | None:
    """A property with whole numbers, 0 where it is missing; None if there is no such one."""
    if not isinstance(name, str) or f"nodes/props/{name}/values" not in group:
        return None
    values = _array(path, group, f"nodes/props/{name}/values")
    if values.shape != (count,) or values.dtype.kind not in "iuf" or (values != np.floor(values)).any():
        return None
    return np.where(_is_missing(path, group, name), 0, values).astype(np.int64)


def _links(path: Path, ids: AnyArray, ends: AnyArray) -> IntArray:
    """Pairs of places of nodes."""
    order = np.argsort(ids)
    pairs = ends.reshape(-1, 2)
    place = np.searchsorted(ids, pairs, sorter=order).clip(max=len(ids) - 1)
    found: IntArray = order[place]
    if (ids[found] != pairs).any():
        raise ReadError(f"{path} has edges to nodes that it has not: export the tracks again")
    return found


def _linked(count: int, links: IntArray) -> AnyArray:
    return np.bincount(links.ravel(), minlength=count) > 0


def _axes(path: Path, group: zarr.Group, about: Mapping[str, Any]) -> tuple[_Axis, _Axis, _Axis, list[_Axis]]:
    """Those of time, row and column, and others of space."""
    said = [axis for axis in about.get("axes") or [] if isinstance(axis, dict) and "name" in axis]
    if not said:
        names = ("t", "y", "x")
        if not all(f"nodes/props/{name}/values" in group for name in names):
            raise ReadError(
                f"{path} names no axes, nor properties t, y and x: export the tracks with their axes"
            )
        time, row, column = (_Axis(name, PIXEL if name != "t" else "", None) for name in names)
        return time, row, column, []
    times = [axis for axis in said if axis.get("type") == "time"]
    space = [axis for axis in said if axis.get("type") in ("space", None)]
    if len(times) != 1 or len(space) not in (2, 3):
        raise ReadError(
            f"{path} has the axes {', '.join(str(axis['name']) for axis in said)}: one of time and two or "
            "three of space are needed"
        )
    hints = about.get("display_hints") or {}
    down = _named(space, hints.get("display_vertical"), "y", -2)
    across = _named(space, hints.get("display_horizontal"), "x", -1)
    others = [axis for axis in space if axis is not down and axis is not across]
    named = [_axis(group, *pair) for pair in ((times[0], "t"), (down, "y"), (across, "x"))]
    return named[0], named[1], named[2], [_axis(group, axis, "z") for axis in others]


def _named(space: list[dict[str, Any]], hint: Any, ending: str, place: int) -> dict[str, Any]:
    for axis in space:
        if axis["name"] == hint:
            return axis
    ends = [axis for axis in space if str(axis["name"]).lower().endswith(ending)]
    return ends[0] if len(ends) == 1 else space[place]


def _axis(group: zarr.Group, said: dict[str, Any], usual: str) -> _Axis:
    """An axis; TrackMate writes its positions under the usual name, whatever it calls the axis."""
    name = str(said["name"])
    if f"nodes/props/{name}/values" not in group and f"nodes/props/{usual}/values" in group:
        name = usual
    unit = str(said.get("unit") or "")
    scale = said.get("scale")
    scaled_unit = length_unit(str(said.get("scaled_unit") or ""))
    known = pixel_size_um((scale, scale), scaled_unit) if isinstance(scale, int | float) else None
    return _Axis(name, unit if said.get("type") == "time" else length_unit(unit), known)


def _frames(path: Path, time: FloatArray, unit: str, interval_s: float | None) -> tuple[IntArray, str]:
    """Numbers of frames, and a remark on them."""
    seconds = frame_interval_s("1", unit)
    step = None if seconds is None or interval_s is None else interval_s / seconds
    whole = bool((time == np.floor(time)).all() and (time >= 0).all() and time.max() < 2**31)
    if whole:
        frames = time.astype(np.int64)
        apart = int(np.gcd.reduce(frames))
        if step is not None and apart > 1 and np.isclose(apart, step, rtol=0.01):
            return frames // apart, ""
        words = f"tracks stand on every {apart}th frame: are they times? Then pass the frame interval"
        return frames, words if apart > 1 and len(np.unique(frames)) > 2 else ""
    if step is None:
        raise ReadError(
            f"{path} has times that are no whole frames: pass the time between frames (--frame-interval)"
        )
    numbers = time / step
    if (np.abs(numbers - np.round(numbers)) > 0.05).any() or numbers.min() < -0.05:
        raise ReadError(
            f"{path} has times that do not lie on frames {step:g} {unit} apart: pass the right time between "
            "frames (--frame-interval)"
        )
    return np.round(numbers).astype(np.int64), ""


def _tracklets(path: Path, group: zarr.Group, about: Mapping[str, Any], count: int) -> IntArray:
    """Numbers that the file gives to tracks, 0 where it gives none."""
    props = about.get("track_node_props") or {}
    for kind in ("tracklet", "lineage"):
        numbers = _whole_numbers(path, group, props.get(kind), count)
        if numbers is not None and numbers.min() >= 0:
            return numbers
    return np.zeros(count, dtype=np.int64)


def _labels(path: Path, group: zarr.Group, about: Mapping[str, Any], count: int) -> IntArray | None:
    """Labels of the nodes, where the file says them."""
    related = about.get("related_objects") or []
    said = [one.get("label_prop") for one in related if isinstance(one, dict) and one.get("type") == "labels"]
    for name in (*said, _LABELS):
        found = _whole_numbers(path, group, name, count)
        if found is not None:
            return found
    return None


def _radius(path: Path, group: zarr.Group, about: Mapping[str, Any], count: int) -> FloatArray:
    name = about.get("sphere") or "radius"
    if not isinstance(name, str) or f"nodes/props/{name}/values" not in group:
        return np.full(count, np.nan)
    values = _array(path, group, f"nodes/props/{name}/values")
    return (
        values.astype(float)
        if values.shape == (count,) and values.dtype.kind in "iuf"
        else np.full(count, np.nan)
    )

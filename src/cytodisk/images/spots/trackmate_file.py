"""XML files of TrackMate: a whole session, or its tracks alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.errors import ReadError
from cytodisk.images.spots.spots import Spots
from cytodisk.images.spots.track_units import frame_interval_s, length_unit, pixel_size_um
from cytodisk.scale import Scale

_SESSION, _TRACKS = "TrackMate", "Tracks"  # kinds of files, by their root


def read_trackmate(path: Path) -> Spots:
    """The tracks of a file of TrackMate.

    Parameters
    ----------
    path : Path
        A session (saved by TrackMate), or tracks exported to XML.

    Returns
    -------
    Spots
        Of tracks that TrackMate shows; those that it filters out, and spots in no track, are left out.

    Raises
    ------
    ReadError
        The file is no XML of TrackMate, or is damaged.

    Notes
    -----
    A file with a document type is refused, so that no entities are expanded and no other file is read.
    """
    found = _Found()
    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = _refuse_doctype
    parser.StartElementHandler = found.start
    parser.EndElementHandler = found.end
    parser.CharacterDataHandler = found.text
    try:
        with path.open("rb") as file:
            parser.ParseFile(file)
    except expat.ExpatError as error:
        raise ReadError(f"{path} is no XML file, or is cut short ({error}): save it again") from error
    except (_FaultError, ValueError, KeyError) as error:
        words = f"has no {error.args[0]}" if isinstance(error, KeyError) else str(error)
        line = parser.CurrentLineNumber
        raise ReadError(f"{path}, line {line}: {words}: save it again with TrackMate") from error
    except LookupError as error:  # of its coding
        raise ReadError(f"{path} cannot be read ({error}): save it again with TrackMate") from error
    return _session(path, found) if found.root == _SESSION else _exported(path, found)


class _FaultError(Exception):
    """What is wrong with an element."""


def _refuse_doctype(*_: Any) -> None:
    raise _FaultError("the file has a document type, which files of TrackMate have not")


@dataclass
class _Found:
    """What is collected of a file."""

    root: str = ""
    elements: dict[str, dict[str, str]] = field(default_factory=dict)  # those that stand once
    spots: list[tuple[int, float, float, float, FloatArray | None]] = field(default_factory=list)
    ids: dict[int, int] = field(default_factory=dict)  # of spots: their place
    links: list[tuple[int, int, int]] = field(default_factory=list)  # two spots, track
    shown: set[int] = field(default_factory=set)
    particles: int = 0
    _frame: str = ""
    _track: int = 0
    _spot: dict[str, str] | None = None
    _text: list[str] = field(default_factory=list)

    def start(self, name: str, attributes: dict[str, str]) -> None:
        """Take in the start of an element."""
        if not self.root:
            if name not in (_SESSION, _TRACKS):
                raise _FaultError(f"the file begins with <{name}>, not with <{_SESSION}>")
            self.root = name
        if name in (_TRACKS, "Model", "ImageData", "FilteredTracks"):
            self.elements[name] = attributes
        elif name == "SpotsInFrame":
            self._frame = attributes["frame"]
        elif name == "Spot":
            self._spot, self._text = attributes, []
        elif name == "Track":
            self._track = _whole(attributes, "TRACK_ID")
        elif name == "TrackID":
            self.shown.add(_whole(attributes, "TRACK_ID"))
        elif name == "Edge":
            ends = _whole(attributes, "SPOT_SOURCE_ID"), _whole(attributes, "SPOT_TARGET_ID")
            self.links.append((*ends, self._track))
        elif name == "particle":
            self.particles += 1
        elif name == "detection":
            place = _number(attributes, "y"), _number(attributes, "x")
            self.spots.append((_whole(attributes, "t"), *place, float(self.particles), None))

    def text(self, content: str) -> None:
        """Take in text."""
        if self._spot is not None:
            self._text.append(content)

    def end(self, name: str) -> None:
        """Take in the end of an element."""
        if name != "Spot" or self._spot is None:
            return
        spot, self._spot = self._spot, None
        frame = _whole({"frame": spot.get("FRAME", self._frame)}, "frame")
        place = _number(spot, "POSITION_Y"), _number(spot, "POSITION_X")
        radius = _number(spot, "RADIUS") if "RADIUS" in spot else np.nan
        outline = _outline(spot, "".join(self._text), place)
        self.ids[_whole(spot, "ID")] = len(self.spots)
        self.spots.append((frame, *place, radius, outline))


def _number(attributes: Mapping[str, str], name: str) -> float:
    value = float(attributes[name])
    if not np.isfinite(value):
        raise _FaultError(f"{name} is {attributes[name]}")
    return value


def _whole(attributes: Mapping[str, str], name: str) -> int:
    value = _number(attributes, name)
    if not value.is_integer() or not 0 <= value < 2**31:
        raise _FaultError(f"{name} is {attributes[name]}, no whole number from 0")
    return int(value)


def _outline(spot: dict[str, str], text: str, place: tuple[float, float]) -> FloatArray | None:
    """Outline of a spot, of which the file has (x, y) from its centre."""
    if "ROI_N_POINTS" not in spot or not text.strip():
        return None
    values = np.array(text.split(), dtype=float)
    if len(values) % 2 or not np.isfinite(values).all():
        raise _FaultError("an outline has no pairs of numbers")
    points = values.reshape(-1, 2)
    if len(points) != _whole(spot, "ROI_N_POINTS"):
        raise _FaultError(f"an outline has {len(points)} points, not {spot['ROI_N_POINTS']}")
    return np.asarray(points[:, ::-1] + np.array(place))


def _session(path: Path, found: _Found) -> Spots:
    links = [link for link in found.links if link[2] in found.shown or "FilteredTracks" not in found.elements]
    lost = [link for link in links if link[0] not in found.ids or link[1] not in found.ids]
    if lost:
        raise ReadError(f"{path}: {len(lost)} links lead to spots that the file has not: save it again")
    names = np.zeros(len(found.spots), dtype=np.int64)
    pairs = np.array([(found.ids[one], found.ids[other]) for one, other, _ in links], dtype=np.int64)
    pairs = pairs.reshape(-1, 2)
    names[pairs[:, 0]] = names[pairs[:, 1]] = np.array([track for *_, track in links], dtype=np.int64) + 1
    used = np.flatnonzero(names)
    if not used.size:
        raise ReadError(f"{path} holds no track: track the cells in TrackMate, and save again")
    remarks = []
    if len(used) < len(names):
        remarks.append(f"{len(names) - len(used)} of {len(names)} spots are in no track that TrackMate shows")
    place = np.zeros(len(names), dtype=np.int64)
    place[used] = np.arange(len(used))
    spots = [found.spots[spot] for spot in used]
    image, model = found.elements.get("ImageData", {}), found.elements.get("Model", {})
    unit = length_unit(model.get("spatialunits", ""))
    size = _size(image, ("pixelheight", "pixelwidth"))
    shape = _size(image, ("height", "width"))
    interval = frame_interval_s(image.get("timeinterval"), model.get("timeunits", ""))
    return Spots(
        path,
        np.array([spot[0] for spot in spots]),
        np.array([spot[1:3] for spot in spots]),
        np.array([spot[3] for spot in spots]),
        names[used],
        place[pairs],
        tuple(spot[4] for spot in spots),
        unit=unit,
        pixel_size=size,
        image_shape=None if shape is None else (int(shape[0]), int(shape[1])),
        n_frames=int(image["nframes"]) if image.get("nframes", "").isdigit() else None,
        scale=Scale(pixel_size_um(size, unit), interval),
        remarks=tuple(remarks),
    )


def _size(attributes: Mapping[str, str], names: tuple[str, str]) -> tuple[float, float] | None:
    """Two positive numbers, or None where they are missing or wrong."""
    try:
        first, second = (float(attributes[name]) for name in names)
    except (KeyError, ValueError):
        return None
    return (first, second) if 0 < first < np.inf and 0 < second < np.inf else None


def _exported(path: Path, found: _Found) -> Spots:
    """Tracks that were exported alone: each a list of detections."""
    if not found.spots:
        raise ReadError(f"{path} holds no track: track the cells in TrackMate, and export again")
    names = np.array([int(spot[3]) for spot in found.spots])
    frame = np.array([spot[0] for spot in found.spots])
    order = np.lexsort([frame, names])
    links = np.column_stack([order[:-1], order[1:]])
    tracks = found.elements[_TRACKS]
    interval = frame_interval_s(tracks.get("frameInterval"), tracks.get("timeUnits", ""))
    return Spots(
        path,
        frame,
        np.array([spot[1:3] for spot in found.spots]),
        np.full(len(frame), np.nan),
        names,
        links[names[links[:, 0]] == names[links[:, 1]]],
        unit=length_unit(tracks.get("spaceUnits", "")),
        scale=Scale(None, interval),
    )

"""OME-XML: size, order, scale and names of the images of a file, and what of it contradicts itself."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from cytodisk.images.formats.measured_scale import agreed_interval
from cytodisk.images.formats.said_scale import Said, duration, length, square
from cytodisk.images.scale_units import number, seconds
from cytodisk.scale import Scale

_BARE = re.compile(r"&(?!(?:\w+|#\d+|#x[0-9a-fA-F]+);)")
_NOT_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")


@dataclass(frozen=True)
class OmeImage:
    """What OME-XML says of one image.

    Attributes
    ----------
    name : str
    order : str
        Axes outside a plane, slowest first, as "TCZ".
    sizes : mapping
        Size along X, Y, Z, C and T.
    scale : Scale
    channels : tuple of str
        Empty if one lacks its name.
    notes : tuple of str
        What of it is not believed.
    missing : tuple of str
        Names of the files of a set that are not there.
    placed : bool
        It says which page holds which plane; else they follow each other.
    """

    name: str
    order: str
    sizes: Mapping[str, int]
    scale: Scale
    channels: tuple[str, ...]
    notes: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    placed: bool = False

    @property
    def planes(self) -> int:
        """How many there are."""
        return self.sizes["Z"] * self.sizes["C"] * self.sizes["T"]


class OmeError(ValueError):
    """OME-XML that cannot be used, with the reason in words."""


def ome_images(file: Path, xml: str) -> tuple[OmeImage, ...]:
    """The images that OME-XML describes.

    Parameters
    ----------
    file : Path
        It stands in.
    xml : str

    Raises
    ------
    OmeError
        It cannot be used.
    ReadError
        Pixels are not square.
    """
    root = _parsed(xml)
    for element in root:
        if _tag(element) == "BinaryOnly":
            root = _companion(file, element.attrib.get("MetadataFile", ""))
    found = tuple(
        _image(file, image, pixels)
        for image in root.iter()
        if _tag(image) == "Image"
        for pixels in image
        if _tag(pixels) == "Pixels"
    )
    if not found:
        raise OmeError("it describes no image")
    return found


def _parsed(xml: str) -> ElementTree.Element:
    try:
        return ElementTree.fromstring(xml)
    except ElementTree.ParseError as error:
        first = str(error)
    try:  # names that were put in as they were typed are the usual fault
        return ElementTree.fromstring(_BARE.sub("&amp;", _NOT_XML.sub("", xml)))
    except ElementTree.ParseError:
        raise OmeError(f"it is no proper XML: {first}") from None


def _companion(file: Path, name: str) -> ElementTree.Element:
    """The metadata of a file that only has pixels; they stand in another one."""
    beside = file.parent / Path(name.replace("\\", "/")).name
    if not name or not beside.is_file():
        raise OmeError(f"it only names another file that has them, {name!r}, which is not there")
    try:
        return _parsed(beside.read_text(encoding="utf-8", errors="replace"))
    except OSError as error:
        raise OmeError(f"they stand in {beside.name}, which cannot be read: {error.strerror}") from error


def _image(file: Path, image: ElementTree.Element, pixels: ElementTree.Element) -> OmeImage:
    said = pixels.attrib
    sizes = {axis: _size(said.get(f"Size{axis}"), axis) for axis in "XYZCT"}
    order = said.get("DimensionOrder", "XYCZT")[:1:-1]
    if sorted(order) != ["C", "T", "Z"]:
        raise OmeError(f"its DimensionOrder is {said['DimensionOrder']!r}")
    sides = [
        length(
            said.get(f"PhysicalSize{axis}"), said.get(f"PhysicalSize{axis}Unit", "µm"), f"PhysicalSize{axis}"
        )
        for axis in "XY"
    ]
    pixel_size, notes = square(file, sides)
    interval, more = _interval(pixels) if sizes["T"] > 1 else (None, ())
    names = tuple(e.attrib.get("Name", "") for e in pixels if _tag(e) == "Channel")
    return OmeImage(
        image.attrib.get("Name", ""),
        order,
        sizes,
        Scale(pixel_size, interval),
        names if all(names) else (),
        (*notes, *more),
        _missing(file, pixels),
        any(_tag(data) == "TiffData" and data.attrib for data in pixels),
    )


def _size(text: str | None, axis: str) -> int:
    if text is None or not re.fullmatch("[0-9]{1,18}", text.strip()) or int(text) < 1:
        raise OmeError(f"its Size{axis} is {'missing' if text is None else repr(text[:40])}")
    return int(text)


def _interval(pixels: ElementTree.Element) -> Said:
    """The time between frames, as far as what was set and what the planes say agree."""
    said = pixels.attrib
    planned, notes = duration(said.get("TimeIncrement"), said.get("TimeIncrementUnit", "s"), "TimeIncrement")
    times = _times(pixels)
    if len(set(times)) < 2:  # not timed
        return planned, notes
    interval, contradiction = agreed_interval(times, planned, len(times))
    return interval, (*(notes if interval is None else ()), *contradiction)


def _times(pixels: ElementTree.Element) -> list[float]:
    """Seconds of the first frames, up to one that is not timed, by the planes of one channel and slice."""
    times: dict[int, float] = {}
    first: tuple[str, str] | None = None
    for plane in pixels:
        said = plane.attrib
        time, unit = number(said.get("DeltaT")), seconds(said.get("DeltaTUnit", "s"))
        if _tag(plane) != "Plane" or time is None or unit is None or not said.get("TheT", "").isdecimal():
            continue
        place = said.get("TheC", "0"), said.get("TheZ", "0")
        first = first or place
        if place == first:
            times[int(said["TheT"])] = time * unit
    return [times[frame] for frame in range(next(n for n in range(len(times) + 1) if n not in times))]


def _missing(file: Path, pixels: ElementTree.Element) -> tuple[str, ...]:
    """Names of files of a set that are not beside it."""
    named = (e.attrib.get("FileName", "") for data in pixels if _tag(data) == "TiffData" for e in data)
    return tuple(name for name in dict.fromkeys(named) if name and not (file.parent / name).is_file())


def _tag(element: ElementTree.Element) -> str:
    return str(element.tag).rpartition("}")[2]

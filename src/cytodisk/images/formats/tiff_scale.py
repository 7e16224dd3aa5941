"""Scale and names of channels of a TIFF: from OME-XML, ImageJ's description, or its resolution tags."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import tifffile

from cytodisk.images.formats.ome_xml import OmeImage
from cytodisk.images.formats.said_scale import (
    NO_PIXEL_SIZE,
    NOTHING,
    Said,
    duration,
    length,
    print_resolution,
    square,
)
from cytodisk.scale import UNKNOWN, Scale, alike

_TAG_UNITS = {2: "inch", 3: "cm", 4: "mm", 5: "µm"}
_LEAST_UM, _MOST_UM = 1e-3, 10.0  # sides of pixels of a microscope


@dataclass(frozen=True)
class TiffSays:
    """What a TIFF says beside its pixels.

    Attributes
    ----------
    scale : Scale
    channels : tuple of str
        Empty where it does not name them.
    notes : tuple of str
    """

    scale: Scale = UNKNOWN
    channels: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def tiff_says(file: Path, tiff: tifffile.TiffFile, image: OmeImage | None) -> TiffSays:
    """Scale and names of a TIFF.

    Parameters
    ----------
    file : Path
    tiff : tifffile.TiffFile
        Opened.
    image : OmeImage or None
        What its OME metadata say of the image that is read.

    Raises
    ------
    ReadError
        Pixels are not square.
    """
    tags = tag_sides(tiff.pages.first)
    if image is not None:
        return _beside_tags(TiffSays(image.scale, image.channels, image.notes), tags)
    metadata = imagej_metadata(tiff)
    if metadata:
        pixel_size, notes = square(file, _imagej_sides(metadata, tiff.pages.first))
        unit = metadata.get("tunit", "s")
        interval, more = duration(metadata.get("finterval"), unit, "finterval (Frame interval)")
        return TiffSays(Scale(pixel_size, interval), (), (*notes, *more))
    return TiffSays(notes=_unconfirmed(tags))


def imagej_metadata(tiff: tifffile.TiffFile) -> dict[str, Any]:
    """What ImageJ wrote; nothing where it did not, or where that cannot be read."""
    try:
        return dict(tiff.imagej_metadata or {}) if tiff.is_imagej else {}
    except (ValueError, TypeError, IndexError, KeyError):
        return {}


def tag_sides(page: Any) -> tuple[float, float] | None:
    """Sides of a pixel in µm by the resolution tags; None where they say none, or one for printing."""
    units = page.tags.get("ResolutionUnit")
    unit = _TAG_UNITS.get(int(units.value)) if units is not None else None
    sides = [_from_tag(page, name, unit)[0] for name in ("XResolution", "YResolution")] if unit else []
    if len(sides) != 2 or sides[0] is None or sides[1] is None or print_resolution(sides[0]):
        return None
    return sides[0], sides[1]


def _imagej_sides(metadata: dict[str, Any], page: Any) -> list[Said]:
    unit = metadata.get("unit", "")
    units = {"XResolution": unit, "YResolution": metadata.get("yunit", unit)}
    return [_from_tag(page, name, said) for name, said in units.items()]


def _from_tag(page: Any, name: str, unit: Any) -> Said:
    tag = page.tags.get(name)
    if tag is None:
        return NOTHING
    try:
        above, below = tag.value
        value = below / above
    except (TypeError, ValueError, ZeroDivisionError):
        return NOTHING
    return length(value, unit, "pixel size")


def _beside_tags(says: TiffSays, tags: tuple[float, float] | None) -> TiffSays:
    """OME metadata against resolution tags: where they differ, neither is believed."""
    pixel_size = says.scale.pixel_size_um
    if tags is None or pixel_size is None or alike(pixel_size, *tags, ratio=1.02):
        return says
    words = f"its OME metadata say pixels of {pixel_size:.4g} µm, its resolution tags {tags[0]:.4g} µm"
    note = f"{words}: neither is believed; {NO_PIXEL_SIZE}"
    return replace(says, scale=Scale(None, says.scale.frame_interval_s), notes=(*says.notes, note))


def _unconfirmed(tags: tuple[float, float] | None) -> tuple[str, ...]:
    """Tags alone are also what scanners and drawing programs fill in."""
    if tags is None or not _LEAST_UM <= tags[0] <= _MOST_UM or not alike(*tags):
        return ()
    return (
        f"its resolution tags mean pixels of {tags[0]:.4g} µm, which nothing else in it confirms: if that is "
        f"right, pass --pixel-size {tags[0]:.4g}",
    )

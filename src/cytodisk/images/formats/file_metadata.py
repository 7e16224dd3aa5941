"""What the metadata of an image file say: axes, scale and names of channels."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import tifffile

from cytodisk.errors import ReadError
from cytodisk.scale import Scale

_MICROMETRES = {
    "µm": 1.0,
    "um": 1.0,
    "micron": 1.0,
    "microns": 1.0,
    "nm": 1e-3,
    "mm": 1e3,
    "cm": 1e4,
    "m": 1e6,
}
_SECONDS = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0}


def ome_metadata(file: Path, xml: str) -> tuple[Scale, tuple[str, ...]]:
    """Scale of an OME-TIFF, and the names of its channels; no names if one lacks its own.

    Parameters
    ----------
    file : Path
        For messages.
    xml : str
        Its OME metadata.

    Raises
    ------
    ReadError
        Its pixels are not square.
    """
    pixels = next(e for e in ElementTree.fromstring(xml).iter() if e.tag.endswith("}Pixels"))
    sizes = [
        float(pixels.attrib[f"PhysicalSize{axis}"])
        * _MICROMETRES.get(_micro(pixels.attrib.get(f"PhysicalSize{axis}Unit", "µm")), np.nan)
        for axis in "XY"
        if f"PhysicalSize{axis}" in pixels.attrib
    ]
    interval = _seconds(pixels.attrib.get("TimeIncrement"), pixels.attrib.get("TimeIncrementUnit", "s"))
    names = [e.attrib.get("Name", "") for e in pixels if e.tag.endswith("}Channel")]
    return Scale(_square(file, sizes), interval), tuple(names) if all(names) else ()


def imagej_scale(file: Path, tiff: tifffile.TiffFile) -> Scale:
    """Scale of an ImageJ TIFF.

    Raises
    ------
    ReadError
        Its pixels are not square.
    """
    metadata = tiff.imagej_metadata or {}
    unit = _micro(str(metadata.get("unit", "")).replace("\\u00B5", "µ").strip())
    tags = tiff.pages.first.tags
    sizes = []
    if unit in _MICROMETRES:
        for name in ("XResolution", "YResolution"):
            above, below = tags[name].value if name in tags else (0, 1)
            sizes.append(below / above * _MICROMETRES[unit] if above else np.nan)
    return Scale(_square(file, sizes), _seconds(metadata.get("finterval"), metadata.get("tunit", "s")))


def channel_names(given: Sequence[str], count: int) -> tuple[str, ...]:
    """A name for each channel: those given, each made unique, or "0", "1", … where they are not as many."""
    if len(given) != count:
        return tuple(str(number) for number in range(count))
    again = [given[:place].count(name) for place, name in enumerate(given)]
    return tuple(f"{name} ({n + 1})" if n else name for name, n in zip(given, again, strict=True))


def _micro(unit: str) -> str:
    return unit.replace("\u03bc", "\u00b5")  # the Greek letter mu stands for the micro sign


def _square(file: Path, sizes: list[float]) -> float | None:
    if not sizes or not np.isfinite(sizes).all() or min(sizes) <= 0:
        return None
    if max(sizes) > 1.01 * min(sizes):
        raise ReadError(f"{file} has pixels of {sizes[0]:g} × {sizes[-1]:g} µm: resample it to square pixels")
    return sizes[0]


def _seconds(interval: Any, unit: Any) -> float | None:
    if not interval:
        return None
    value = float(interval) * _SECONDS.get(str(unit), np.nan)
    return value if np.isfinite(value) and value > 0 else None

"""Units in files of tracks."""

import numpy as np

from cytodisk.checks import LARGEST_SCALE, SMALLEST_SCALE
from cytodisk.images.spots.spots import PIXEL

_MICROMETRES = {
    "µm": 1.0,
    "um": 1.0,
    "micron": 1.0,
    "micrometer": 1.0,
    "micrometre": 1.0,
    "nm": 1e-3,
    "nanometer": 1e-3,
    "nanometre": 1e-3,
    "mm": 1e3,
    "millimeter": 1e3,
    "millimetre": 1e3,
    "cm": 1e4,
    "centimeter": 1e4,
    "m": 1e6,
    "meter": 1e6,
}
_SECONDS = {"s": 1.0, "sec": 1.0, "second": 1.0, "ms": 1e-3, "msec": 1e-3, "millisecond": 1e-3}
_SECONDS |= {"min": 60.0, "minute": 60.0, "h": 3600.0, "hr": 3600.0, "hour": 3600.0}


def length_unit(words: str) -> str:
    """A file's unit of length: "px", one that is known, or the file's own words."""
    plain = words.strip().lower().replace("\u03bc", "\u00b5")
    if plain in ("", "pixel", "pixels", "px"):
        return PIXEL
    return plain if plain in _MICROMETRES else plain.removesuffix("s")


def micrometres(unit: str) -> float | None:
    """How many µm a unit of length has; None if it is unknown, or pixels."""
    return _MICROMETRES.get(unit)


def pixel_size_um(size: tuple[float, float] | None, unit: str) -> float | None:
    """Side of a square pixel in µm; None where it is unknown."""
    factor = micrometres(unit)
    if size is None or factor is None or not np.isclose(*size, rtol=0.01):
        return None
    return size[1] * factor if SMALLEST_SCALE <= size[1] * factor <= LARGEST_SCALE else None


def frame_interval_s(interval: str | None, unit: str) -> float | None:
    """Seconds between frames; None where they are unknown."""
    plain = unit.strip().lower()
    factor = _SECONDS.get(plain) or _SECONDS.get(plain.removesuffix("s"))
    try:
        value = float(interval or "nan") * (factor or np.nan)
    except ValueError:
        return None
    return value if SMALLEST_SCALE <= value <= LARGEST_SCALE else None

"""Units in files of tracks."""

from cytodisk.checks import LARGEST_SCALE, SMALLEST_SCALE
from cytodisk.images.scale_units import is_no_unit, micrometres, number, seconds
from cytodisk.images.spots.spots import PIXEL
from cytodisk.scale import alike


def length_unit(words: str) -> str:
    """A file's unit of length: "px", or the file's own words."""
    return PIXEL if is_no_unit(words) else words.strip()


def pixel_size_um(size: tuple[float, float] | None, unit: str) -> float | None:
    """Side of a square pixel in µm; None where it is unknown."""
    factor = micrometres(unit)
    if size is None or factor is None or not alike(*size):
        return None
    return _measurable(size[1] * factor)


def frame_interval_s(interval: str | None, unit: str) -> float | None:
    """Seconds between frames; None where they are unknown."""
    value, factor = number(interval), seconds(unit)
    return None if value is None or factor is None else _measurable(value * factor)


def _measurable(value: float) -> float | None:
    return value if SMALLEST_SCALE <= value <= LARGEST_SCALE else None

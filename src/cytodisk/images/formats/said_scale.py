"""What a file says of its scale, value by value: believed where it can be, or named with what to pass."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeAlias

from cytodisk.checks import LARGEST_SCALE, SMALLEST_SCALE
from cytodisk.errors import ReadError
from cytodisk.images.scale_units import is_no_unit, micrometres, number, seconds
from cytodisk.scale import alike

Said: TypeAlias = tuple[float | None, tuple[str, ...]]
"""A value, None if it is unknown, and notes on what is wrong."""

NO_PIXEL_SIZE = "the pixel size is unknown: pass --pixel-size, in µm"
NO_INTERVAL = "the frame interval is unknown: pass --frame-interval, in seconds"
NOTHING: Said = (None, ())

_PRINT_DPI = (72, 75, 90, 96, 100, 120, 144, 150, 180, 200, 220, 240, 250, 300, 350, 360, 400, 600, 1200)
_INCH_UM = 25400.0


def length(value: Any, unit: Any, field: str) -> Said:
    """A side of a pixel in µm.

    Parameters
    ----------
    value : object
        None where the file gives none.
    unit : object
    field : str
        What the file calls it, for notes.
    """
    return _measured(value, unit, field, micrometres, "length", NO_PIXEL_SIZE)


def duration(value: Any, unit: Any, field: str) -> Said:
    """A time in seconds; see `length`."""
    return _measured(value, unit, field, seconds, "time", NO_INTERVAL)


def _measured(value: Any, unit: Any, field: str, factor_of: Any, kind: str, remedy: str) -> Said:
    if value is None or is_no_unit(unit):
        return NOTHING
    amount = number(value)
    if amount is None or amount < 0:
        return None, (f"its {field} is {_shown(value)}, which is no number above 0; {remedy}",)
    if amount == 0:  # how files say that they do not know
        return NOTHING
    factor = factor_of(unit)
    if factor is None:
        return None, (
            f"its {field} is {_shown(value)} {_shown(unit)}, which is no known unit of {kind}; {remedy}",
        )
    if not SMALLEST_SCALE <= amount * factor <= LARGEST_SCALE:
        return None, (f"its {field} of {_shown(value)} {_shown(unit)} is beyond all measure; {remedy}",)
    return amount * factor, ()


def square(file: Path, sides: Sequence[Said]) -> Said:
    """The side of a pixel, from those along x and y.

    Parameters
    ----------
    file : Path
        For messages.
    sides : sequence of (float or None, tuple of str)

    Raises
    ------
    ReadError
        Pixels are not square, so that a cell would be mapped with a wrong shape.
    """
    notes = tuple(dict.fromkeys(note for _, notes in sides for note in notes))
    known = [side for side, _ in sides if side is not None]
    if notes or not known:
        return None, notes
    if not alike(*known):
        raise ReadError(
            f"{file} has pixels of {known[0]:g} × {known[-1]:g} µm, so the cell is stretched: resample it to "
            "square pixels (Fiji: Image > Scale), or, if this is wrong, correct it there (Image > Properties)"
        )
    if dpi := print_resolution(known[0]):
        return None, (f"it has {dpi} dots an inch, a resolution for printing, no scale; {NO_PIXEL_SIZE}",)
    return known[0], ()


def print_resolution(side_um: float) -> int | None:
    """The dots per inch, if a side of a pixel stands for one of those that programs fill in by themselves."""
    return next((dpi for dpi in _PRINT_DPI if alike(side_um, _INCH_UM / dpi, ratio=1.002)), None)


def _shown(value: Any) -> str:
    text = "".join(letter if letter.isprintable() else "?" for letter in str(value))
    return repr(text if len(text) <= 40 else text[:39] + "…")

"""Numbers and units of length and time as files give them and people type them."""

from __future__ import annotations

import math
import re
import unicodedata
from typing import Any

_PREFIXES = {"": 1.0, "k": 1e3, "c": 1e-2, "d": 1e-1, "m": 1e-3, "µ": 1e-6, "u": 1e-6, "n": 1e-9, "p": 1e-12}
_LONG_PREFIXES = {
    "": 1.0,
    "kilo": 1e3,
    "deci": 1e-1,
    "centi": 1e-2,
    "milli": 1e-3,
    "micro": 1e-6,
    "nano": 1e-9,
    "pico": 1e-12,
}
_METRES = {f"{prefix}m": factor for prefix, factor in _PREFIXES.items()}
_METRES |= {
    f"{prefix}{word}": factor for prefix, factor in _LONG_PREFIXES.items() for word in ("meter", "metre")
}
_METRES |= {"micron": 1e-6, "å": 1e-10, "angstrom": 1e-10, "ångström": 1e-10, "ångstrom": 1e-10}
_METRES |= {"angström": 1e-10, "inch": 0.0254, "in": 0.0254, '"': 0.0254}
_METRES |= {"mil": 2.54e-5, "thou": 2.54e-5}

_SECONDS = {f"{prefix}{word}": f for prefix, f in _PREFIXES.items() for word in ("s", "sec") if f <= 1}
_SECONDS |= {f"{prefix}second": factor for prefix, factor in _LONG_PREFIXES.items() if factor <= 1}
_SECONDS |= {"min": 60.0, "minute": 60.0, "h": 3600.0, "hr": 3600.0, "hour": 3600.0}
_SECONDS |= {"d": 86400.0, "day": 86400.0, "millisec": 1e-3, "microsec": 1e-6}

NO_UNITS = ("", "pixel", "pixels", "px", "reference frame", "frame", "frames", "null", "none", "unknown", "?")
"""What files say that have no unit; whoever wrote one of these did not calibrate."""


def micrometres(unit: Any) -> float | None:
    """How many µm a unit of length is; None for one that is not known.

    Parameters
    ----------
    unit : object
        In any case, one or many, in US or UK spelling, such as "Microns" or "micrometres".

    Returns
    -------
    float or None

    Examples
    --------
    >>> micrometres("Nanometres")
    0.001
    """
    metres = _looked_up(unit, _METRES)
    return None if metres is None else float(f"{metres * 1e6:.12g}")


def seconds(unit: Any) -> float | None:
    """How many seconds a unit of time is; None for one that is not known.

    Parameters
    ----------
    unit : object
        In any case, one or many, such as "Minutes" or "msec".

    Returns
    -------
    float or None

    Examples
    --------
    >>> seconds("hrs"), seconds("msec")
    (3600.0, 0.001)
    """
    return _looked_up(unit, _SECONDS)


def number(text: Any) -> float | None:
    """A finite number, also one with a decimal comma; None for anything else, as for "1,000", which may be 1.

    Parameters
    ----------
    text : object

    Returns
    -------
    float or None

    Examples
    --------
    >>> number("0,25"), number("1e-3"), number("0.2 µm")
    (0.25, 0.001, None)
    """
    words = str(text).strip()
    if re.fullmatch(r"[+-]?\d+,\d+", words) and not re.fullmatch(r"[+-]?[1-9]\d{0,2},\d{3}", words):
        words = words.replace(",", ".")
    try:
        value = float(words)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def is_no_unit(unit: Any) -> bool:
    """Whether a unit says that there is none, as "pixel" does."""
    return str(unit).strip().lower() in NO_UNITS


def _looked_up(unit: Any, known: dict[str, float]) -> float | None:
    text = re.sub(r"\\u([0-9a-fA-F]{4})", lambda found: chr(int(found[1], 16)), str(unit))  # ImageJ's µ
    text = unicodedata.normalize("NFC", text).replace("\u03bc", "\u00b5")
    text = text.replace("\u00c2\u00b5", "\u00b5")  # UTF-8 that was read as Latin-1
    text = re.sub(r"\s+", " ", text).strip(" .")
    word = text.lower()
    for candidate in (word, word.removesuffix("s"), word.removesuffix("es")):
        if candidate in known:
            return known[candidate]
    return None

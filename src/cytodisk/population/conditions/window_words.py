"""Windows in words: "layers 0–2, sectors 10–14"."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_SEVERAL = ("–", ",", " to ")  # what stands between the first and the last of several


def runs_of(numbers: NDArray[np.integer], closed_at: int | None = None) -> str:
    """Whole numbers as runs: "0–2, 5".

    Parameters
    ----------
    numbers : ndarray of int
    closed_at : int, optional
        Count of numbers around a circle, so that 58, 59, 0, 1 are "58–1".

    Returns
    -------
    str
    """
    some = np.unique(numbers)
    if not len(some):
        return ""
    parts = np.split(some, np.flatnonzero(np.diff(some) > 1) + 1)
    if closed_at is not None and len(parts) > 1 and some[0] == 0 and some[-1] == closed_at - 1:
        parts = [np.concatenate([parts[-1], parts[0]]), *parts[1:-1]]
    return ", ".join(f"{part[0]}" if len(part) == 1 else f"{part[0]}–{part[-1]}" for part in parts)


def lags_of(places: NDArray[np.integer], lags: NDArray[np.floating], unit: str) -> str:
    """Places along the lags of curves as lags: "−10 to 5 s, 20 s".

    Parameters
    ----------
    places : ndarray of int
    lags : ndarray of float
    unit : str
        As "s"; empty where it is not known.

    Returns
    -------
    str
    """
    some = np.unique(places)
    parts = np.split(some, np.flatnonzero(np.diff(some) > 1) + 1)
    ends = [dict.fromkeys(f"{lags[k]:g}".replace("-", "−") for k in (part[0], part[-1])) for part in parts]
    return ", ".join(f"{' to '.join(words)} {unit}".rstrip() for words in ends)


def p_words(p: float) -> str:
    """A p-value as it is said: "p = 0.029", "p < 0.001"."""
    return "p < 0.001" if p < 0.001 else f"p = {p:.2g}"


def signed(value: float) -> str:
    """A difference with its sign, and a true minus: "+0.118", "−67.1"."""
    return f"{value:+.3g}".replace("-", "−")


def with_minus(value: float, digits: int = 3) -> str:
    """A number with a true minus: "−606"."""
    return f"{value:.{digits}g}".replace("-", "−")


def windows_words(layers: str, places: str, kind: str) -> str:
    """Layers and places along them, each as one or many: "layer 0, sectors 0–11".

    Parameters
    ----------
    layers : str
        As `runs_of` says them.
    places : str
        Sectors as `runs_of` says them, or lags as `lags_of` does.
    kind : str
        "sector" or "lag".

    Returns
    -------
    str
    """
    named = [(kind, places)] if not layers else [("layer", layers), (kind, places)]
    return ", ".join(
        f"{one}{'s' if any(mark in numbers for mark in _SEVERAL) else ''} {numbers}" for one, numbers in named
    )

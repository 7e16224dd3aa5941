"""A window under the cursor in words."""

from __future__ import annotations

import numpy as np

from cytodisk.number_words import rounded
from cytodisk.plot.layer_looks import layer_word


def number_with_unit(value: float, unit: str, *, signed: bool = False) -> str:
    """A number with its unit and a true minus; a dash if it is not known.

    Parameters
    ----------
    value : float
    unit : str
    signed : bool
        With a plus, too.

    Examples
    --------
    >>> from cytodisk.napari.disk_view.window_words import number_with_unit
    >>> number_with_unit(-0.02341, "µm/s", signed=True), number_with_unit(float("nan"), "a.u.")
    ('−0.0234 µm/s', '–')
    """
    if not np.isfinite(value):
        return "–"
    plus = "+" if signed and value > 0 else ""
    words = f"{plus}{rounded(value)}".replace("-", "−")
    return words if unit in ("", "1") else f"{words} {unit}"


def place_words(
    layer: int, sector: int, layers: int, cytoplasm_layers: int | None, depth: float, unit: str
) -> str:
    """Where a window is, as "layer 3, sector 12, 1.4 µm deep".

    Parameters
    ----------
    layer, sector : int
    layers : int
        Number of all layers.
    cytoplasm_layers : int or None
        How many are not in the nucleus, in a cell with one.
    depth : float
        Left out if it is NaN.
    unit : str
    """
    deep = f", {rounded(depth, 2)} {unit} deep" if np.isfinite(depth) else ""
    return f"{layer_word(layer, layers, cytoplasm_layers)}, sector {sector}{deep}"

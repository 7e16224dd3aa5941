"""Which axis of a layer is what: by its labels and units; Q where the layer does not say."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cytodisk.images.scale_units import is_no_unit, micrometres, seconds

UNNAMED = "Q"

_NAMES = {
    **dict.fromkeys(("t", "time", "times", "frame", "frames", "timepoint", "timepoints"), "T"),
    **dict.fromkeys(("c", "ch", "channel", "channels"), "C"),
    **dict.fromkeys(("z", "slice", "slices", "plane", "depth"), "Z"),
    "y": "Y",
    "x": "X",
}


def unit_words(units: Sequence[Any]) -> list[str]:
    """Units of a layer's axes as words; "pixel" where it has none."""
    return [str(unit) for unit in units]


def layer_axes(layer: Any) -> str:
    """Letters of a layer's axes: T time, C channels, Z slices, Y, X, and Q for one without a name.

    Parameters
    ----------
    layer : napari.layers.Layer

    Returns
    -------
    str
        The last two that nothing names are Y and X, as napari shows them.
    """
    names = [_NAMES.get(str(name).strip().lower(), UNNAMED) for name in layer.axis_labels]
    free = [k for k, name in enumerate(names) if name == UNNAMED]
    for letter in "XY":
        if letter not in names and free:
            names[free.pop()] = letter
    units = unit_words(layer.units)
    for k in free:
        if seconds(units[k]) is not None:
            names[k] = "T"
        elif not is_no_unit(units[k]) and micrometres(units[k]) is not None:
            names[k] = "Z"
    return "".join(names)


def without_single(letters: str, shape: Sequence[int]) -> tuple[str, tuple[int, ...]]:
    """Letters and sizes without axes of length 1 beside Y and X."""
    kept = [(one, int(size)) for one, size in zip(letters, shape, strict=True) if size > 1 or one in "YX"]
    return "".join(one for one, _ in kept), tuple(size for _, size in kept)


def time_axis(layer: Any) -> int | None:
    """Which axis of a layer is time, counted from the end; one without a name is taken for it.

    Parameters
    ----------
    layer : napari.layers.Layer
    """
    letters = layer_axes(layer)
    known = next((one for one in ("T", UNNAMED) if one in letters), None)
    return None if known is None else letters.index(known) - len(letters)

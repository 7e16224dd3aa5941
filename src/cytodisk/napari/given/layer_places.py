"""Whether layers lie on each other pixel by pixel, as files do."""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.errors import ReadError
from cytodisk.images.scale_units import micrometres
from cytodisk.napari.given.layer_axes import time_axis

_MOVED = 0.01  # pixels, or frames, that layers may be moved against each other


def check_places(masks: Any, other: Any) -> None:
    """Refuse a layer that is moved, turned or scaled against that of the masks.

    Parameters
    ----------
    masks, other : napari.layers.Layer
        Files have no place: a pixel of one goes with the same pixel of the other.

    Raises
    ------
    ReadError
        They differ.
    """
    if not _same_scale(masks, other):
        raise _fault(masks, other, "has other pixels than", f"{masks.name}.scale = {other.name}.scale")
    if (_signs(masks) != _signs(other)).any():
        raise _fault(masks, other, "is mirrored against", "give both a scale above 0")
    if not np.allclose(_turn(masks), _turn(other), atol=1e-6):
        raise _fault(masks, other, "is turned or sheared against", "take its rotate, shear and affine out")
    moved = _corner(masks) - _corner(other)
    if (np.abs(moved) > _MOVED).any():
        words = " and ".join(f"{value:.3g}" for value in moved)
        raise _fault(
            masks, other, f"is moved (by {words} px in y and x) against", "set its translate to the same"
        )
    begins = [first for one in (masks, other) if (first := _first_frame(one)) is not None]
    if len(begins) > 1 and abs(begins[0] - begins[1]) > _MOVED:
        raise _fault(masks, other, "begins at another time than", "set its translate to the same")


def _fault(masks: Any, other: Any, what: str, remedy: str) -> ReadError:
    return ReadError(
        f"layer {masks.name} {what} layer {other.name}, and pixels of the two are compared one by one: "
        f"{remedy}, or save both cut to the same field"
    )


def _same_scale(masks: Any, other: Any) -> bool:
    """Whether pixels are of one size; a layer that nobody scaled lies where its pixels are."""
    sizes = [np.abs(np.asarray(one.scale, dtype=float)[-2:]) for one in (masks, other)]
    units = [tuple(map(str, one.units[-2:])) for one in (masks, other)]
    if any(
        unit == ("pixel", "pixel") and (size == 1.0).all() for unit, size in zip(units, sizes, strict=True)
    ):
        return True
    factors = [micrometres(unit[0]) for unit in units]
    first, second = sizes
    if factors[0] is not None and factors[1] is not None:
        first, second = first * factors[0], second * factors[1]
    return bool(np.allclose(first, second, rtol=0.01))


def _turn(layer: Any) -> FloatArray:
    """What turns and shears the last two axes."""
    affine = np.asarray(layer.affine.affine_matrix, dtype=float)[-3:-1, -3:-1]
    rotate = np.asarray(layer.rotate, dtype=float)[-2:, -2:]
    shear = np.asarray(layer.shear, dtype=float)
    last = shear[-1:] if shear.ndim == 1 else shear[-2:-1, -1]
    return np.concatenate([affine.ravel(), rotate.ravel(), last])


def _signs(layer: Any) -> FloatArray:
    """-1 along axes that are mirrored."""
    signs: FloatArray = np.sign(np.asarray(layer.scale, dtype=float)[-2:])
    return signs


def _corner(layer: Any) -> FloatArray:
    """Where the centre of the first pixel lies, beside turns; (y, x) in pixels, whatever the unit."""
    affine = np.asarray(layer.affine.affine_matrix, dtype=float)[-3:-1, -1]
    translate: FloatArray = np.asarray(layer.translate, dtype=float)[-2:]
    corner: FloatArray = (translate + affine) / np.abs(np.asarray(layer.scale, dtype=float)[-2:])
    return corner


def _first_frame(layer: Any) -> float | None:
    """Where the first frame lies, in frames; None without an axis of time."""
    axis = time_axis(layer)
    return None if axis is None else float(layer.translate[axis] / layer.scale[axis])

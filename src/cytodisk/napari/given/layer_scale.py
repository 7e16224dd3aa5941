"""What a layer says of the size of a pixel and of the time between frames."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cytodisk.checks import LARGEST_SCALE, SMALLEST_SCALE
from cytodisk.errors import ReadError
from cytodisk.images.scale_units import micrometres, seconds
from cytodisk.napari.given.layer_axes import UNNAMED, layer_axes, unit_words
from cytodisk.scale import Scale, alike


@dataclass(frozen=True)
class LayerScale:
    """Scale of a layer.

    Attributes
    ----------
    scale : Scale
        What is known: a number with a unit.
    bare_pixel, bare_interval : float or None
        Numbers other than 1 that have no unit, so that they say nothing.
    """

    scale: Scale
    bare_pixel: float | None = None
    bare_interval: float | None = None

    def notes(self, name: str, known: Scale, *, is_movie: bool) -> list[str]:
        """What to tell a user of numbers without a unit, unless others confirm them.

        Parameters
        ----------
        name : str
            Of the layer.
        known : Scale
            What is known from elsewhere.
        is_movie : bool
        """
        said = [
            (self.bare_pixel, known.pixel_size_um, "pixel", "µm", "--pixel-size", "pixel size"),
            (self.bare_interval, known.frame_interval_s, "frame", "s", "--frame-interval", "frame interval"),
        ]
        return [
            f"layer {name} has the scale {bare:g} a {what}, and no unit: the {quantity} is taken as unknown. "
            f"If it is in {unit}, type it ({flag} {bare:g})"
            for bare, sure, what, unit, flag, quantity in said[: 2 if is_movie else 1]
            if bare is not None and (sure is None or not alike(bare, sure))
        ]


def layer_scale(layer: Any, letters: str | None = None) -> LayerScale:
    """Scale of a layer by its `scale` and `units`.

    Parameters
    ----------
    layer : napari.layers.Layer
    letters : str, optional
        Of its axes; without it those of `layer_axes`.

    Returns
    -------
    LayerScale

    Raises
    ------
    ReadError
        Its pixels are not square, or its scale is none.
    """
    letters = layer_axes(layer) if letters is None else letters
    units = dict(zip(letters, unit_words(layer.units), strict=True))
    sides = {one: abs(float(size)) for one, size in zip(letters, layer.scale, strict=True)}
    factors = [micrometres(units[one]) for one in "YX"]
    has_unit = None not in factors
    height, width = (
        sides[one] * (1.0 if factor is None else factor) for one, factor in zip("YX", factors, strict=True)
    )
    if not (height > 0 and width > 0 and alike(height, width)):
        unit = "µm" if has_unit else "no unit"
        raise ReadError(
            f"layer {layer.name} has pixels of {height:.4g} × {width:.4g} ({unit}), which are not square: "
            "resample it to square pixels, or correct its scale"
        )
    pixel = width if has_unit and SMALLEST_SCALE <= width <= LARGEST_SCALE else None
    interval = bare = None
    time = next((one for one in ("T", UNNAMED) if letters.count(one) == 1), None)
    if time is not None:
        factor = seconds(units[time])
        interval = None if factor is None else float(f"{sides[time] * factor:.9g}")
        bare = sides[time] if factor is None and sides[time] != 1.0 else None
    known = Scale(None if pixel is None else float(f"{pixel:.9g}"), interval)
    return LayerScale(known, width if pixel is None and width != 1.0 else None, bare)

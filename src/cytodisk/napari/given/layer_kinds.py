"""What kind of layer it is, told without importing napari."""

from __future__ import annotations

from typing import Any, Literal, TypeAlias

MARK = "cytodisk"
"""Key of a layer's metadata that all layers of cytodisk have."""

LayerKind: TypeAlias = Literal["labels", "image", "shapes", "tracks", "points", "other"]

_KINDS: dict[str, LayerKind] = {
    "Labels": "labels",
    "Image": "image",
    "Shapes": "shapes",
    "Tracks": "tracks",
    "Points": "points",
}

MASKS: tuple[LayerKind, ...] = ("labels", "shapes", "image")
"""Kinds of layers that can hold masks; an image is one of 0 and 1."""
SIGNALS: tuple[LayerKind, ...] = ("image",)
NUCLEI: tuple[LayerKind, ...] = ("labels", "shapes", "image")
TRACKS: tuple[LayerKind, ...] = ("tracks",)


def layer_kind(layer: Any) -> LayerKind:
    """Kind of a layer of napari, also of one whose class inherits one of napari's.

    Parameters
    ----------
    layer : napari.layers.Layer

    Returns
    -------
    {"labels", "image", "shapes", "tracks", "points", "other"}
    """
    names = (cls.__name__ for cls in type(layer).__mro__)
    return next((_KINDS[name] for name in names if name in _KINDS), "other")


def is_result(layer: Any) -> bool:
    """Whether cytodisk made a layer as a result: such a layer is no input."""
    made = dict(layer.metadata).get(MARK)
    return isinstance(made, dict) and "study" in made


def pixels_of(layer: Any) -> Any:
    """The array of an image or of labels, of a pyramid its finest level."""
    return layer.data[0] if layer.multiscale else layer.data


def is_picture(layer: Any) -> bool:
    """Whether a layer is an image of colours."""
    return bool(getattr(layer, "rgb", False))

"""Layers of a viewer by their role, each of a kind that can have it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from cytodisk.errors import CytodiskError, MaskError, ReadError, SignalError
from cytodisk.napari.given.layer_kinds import MASKS, NUCLEI, SIGNALS, TRACKS, LayerKind, layer_kind

_WORDS = {"labels": "labels", "shapes": "shapes, one a cell", "image": "an image", "tracks": "tracks"}


@dataclass(frozen=True)
class ChosenLayers:
    """Layers of a viewer by their role.

    Attributes
    ----------
    masks : napari.layers.Layer
        Labels, an image of 0 and 1, or shapes.
    signal : tuple of napari.layers.Image
        One with all channels, or a layer for each.
    nuclei : napari.layers.Layer or None
    tracks : napari.layers.Tracks or None
    """

    masks: Any
    signal: tuple[Any, ...] = ()
    nuclei: Any | None = None
    tracks: Any | None = None

    @property
    def all(self) -> list[Any]:
        """All layers, that of the masks first."""
        return [one for one in (self.masks, *self.signal, self.nuclei, self.tracks) if one is not None]

    @property
    def of_pixels(self) -> list[Any]:
        """Labels and images among them."""
        return [one for one in self.all if layer_kind(one) in ("labels", "image")]

    @property
    def roles(self) -> Iterator[tuple[str, Any, tuple[LayerKind, ...], type[CytodiskError]]]:
        """Role, layer, the kinds that can have the role, and the error for others."""
        yield "masks", self.masks, MASKS, MaskError
        for layer in self.signal:
            yield "signal", layer, SIGNALS, SignalError
        if self.nuclei is not None:
            yield "nuclei", self.nuclei, NUCLEI, MaskError
        if self.tracks is not None:
            yield "tracks", self.tracks, TRACKS, ReadError


def check_kinds(chosen: ChosenLayers) -> None:
    """Refuse layers that cannot have their role.

    Parameters
    ----------
    chosen : ChosenLayers

    Raises
    ------
    MaskError, SignalError, ReadError
    """
    for role, layer, kinds, fault in chosen.roles:
        kind = layer_kind(layer)
        if kind not in kinds:
            what = f"points are no {role}" if kind == "points" else f"it is a layer of {kind}"
            wanted = ", or ".join(_WORDS[one] for one in kinds)
            raise fault(f"{role}: layer {layer.name} cannot be used, {what}: choose a layer of {wanted}")

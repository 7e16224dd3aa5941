"""Where layers of a study lie in a viewer: scale, units, and the layer that they were measured on."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from cytodisk.napari.given.layer_kinds import MARK, is_picture, layer_kind
from cytodisk.napari.study_layers.shown_cells import ShownCells


@dataclass(frozen=True)
class StudyPlace:
    """Scale, place and units of layers with axes (time,) y, x.

    Attributes
    ----------
    scale, translate : tuple of float
    units : tuple of str
    beside : str
        Name of the open layer that it was taken from; empty if the study alone says it.
    """

    scale: tuple[float, ...]
    translate: tuple[float, ...]
    units: tuple[Any, ...]
    beside: str = ""

    @property
    def settings(self) -> dict[str, Any]:
        """What a layer takes."""
        axes = ("time", "y", "x")[-len(self.scale) :]
        return {"scale": self.scale, "translate": self.translate, "units": self.units, "axis_labels": axes}


def place_of(cells: ShownCells, layers: Iterable[Any] = ()) -> StudyPlace:
    """Where a study's layers lie: over an open image of the same size, or as the study's scale says.

    Parameters
    ----------
    cells : ShownCells
    layers : iterable of Layer
        That are open. The first image or labels whose pixels and frames are those of the study is taken;
        layers of cytodisk are not looked at.

    Returns
    -------
    StudyPlace
    """
    own = _own_place(cells)
    for layer in layers:
        shape: Any = getattr(getattr(layer, "data", None), "shape", ())
        is_image = layer_kind(layer) in ("image", "labels") and not is_picture(layer)
        if MARK in layer.metadata or len(shape) < len(own.scale) or not is_image:
            continue
        fits = tuple(shape[-2:]) == cells.image_shape
        if fits and (not cells.is_stack or shape[-3] >= cells.n_frames):
            last = slice(-len(own.scale), None)
            return StudyPlace(
                tuple(layer.scale[last]), tuple(layer.translate[last]), tuple(layer.units[last]), layer.name
            )
    return own


def _own_place(cells: ShownCells) -> StudyPlace:
    scale = cells.study.scale
    length, unit = (1.0, "pixel") if scale.pixel_size_um is None else (scale.pixel_size_um, "micrometer")
    if not cells.is_stack:
        return StudyPlace((length, length), (0.0, 0.0), (unit, unit))
    known = scale.frame_interval_s is not None and cells.study.is_movie
    time, second = (scale.frame_interval_s or 1.0, "second") if known else (1.0, "pixel")
    return StudyPlace((time, length, length), (0.0, 0.0, 0.0), (second, unit, unit))

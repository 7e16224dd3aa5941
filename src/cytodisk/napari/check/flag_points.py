"""Places that are wrong as a layer of points, and the way there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.napari.check.found_flags import FlagPlace, FoundFlag
from cytodisk.napari.given.layer_kinds import MARK
from cytodisk.napari.napari_versions import camera_of

ROLE = "flags"
_COLOUR = "#ffb000"  # told from cells and backgrounds by all, also the colour blind
_SMALL, _LARGE = 10.0, 30.0  # px of the image, of all places and of the one that was clicked
_ON_SCREEN = 14, 70  # px that a point has at least and at most
_LONGEST = 200  # letters in the status bar


@dataclass(frozen=True)
class FlagGround:
    """Where places lie in the viewer.

    Attributes
    ----------
    scale, translate : tuple of float
        Of the axes of the layer that they are in, y and x last.
    units : tuple of object
    time_axis : int or None
        Which of them is time, counted from the end, such as -3; None without one.
    """

    scale: tuple[float, ...]
    translate: tuple[float, ...]
    units: tuple[Any, ...]
    time_axis: int | None = None

    @classmethod
    def of(cls, layer: Any, time_axis: int | None = -3) -> FlagGround:
        """That of a layer; without another word an axis before y and x is time."""
        has_time = time_axis is not None and layer.ndim >= -time_axis
        place = tuple(layer.scale), tuple(layer.translate), tuple(layer.units)
        return cls(*place, time_axis if has_time else None)

    def point(self, place: FlagPlace) -> tuple[float, ...] | None:
        """A place in the pixels of a layer; None without one."""
        if place.yx is None:
            return None
        point = [0.0] * (len(self.scale) - 2) + [*place.yx]
        if self.time_axis is not None:
            point[self.time_axis] = float(place.frame or 0)
        return tuple(point)

    def world(self, place: FlagPlace) -> tuple[float, ...] | None:
        """A place in the viewer."""
        point = self.point(place)
        return None if point is None else tuple(np.array(point) * self.scale + self.translate)


def flag_features(
    flags: Sequence[FoundFlag], ground: FlagGround
) -> tuple[np.ndarray[Any, Any], pd.DataFrame]:
    """Points of all places, and what the status bar says of each.

    Parameters
    ----------
    flags : sequence of FoundFlag
    ground : FlagGround

    Returns
    -------
    (ndarray of shape (N, D), DataFrame)
        The table has the columns flag, cell, frame, finding, remedy.
    """
    points, rows = [], []
    for flag in flags:
        for place in flag.places:
            point = ground.point(place)
            if point is None:
                continue
            points.append(point)
            said = place.note or flag.finding
            rows.append((flag.name, place.cell, place.frame, _short(said), _short(flag.remedy)))
    names = ["flag", "cell", "frame", "finding", "remedy"]
    return np.array(points, dtype=float).reshape(len(points), len(ground.scale)), pd.DataFrame(
        rows, columns=names
    )


def add_flag_points(
    viewer: Any, flags: Sequence[FoundFlag], ground: FlagGround, *, name: str, mark: dict[str, Any]
) -> Any | None:
    """Add a layer of points with all places.

    Parameters
    ----------
    viewer : Viewer
    flags : sequence of FoundFlag
    ground : FlagGround
    name : str
        Of the layer.
    mark : dict
        Its metadata under "cytodisk".

    Returns
    -------
    Points or None
        None if there is no place.
    """
    points, features = flag_features(flags, ground)
    if not len(points):
        return None
    selected = set(viewer.layers.selection)
    layer = viewer.add_points(
        points,
        name=name,
        features=features,
        scale=ground.scale,
        translate=ground.translate,
        units=ground.units,
        metadata={MARK: {"role": ROLE, **mark}},
        symbol="disc",
        face_color="transparent",
        border_color=_COLOUR,
        border_width=0.2,
        size=_SMALL,
        out_of_slice_display=False,
    )
    layer.canvas_size_limits = _ON_SCREEN
    layer.editable = False
    if selected:
        viewer.layers.selection = selected  # what the user works on stays
    return layer


class FlagMarks:
    """Places that are wrong in a viewer: small circles, and a large one at the place that was clicked.

    Parameters
    ----------
    viewer : Viewer
    flags : sequence of FoundFlag
    ground : FlagGround
    mark : dict
        Metadata of their layer.
    name : str
        Of their layer.

    Attributes
    ----------
    layer : Points or None
        None if there is no place.
    """

    def __init__(
        self,
        viewer: Any,
        flags: Sequence[FoundFlag],
        ground: FlagGround,
        mark: dict[str, Any],
        *,
        name: str,
    ):
        self._viewer, self._ground = viewer, ground
        places = (place for flag in flags for place in flag.places if place.yx is not None)
        self._row: dict[FlagPlace, int] = {}
        for row, place in enumerate(places):
            self._row.setdefault(place, row)
        self.layer = add_flag_points(viewer, flags, ground, name=name, mark=mark)

    def go(self, place: FlagPlace) -> bool:
        """Bring the slider to the frame of a place, and the place to the middle of the canvas.

        Returns
        -------
        bool
            Whether there is anything to see.
        """
        if self.layer is not None and place in self._row and len(self.layer.data) > self._row[place]:
            sizes = np.full(len(self.layer.data), _SMALL)
            sizes[self._row[place]] = _LARGE
            self.layer.size = sizes
        ground, viewer, world = self._ground, self._viewer, self._ground.world(place)
        axis = None if place.frame is None else ground.time_axis
        if axis is not None:
            time = (place.frame or 0) * ground.scale[axis] + ground.translate[axis]
            viewer.dims.set_point(viewer.dims.ndim + axis, time)
        if world is None:
            return axis is not None
        camera_of(viewer).center = world[-2:]
        return True

    def remove(self) -> None:
        """Take the layer out of the viewer, if it is still there."""
        if self.layer is not None and self.layer in self._viewer.layers:
            self._viewer.layers.remove(self.layer)


def _short(words: str) -> str:
    return words if len(words) <= _LONGEST else words[:_LONGEST].rpartition(" ")[0] + " …"

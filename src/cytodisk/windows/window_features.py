"""Windows and cells as GeoJSON features, for QuPath and other programs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import shapely

from cytodisk.arrays import FloatArray
from cytodisk.errors import WindowError
from cytodisk.windows.layer_coords import layer_coords
from cytodisk.windows.on_cell import WindowsOnCell

_FIRST_PIXEL = 0.5  # of its centre, where the image's corner is (0, 0)
_SLIVER = 1e-3  # of a window's area: a smaller piece beside it is left out
_DECIMALS = 4  # of coordinates in pixels


def window_features(
    windows: WindowsOnCell,
    polygons: Sequence[FloatArray],
    values: Mapping[str, FloatArray],
    cell: str,
    corner: tuple[int, int],
) -> Iterator[dict[str, Any]]:
    """The cell, if it has a name, then its windows, as `CellWindows.geojson` has them.

    Parameters
    ----------
    windows : WindowsOnCell
    polygons : sequence of ndarray of shape (N, 2)
        Of the windows, by number; without points where there is none.
    values : mapping of str to ndarray of shape (layers, sectors)
    cell : str
        Name of the cell; empty for windows alone.
    corner : (int, int)
        (row, column) of the mask's first pixel in the image.

    Yields
    ------
    dict

    Raises
    ------
    WindowError
        An array of values has another shape.
    """
    measured = {**_measures(windows), **{name: np.asarray(array) for name, array in values.items()}}
    for name, array in measured.items():
        if array.shape != windows.areas.shape:
            raise WindowError(f"values[{name!r}] has shape {array.shape}, the windows {windows.areas.shape}")
    if cell:
        area = _by_unit(windows, "area", np.array(_pixels(windows), dtype=np.float64))
        numbers = {name: float(value) for name, value in area.items()}
        yield _feature(windows.outline_yx, corner, "annotation", {"name": cell}, numbers)
    compartments = layer_coords(windows.grid).get("compartment", ("layer", []))[1]
    for number, polygon in enumerate(polygons):
        layer, sector = divmod(number, windows.grid.sectors)
        if not len(polygon):
            continue
        named = {
            "name": f"layer {layer}, sector {sector}",
            "classification": {"name": f"layer {layer}"},
            "layer": layer,
            "sector": sector,
        }
        if len(compartments):
            named["compartment"] = str(compartments[layer])
        here = {name: float(array[layer, sector]) for name, array in measured.items()}
        yield _feature(polygon, corner, "detection", named, here)


def _pixels(windows: WindowsOnCell) -> int:
    """Pixels of the cell without excluded holes."""
    in_holes = 0 if windows.holes is None else windows.holes.box.sum()
    return int(windows.placed_mask.box.sum() - in_holes)


def _measures(windows: WindowsOnCell) -> dict[str, FloatArray]:
    """What is known of all windows without a signal."""
    return _by_unit(windows, "area", windows.areas)


def _by_unit(windows: WindowsOnCell, name: str, areas: FloatArray) -> dict[str, FloatArray]:
    """Areas in square pixels, and in µm² if the scale is known; units as QuPath writes them."""
    found = {f"{name} px^2": areas}
    if windows.scale.pixel_size_um is not None:
        found[f"{name} µm^2"] = windows.scale.area(areas)
    return found


def _feature(
    polygon_yx: FloatArray,
    corner: tuple[int, int],
    kind: str,
    named: Mapping[str, Any],
    numbers: Mapping[str, float],
) -> dict[str, Any]:
    known = {name: number for name, number in numbers.items() if np.isfinite(number)}  # JSON has no NaN
    return {
        "type": "Feature",
        "geometry": shapely.geometry.mapping(area_within(polygon_yx, corner)),
        "properties": {"objectType": kind, **named, "measurements": known},
    }


def area_within(
    polygon_yx: FloatArray, corner: tuple[int, int] = (0, 0)
) -> shapely.Polygon | shapely.MultiPolygon:
    """The area in an outline, (x, y) from the image's corner; in pieces where the outline touches itself.

    Parameters
    ----------
    polygon_yx : ndarray of shape (N, 2)
        (row, column) in pixels, pixel centres at integers; last point not repeated.
    corner : (int, int)
        (row, column) of the pixel that these count from, in the image.
    """
    points = np.round(polygon_yx + np.array(corner) + _FIRST_PIXEL, _DECIMALS)[:, ::-1]
    polygon = shapely.Polygon(points)
    if polygon.is_valid:
        return polygon
    parts = shapely.get_parts(shapely.make_valid(polygon))
    flat = [piece for part in parts for piece in shapely.get_parts(part) if piece.geom_type == "Polygon"]
    least = _SLIVER * sum(piece.area for piece in flat)
    large = [piece for piece in flat if piece.area >= least]
    return large[0] if len(large) == 1 else shapely.MultiPolygon(large)

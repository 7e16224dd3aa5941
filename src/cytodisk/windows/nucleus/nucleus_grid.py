"""Grids with layers of a nucleus, and the maps that they fit."""

from dataclasses import replace
from typing import TypeVar

from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import WindowError
from cytodisk.windows.polar_layout import PolarLayout

Layout = TypeVar("Layout", bound=PolarLayout)


def with_nucleus_of(grid: Layout, disk: DiskMap) -> Layout:
    """The grid with the radius that the nucleus has in a map.

    Parameters
    ----------
    grid : PolarLayout
    disk : DiskMap

    Returns
    -------
    PolarLayout
        The same one where neither has a nucleus.

    Raises
    ------
    WindowError
        Only one of the two has a nucleus.
    """
    nucleus = disk.nucleus
    if nucleus is None and not grid.nucleus_layers:
        return grid
    if nucleus is None:
        raise WindowError(
            f"the grid has {grid.nucleus_layers} nucleus_layers and the map no nucleus: pass nucleus to "
            "map_to_disk, or leave nucleus_layers out"
        )
    if not grid.nucleus_layers:
        raise WindowError(
            "the map has a nucleus and the grid no layers for it: pass nucleus_layers to polar_windows, such "
            "as polar_windows(layers=8, sectors=60, nucleus_layers=3)"
        )
    return replace(grid, nucleus_radius=nucleus.radius)

"""How far from the outline of its nucleus the windows of a cell lie, inside of it and outside."""

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.geometry.edge_distance import EdgeDistance
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.windows.depths import NUCLEUS_DISTANCES, window_depths
from cytodisk.windows.nucleus.compartment_rule import nuclear_box, nucleus_of
from cytodisk.windows.pixel_shares.hole_pixels import without_pixels
from cytodisk.windows.pixel_shares.shares import Subpixels


def nucleus_distances(disk: DiskMap, subpixels: Subpixels, n_windows: int) -> FloatArray:
    """Median, 5th and 95th percentile of the distance of each window's subpixels to the nuclear outline.

    Parameters
    ----------
    disk : DiskMap
        With a nucleus.
    subpixels : Subpixels
        Of its mask.
    n_windows : int

    Returns
    -------
    ndarray of shape (windows, 3) and dtype float
        In pixels, 0 or more on either side of the outline: 0 for what a pixel at the outline has on the
        other side of it. NaN for a window without subpixels.
    """
    cell, nuclear = disk.placed_mask.box, nuclear_box(disk)
    outline = disk.vertices_yx[nucleus_of(disk).boundary] - disk.placed_mask.corner
    around, found = np.pad(cell, 1), np.full((n_windows, len(NUCLEUS_DISTANCES)), np.nan)
    for box, loop in ((nuclear, outline), (~nuclear, outline[::-1])):  # from inside, from outside
        distance = EdgeDistance(PlacedMask(box, (0, 0), box.shape), loop)
        own, _ = without_pixels(subpixels, ~box[cell], n_windows)
        here = window_depths(distance, own, n_windows, around)
        found = np.where(np.isnan(here), found, here)
    return found

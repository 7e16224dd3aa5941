"""Where the nucleus lies in its cell."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.geometry.polygon import centroid

LEAST_OFFSET_PX = 1.0
"""Distance between the centroids of cell and nucleus below which it has no direction."""


class NucleusPlace(NamedTuple):
    """Size and place of a nucleus; all NaN without one.

    Attributes
    ----------
    area_px : float
        Pixels of the nucleus.
    centroid_yx : ndarray of shape (2,) and dtype float
        Of the nuclear outline, (row, column) in pixels.
    offset_px : float
        Distance between the centroids of the cell and the nucleus.
    polarity : float
        That distance over the radius of a disk of the area within the cell's outline.
    direction : float
        From the nucleus' centroid to the cell's, in degrees from +x towards +y, 0 to 360; NaN if the offset
        is below 1 px.
    """

    area_px: float
    centroid_yx: FloatArray
    offset_px: float
    polarity: float
    direction: float


NOWHERE = NucleusPlace(np.nan, np.full(2, np.nan), np.nan, np.nan, np.nan)


def nucleus_place(disk: DiskMap) -> NucleusPlace:
    """Size and place of the nucleus of a map.

    Parameters
    ----------
    disk : DiskMap
        With or without a nucleus.

    Returns
    -------
    NucleusPlace
    """
    outline = disk.nucleus_outline_yx
    if disk.nucleus is None or outline is None:
        return NOWHERE
    middle = centroid(outline)
    down, right = centroid(disk.outline_yx) - middle
    offset = float(np.hypot(down, right))
    direction = np.degrees(np.arctan2(down, right)) % 360.0 if offset >= LEAST_OFFSET_PX else np.nan
    polarity = offset / np.sqrt(disk.report.outline_px / np.pi)
    area = float(disk.nucleus.report.area_px)
    return NucleusPlace(area, middle, offset, float(polarity), float(direction))


def turn_of_disk(disk: DiskMap) -> float:
    """Angle in degrees that a direction in the disk is turned by, on average over the edge, in the cell.

    It is 0 for the map that `align="upright"` gives.
    """
    angles = disk.boundary_angles
    before = np.append(angles[-1] - 2.0 * np.pi, angles[:-1])
    after = np.append(angles[1:], angles[0] + 2.0 * np.pi)
    away = disk.outline_yx - centroid(disk.outline_yx)
    turned = np.sum((after - before) * (away[:, 1] + 1j * away[:, 0]) * np.exp(-1j * angles))
    return float(np.degrees(np.angle(turned)))


def direction_in_disk(disk: DiskMap) -> float:
    """Angle in the disk, in degrees, of the direction from the nucleus' centroid to the cell's, or NaN."""
    if disk.nucleus is None:
        return float("nan")
    return nucleus_place(disk).direction - turn_of_disk(disk)

"""Outlines of cells at rest: from +x, the heading, towards +y, with the centre at 0, in pixels."""

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.geometry.polygon import signed_area

ANGLE = np.linspace(0.0, 2.0 * np.pi, 2000, endpoint=False)  # of an outline's points, in radians


def lobed(random: np.random.Generator, radius: float, roughness: float) -> FloatArray:
    """A round outline with a few shallow lobes.

    Parameters
    ----------
    random : Generator
    radius : float
        Radius of the disk of the same area, in pixels.
    roughness : float
        Height of the largest lobe over the radius.

    Returns
    -------
    ndarray of shape (2000, 2) and dtype float
        (row, column) in pixels.
    """
    return of_area(polar(1.0 + waves(random, roughness)), radius)


def egg(random: np.random.Generator, radius: float) -> FloatArray:
    """Blunt and broad towards +x, narrow towards -x, where it bends aside; shape (2000, 2), in pixels."""
    ahead = np.cos(ANGLE)
    broad = 0.86 + 0.36 * ahead
    bent = random.choice([-1.0, 1.0]) * random.uniform(0.05, 0.15) * (ahead - 1.0) ** 2
    shape = np.column_stack([broad * np.sin(ANGLE) + bent, 0.95 * ahead - 0.2 * ahead**2])
    return of_area(shape * (1.0 + waves(random, 0.02))[:, None], radius)


def waves(random: np.random.Generator, roughness: float) -> FloatArray:
    """A sum of two to six waves around the cell, the longest the highest; shape (2000,)."""
    mode = np.arange(2, 7)
    height = roughness * random.uniform(0.5, 1.0, mode.size) * (2.0 / mode) ** 0.5
    phase = random.uniform(-np.pi, np.pi, mode.size)
    return np.asarray(height @ np.cos(np.outer(mode, ANGLE) + phase[:, None]))


def polar(distance: FloatArray) -> FloatArray:
    """Points at a distance from the centre in the directions `ANGLE`, shape (2000, 2)."""
    return np.asarray(distance[:, None] * np.column_stack([np.sin(ANGLE), np.cos(ANGLE)]))


def of_area(outline_yx: FloatArray, radius: float) -> FloatArray:
    """The outline scaled to the area of a disk."""
    return np.asarray(outline_yx * radius * np.sqrt(np.pi / signed_area(outline_yx)))


def outward(outline_yx: FloatArray) -> FloatArray:
    """Outward unit normal at each point of an outline, shape (N, 2)."""
    along = np.roll(outline_yx, -1, axis=0) - np.roll(outline_yx, 1, axis=0)
    normal = np.column_stack([-along[:, 1], along[:, 0]])
    return np.asarray(normal / np.hypot(normal[:, 0], normal[:, 1])[:, None])

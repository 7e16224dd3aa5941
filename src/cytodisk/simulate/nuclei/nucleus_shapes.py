"""Shapes of nuclei, and the pixels of a cell in which a nucleus may lie."""

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.geometry.polygon import centroid
from cytodisk.simulate.resting_shapes import of_area

EIGHT = np.ones((3, 3), dtype=bool)
_POINTS = 720
_BEAN_BEND = 0.8  # radians from the middle of a bean to each end
_BEAN_LENGTH = 0.7  # from the middle to each end, in widths


def room_for_nucleus(mask: BoolArray, gap: int = 1) -> BoolArray:
    """Pixels of a cell with cell pixels on all sides, `gap` px far, corners too; shape (H, W)."""
    return np.asarray(ndimage.binary_erosion(mask, EIGHT, iterations=gap))


def oval(area: float, elongation: float = 1.0, angle: float = 0.0) -> FloatArray:
    """Outline of an ellipse about the origin.

    Parameters
    ----------
    area : float
        In square pixels.
    elongation : float
        Longer over shorter axis.
    angle : float
        Of the longer axis, in radians from +x towards +y.

    Returns
    -------
    ndarray of shape (720, 2) and dtype float
        (row, column) in pixels, from the longer axis towards +y.
    """
    turn = np.linspace(0.0, 2.0 * np.pi, _POINTS, endpoint=False)
    across, along = np.sin(turn) / np.sqrt(elongation), np.cos(turn) * np.sqrt(elongation)
    return turned(of_area(np.column_stack([across, along]), np.sqrt(area / np.pi)), angle)


def bean(area: float, angle: float = 0.0) -> FloatArray:
    """Outline of a bean about the origin: a thick bent line with round ends, hollow on one side.

    Parameters
    ----------
    area : float
        In square pixels.
    angle : float
        Of its long axis, in radians from +x towards +y.

    Returns
    -------
    ndarray of shape (720, 2) and dtype float
        (row, column) in pixels.
    """
    bend = np.linspace(_BEAN_BEND, -_BEAN_BEND, _POINTS // 4)
    end = np.linspace(0.0, np.pi, _POINTS // 4)
    radius = 2.0 * _BEAN_LENGTH / _BEAN_BEND  # of the bent line, in half widths
    outer, inner = (radius + 1.0) * _directions(bend), (radius - 1.0) * _directions(bend[::-1])
    middle = radius * _directions(np.array([-_BEAN_BEND, _BEAN_BEND]))
    caps = [middle[0] + _directions(-_BEAN_BEND - end), middle[1] + _directions(_BEAN_BEND + np.pi - end)]
    outline = of_area(np.concatenate([outer, caps[0], inner, caps[1]]), np.sqrt(area / np.pi))
    return turned(outline - centroid(outline), angle)


def turned(outline_yx: FloatArray, angle: float) -> FloatArray:
    """Points turned about the origin, from +x towards +y; shape (N, 2)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.asarray(outline_yx @ np.array([[cosine, -sine], [sine, cosine]]))


def _directions(angle: FloatArray) -> FloatArray:
    """Unit vectors at angles from +y, (row, column)."""
    return np.column_stack([np.cos(angle), np.sin(angle)])

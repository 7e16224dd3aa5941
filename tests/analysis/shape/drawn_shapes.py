"""Shapes drawn on a grid of pixels, whose numbers are known on paper."""

import numpy as np
from skimage.draw import polygon2mask

from cytodisk.arrays import BoolArray, FloatArray


def draw(outline_yx: FloatArray) -> BoolArray:
    """Pixels inside a polygon around the origin."""
    reach = int(np.ceil(np.abs(outline_yx).max())) + 3
    return np.asarray(polygon2mask((2 * reach + 1, 2 * reach + 1), outline_yx + reach))


def ellipse(a: float, b: float, angle: float = 0.0) -> BoolArray:
    turn = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    return draw(turned(np.column_stack([b * np.sin(turn), a * np.cos(turn)]), angle))


def rectangle(a: float, b: float, angle: float = 0.0) -> BoolArray:
    """Sides `a` and `b`."""
    return draw(turned(0.5 * np.array([[-b, -a], [-b, a], [b, a], [b, -a]]), angle))


def star(arms: int, radius: float, inner: float = 0.35) -> BoolArray:
    turn = np.arange(2 * arms) * np.pi / arms + 0.1
    r = radius * np.where(np.arange(2 * arms) % 2, inner, 1.0)
    return draw(np.column_stack([r * np.sin(turn), r * np.cos(turn)]))


def lopsided(size: float, angle: float = 0.0) -> BoolArray:
    """A body with three lobes of different reach, without any symmetry."""
    turn = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    r = size * (1.0 + 0.3 * np.cos(2 * turn + 0.4) + 0.25 * np.cos(3 * turn + 1.0) + 0.1 * np.cos(5 * turn))
    return draw(turned(np.column_stack([r * np.sin(turn), r * np.cos(turn)]), angle))


def turned(points_yx: FloatArray, angle: float) -> FloatArray:
    cos, sin = np.cos(angle), np.sin(angle)
    return points_yx @ np.array([[cos, sin], [-sin, cos]])

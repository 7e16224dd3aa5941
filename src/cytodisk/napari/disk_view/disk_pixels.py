"""Which window each pixel of a picture of the disk lies in, so that a frame is painted by a look-up."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from matplotlib.colors import Colormap

from cytodisk.arrays import AnyArray, FloatArray, IntArray
from cytodisk.plot.style import colour_map
from cytodisk.windows.polar_windows import PolarGrid

_STEPS = 256  # of colours
_CLEAR = np.uint32(0)


@dataclass(frozen=True)
class DiskFrame:
    """Where the disk lies in a square picture, and the ring around it that shows the edge's velocity.

    Attributes
    ----------
    size : int
        Pixels across the picture, whose middle is that of the disk.
    radius : float
        Of the disk in pixels.
    ring : (float, float) or None
        Radii of the ring in pixels.
    """

    size: int
    radius: float
    ring: tuple[float, float] | None = None

    @cached_property
    def places_uv(self) -> FloatArray:
        """(u, v) of each pixel, shape (size, size, 2)."""
        axis = (np.arange(self.size) + 0.5 - 0.5 * self.size) / self.radius
        return np.stack(np.broadcast_arrays(axis[None, :], axis[:, None]), axis=-1)

    def point(self, u: float, v: float) -> tuple[float, float]:
        """(x, y) in the picture of a point of the disk."""
        return 0.5 * self.size + u * self.radius, 0.5 * self.size + v * self.radius

    def place(self, x: float, y: float) -> tuple[float, float] | None:
        """(u, v) of a point of the picture; one in the ring is put on the disk's rim, None elsewhere."""
        u, v = (x - 0.5 * self.size) / self.radius, (y - 0.5 * self.size) / self.radius
        away = float(np.hypot(u, v))
        if away <= 1.0:
            return u, v
        last = 1.0 if self.ring is None else self.ring[1] / self.radius
        return (u / away, v / away) if away <= last else None


@dataclass(frozen=True, eq=False)
class DiskPixels:
    """Number of the window of each pixel.

    Attributes
    ----------
    grid : PolarGrid
        With its radii.
    frame : DiskFrame
    """

    grid: PolarGrid
    frame: DiskFrame

    @cached_property
    def numbers(self) -> IntArray:
        """Window of each pixel; n_windows + sector in the ring; n_windows + sectors elsewhere."""
        grid, size = self.grid, self.frame.size
        places = self.frame.places_uv.reshape(-1, 2)
        away = np.hypot(*places.T)
        numbers = np.full(len(places), grid.n_windows + grid.sectors, dtype=np.intp)
        inside = away <= 1.0
        numbers[inside] = grid.window_of(places[inside])
        if self.frame.ring is not None:
            low, high = (radius / self.frame.radius for radius in self.frame.ring)
            around = (away >= low) & (away <= high)
            numbers[around] = grid.n_windows + grid.sector_of(places[around])
        return numbers.reshape(size, size)

    def painted(self, windows: AnyArray, ring: AnyArray | None = None) -> AnyArray:
        """Colours of the pixels.

        Parameters
        ----------
        windows : ndarray of shape (windows,) and dtype uint32
            Colours, as `colours_of` gives them.
        ring : ndarray of shape (sectors,) and dtype uint32, optional
            Without it the ring is clear.

        Returns
        -------
        ndarray of shape (size, size) and dtype uint32
            Alpha, red, green and blue; 0 where the picture is clear.
        """
        around = np.full(self.grid.sectors, _CLEAR) if ring is None else ring
        found: AnyArray = np.concatenate([windows.ravel(), around, [_CLEAR]]).astype(np.uint32)[self.numbers]
        return found

    def hatched(self, colours: AnyArray, windows: AnyArray) -> AnyArray:
        """Paint lines over some windows, in place.

        Parameters
        ----------
        colours : ndarray of shape (size, size) and dtype uint32
        windows : ndarray of shape (windows,) and dtype bool

        Returns
        -------
        ndarray
            The same colours.
        """
        chosen = np.concatenate([windows.ravel(), np.zeros(self.grid.sectors + 1, dtype=bool)])
        colours[chosen[self.numbers] & self._lines] = _HATCH
        return colours

    @cached_property
    def _lines(self) -> Any:
        step = max(4, self.frame.size // 48)
        row, column = np.indices((self.frame.size, self.frame.size), sparse=True)
        return (row + column) % step < max(1, step // 5)


@dataclass(frozen=True, eq=False)
class DiskColours:
    """What a picture of the disk shows.

    Attributes
    ----------
    grid : PolarGrid
        With its radii.
    windows : ndarray of shape (windows,) and dtype uint32, or None
        Colours; None where the cell has no map.
    ring : ndarray of shape (sectors,) and dtype uint32, or None
        Colours of the edge's velocity.
    hatched : ndarray of shape (windows,) and dtype bool, or None
    image : ndarray of shape (n, n) and dtype uint32, or None
        Colours of a signal mapped onto the disk, instead of those of windows.
    nucleus_radius : float or None
    """

    grid: PolarGrid
    windows: AnyArray | None = None
    ring: AnyArray | None = None
    hatched: AnyArray | None = None
    image: AnyArray | None = None
    nucleus_radius: float | None = None


_HATCH = np.uint32(0xFF555555)


def colours_of(values: Any, limits: tuple[float, float], colours: str) -> AnyArray:
    """Colours of numbers.

    Parameters
    ----------
    values : array_like
        NaN is light grey, as in all figures.
    limits : (float, float)
    colours : str
        Name of a colour map.

    Returns
    -------
    ndarray of the shape of values and dtype uint32
        Alpha, red, green and blue.
    """
    numbers, (low, high) = np.asarray(values, dtype=np.float64), limits
    known = np.isfinite(numbers)
    share = (np.where(known, numbers, low) - low) / (high - low)
    step = np.where(known, np.clip(share * _STEPS, 0, _STEPS - 1), _STEPS).astype(np.intp)
    found: AnyArray = colour_table(colours)[step]
    return found


@lru_cache(maxsize=8)
def colour_table(colours: str) -> AnyArray:
    """Colours of a colour map from low to high, and of what is missing as the last one; (257,)."""
    named: Colormap = colour_map(colours)
    table = named(np.linspace(0.0, 1.0, _STEPS))
    red, green, blue = np.rint(255 * np.vstack([table, named.get_bad()])[:, :3]).astype(np.uint32).T
    found: AnyArray = (np.uint32(255) << 24) | (red << 16) | (green << 8) | blue
    return found.astype(np.uint32)

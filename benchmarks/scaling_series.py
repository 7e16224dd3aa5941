"""What `scaling.py` measures: each series makes the same work larger."""

from collections.abc import Callable
from dataclasses import dataclass

import scaling_points as points


@dataclass(frozen=True)
class Growth:
    """How fast a quantity may grow.

    Attributes
    ----------
    y, x : str
        Names of the quantity and of what it grows with, among the numbers of the series' points.
    at_most : float
        Largest exponent.
    why : str
        Where that comes from.
    """

    y: str
    x: str
    at_most: float
    why: str


@dataclass(frozen=True)
class Series:
    """One kind of work at growing sizes.

    Attributes
    ----------
    name : str
    sizes : tuple of int
        In the order of measurement; `few` for a quick run.
    few : tuple of int
    measure : callable
        Numbers of a point, by name.
    growths : tuple of Growth
    """

    name: str
    sizes: tuple[int, ...]
    few: tuple[int, ...]
    measure: Callable[[int], dict[str, float]]
    growths: tuple[Growth, ...]


_LINEAR = 1.1  # one, and something for the noise of a machine that is in use
_OUTLINE, _AREA = "outline (vertices)", "area (px)"
_FACTORS = "sparse factors of a plane mesh take n^1.5 (nested dissection)"
_PIXELS = "every pixel is looked at a fixed number of times"
_FILL = "factors of a plane mesh hold n log n numbers, 1.2 over this range"
_STREAMED = "streamed: nothing may stay in memory (0.05 is 4 % a doubling)"
_SIZES = (100, 250, 630, 1600, 4000, 10000, 20000)

SERIES: dict[str, Series] = {
    series.name: series
    for series in (
        Series(
            "map of a disk",
            _SIZES,
            (250, 1000, 4000),
            lambda size: points.map_cost(points.disk_of(size)),
            (
                Growth("seconds", _OUTLINE, 2.0, "its area, in pixels, grows with the square of the outline"),
                Growth("seconds", _AREA, _LINEAR, _PIXELS),
                Growth("memory (MB)", _AREA, _LINEAR, _PIXELS),
            ),
        ),
        Series(
            "map of a fishbone",
            (2, 3, 5, 8, 13, 20, 28),
            (3, 6, 12),
            lambda size: points.map_cost(points.fishbone(size)),
            (
                Growth("seconds", _OUTLINE, 1.5, _FACTORS),
                Growth("seconds a step", _OUTLINE, 1.5, _FACTORS),
                Growth("Newton steps", _OUTLINE, 0.2, "Newton's method need not know the size of the mesh"),
                Growth("memory (MB)", _OUTLINE, 1.2, _FILL),
            ),
        ),
        Series(
            "next frame of a disk",
            (250, 630, 1600, 4000, 10000),
            (250, 1000, 4000),
            points.next_frame,
            (
                Growth("seconds", _OUTLINE, 2.0, "as the map of a disk"),
                Growth("seconds", _AREA, _LINEAR, _PIXELS),
                Growth("memory (MB)", _AREA, _LINEAR, _PIXELS),
            ),
        ),
        Series(
            "600 windows on a disk",
            (1000, 5000, 20000, 100000, 500000, 2000000),
            (2000, 20000, 200000),
            points.windows_by_area,
            (Growth("seconds", _AREA, _LINEAR, _PIXELS), Growth("memory (MB)", _AREA, _LINEAR, _PIXELS)),
        ),
        Series(
            "windows on one disk",
            (5, 10, 20, 40, 70, 100),
            (5, 20, 70),
            points.windows_by_number,
            (
                Growth("seconds", "windows", _LINEAR, "a window costs no more where there are many"),
                Growth("memory (MB)", "windows", _LINEAR, "a window costs no more where there are many"),
            ),
        ),
        Series(
            "frames of a movie",
            (8, 16, 32, 64, 128, 256),
            (8, 32),
            points.movie,
            (
                Growth("seconds", "frames", _LINEAR, "a frame costs no more late in a movie"),
                Growth("peak (MB)", "frames", 0.05, _STREAMED),
            ),
        ),
        Series(
            "cells of label images",
            (50, 100, 200, 400, 800),
            (100, 400),
            points.cells,
            (
                Growth("seconds", "cells", _LINEAR, "a cell costs no more late in a folder"),
                Growth("peak (MB)", "cells", 0.05, _STREAMED),
            ),
        ),
        Series(
            "workers on a movie",
            (1, 2),
            (1, 2),
            points.movie_workers,
            (Growth("seconds", "workers", 0.0, "a frame's map waits for that of the frame before"),),
        ),
        Series(
            "workers on label images",
            (1, 2),
            (1, 2),
            points.cell_workers,
            (Growth("seconds", "workers", -0.6, "cells do not wait for each other: 1.5 times as fast"),),
        ),
    )
}

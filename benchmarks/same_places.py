"""Two maps of nearly the same cell: do its points come into the same windows, and how far are they moved?"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt

import cytodisk as cd
from cell_outlines import Shape, rotation
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.disk_map import DiskMap

GRIDS = {"5x30": (5, 30), "10x60": (10, 60), "20x120": (20, 120)}
CHANGES = ("mirrored", "noise", "turned", "larger")
POINTS = 800
TURN_DEGREES = 17.0
TIMES_LARGER = 2.0
_FLIPPED = 0.5  # of the pixels on either side of the edge
Move = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Change:
    """Another mask of the same cell.

    Attributes
    ----------
    name : str
    mask : ndarray of shape (H, W) and dtype bool
    place : callable
        Where the other mask has points (y, x) of the first.
    turn : ndarray of shape (2, 2) and dtype float
        What the change does to the disk: (u, v) of the first map times this are those of the other.
    size : float
        Pixels of the other mask for one of the first.
    """

    name: str
    mask: BoolArray
    place: Move
    turn: FloatArray
    size: float = 1.0


def measure(
    shape: Shape, method: str, seed: int, phase: tuple[float, float] | None = None
) -> Iterator[dict[str, Any]]:
    """Rows of a shape, one for each change.

    The seed chooses where the shape lies between pixels, unless that is given, which points are followed, and
    the noise.
    """
    random = np.random.default_rng([seed, 29])
    anywhere = random.random(2)
    drawing = shape.drawn(anywhere if phase is None else phase)
    disk = cd.map_to_disk(drawing.mask, method=method)
    points = inner_points(drawing.mask, random)
    row = {"shape": shape.name, "family": shape.family, "method": method, "seed": seed} | quality(disk)
    for change in changes(shape, drawing.places, drawing.mask, random):
        other = cd.map_to_disk(change.mask, method=method)
        yield row | {"change": change.name} | compared(disk, other, points, change, shape.diameter)


def inner_points(mask: BoolArray, random: np.random.Generator) -> FloatArray:
    """Pixels more than one pixel away from the outside."""
    inner = np.argwhere(distance_transform_edt(mask) > 1.0)
    return random.permutation(inner)[:POINTS].astype(np.float64)


def quality(disk: DiskMap) -> dict[str, Any]:
    """How far the map is from keeping area, by triangle and by window."""
    percentiles = disk.distortion.area_percentiles
    figures = {
        "pixels": int(disk.mask.sum()),
        "steps": disk.steps,
        "valid": disk.certificate.valid,
        "area_error": disk.distortion.area,
        "area_ratio_p1": percentiles[1],
        "area_ratio_p99": percentiles[99],
    }
    errors = {f"window_error_{name}": window_error(disk, *grid) for name, grid in GRIDS.items()}
    return figures | errors


def window_error(disk: DiskMap, layers: int, sectors: int) -> float:
    """Mean |ln| of the windows' areas over their mean."""
    return cd.polar_windows(layers, sectors).on(disk).area_error


def changes(shape: Shape, places: Move, mask: BoolArray, random: np.random.Generator) -> Iterator[Change]:
    """The four other masks of a cell: its mirror image, with noise, turned, and twice as large."""
    last = mask.shape[1] - 1
    upright = np.eye(2)
    yield Change("mirrored", mask[:, ::-1], lambda yx: np.c_[yx[:, 0], last - yx[:, 1]], np.diag([-1.0, 1.0]))
    noisy = cd.simulate.flipped_masks(mask[None], _FLIPPED, int(random.integers(2**31)))[0]
    yield Change("noise", noisy, lambda yx: yx, upright)
    origin = places(np.zeros((1, 2)))
    turned = shape.drawn(random.random(2), turn=TURN_DEGREES)
    matrix = rotation(TURN_DEGREES)  # of (y, x); (u, v) are the other way round
    yield Change("turned", turned.mask, lambda yx: turned.places(yx - origin), matrix[::-1, ::-1])
    larger = shape.drawn(random.random(2), size=TIMES_LARGER)
    yield Change("larger", larger.mask, lambda yx: larger.places(yx - origin), upright, TIMES_LARGER)


def compared(
    disk: DiskMap, other: DiskMap, points: FloatArray, change: Change, diameter: float
) -> dict[str, float]:
    """Share of points in the same window by grid, and how far one place of the disk is moved in the cell."""
    moved = change.place(points)
    here, there = disk.to_disk(points), other.to_disk(moved, outside="nearest") @ change.turn
    shares = {}
    for name, grid in GRIDS.items():
        window_of = cd.polar_windows(*grid).window_of
        shares[f"same_{name}"] = float((window_of(here) == window_of(there)).mean())
    shift = np.hypot(*(other.to_cell(here @ change.turn.T) - moved).T) / change.size
    return shares | {
        "shift_px": float(np.median(shift)),
        "shift_percent": float(np.median(shift)) * 100.0 / diameter,
        "shift_p95_percent": float(np.percentile(shift, 95)) * 100.0 / diameter,
    }

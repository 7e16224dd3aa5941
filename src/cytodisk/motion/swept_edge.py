"""The edge of a cell cut into short pieces, and the area that each sweeps from one frame to the next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.geometry.outline import on_border
from cytodisk.motion.contour import Contour
from cytodisk.motion.matching import carry
from cytodisk.motion.registration import IDENTITY, RigidTransform
from cytodisk.motion.tracking import TrackedBoundary, point_angles

Frame: TypeAlias = Literal["lab", "cell"]
FRAMES: tuple[Frame, ...] = ("lab", "cell")

_PIECE_PX = 0.5  # length of a piece in the first frame
_LANDED_PX = 0.7  # where a piece comes to lie longer than this in the second frame, it is divided
_FASTEST_PX = 0.5  # length of edge over which the fastest motion is averaged; contours are smooth over 4 px


@dataclass(frozen=True, eq=False)
class SweptEdge:
    """Pieces of a cell's edge between two frames; what they sweep adds up to the change of area.

    Attributes
    ----------
    area_px2 : ndarray of shape (M,) and dtype float
        Signed area between a piece and the place it comes to, positive where the cell wins.
    length_px : ndarray of shape (M,) and dtype float
        Mean of the piece's lengths in both frames.
    angles : ndarray of shape (M,) and dtype float
        Where each piece starts on the disk, mean of both frames, in radians; the next one starts where it
        ends.
    free : ndarray of shape (M,) and dtype bool
        Off the image's border in both frames.
    """

    area_px2: FloatArray
    length_px: FloatArray
    angles: FloatArray
    free: BoolArray

    @property
    def absolute_px2(self) -> float:
        """Sum of the swept areas without their signs, of pieces off the border."""
        return float(np.abs(self.area_px2[self.free]).sum())

    def by_sector(self, sectors: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Swept area, length and displacement of the fastest stretch of each sector, off the border.

        A piece that lies in several sectors is shared out by its angle. A stretch is half a pixel of edge
        around a piece of the sector, and may reach over the sector's ends.

        Parameters
        ----------
        sectors : int

        Returns
        -------
        area_px2, length_px, fastest_px : ndarray of shape (S,) and dtype float
            The last one is NaN where no piece is off the border.
        """
        ends = np.append(self.angles, self.angles[0] + 2.0 * np.pi) * (sectors / (2.0 * np.pi))
        stretch = _stretch_means(self.area_px2, self.length_px, self.free, 0.5 * _FASTEST_PX)
        return _by_sector(self.area_px2, self.length_px, stretch, self.free, ends, sectors)


def swept_edge(
    here: TrackedBoundary,
    there: TrackedBoundary,
    frame: Frame = "lab",
    image_shape: tuple[int, ...] | None = None,
) -> SweptEdge:
    """Cut the edge into pieces of half a pixel, and follow each to the next frame.

    Parameters
    ----------
    here, there : TrackedBoundary
        Of two consecutive frames.
    frame : {"lab", "cell"}
        Motion in the image, or after rigid registration.
    image_shape : (int, int), optional
        By default no border cuts the cell off.

    Returns
    -------
    SweptEdge

    Notes
    -----
    Pieces are taken where the step between the two frames matched the outlines, not at the tracked points:
    where a protrusion grows, few of the first frame's points are left.
    """
    first, second = _dense(*_matched(here, there), here.contour, there.contour)
    start, stop = transforms(here, there, frame)
    a, b = start(here.contour.at(first)), stop(there.contour.at(second))
    a_next, b_next = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
    across, back = b_next - a, b - a_next
    area = 0.5 * (across[:, 0] * back[:, 1] - across[:, 1] * back[:, 0])
    length = 0.5 * (np.linalg.norm(a_next - a, axis=1) + np.linalg.norm(b_next - b, axis=1))
    free = np.ones(len(a), dtype=np.bool_)
    if image_shape is not None:
        shape = (int(image_shape[0]), int(image_shape[1]))
        cut = on_border(here.contour.outline_at(first), shape)
        cut |= on_border(there.contour.outline_at(second), shape)
        free = ~(cut | np.roll(cut, -1))
    return SweptEdge(area, length, _mean_angles(here, there, first, second), free)


def transforms(
    here: TrackedBoundary, there: TrackedBoundary, frame: Frame
) -> tuple[RigidTransform, RigidTransform]:
    """From each image to the frame in which motion is measured."""
    return (IDENTITY, IDENTITY) if frame == "lab" else (here.transform, there.transform)


def _matched(here: TrackedBoundary, there: TrackedBoundary) -> tuple[FloatArray, FloatArray]:
    """Places on both contours that the step matched; those of the tracked points if it kept none."""
    return (here.s, there.s) if there.matched_s is None else (there.matched_s[0], there.matched_s[1])


def _dense(x: FloatArray, y: FloatArray, here: Contour, there: Contour) -> tuple[FloatArray, FloatArray]:
    """Places of the pieces' ends on both contours, from places that match."""
    count = max(8, round(here.length / _PIECE_PX))
    first = here.length * np.arange(count) / count
    second = carry(first, x, y, here.length, there.length)
    gaps = np.diff(second, append=second[0] + there.length)
    parts = np.maximum(1, np.ceil(gaps / _LANDED_PX)).astype(np.int64)
    piece = np.repeat(np.arange(count), parts)
    share = (np.arange(len(piece)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[piece]
    first = first[piece] + share * here.length / count
    return first, carry(first, x, y, here.length, there.length)


def _mean_angles(
    here: TrackedBoundary, there: TrackedBoundary, first: FloatArray, second: FloatArray
) -> FloatArray:
    turn = 2.0 * np.pi
    angles = point_angles(len(here.s))
    before = carry(first, here.s, angles, here.contour.length, turn)
    after = carry(second, there.s, angles, there.contour.length, turn)
    after += turn * np.round((before - after).mean() / turn)
    return np.asarray(0.5 * (before + after))


@njit(cache=True)
def _stretch_means(area: FloatArray, length: FloatArray, free: BoolArray, reach: float) -> FloatArray:
    """Swept area over length of the stretch of edge around each piece; NaN on the border."""
    n = len(area)
    means = np.full(n, np.nan)
    for i in range(n):
        if not free[i]:
            continue
        swept, held = area[i], length[i]
        for step in (1, -1):
            gone = 0.5 * length[i]
            j = (i + step) % n
            while gone < reach and j != i and free[j]:
                swept += area[j]
                held += length[j]
                gone += length[j]
                j = (j + step) % n
        means[i] = swept / max(held, 1e-12)
    return means


@njit(cache=True)
def _by_sector(
    area: FloatArray,
    length: FloatArray,
    stretch: FloatArray,
    free: BoolArray,
    ends: FloatArray,
    sectors: int,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Share pieces out to sectors; `ends` are the pieces' ends in sectors, increasing through one turn."""
    swept, held, fastest = np.zeros(sectors), np.zeros(sectors), np.full(sectors, np.nan)
    for i in range(len(area)):
        if not free[i]:
            continue
        low, high = ends[i], ends[i + 1]
        first = int(np.floor(low))
        last = max(first, int(np.ceil(high)) - 1)
        for number in range(first, last + 1):
            share = 1.0
            if last > first:
                share = (min(high, number + 1.0) - max(low, float(number))) / (high - low)
            sector = number % sectors
            swept[sector] += share * area[i]
            held[sector] += share * length[i]
            if not abs(stretch[i]) <= abs(fastest[sector]):
                fastest[sector] = stretch[i]
    return swept, held, fastest

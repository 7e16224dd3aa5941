"""Skeleton of a cell: its branches, tips and length, without the spurs of a rough edge."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from skimage import morphology

from cytodisk.analysis.shape.cell_shape import CellShape
from cytodisk.analysis.shape.feature import FeatureGroup, plain
from cytodisk.arrays import BoolArray, FloatArray, IntArray

_SPUR = (
    0.4  # of the equivalent radius that a branch sticks out from the disk at its base; a square corner: 0.37
)


@dataclass(frozen=True)
class Skeleton:
    """The pixels of a skeleton and the links between neighbours.

    Attributes
    ----------
    depth : ndarray of shape (P,) and dtype float
        Distance of each pixel from the cell's edge, in pixels.
    links : ndarray of shape (L, 2) and dtype int
        Pairs of neighbouring pixels.
    lengths : ndarray of shape (L,) and dtype float
        Lengths of the links: 1, or √2 where only corners meet.
    """

    depth: FloatArray
    links: IntArray
    lengths: FloatArray

    @property
    def length(self) -> float:
        """Length of all links, in pixels."""
        return float(self.lengths.sum())

    @cached_property
    def neighbours(self) -> IntArray:
        """Number of neighbours of each pixel, shape (P,)."""
        return np.bincount(self.links.ravel(), minlength=len(self.depth))

    @property
    def tips(self) -> BoolArray:
        """Pixels with one neighbour, shape (P,)."""
        return np.asarray(self.neighbours == 1)

    @property
    def junctions(self) -> BoolArray:
        """Pixels with three neighbours or more, shape (P,)."""
        return np.asarray(self.neighbours > 2)

    @cached_property
    def branches(self) -> IntArray:
        """Number of the branch that each pixel belongs to, shape (P,), -1 for junctions."""
        free = self.links[~self.junctions[self.links].any(axis=1)]
        n_pixels = len(self.depth)
        graph = sparse.csr_array((np.ones(len(free)), (free[:, 0], free[:, 1])), shape=(n_pixels, n_pixels))
        _, pieces = connected_components(graph, directed=False)
        numbers = np.full(n_pixels, -1)
        numbers[~self.junctions] = np.unique(pieces[~self.junctions], return_inverse=True)[1]
        return numbers

    @property
    def n_branches(self) -> int:
        return int(self.branches.max(initial=-1)) + 1

    def without(self, pixels: BoolArray) -> Skeleton:
        """The skeleton without some of its pixels, given as an array of shape (P,) and dtype bool."""
        place = np.cumsum(~pixels) - 1
        left = ~pixels[self.links].any(axis=1)
        return Skeleton(self.depth[~pixels], place[self.links[left]], self.lengths[left])


def measure_skeleton(shape: CellShape) -> dict[str, float]:
    """Branches, tips, length and width along the skeleton.

    Parameters
    ----------
    shape : CellShape

    Returns
    -------
    dict of str to float
        By name, see `SKELETON`.
    """
    found = pruned(skeleton_of(shape), _SPUR * shape.radius)
    return {
        "skeleton_length": found.length / shape.diameter,
        "skeleton_branches": float(found.n_branches),
        "skeleton_tips": float(found.tips.sum()),
        "skeleton_width": float(found.depth.mean() / shape.radius),
        "skeleton_width_variation": float(found.depth.std() / found.depth.mean()),
    }


def skeleton_of(shape: CellShape) -> Skeleton:
    """Thin a cell to lines of one pixel.

    Parameters
    ----------
    shape : CellShape

    Returns
    -------
    Skeleton
    """
    thin: Any = morphology.skeletonize(shape.mask)  # type: ignore[no-untyped-call,unused-ignore]
    place = np.cumsum(thin).reshape(thin.shape) - 1
    down, right = thin[:-1] & thin[1:], thin[:, :-1] & thin[:, 1:]
    # Neighbours at a corner do not count where a pixel at their sides joins the two already.
    falling = thin[:-1, :-1] & thin[1:, 1:] & ~thin[:-1, 1:] & ~thin[1:, :-1]
    rising = thin[1:, :-1] & thin[:-1, 1:] & ~thin[:-1, :-1] & ~thin[1:, 1:]
    straight = [(place[:-1][down], place[1:][down]), (place[:, :-1][right], place[:, 1:][right])]
    oblique = [
        (place[:-1, :-1][falling], place[1:, 1:][falling]),
        (place[1:, :-1][rising], place[:-1, 1:][rising]),
    ]
    links = np.concatenate([np.column_stack(pair) for pair in (*straight, *oblique)])
    lengths = np.ones(len(links))
    lengths[down.sum() + right.sum() :] = np.sqrt(2.0)
    return Skeleton(shape.depth[thin], links, lengths)


def pruned(skeleton: Skeleton, least_px: float) -> Skeleton:
    """Remove branches that hardly stick out from the largest disk in the cell at their base.

    Parameters
    ----------
    skeleton : Skeleton
    least_px : float
        How far beyond that disk a branch must reach, in pixels.

    Returns
    -------
    Skeleton
    """
    while True:
        spurs = _spurs(skeleton, least_px)
        if not spurs.any():
            return skeleton
        skeleton = skeleton.without(spurs)


def _spurs(skeleton: Skeleton, least_px: float) -> BoolArray:
    """Pixels of branches with a free end that end within the disk at their base, or little beyond it."""
    branch, count = skeleton.branches, skeleton.n_branches
    first, second = branch[skeleton.links].T
    inside = (first == second) & (first >= 0)
    to_base = (first >= 0) != (second >= 0)
    base_of = np.maximum(first, second)[to_base]
    base_pixel = np.where(first < 0, skeleton.links[:, 0], skeleton.links[:, 1])[to_base]
    base, end = np.zeros(count), np.full(count, -np.inf)
    np.maximum.at(base, base_of, skeleton.depth[base_pixel])
    np.maximum.at(end, branch[skeleton.tips], skeleton.depth[skeleton.tips])
    length = np.bincount(first[inside], skeleton.lengths[inside], minlength=count)
    length += np.bincount(base_of, skeleton.lengths[to_base], minlength=count)
    spur = (base > 0) & np.isfinite(end) & (length + end < base + least_px)
    return np.asarray((branch >= 0) & spur[branch])


SKELETON = FeatureGroup(
    "skeleton",
    (
        plain("skeleton_length", "Length of the skeleton, spurs removed / equivalent diameter"),
        plain("skeleton_branches", "Branches of the skeleton, spurs removed"),
        plain("skeleton_tips", "Free ends of the skeleton, spurs removed"),
        plain("skeleton_width", "Mean distance from the skeleton to the edge / equivalent radius"),
        plain("skeleton_width_variation", "sd / mean of the distance from the skeleton to the edge"),
    ),
    measure_skeleton,
)

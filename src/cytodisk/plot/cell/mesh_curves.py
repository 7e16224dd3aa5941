"""Edges of the mesh of a cell with its nucleus as they lie on the disk, where most of them are curves."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.nucleus.cone import TURN, rounded
from cytodisk.disk.nucleus.nucleus import Nucleus

_POINTS_PER_TURN = 360  # of curves in the cytoplasm: one a degree
_SIDES = ((0, 1), (1, 2), (2, 0))


def mesh_curves(disk: DiskMap, nucleus: Nucleus) -> list[FloatArray]:
    """Every edge of the mesh once, as points on the disk.

    An edge of the cytoplasm is straight in (share, turn), so it is a curve on the disk; one of the nucleus
    is straight in the polygon of its own disk, which becomes round ray by ray.

    Parameters
    ----------
    disk : DiskMap
    nucleus : Nucleus
        Its nucleus.

    Returns
    -------
    list of ndarray of shape (N, 2) and dtype float
        (u, v).
    """
    outer = nucleus.corners(disk.triangles)
    ring = np.concatenate([outer[:, side] for side in _SIDES])[_once(disk.triangles[~nucleus.inside])]
    inner = disk.triangles[nucleus.inside]
    pairs = np.concatenate([inner[:, side] for side in _SIDES])[_once(inner)]
    within = nucleus.own_uv[pairs[~np.isin(pairs, nucleus.boundary).all(axis=1)]]
    return _in_cytoplasm(ring, nucleus) + _in_nucleus(within, nucleus)


def _once(triangles: IntArray) -> IntArray:
    """Places of the sides of triangles, side by side, that come first among equals."""
    sides = np.sort(np.concatenate([triangles[:, side] for side in _SIDES]), axis=1)
    return np.asarray(np.unique(sides, axis=0, return_index=True)[1])


def _in_cytoplasm(edges: FloatArray, nucleus: Nucleus) -> list[FloatArray]:
    """Edges from (share, turn) to (share, turn), shape (E, 2, 2), on the disk."""
    counts = 2 + np.ceil(np.abs(np.diff(edges[:, :, 1], axis=1)[:, 0]) * _POINTS_PER_TURN).astype(int)
    share, turn = np.moveaxis(_along(edges, counts), -1, 0)
    radius = nucleus.radius_at(np.maximum(share, 0.0))
    points = radius[:, None] * np.column_stack([np.cos(TURN * turn), np.sin(TURN * turn)])
    return np.split(points, np.cumsum(counts)[:-1])


def _in_nucleus(edges: FloatArray, nucleus: Nucleus) -> list[FloatArray]:
    """Edges from (u, v) to (u, v) of the nucleus' own disk, shape (E, 2, 2), on the disk of the cell."""
    length = np.hypot(*np.diff(edges, axis=1)[:, 0].T)
    counts = 2 + np.ceil(length * _POINTS_PER_TURN / TURN).astype(int)
    points = nucleus.radius * rounded(_along(edges, counts), nucleus.boundary_angles)
    return np.split(points, np.cumsum(counts)[:-1])


def _along(edges: FloatArray, counts: IntArray) -> FloatArray:
    """So many points evenly along each edge, one edge after the other, shape (points, 2)."""
    edge = np.repeat(np.arange(len(edges)), counts)
    first = np.repeat(np.cumsum(counts) - counts, counts)
    fraction = (np.arange(len(edge)) - first) / (counts[edge] - 1)
    return np.asarray(edges[edge, 0] + fraction[:, None] * (edges[edge, 1] - edges[edge, 0]))

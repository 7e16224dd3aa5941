"""Distortion of a map with a nucleus."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.distortion import LEAST_AREA, Distortion, distortion_of
from cytodisk.disk.nucleus.nucleus import Nucleus


def distortion_by_compartment(
    vertices_yx: FloatArray, vertices_uv: FloatArray, triangles: IntArray, nucleus: Nucleus
) -> Distortion:
    """Distortion with areas as shares of their compartment, in cell and disk; 1 is perfect in both.

    Parameters
    ----------
    vertices_yx, vertices_uv : ndarray of shape (V, 2) and dtype float
    triangles : ndarray of shape (F, 3) and dtype int
    nucleus : Nucleus

    Returns
    -------
    Distortion
        Stretches are those of the triangles between the vertices' places in the disk.
    """
    whole = distortion_of(vertices_yx, vertices_uv, triangles)
    ratio = np.empty(len(triangles))
    corners = nucleus.corners(triangles)
    for part, in_disk in (
        (~nucleus.inside, _areas(corners)),
        (nucleus.inside, _areas(nucleus.own_uv[triangles[nucleus.inside]][..., ::-1])),
    ):
        share, sizes = whole.area_share[part], np.maximum(np.abs(in_disk), LEAST_AREA)
        ratio[part] = sizes / sizes.sum() / (share / share.sum())
    return Distortion(ratio, whole.triangle_stretch, whole.area_share)


def _areas(corners: FloatArray) -> FloatArray:
    """Twice the signed areas of triangles from their corners (F, 3, 2)."""
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.asarray(one[:, 1] * two[:, 0] - one[:, 0] * two[:, 1])

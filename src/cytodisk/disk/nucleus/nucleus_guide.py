"""What the frame before tells about the map of a cell with its nucleus."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.harmonic import cotangents, fill_laplacian
from cytodisk.disk.nucleus.cone import TURN, to_polygon
from cytodisk.disk.nucleus.nucleus import loop_angles
from cytodisk.geometry.nucleus_mesh import NucleusMesh


class NucleusGuide(NamedTuple):
    """Where a nucleus and the inside of its cell were in the frame before.

    Attributes
    ----------
    angles : ndarray of shape (N,) and dtype float
        Of the nuclear outline in the disk in radians, increasing through one turn, which whole turns ever.
    twist : float
        How far the nucleus had turned against the membrane, in radians; see `CylinderMap`.
    depths, turns : ndarray of shape (V,) and dtype float
        Where the vertices would rather be: of the cytoplasm the share of its disk area outside them, of the
        nucleus the radius in its own disk; and their angles in radians. NaN where nothing is known.
    inertia : float
        How much they are to stay there, against equal areas.
    """

    angles: FloatArray
    twist: float
    depths: FloatArray
    turns: FloatArray
    inertia: float


def anchor_places(mesh: NucleusMesh, guide: NucleusGuide, start: FloatArray, half: float) -> FloatArray:
    """Where vertices would rather be, in the frames of `relax_compartments`.

    Parameters
    ----------
    mesh : NucleusMesh
    guide : NucleusGuide
    start : ndarray of shape (V, 2) and dtype float
        What the relaxation starts from: whole turns are chosen so that they are near it, and outlines stay.
    half : float
        The p of the nuclear outline.

    Returns
    -------
    ndarray of shape (V, 2) and dtype float
    """
    away = guide.turns - start[:, 0]
    anchor = np.column_stack([start[:, 0] + away - TURN * np.round(away / TURN), half * guide.depths])
    outline = loop_angles(start[mesh.nucleus_boundary, 0] / TURN)
    inner = mesh.vertex_inside
    anchor[inner] = to_polygon(guide.depths[inner], guide.turns[inner], outline)
    n_outlines = mesh.n_boundary + mesh.n_nucleus
    anchor[:n_outlines] = start[:n_outlines]
    return np.where(np.isnan(anchor), start, anchor)


def between_outlines(mesh: NucleusMesh, outline_values: FloatArray, system: BlockSystem) -> FloatArray:
    """Values at all vertices that are given on both outlines and harmonic between and inside them.

    Parameters
    ----------
    mesh : NucleusMesh
    outline_values : ndarray of shape (B + N, 2) and dtype float
        Two numbers a vertex of membrane and nuclear outline, such as a displacement.
    system : BlockSystem
        Of this mesh.

    Returns
    -------
    ndarray of shape (V, 2) and dtype float
    """
    values = np.zeros((len(mesh.vertices_yx), 2))
    values[: len(outline_values)] = outline_values
    unknown, place = system.unknown.copy(), system.place.copy()
    loop = mesh.nucleus_boundary
    pinned = unknown[loop]
    unknown[loop] = -1
    on_loop = (mesh.triangles >= loop[0]) & (mesh.triangles <= loop[-1])
    place[on_loop[:, :, None] | on_loop[:, None, :]] = -1
    right = np.zeros((len(system.vertex), 2))
    weights = cotangents(mesh).reshape(3, -1)
    fill_laplacian(mesh.triangles, weights, values, unknown, place, system.blocks, right)
    for axis in (0, 1):
        system.blocks[system.diagonal[pinned], axis, axis] = 1.0
    right[pinned] = values[loop]
    system.factorise()
    values[system.vertex] = system.solve(right)
    return values

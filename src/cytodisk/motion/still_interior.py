"""Disk map of a later frame whose inside keeps its place in the lab; only near the edge it moves with it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.cell_mesh import CellMesh
from cytodisk.disk.disk_map import DiskMap, Start
from cytodisk.disk.harmonic import fading_extension, harmonic_map, vertex_areas
from cytodisk.disk.mapping import disk_map
from cytodisk.disk.mapping_parameters import NEWTON_METHODS
from cytodisk.disk.newton_triangles import relax_triangles
from cytodisk.disk.untangle import untangled
from cytodisk.errors import ParameterError
from cytodisk.geometry.mesh import triangle_areas
from cytodisk.motion.tracking_parameters import MovieSettings
from cytodisk.scale import Scale

FADE_PX = 4.0
_LEAST_FADE_PX = 1.0 - 1e-9  # the mesh shows no shorter one, and the edge would move in ever more steps
_LONGEST_STEP = 0.5  # of the fade: how far the edge moves at once
_MOST_AWAY = 0.01  # of the diameter: places farther from the last map than that have lost it
_PULL = 1e5  # towards the carried places
_SHAPE_WEIGHT = 0.02
_ON_CIRCLE = 1.0 - 1e-12  # just inside, so that it has a place in the cell


class StillMap(NamedTuple):
    """Map of a frame, and why its inside did not go on from the frame before; empty if it did."""

    disk: DiskMap
    restarted: str


def fade_in_px(settings: MovieSettings, scale: Scale) -> float:
    """Depth in pixels over which the motion of the edge fades.

    Parameters
    ----------
    settings : MovieSettings
    scale : Scale

    Returns
    -------
    float

    Raises
    ------
    ParameterError
        `fade_um` is given, but not the size of a pixel, or not interior "still"; it is less than a pixel; or
        the method relaxes no interior.
    """
    if settings.interior == "area":
        if settings.fade_um is not None:
            raise ParameterError('fade_um is for interior "still": pass --interior still (interior="still")')
        return FADE_PX
    if settings.method not in NEWTON_METHODS:
        raise ParameterError(
            f'interior "still" needs method "newton" or "newton-triangles", got {settings.method!r}'
        )
    if settings.fade_um is None:
        return FADE_PX
    if scale.pixel_size_um is None:
        raise ParameterError("fade_um needs a pixel size: pass it as --pixel-size (pixel_size_um=…)")
    fade_px = settings.fade_um / scale.pixel_size_um
    if fade_px < _LEAST_FADE_PX:
        raise ParameterError(
            f"fade_um must be at least the side of a pixel, {scale.pixel_size_um:g} µm, got "
            f"{settings.fade_um:g}"
        )
    return fade_px


def still_map(
    cell: CellMesh, angles: FloatArray, previous: DiskMap, settings: MovieSettings, fade_px: float
) -> StillMap:
    """Map a frame so that what is far from the edge keeps its place in the lab since the frame before.

    The displacement of the edge fades inwards as exp(-depth / fade), in steps of at most half the fade. The
    last map is read where each vertex came from. Flipped triangles push their corners apart; then the
    vertices are pulled to the places they had, under a barrier that no triangle passes. Areas do not count.

    Parameters
    ----------
    cell : CellMesh
        This frame.
    angles : ndarray of shape (B,) and dtype float
        Angle of each boundary vertex, in radians, strictly increasing within one turn.
    previous : DiskMap
        The last frame's.
    settings : MovieSettings
    fade_px : float

    Returns
    -------
    StillMap
        With a valid certificate.

    Raises
    ------
    MapError
        No valid map was found.
    """
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    origin = origins(cell, previous.to_cell(circle * _ON_CIRCLE), fade_px)
    anchor = previous.to_disk(origin, outside="nearest")
    anchor[: len(circle)] = circle
    uv = untangled(cell.mesh, anchor)
    start: Start = "previous"
    if uv is None:
        uv, start = harmonic_map(cell.mesh, circle, cell.system)
    relaxed = relax_triangles(cell.mesh, uv, _SHAPE_WEIGHT, anchor, _PULL, cell.system, area_weight=0.0)
    away = 0.5 * _distance_of_most(cell, relaxed.vertices_uv - anchor)
    why = f"places inside lie {away:.1%} of the diameter from where the last map has them"
    return StillMap(disk_map(cell, relaxed, start, settings), why if away > _MOST_AWAY else "")


def _distance_of_most(cell: CellMesh, moved_uv: FloatArray) -> float:
    """Distance in the disk that 95 % of a cell's area have not moved beyond."""
    distance = np.linalg.norm(moved_uv, axis=1)
    order = np.argsort(distance)
    share = np.cumsum(vertex_areas(cell.mesh)[order])
    return float(distance[order][np.searchsorted(share, 0.95 * share[-1])])


def origins(cell: CellMesh, boundary_yx: FloatArray, fade_px: float) -> FloatArray:
    """Where each vertex of a mesh was, if its boundary was elsewhere and its inside hardly moved.

    Parameters
    ----------
    cell : CellMesh
    boundary_yx : ndarray of shape (B, 2) and dtype float
        Where the boundary vertices were, in the image.
    fade_px : float

    Returns
    -------
    ndarray of shape (V, 2) and dtype float
    """
    moved = boundary_yx - cell.corner - cell.outline
    steps = max(1, math.ceil(float(np.linalg.norm(moved, axis=1).max()) / (_LONGEST_STEP * fade_px)))
    places, mesh = cell.mesh.vertices_yx, cell.mesh
    for _ in range(steps):
        places = places + fading_extension(mesh, moved / steps, fade_px, cell.system)
        # Where the edge passed itself, triangles are turned over: the equation stays that of the mesh before.
        if (triangle_areas(places, mesh.triangles) > 0.0).all():
            mesh = replace(mesh, vertices_yx=places)
    return places + cell.corner

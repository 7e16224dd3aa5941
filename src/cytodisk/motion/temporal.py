"""Disk map of a later frame: boundary angles from tracked points, interior from the last frame."""

import numpy as np
from scipy.interpolate import PchipInterpolator

from cytodisk.arrays import FloatArray
from cytodisk.disk.cell_mesh import CellMesh
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.harmonic import harmonic_extension
from cytodisk.motion.contour import Contour
from cytodisk.motion.matching import carry

_LEAST_GAP = 1e-3  # of the mean angle between neighbouring outline points
_OVERHANG = 3


def tracked_angles(contour: Contour, s: FloatArray, angles: FloatArray) -> FloatArray:
    """Angle on the circle of each outline point, from tracked points on the same outline.

    Parameters
    ----------
    contour : Contour
    s : ndarray of shape (N,) and dtype float
        Distance along the contour of the tracked points, strictly increasing through one turn.
    angles : ndarray of shape (N,) and dtype float
        Their angles in radians, strictly increasing through one turn.

    Returns
    -------
    ndarray of shape (B,) and dtype float
        Strictly increasing, all within one turn: cubic interpolation that keeps order (Fritsch & Carlson
        1980, doi:10.1137/0717021).
    """
    turn, length = 2.0 * np.pi, contour.length
    x = np.concatenate([s[-_OVERHANG:] - length, s, s[:_OVERHANG] + length])
    y = np.concatenate([angles[-_OVERHANG:] - turn, angles, angles[:_OVERHANG] + turn])
    at = s[0] + np.mod(contour.arc[:-1] - s[0], length)
    found = PchipInterpolator(x, y)(at)
    found = np.unwrap(found)  # the outline's first point may lie within the turn
    gaps = np.diff(found, append=found[0] + turn)
    gaps = np.maximum(gaps, _LEAST_GAP * turn / len(gaps))
    steps = np.cumsum(gaps) * (turn / gaps.sum())
    return np.asarray(found[0] + np.concatenate([[0.0], steps[:-1]]))


def carried_inside(
    cell: CellMesh,
    contour: Contour,
    s: FloatArray,
    previous: DiskMap,
    previous_contour: Contour,
    previous_s: FloatArray,
) -> FloatArray:
    """Where a cell's vertices lie in the disk if its inside moved with its boundary since the last frame.

    The boundary's displacement since then is continued inside by a harmonic function, and the last map is
    read at the place that each vertex came from.

    Parameters
    ----------
    cell : CellMesh
        This frame.
    contour, previous_contour : Contour
        This frame's and the last one's, both in the image's frame.
    s, previous_s : ndarray of shape (N,) and dtype float
        The tracked points on them.
    previous : DiskMap
        The last frame's.

    Returns
    -------
    ndarray of shape (V, 2) and dtype float
        (u, v); not certified.
    """
    moved = displacement_back(contour, s, previous_contour, previous_s)
    origin = cell.mesh.vertices_yx + cell.corner + harmonic_extension(cell.mesh, moved, cell.system)
    return previous.to_disk(origin, outside="nearest")


def displacement_back(
    contour: Contour, s: FloatArray, previous_contour: Contour, previous_s: FloatArray
) -> FloatArray:
    """From each point of an outline to where it was in the last frame, shape (B, 2).

    Parameters
    ----------
    contour, previous_contour : Contour
        This frame's and the last one's, both in the image's frame.
    s, previous_s : ndarray of shape (N,) and dtype float
        The tracked points on them.

    Returns
    -------
    ndarray of shape (B, 2) and dtype float
        (row, column) in pixels.
    """
    was = carry(contour.arc[:-1], s, previous_s, contour.length, previous_contour.length)
    return np.asarray(previous_contour.outline_at(was) - contour.outline_yx)

"""What the harmonic map onto the disk does to a cell: protrusions shrink, the more the farther they reach."""

import numpy as np

from cytodisk.analysis.shape.cell_shape import CellShape, even_steps
from cytodisk.analysis.shape.feature import FeatureGroup, plain
from cytodisk.arrays import FloatArray
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.distortion import distortion_of
from cytodisk.disk.harmonic import harmonic_map
from cytodisk.errors import MeshError
from cytodisk.geometry.mesh import Mesh, mesh_inside

_STEPS_ACROSS = 40  # edges of the mesh along the equivalent diameter; finer ones rank cells the same
_FINEST_PX = 0.9  # as `map_to_disk` has it
FINE_MESH = (
    "harmonic features from a mesh as fine as the pixels: its outline cannot be meshed in larger steps"
)
_PERCENTILES = (5, 25, 75, 95)


def measure_distortion(shape: CellShape) -> dict[str, float]:
    """Area and angle error of the harmonic map, on a mesh as coarse as the cell's size allows.

    Parameters
    ----------
    shape : CellShape

    Returns
    -------
    dict of str to float
        By name, see `DISTORTION`.

    Raises
    ------
    MapError
        The cell is too branched for its size to be mapped in double precision.
    """
    mesh = coarse_mesh(shape)
    angles = boundary_angles(mesh.vertices_yx[: mesh.n_boundary])
    vertices_uv, _ = harmonic_map(mesh, np.column_stack([np.cos(angles), np.sin(angles)]))
    found = distortion_of(mesh.vertices_yx, vertices_uv, mesh.triangles)
    areas, angle = found.area_percentiles, found.angle_percentiles
    return {
        "harmonic_area_error": found.area,
        "harmonic_angle_error": angle[50] - 1.0,
        "harmonic_angle_error_p95": angle[95] - 1.0,
        **{f"harmonic_area_p{p:02d}": float(np.log2(areas[p])) for p in _PERCENTILES},
        "harmonic_inner": _inner_share(mesh, vertices_uv, found.area_share),
    }


def coarse_mesh(shape: CellShape) -> Mesh:
    """Triangulation of a cell whose edges are a fortieth of its equivalent diameter.

    Where the cell is thinner than such an edge, opposite edges of the outline can cross. The outline is then
    that of the pixels, the mesh as fine as they are, and the shape's notes say so.

    Parameters
    ----------
    shape : CellShape

    Returns
    -------
    Mesh

    Raises
    ------
    MeshError
        The pixel outline cannot be meshed either.
    """
    step = max(_FINEST_PX, shape.diameter / _STEPS_ACROSS)
    outline = even_steps(shape.outline, max(16, round(shape.perimeter / step)))
    try:
        return mesh_inside(outline, shape.mask, edge_length=step)
    except MeshError:
        shape.notes.append(FINE_MESH)
        return mesh_inside(shape.traced, shape.mask, edge_length=_FINEST_PX)


def _inner_share(mesh: Mesh, vertices_uv: FloatArray, share: FloatArray) -> float:
    """Share of the cell that the map puts into the inner half of the disk's area; 0.5 for a disk."""
    middles = vertices_uv[mesh.triangles].mean(axis=1)
    return float(share @ ((middles**2).sum(axis=1) < 0.5))


DISTORTION = FeatureGroup(
    "distortion",
    (
        plain("harmonic_area_error", "Mean |ln λ| of the harmonic map; 0 for a disk"),
        plain("harmonic_angle_error", "Median ratio of largest to smallest stretch - 1; 0 for a disk"),
        plain("harmonic_angle_error_p95", "Percentile 95 of the ratio of largest to smallest stretch - 1"),
        *(
            plain(f"harmonic_area_p{p:02d}", f"Percentile {p} of log2 λ, λ disk area over cell area")
            for p in _PERCENTILES
        ),
        plain("harmonic_inner", "Share of the cell that comes into the inner half of the disk's area"),
    ),
    measure_distortion,
)

"""`map_to_disk`: from a mask to a map with its certificate."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.advection import advect
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.disk_map import DiskMap, Start
from cytodisk.disk.harmonic import harmonic_map
from cytodisk.disk.mapping_parameters import NEWTON_METHODS, Align, MappingParameters, MapToDiskParameters
from cytodisk.disk.newton import relax
from cytodisk.disk.newton_triangles import relax_triangles
from cytodisk.disk.relaxed import Relaxed
from cytodisk.disk.untangle import untangled
from cytodisk.errors import MapError
from cytodisk.geometry.mask import MaskReport, clean_mask
from cytodisk.geometry.mesh import Mesh, mesh_inside
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.scale import UNKNOWN, Scale
from cytodisk.taking import takes

# Triangles of nearly one area up to the edge: at this clearance they differ least on the reference masks.
_ISOTROPIC = {"growth": 0.0, "clearance": 0.5}


@takes(MapToDiskParameters)
def map_to_disk(
    mask: Any,
    **settings: Any,
) -> DiskMap:
    """Map one cell one to one onto the unit disk.

    The mask is first reduced to its largest piece without holes (`clean_mask`); the map's `report` says what
    that changed.

    Parameters
    ----------
    mask : array_like of shape (H, W), or DataArray with dims (y, x)
        One cell: boolean, whole numbers with one value beside 0, or floats that are 0 and 1.
    **settings
        See `MapToDiskParameters`.

    Returns
    -------
    DiskMap
        With a valid certificate, except for "advection".

    Raises
    ------
    MaskError
        The mask is not the mask of one cell.
    ParameterError
        A parameter is out of its range.
    MapError
        No valid map was found; never an invalid map instead. "advection" raises it only if the harmonic map
        it starts from is not valid.

    See Also
    --------
    map_movie : The cell of a movie, with maps that correspond through time.
    certify : The proof alone.
    load_map : Read a map from a file.

    References
    ----------
    u-Unwrap, section 3 (ii) and appendix A.2.1.

    Examples
    --------
    >>> import cytodisk as cd
    >>> disk = cd.map_to_disk(cd.simulate.star(arms=3, body_radius=12, arm_length=20))
    >>> disk.certificate.valid
    True
    >>> disk.to_cell([[0.0, 0.0]]).round(1)  # the cell's point at the disk's centre, (row, column)
    array([[37. , 27.6]])
    """
    parameters = MapToDiskParameters.of(**settings)
    return map_cell(mask, parameters, Scale.of(mask).given(parameters.pixel_size_um))


def map_cell(mask: Any, parameters: MappingParameters, scale: Scale = UNKNOWN) -> DiskMap:
    """As `map_to_disk`, with parameters that are known already."""
    cell = mesh_cell(mask, parameters, scale)
    angles = boundary_angles(cell.outline, _relative(parameters.align, cell.corner))
    return map_mesh(cell, angles, parameters)


@dataclass(frozen=True, eq=False)
class CellMesh:
    """A cleaned mask with the mesh that is to be mapped.

    Attributes
    ----------
    placed_mask : PlacedMask
    report : MaskReport
    mesh : Mesh
        In the frame of the mask's bounding box, so that a shifted mask gives the same mesh.
    corner : ndarray of shape (2,) and dtype float
        First pixel of the bounding box.
    edge_length : float
    scale : Scale
    """

    placed_mask: PlacedMask
    report: MaskReport
    mesh: Mesh
    corner: FloatArray
    edge_length: float
    scale: Scale

    @cached_property
    def system(self) -> BlockSystem:
        """For functions on the mesh that are given at its boundary."""
        return BlockSystem(self.mesh)

    @property
    def outline(self) -> FloatArray:
        """Outline in the frame of the bounding box, shape (B, 2)."""
        return self.mesh.vertices_yx[: self.mesh.n_boundary]


def mesh_cell(mask: Any, parameters: MappingParameters, scale: Scale = UNKNOWN) -> CellMesh:
    """Clean a mask and triangulate its inside.

    Parameters
    ----------
    mask : array_like of shape (H, W), or PlacedMask
        As for `map_to_disk`; or its box, with one more pixel on every side where the image goes on.
    parameters : MappingParameters
        Method "advection" needs triangles of one size, the others take larger ones inside.
    scale : Scale
        Scale of the image.

    Returns
    -------
    CellMesh

    Raises
    ------
    MaskError
        The mask is not the mask of one cell.
    MeshError
        It could not be triangulated.
    """
    corner, image_shape = (0, 0), ()
    if isinstance(mask, PlacedMask):
        mask, corner, image_shape = mask.box, mask.corner, mask.image_shape
    cleaned, report = clean_mask(mask)
    placed = PlacedMask.of(cleaned, corner, image_shape)
    spacing = _ISOTROPIC if parameters.method == "advection" else {}
    mesh = mesh_inside(trace_outline(placed.box), placed.box, edge_length=parameters.spacing_px, **spacing)
    first = np.array(placed.corner, dtype=np.float64)
    return CellMesh(placed, report, mesh, first, parameters.spacing_px, scale)


def map_mesh(
    cell: CellMesh,
    angles: FloatArray,
    parameters: MappingParameters,
    *,
    anchor_uv: FloatArray | None = None,
    inertia: float = 0.0,
) -> DiskMap:
    """Map a meshed cell onto the disk, with its boundary at given angles.

    Parameters
    ----------
    cell : CellMesh
    angles : ndarray of shape (B,) and dtype float
        Angle of each boundary vertex in radians, strictly increasing, all within one turn.
    parameters : MappingParameters
    anchor_uv : ndarray of shape (V, 2) and dtype float, optional
        Where the vertices would rather be, such as where the last frame of a movie puts them. The
        relaxation starts there if its flipped triangles can be mended, else from the harmonic map; `start`
        of the map says which it was. "advection" always starts from the harmonic map.
    inertia : float
        How much the inside is to stay at the anchor, against equal areas; see `relax`.

    Returns
    -------
    DiskMap
        With a valid certificate, except for "advection".

    Raises
    ------
    MapError
        No valid map was found.
    """
    method, shape_weight = parameters.method, parameters.shape_weight
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    uv, start = _start(cell, circle, None if method == "advection" else anchor_uv)
    if method in NEWTON_METHODS:
        by_newton = relax if method == "newton" else relax_triangles
        relaxed = by_newton(cell.mesh, uv, shape_weight, anchor_uv, inertia, cell.system)
        return disk_map(cell, relaxed, start, parameters)
    if method == "advection":
        advected = advect(cell.mesh, uv)
        made = Relaxed(advected.vertices_uv, advected.steps, True)
        return disk_map(cell, made, start, parameters, advected.triangles)
    return disk_map(cell, Relaxed(uv, 0, True), start, parameters)


def disk_map(
    cell: CellMesh,
    relaxed: Relaxed,
    start: Start,
    parameters: MappingParameters,
    triangles: IntArray | None = None,
) -> DiskMap:
    """Map of a cell from where its vertices lie in the disk.

    Parameters
    ----------
    cell : CellMesh
    relaxed : Relaxed
    start : str
        What the relaxation started from.
    parameters : MappingParameters
    triangles : ndarray of shape (F, 3) and dtype int, optional
        Where they are not those of the mesh.

    Returns
    -------
    DiskMap

    Raises
    ------
    MapError
        The certificate is not valid; the method "advection" alone may return such a map.
    """
    disk = DiskMap(
        vertices_yx=cell.mesh.vertices_yx + cell.corner,
        vertices_uv=relaxed.vertices_uv,
        triangles=cell.mesh.triangles if triangles is None else triangles,
        boundary=cell.mesh.boundary,
        placed_mask=cell.placed_mask,
        report=cell.report,
        method=parameters.method,
        start=start,
        shape_weight=parameters.shape_weight,
        edge_length=cell.edge_length,
        steps=relaxed.steps,
        converged=relaxed.converged,
        scale=cell.scale,
    )
    if parameters.method != "advection" and not disk.certificate.valid:
        raise MapError(f"no valid map was found: {'; '.join(disk.certificate.faults)}")
    return disk


def _start(cell: CellMesh, circle: FloatArray, anchor_uv: FloatArray | None) -> tuple[FloatArray, Start]:
    if anchor_uv is not None:
        uv = untangled(cell.mesh, np.concatenate([circle, anchor_uv[cell.mesh.n_boundary :]]))
        if uv is not None:
            return uv, "previous"
    return harmonic_map(cell.mesh, circle, cell.system)


def _relative(align: Align, corner: FloatArray) -> Align:
    if isinstance(align, tuple):
        return (align[0] - corner[0], align[1] - corner[1])
    return align

"""`map_to_disk`: from a mask to a map with its certificate."""

from typing import Any, NamedTuple

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.by_advection.advection import advect
from cytodisk.disk.cell_mesh import CellMesh, mesh_cell
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.disk_map import DiskMap, Start
from cytodisk.disk.harmonic import harmonic_map
from cytodisk.disk.mapping_parameters import NEWTON_METHODS, Align, MappingParameters, MapToDiskParameters
from cytodisk.disk.newton import relax
from cytodisk.disk.newton_triangles import relax_triangles
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.disk.nucleus.nucleus_guide import NucleusGuide
from cytodisk.disk.nucleus.nucleus_mapping import map_compartments
from cytodisk.disk.nucleus.nucleus_parameters import NucleusParameters, NucleusRadius
from cytodisk.disk.relaxed import Relaxed
from cytodisk.disk.untangle import untangled
from cytodisk.errors import MapError, ParameterError
from cytodisk.geometry.nucleus_mesh import NucleusMesh
from cytodisk.geometry.polygon import centroid
from cytodisk.scale import UNKNOWN, Scale
from cytodisk.taking import takes

_PLAIN = NucleusParameters()


@takes(MapToDiskParameters)
def map_to_disk(
    mask: Any,
    nucleus: Any = None,
    **settings: Any,
) -> DiskMap:
    """Map one cell one to one onto the unit disk, with its nucleus on a circle of its own if it is given.

    The mask is first reduced to its largest piece without holes (`clean_mask`); the map's `report` says what
    that changed. With `holes="exclude"` the map is the same, and knows its holes. The nucleus is fitted into
    the cell (`fit_nucleus`), as the report of the map's `nucleus` says.

    Parameters
    ----------
    mask : array_like of shape (H, W), or DataArray with dims (y, x)
        One cell: boolean, whole numbers with one value beside 0, or floats that are 0 and 1.
    nucleus : array_like of shape (H, W), optional
        The cell's nucleus, in the same image. Then the places between membrane and nucleus, and those inside
        the nucleus, keep their share of their compartment's area.
    **settings
        See `MapToDiskParameters`; `nucleus_radius` and `several` count with a nucleus alone.

    Returns
    -------
    DiskMap
        With a valid certificate, except for "advection".

    Raises
    ------
    MaskError
        The mask is not the mask of one cell.
    NucleusError
        The nucleus is not that of this cell.
    ParameterError
        A parameter is out of its range, or does not go with a nucleus.
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

    >>> nucleus = cd.simulate.disk(5, margin=23)
    >>> disk = cd.map_to_disk(cd.simulate.disk(20), nucleus=nucleus)
    >>> disk.certificate.valid, disk.nucleus_radius
    (True, 0.5)
    """
    parameters = MapToDiskParameters.of(**settings)
    scale = Scale.of(mask).given(parameters.pixel_size_um)
    return map_cell(mask, parameters, scale, nucleus, parameters.part(NucleusParameters))


def map_cell(
    mask: Any,
    parameters: MappingParameters,
    scale: Scale = UNKNOWN,
    nucleus: Any = None,
    of_nucleus: NucleusParameters = _PLAIN,
) -> DiskMap:
    """As `map_to_disk`, with parameters that are known already."""
    cell = mesh_cell(mask, parameters, scale, nucleus, of_nucleus.several)
    angles = boundary_angles(cell.outline, align_of(cell, parameters.align))
    return map_mesh(cell, angles, parameters, nucleus_radius=of_nucleus.nucleus_radius)


def align_of(cell: CellMesh, align: Align) -> Align:
    """Where the disk's rotation is to end, in the frame of the cell's box.

    Raises
    ------
    ParameterError
        It goes by the nucleus, and there is none.
    """
    if align != "nucleus":
        return _relative(align, cell.corner)
    if cell.nucleus_outline is None:
        raise ParameterError('align "nucleus" needs a nucleus: pass it (nucleus=…, --nuclei)')
    away = centroid(cell.outline) - centroid(cell.nucleus_outline)
    return -float(np.degrees(np.arctan2(away[0], away[1])))


def map_mesh(
    cell: CellMesh,
    angles: FloatArray,
    parameters: MappingParameters,
    *,
    anchor_uv: FloatArray | None = None,
    inertia: float = 0.0,
    nucleus_radius: NucleusRadius = _PLAIN.nucleus_radius,
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
    nucleus_radius : float or "area"
        Of the circle of a nucleus.

    Returns
    -------
    DiskMap
        With a valid certificate, except for "advection".

    Raises
    ------
    MapError
        No valid map was found.
    """
    if cell.nucleus is not None:
        return map_with_nucleus(cell, angles, parameters, nucleus_radius).disk
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


class MapWithNucleus(NamedTuple):
    """A map with a nucleus, as a movie goes on from it.

    Attributes
    ----------
    disk : DiskMap
    twist : float
        How far the nucleus has turned against the membrane, in radians; see `CylinderMap`.
    unwound : bool
        Whether a whole turn was taken back since the frame before.
    """

    disk: DiskMap
    twist: float
    unwound: bool


def map_with_nucleus(
    cell: CellMesh,
    angles: FloatArray,
    parameters: MappingParameters,
    nucleus_radius: NucleusRadius,
    guide: NucleusGuide | None = None,
) -> MapWithNucleus:
    """Map a meshed cell and its nucleus onto the disk, with the membrane at given angles.

    Parameters
    ----------
    cell : CellMesh
        With a nucleus.
    angles : ndarray of shape (B,) and dtype float
        As for `map_mesh`.
    parameters : MappingParameters
    nucleus_radius : float or "area"
    guide : NucleusGuide, optional
        Of the frame before in a movie; without it the nuclear outline slides to where cytoplasm and nucleus
        are mapped best.

    Returns
    -------
    MapWithNucleus
        With a valid certificate.

    Raises
    ------
    MapError
        No valid map was found.
    """
    assert cell.nucleus is not None
    assert isinstance(cell.mesh, NucleusMesh)
    parts = cell.mesh, cell.nucleus, angles, parameters.shape_weight
    found = map_compartments(*parts, nucleus_radius, guide, cell.system)
    disk = disk_map(cell, found.relaxed, found.start, parameters, nucleus=found.nucleus)
    return MapWithNucleus(disk, found.twist, found.unwound)


def disk_map(
    cell: CellMesh,
    relaxed: Relaxed,
    start: Start,
    parameters: MappingParameters,
    triangles: IntArray | None = None,
    nucleus: Nucleus | None = None,
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
    nucleus : Nucleus, optional

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
        nucleus=nucleus,
        holes=cell.holes,
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

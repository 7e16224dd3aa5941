"""The proof that a map is a bijection, from its arrays alone."""

from dataclasses import dataclass

import numpy as np
from shapely.geometry import LinearRing

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.geometry.exact import orientations
from cytodisk.geometry.half_edges import HalfEdges, half_edges

_ON_CIRCLE = 1e-12


@dataclass(frozen=True)
class Certificate:
    """Whether a map is one to one, and what speaks against it.

    A piecewise linear map of a disk-type triangulation that keeps every triangle positive and takes the
    boundary one to one onto a convex polygon's is a bijection. `faults` lists every condition that does not
    hold; the map is valid when there is none.

    Attributes
    ----------
    faults : tuple of str
        In words; empty for a valid map.
    flipped_in_cell, flipped_in_disk : tuple of int
        Triangles whose area is not positive.
    n_triangles : int
    n_exact : int
        Signs that floating point left in doubt and rational arithmetic decided.
    euler_characteristic : int
        1 for a topological disk.

    Examples
    --------
    >>> import cytodisk as cd
    >>> proof = cd.map_to_disk(cd.simulate.disk(10)).certificate
    >>> proof.valid, proof.faults, proof.flipped_in_disk
    (True, (), ())
    """

    faults: tuple[str, ...]
    flipped_in_cell: tuple[int, ...]
    flipped_in_disk: tuple[int, ...]
    n_triangles: int
    n_exact: int
    euler_characteristic: int

    @property
    def valid(self) -> bool:
        """True when every condition of the proof holds."""
        return not self.faults


def certify(
    vertices_yx: FloatArray, vertices_uv: FloatArray, triangles: IntArray, boundary: IntArray
) -> Certificate:
    """Check every condition under which a map is a bijection.

    Parameters
    ----------
    vertices_yx : ndarray of shape (V, 2) and dtype float
        In the cell, (row, column).
    vertices_uv : ndarray of shape (V, 2) and dtype float
        In the disk, (u, v).
    triangles : ndarray of shape (F, 3) and dtype int
    boundary : ndarray of shape (B,) and dtype int
        The boundary loop in order.

    Returns
    -------
    Certificate
        Never raises for a bad map: it says what is wrong.

    See Also
    --------
    map_to_disk : Makes a map, which has its certificate.

    Examples
    --------
    >>> import cytodisk as cd
    >>> disk = cd.map_to_disk(cd.simulate.disk(10))
    >>> mirrored = disk.vertices_uv[:, ::-1]
    >>> cd.certify(disk.vertices_yx, disk.vertices_uv, disk.triangles, disk.boundary).valid
    True
    >>> cd.certify(disk.vertices_yx, mirrored, disk.triangles, disk.boundary).valid
    False
    """
    broken = malformed(vertices_yx, vertices_uv, triangles, boundary)
    if broken:
        return Certificate(broken, (), (), len(triangles), 0, 0)
    in_cell, exact_cell = orientations(vertices_yx, triangles)
    in_disk, exact_disk = orientations(vertices_uv[:, ::-1], triangles)
    edges = half_edges(triangles, len(vertices_yx))
    faults = orientation_faults(in_cell, in_disk)
    faults += mesh_faults(edges)
    faults += boundary_faults(vertices_yx, vertices_uv, edges, boundary)
    return Certificate(
        faults=tuple(faults),
        flipped_in_cell=tuple(np.flatnonzero(in_cell <= 0).tolist()),
        flipped_in_disk=tuple(np.flatnonzero(in_disk <= 0).tolist()),
        n_triangles=len(triangles),
        n_exact=exact_cell + exact_disk,
        euler_characteristic=edges.euler_characteristic,
    )


def orientation_faults(in_cell: IntArray, in_disk: IntArray) -> list[str]:
    """What speaks against all triangles being positive, from their signs in cell and disk."""
    faults = []
    for sign, frame in ((in_cell, "cell"), (in_disk, "disk")):
        count = int((sign <= 0).sum())
        if count:
            are = "triangle is" if count == 1 else "triangles are"
            faults.append(f"{count} {are} not positive in the {frame}")
    return faults


def mesh_faults(edges: HalfEdges) -> list[str]:
    """What speaks against a triangulation being that of a topological disk."""
    faults = []
    if edges.euler_characteristic != 1:
        faults.append(f"the Euler characteristic is {edges.euler_characteristic}, not 1")
    if edges.repeated:
        faults.append("two triangles are on the same side of an edge")
    if not edges.all_used:
        faults.append("a vertex belongs to no triangle")
    return faults


def malformed(
    vertices_yx: FloatArray, vertices_uv: FloatArray, triangles: IntArray, boundary: IntArray
) -> tuple[str, ...]:
    """Faults that leave nothing to be checked."""
    faults = []
    n_vertices = len(vertices_yx)
    if vertices_yx.shape != (n_vertices, 2) or vertices_uv.shape != (n_vertices, 2):
        faults.append(f"vertices have shape {vertices_yx.shape} in the cell, {vertices_uv.shape} in the disk")
    elif not (np.isfinite(vertices_yx).all() and np.isfinite(vertices_uv).all()):
        faults.append("a vertex is not finite")
    for name, indices in (("triangles", triangles), ("boundary", boundary)):
        if indices.size and (indices.min() < 0 or indices.max() >= n_vertices):
            faults.append(f"{name} name a vertex that does not exist")
    if len(triangles) == 0 or len(boundary) < 3:
        faults.append(f"there are {len(triangles)} triangles and {len(boundary)} boundary vertices")
    return tuple(faults)


def boundary_faults(
    vertices_yx: FloatArray, vertices_uv: FloatArray, edges: HalfEdges, boundary: IntArray
) -> list[str]:
    """What speaks against a boundary being the one loop of a mesh, on the circle in order."""
    faults = []
    if not is_the_loop(edges, (boundary,)):
        faults.append("the boundary is not the one loop of edges that belong to one triangle")
    if not LinearRing(vertices_yx[boundary]).is_simple:
        faults.append("the boundary crosses itself in the cell")
    on_circle = vertices_uv[boundary]
    if not np.abs(np.hypot(*on_circle.T) - 1.0).max() <= _ON_CIRCLE:
        faults.append("a boundary vertex is not on the unit circle")
    if not runs_round_once(on_circle):
        faults.append("the boundary's angles do not increase strictly through one turn")
    return faults


def is_the_loop(edges: HalfEdges, loops: tuple[IntArray, ...]) -> bool:
    """Whether loops of vertices, in their directions, are all edges that belong to one triangle."""
    n_vertices = len(edges.first) - 1
    outer = (edges.start * n_vertices + edges.end)[edges.outer]
    along = np.sort(np.concatenate([loop * n_vertices + np.roll(loop, -1) for loop in loops]))
    vertices = np.concatenate(loops)
    return len(np.unique(vertices)) == len(vertices) and np.array_equal(outer, along)


def runs_round_once(on_circle: FloatArray) -> bool:
    """Whether points in their order, (u, v), are the corners of a convex polygon around the centre, once."""
    following = np.roll(on_circle, -1, axis=0)
    corners = np.arange(len(on_circle))[:, None] + np.arange(3)
    turns, _ = orientations(on_circle[:, ::-1], corners % len(on_circle))
    steps = np.arctan2(
        on_circle[:, 0] * following[:, 1] - on_circle[:, 1] * following[:, 0],
        (on_circle * following).sum(axis=1),
    )
    return bool((turns > 0).all() and (steps > 0).all() and abs(steps.sum() - 2.0 * np.pi) < 1e-6)

"""A mask → a mesh to be mapped, with its nucleus where there is one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.disk.nucleus.nucleus_mapping import FittedNucleus
from cytodisk.errors import ParameterError
from cytodisk.geometry.depth import depth_of
from cytodisk.geometry.mask import FilledMask, MaskReport
from cytodisk.geometry.mesh import Mesh, mesh_inside
from cytodisk.geometry.nucleus_mask import fit_nucleus
from cytodisk.geometry.nucleus_mesh import NucleusMesh, mesh_with_nucleus
from cytodisk.geometry.nucleus_report import SeveralPolicy
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.scale import UNKNOWN, Scale

# Triangles of nearly one area up to the edge: at this clearance they differ least on the reference masks.
_ISOTROPIC = {"growth": 0.0, "clearance": 0.5}


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
    holes : PlacedMask or None
        Holes in the mask that belong to no window.
    nucleus : FittedNucleus or None
        Then the mesh is a `NucleusMesh`.
    """

    placed_mask: PlacedMask
    report: MaskReport
    mesh: Mesh
    corner: FloatArray
    edge_length: float
    scale: Scale
    holes: PlacedMask | None
    nucleus: FittedNucleus | None = None

    @cached_property
    def system(self) -> BlockSystem:
        """For functions on the mesh that are given at its boundary."""
        return BlockSystem(self.mesh)

    @property
    def outline(self) -> FloatArray:
        """Outline in the frame of the bounding box, shape (B, 2)."""
        return self.mesh.vertices_yx[: self.mesh.n_boundary]

    @property
    def nucleus_outline(self) -> FloatArray | None:
        """Nuclear outline in the frame of the bounding box, shape (N, 2)."""
        if not isinstance(self.mesh, NucleusMesh):
            return None
        return self.mesh.vertices_yx[self.mesh.nucleus_boundary]


def mesh_cell(
    mask: Any,
    parameters: MappingParameters,
    scale: Scale = UNKNOWN,
    nucleus: Any = None,
    several: SeveralPolicy = "refuse",
) -> CellMesh:
    """Clean a mask and triangulate its inside.

    Parameters
    ----------
    mask : array_like of shape (H, W), or PlacedMask
        As for `map_to_disk`; or its box, with one more pixel on every side where the image goes on.
    parameters : MappingParameters
        Method "advection" needs triangles of one size, the others take larger ones inside.
    scale : Scale
        Scale of the image.
    nucleus : array_like of shape (H, W), optional
        Mask of its nucleus, of the same shape as the mask.
    several : {"refuse", "largest", "join"}
        What to do with several nuclei.

    Returns
    -------
    CellMesh

    Raises
    ------
    MaskError
        The mask is not the mask of one cell.
    NucleusError
        The nucleus is not that of this cell.
    ParameterError
        The method maps no nucleus.
    MeshError
        It could not be triangulated.
    """
    corner, image_shape = (0, 0), ()
    if isinstance(mask, PlacedMask):
        mask, corner, image_shape = mask.box, mask.corner, mask.image_shape
    found = FilledMask.of(mask)
    placed = PlacedMask.of(found.filled, corner, image_shape)
    spacing = _ISOTROPIC if parameters.method == "advection" else {}
    first, outline = np.array(placed.corner, dtype=np.float64), trace_outline(placed.box)
    if nucleus is None:
        found = found.under(parameters.holes)
        holes = None if found.holes is None else placed.beside(found.holes, corner)
        mesh = mesh_inside(outline, placed.box, edge_length=parameters.spacing_px, **spacing)
        return CellMesh(placed, found.report, mesh, first, parameters.spacing_px, scale, holes)
    if parameters.method != "newton":
        raise ParameterError(f'a nucleus needs method "newton", got {parameters.method!r}')
    fitted, changes = fit_nucleus(found.filled, nucleus, several=several)
    found = found.under(parameters.holes, fitted)
    holes = None if found.holes is None else placed.beside(found.holes, corner)
    inner = placed.beside(fitted, corner).box
    both = mesh_with_nucleus(outline, placed.box, inner, edge_length=parameters.spacing_px)
    own = FittedNucleus(PlacedMask.of(fitted, corner, image_shape), changes, _deepest(inner))
    return CellMesh(placed, found.report, both, first, parameters.spacing_px, scale, holes, own)


def _deepest(mask: BoolArray) -> FloatArray:
    """The pixel of a mask that lies deepest below its edge, shape (2,)."""
    depth = depth_of(np.pad(mask, 1))
    return np.array(np.unravel_index(int(depth.argmax()), depth.shape), dtype=np.float64) - 1.0

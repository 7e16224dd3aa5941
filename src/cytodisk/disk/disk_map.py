"""`DiskMap`: the map between one cell and the unit disk."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property
from typing import Any, Literal, TypeAlias

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.checks import as_points
from cytodisk.disk.certificate import Certificate, certify
from cytodisk.disk.disk_image import image_on_disk
from cytodisk.disk.distortion import Distortion, distortion_of
from cytodisk.disk.map_file import write_map_file
from cytodisk.disk.mapping_parameters import Method
from cytodisk.disk.nucleus.nucleus import Nucleus, loop_angles
from cytodisk.disk.nucleus.nucleus_certificate import certify_compartments
from cytodisk.disk.nucleus.nucleus_chart import NucleusChart
from cytodisk.disk.nucleus.nucleus_distortion import distortion_by_compartment
from cytodisk.disk.polygon_chart import Chart, PolygonChart
from cytodisk.errors import ParameterError
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.geometry.mask import MaskReport
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.scale import UNKNOWN, Scale

Start: TypeAlias = Literal["cotangent", "uniform", "previous"]


@dataclass(frozen=True, eq=False)
class DiskMap:
    """One cell, its disk, and the one-to-one map between them.

    Linear on every triangle; then stretched along the radius, so that the polygon that the boundary
    vertices span in the disk fills the round disk. Only the method "advection" can turn triangles over in the
    disk, so that the map is not one to one there: the certificate says which. `to_disk` then still is a
    function of the cell, and `to_cell` takes one of the triangles that hold a point.

    Attributes
    ----------
    vertices_yx : ndarray of shape (V, 2) and dtype float
        In the cell, (row, column) in pixels, pixel centres at integers.
    vertices_uv : ndarray of shape (V, 2) and dtype float
        In the unit disk, (u, v), u along x and v along y.
    triangles : ndarray of shape (F, 3) and dtype int
    boundary : ndarray of shape (B,) and dtype int
        The boundary loop in order, from +x towards +y.
    placed_mask : PlacedMask
        The mask that was mapped, cleaned and filled, as its box in the image; `mask` is the whole of it.
    report : MaskReport
        What cleaning changed.
    method : {"newton", "newton-triangles", "harmonic", "advection"}
    start : {"cotangent", "uniform", "previous"}
        Where the relaxation started: weights of the harmonic map ("uniform" when cotangent weights turned a
        triangle over), or the previous frame of a movie.
    shape_weight, edge_length : float
        As passed to `map_to_disk`, or its defaults; edge_length in pixels.
    steps : int
        Steps of the relaxation, of Newton's method or of the advection.
    converged : bool
        False when Newton's method stopped before its criterion; the map is valid all the same.
    scale : Scale
        Scale of the image: µm per pixel, and in a movie seconds per frame, where they are known.
    nucleus : Nucleus or None
        The cell's nucleus, where it was given: then the map is linear in other places, as `Nucleus` says.
    holes : PlacedMask or None
        Holes in the mask that belong to no window, in the same box; None if there are none, or if they count
        as cell.

    Examples
    --------
    >>> import cytodisk as cd
    >>> disk = cd.map_to_disk(cd.simulate.star(arms=3, body_radius=12, arm_length=20))
    >>> there = disk.to_disk([[40.0, 30.0]])  # (u, v) of a point of the cell, (row, column)
    >>> disk.to_cell(there).round(6)
    array([[40., 30.]])
    >>> disk.distortion.area < 0.25  # mean |ln λ| of the triangles' areas
    True
    """

    vertices_yx: FloatArray
    vertices_uv: FloatArray
    triangles: IntArray
    boundary: IntArray
    placed_mask: PlacedMask
    report: MaskReport
    method: Method
    start: Start
    shape_weight: float
    edge_length: float
    steps: int
    converged: bool
    scale: Scale = UNKNOWN
    nucleus: Nucleus | None = None
    holes: PlacedMask | None = None

    def __getstate__(self) -> dict[str, Any]:
        """What is computed from the fields is not sent to other processes."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def __repr__(self) -> str:
        return (
            f"<DiskMap {self.method} of {self.report.area_px} px: {len(self.triangles)} triangles, "
            f"valid {self.certificate.valid}, area distortion {self.distortion.area:.3f}>"
        )

    @property
    def mask(self) -> BoolArray:
        """The cleaned mask, its holes filled, shape (H, W) and dtype bool; made anew each time."""
        return self.placed_mask.whole

    @property
    def mask_without_holes(self) -> BoolArray:
        """The same without excluded holes; made anew each time."""
        return self.mask if self.holes is None else self.mask & ~self.holes.whole

    @property
    def outline_yx(self) -> FloatArray:
        """The cell's outline, shape (B, 2), (row, column) in pixels."""
        return self.vertices_yx[self.boundary]

    @cached_property
    def certificate(self) -> Certificate:
        """The proof that the map is a bijection, or what speaks against it."""
        arrays = self.vertices_yx, self.vertices_uv, self.triangles, self.boundary
        return certify(*arrays) if self.nucleus is None else certify_compartments(*arrays, self.nucleus)

    @cached_property
    def distortion(self) -> Distortion:
        """Area and angle distortion, by triangle and in sum; with a nucleus, areas within its compartment."""
        arrays = self.vertices_yx, self.vertices_uv, self.triangles
        return (
            distortion_of(*arrays)
            if self.nucleus is None
            else distortion_by_compartment(*arrays, self.nucleus)
        )

    @cached_property
    def boundary_angles(self) -> FloatArray:
        """Angle of each boundary vertex in radians, strictly increasing through one turn, shape (B,)."""
        if self.nucleus is not None:
            return loop_angles(self.nucleus.places[self.boundary, 1])
        angles = np.arctan2(self.vertices_uv[self.boundary, 1], self.vertices_uv[self.boundary, 0])
        return np.unwrap(angles)

    @property
    def nucleus_radius(self) -> float | None:
        """Radius of the nucleus' circle in the disk; None without a nucleus."""
        return None if self.nucleus is None else self.nucleus.radius

    @property
    def nucleus_boundary(self) -> IntArray | None:
        """Vertices of the nuclear outline in order, shape (N,); None without a nucleus."""
        return None if self.nucleus is None else self.nucleus.boundary

    @property
    def nucleus_outline_yx(self) -> FloatArray | None:
        """The nuclear outline, shape (N, 2), (row, column) in pixels; None without a nucleus."""
        return None if self.nucleus is None else self.vertices_yx[self.nucleus.boundary]

    def to_disk(self, points_yx: Any, *, outside: Literal["nan", "nearest"] = "nan") -> FloatArray:
        """Map points of the cell into the disk.

        Parameters
        ----------
        points_yx : array_like of shape (..., 2)
            (row, column) in pixels.
        outside : {"nan", "nearest"}
            What becomes of points outside the outline: NaN, or the image of the nearest outline point.

        Returns
        -------
        ndarray of shape (..., 2) and dtype float
            (u, v) in the unit disk; what turned triangles carry beyond its rim is put on the rim.

        Raises
        ------
        ParameterError
            The last dimension is not 2, or `outside` is neither.
        """
        if outside not in ("nan", "nearest"):
            raise ParameterError(f"outside must be 'nan' or 'nearest', got {outside!r}")
        points, shape = as_points("points_yx", points_yx)
        uv = self.chart.to_disk(points)
        lost = np.isnan(uv[:, 0]) & np.isfinite(points).all(axis=1)
        if outside == "nearest" and lost.any():
            uv[lost] = self.nearest_on_circle(points[lost])
        return uv.reshape(shape)

    def to_cell(self, points_uv: Any) -> FloatArray:
        """Map points of the disk into the cell; the exact inverse of `to_disk` where the map is one to one.

        Parameters
        ----------
        points_uv : array_like of shape (..., 2)
            (u, v) in the unit disk.

        Returns
        -------
        ndarray of shape (..., 2) and dtype float
            (row, column) in pixels; NaN outside the disk.

        Raises
        ------
        ParameterError
            The last dimension is not 2.
        """
        points, shape = as_points("points_uv", points_uv)
        return self.chart.to_cell(points).reshape(shape)

    def nearest_on_circle(self, points_yx: FloatArray) -> FloatArray:
        """Image (u, v) of the outline point nearest to each of some points (row, column), shape (N, 2)."""
        return self.chart.on_circle(*nearest_on_outline(points_yx, self.outline_yx))

    def image(self, signal: Any, size: int = 256) -> FloatArray:
        """The signal on the disk, read from the cell by linear interpolation between pixels.

        Parameters
        ----------
        signal : array_like of shape (H, W)
            An image of the shape of the mask.
        size : int
            Pixels across the disk.

        Returns
        -------
        ndarray of shape (size, size) and dtype float
            Row along v, column along u, both from -1 to 1; NaN outside the disk, and in excluded holes.

        Raises
        ------
        SignalError
            The signal has another shape than the mask, or is not numeric.
        ParameterError
            `size` is below 1.
        """
        return image_on_disk(signal, self.placed_mask.image_shape, self.to_cell, size, self.holes)

    def placed(self, corner: tuple[int, int], image_shape: tuple[int, int]) -> DiskMap:
        """The same map in the image that its mask was cut out of.

        Parameters
        ----------
        corner, image_shape : (int, int)
            (row, column) of the mask's first pixel in the image, and its (H, W).

        Returns
        -------
        DiskMap
            Its mask has the shape of the image, its points are pixels of the image.
        """
        moved = self.vertices_yx + np.array(corner, dtype=np.float64)
        mask = self.placed_mask.within(corner, image_shape)
        nucleus = None if self.nucleus is None else self.nucleus.placed(corner, image_shape)
        holes = None if self.holes is None else self.holes.within(corner, image_shape)
        return replace(self, placed_mask=mask, vertices_yx=moved, nucleus=nucleus, holes=holes)

    def save(self, path: str | os.PathLike[str], beside: Mapping[str, FloatArray] | None = None) -> None:
        """Write the map to a `.npz` file that `load_map` reads back.

        Parameters
        ----------
        path : path-like
            Ends in `.npz`; written under a temporary name and then renamed.
        beside : dict of str to ndarray, optional
            More arrays for the same file; `load_map` does not read them.

        Raises
        ------
        StudyError
            The file cannot be written.
        ParameterError
            The name does not end in `.npz`.
        """
        facts: dict[str, Any] = {name: getattr(self, name) for name in FACTS}
        header = {"report": asdict(self.report), **asdict(self.scale), **facts}
        arrays = {name: getattr(self, name) for name in _ARRAYS if name != "vertices_uv"}
        beside = {**(beside or {}), "vertices_uv": self.vertices_uv}
        write_map_file(path, header, (self.placed_mask, self.holes), arrays, beside, self.nucleus)

    @cached_property
    def chart(self) -> Chart:
        """The map as functions of points."""
        angles = self.boundary_angles
        if self.nucleus is not None:
            return NucleusChart(self.vertices_yx, self.triangles, self.nucleus, angles)
        arrays = self.vertices_yx, self.vertices_uv, self.triangles, self.boundary
        return PolygonChart(*arrays, angles, onto_rim=self.method == "advection")


_ARRAYS = ("vertices_yx", "vertices_uv", "triangles", "boundary")
FACTS = ("method", "start", "shape_weight", "edge_length", "steps", "converged")

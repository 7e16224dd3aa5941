"""Boundary points from one outline to the next by demons registration and a snake."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import make_interp_spline
from skimage.draw import polygon2mask

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import MissingPartError, ParameterError
from cytodisk.geometry.polygon import edge_lengths
from cytodisk.motion.contour import Contour
from cytodisk.motion.demons_parameters import DemonsParameters
from cytodisk.motion.snake import edge_map, gradient_vector_flow, sample_field, settle

_MARGIN_PX = 10
_MERGED_PX = 1e-6  # points nearer than this are one point of the spline
_SAMPLES_PER_POINT = 16  # of the spline, to measure its length


def propagate(
    here: Contour,
    there: Contour,
    points_yx: FloatArray,
    parameters: DemonsParameters,
) -> FloatArray:
    """Positions on the next outline of the boundary points of an outline.

    Parameters
    ----------
    here, there : Contour
        Two consecutive outlines in one frame; rigid motion between them should have been removed.
    points_yx : ndarray of shape (N, 2) and dtype float
        Points on `here` in their order along it, (row, column) in pixels; at least 4.
    parameters : DemonsParameters

    Returns
    -------
    ndarray of shape (N, 2) and dtype float
        The points in their order, on the boundary of `there` within the accuracy of its pixels. With
        `redistribute` they are evenly spaced along a spline, and only point 0 stays where the snake
        took it.

    Raises
    ------
    ParameterError
        An outline holds no pixel, or the points are not N ≥ 4 finite points at `here`, or have fallen
        together on the way.

    Notes
    -----
    Section A.1, step 2 of the paper. What it leaves open is chosen here: both outlines become binary
    images on one grid of unit pixels; the registration runs its whole number of iterations; the free
    start of the even spacing (iv) is point 0.

    References
    ----------
    .. [1] paper.md, section A.1
    .. [2] Thirion 1998, Image matching as a diffusion process, doi:10.1016/S1361-8415(98)80022-4
    """
    mask_here, mask_there, low = _rasterise(here, there)
    points = _checked(points_yx, low, mask_here.shape) - low
    field = displacement_between(mask_here, mask_there, parameters.iterations, parameters.sigma)
    moved = points + np.column_stack([sample_field(component, points) for component in field])
    edges = edge_map(mask_there)
    flow = gradient_vector_flow(edges, parameters)
    settled = settle(moved, edges, flow, parameters)
    return (space_evenly(settled) if parameters.redistribute else settled) + low


def space_evenly(points_yx: FloatArray) -> FloatArray:
    """As many points at equal distances along the closed cubic spline through given points.

    Parameters
    ----------
    points_yx : ndarray of shape (N, 2) and dtype float
        Closed polygon, (row, column) in pixels; points that coincide with the one before are left out
        of the spline.

    Returns
    -------
    ndarray of shape (N, 2) and dtype float
        The first point is that of the input.

    Raises
    ------
    ParameterError
        Fewer than 4 points are distinct.
    """
    distinct = points_yx[np.roll(edge_lengths(points_yx), 1) > _MERGED_PX]
    if len(distinct) < 4:
        raise ParameterError(
            f"points_yx must have at least 4 distinct points along the boundary, got {len(distinct)} of "
            f"{len(points_yx)}: pass more points, or a cell that is wider than a few pixels"
        )
    if edge_lengths(points_yx)[-1] <= _MERGED_PX:
        # The first point was the one left out: it keeps its place, its twin at the end goes.
        distinct = np.roll(distinct, 1, axis=0)
    knots = np.concatenate([[0.0], np.cumsum(edge_lengths(distinct))])
    spline = make_interp_spline(
        knots, np.concatenate([distinct, distinct[:1]]), k=3, bc_type="periodic", axis=0
    )
    parameter = np.linspace(0.0, knots[-1], _SAMPLES_PER_POINT * len(points_yx) + 1)
    pieces = np.linalg.norm(np.diff(spline(parameter), axis=0), axis=1)
    arc = np.concatenate([[0.0], np.cumsum(pieces)])
    wanted = np.arange(len(points_yx)) * (arc[-1] / len(points_yx))
    return np.asarray(spline(np.interp(wanted, arc, parameter)), dtype=np.float64)


def simple_itk(needed_by: str = 'tracker "demons"') -> Any:
    """The package, whose functions have no types.

    Parameters
    ----------
    needed_by : str
        What cannot be done without it.

    Raises
    ------
    MissingPartError
        It is not installed.
    """
    try:
        import SimpleITK
    except ImportError as error:
        raise MissingPartError.of(f"{needed_by} needs SimpleITK", "demons") from error
    return SimpleITK


def displacement_between(
    fixed: BoolArray, moving: BoolArray, iterations: int, sigma: float, start: FloatArray | None = None
) -> FloatArray:
    """Displacement that takes each pixel of one mask to its place in the other, by symmetric-forces demons.

    Parameters
    ----------
    fixed, moving : ndarray of shape (H, W) and dtype bool
    iterations : int
    sigma : float
        Standard deviation of the smoothing of the field after each iteration, in pixels.
    start : ndarray of shape (2, H, W) and dtype float, optional
        Where the field starts; without it at no displacement.

    Returns
    -------
    ndarray of shape (2, H, W) and dtype float
        (row, column) in pixels, on the pixels of `fixed`.

    Raises
    ------
    MissingPartError
        SimpleITK is not installed.
    """
    sitk = simple_itk()
    demons = sitk.SymmetricForcesDemonsRegistrationFilter()
    # The sums over threads depend on their number.
    demons.SetNumberOfThreads(1)
    demons.SetNumberOfIterations(int(iterations))
    demons.SetStandardDeviations(float(sigma))
    # Most pixels are far from the boundary and still: their mean change would stop it too early.
    demons.SetMaximumRMSError(0.0)
    images = [sitk.GetImageFromArray(mask.astype(np.float32)) for mask in (fixed, moving)]
    if start is not None:
        start_xy = np.ascontiguousarray(np.moveaxis(start[::-1], 0, -1))
        images.append(sitk.GetImageFromArray(start_xy, isVector=True))
    field_xy = sitk.GetArrayFromImage(demons.Execute(*images)).astype(np.float64)
    return np.ascontiguousarray(np.moveaxis(field_xy[..., ::-1], -1, 0))


def _rasterise(here: Contour, there: Contour) -> tuple[BoolArray, BoolArray, FloatArray]:
    """Masks of two outlines on one grid, and the (row, column) of its first pixel."""
    both = np.concatenate([here.points_yx, there.points_yx])
    if not np.isfinite(both).all():
        raise ParameterError("here and there must have finite points, got NaN or infinity: leave such out")
    low = np.floor(both.min(axis=0)) - _MARGIN_PX
    rows, columns = (np.ceil(both.max(axis=0)) + _MARGIN_PX - low).astype(int) + 1
    masks: list[BoolArray] = []
    for name, contour in (("here", here), ("there", there)):
        mask = raster_of(contour.points_yx, low, (rows, columns))
        if not mask.any():
            raise ParameterError(f"{name} must enclose a pixel centre, got none: pass a larger outline")
        masks.append(mask)
    return masks[0], masks[1], low


def raster_of(polygon_yx: FloatArray, low: FloatArray, shape: tuple[int, int]) -> BoolArray:
    """Mask of a closed polygon on a grid of a shape whose first pixel is at (row, column) `low`."""
    inside: BoolArray = polygon2mask(  # type: ignore[no-untyped-call,unused-ignore]
        shape, polygon_yx - low
    )
    return inside


def _checked(points_yx: FloatArray, low: FloatArray, shape: tuple[int, ...]) -> FloatArray:
    points = np.asarray(points_yx, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 4:
        raise ParameterError(f"points_yx must have shape (N, 2), N at least 4, got {points.shape}")
    if not ((points >= low) & (points <= low + np.array(shape) - 1)).all():
        raise ParameterError(
            "points_yx must lie on here, got points far outside or not finite: take them from here.at"
        )
    return points

"""Gradient vector flow and the closed snake that it draws onto an edge."""

import numpy as np
from scipy.ndimage import gaussian_filter, laplace, map_coordinates

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.geometry.polygon import edge_lengths
from cytodisk.motion.demons_parameters import DemonsParameters

_BLUR_PX = 1.0
# Across a straight edge the edge map is exp(-d² / 2w²) to second order in the distance d, with this w².
_RIDGE_VARIANCE = 0.25 * np.pi * _BLUR_PX**2


def edge_map(mask: BoolArray) -> FloatArray:
    """Ridge along the boundary of a mask.

    Parameters
    ----------
    mask : ndarray of shape (H, W) and dtype bool

    Returns
    -------
    ndarray of shape (H, W) and dtype float
        1 where the mask, blurred by 1 pixel, is one half; falls to 0 within about 3 pixels.

    Notes
    -----
    4 m (1 - m) of the blurred mask m has the same height all along the boundary. The usual |∇m|² goes up
    and down with the stair steps of the pixels, and points of a snake would gather at its summits.
    """
    blurred: FloatArray = gaussian_filter(mask.astype(np.float64), _BLUR_PX, mode="nearest")
    return 4.0 * blurred * (1.0 - blurred)


def gradient_vector_flow(edges: FloatArray, parameters: DemonsParameters) -> FloatArray:
    """Gradient of an edge map, spread from the edges into the flat parts by diffusion.

    Parameters
    ----------
    edges : ndarray of shape (H, W) and dtype float
        Edge map, 0 to 1.
    parameters : DemonsParameters
        `gvf_mu` and `gvf_iterations`, each of which takes the flow one pixel further.

    Returns
    -------
    ndarray of shape (2, H, W) and dtype float
        Flow along (row, column), towards the edges, per pixel.

    Notes
    -----
    The diffusion of [1]_, with the weight |∇f|² of the data taken implicitly, which has the same steady
    state and is stable for any edge map.

    References
    ----------
    .. [1] Xu and Prince 1998, Snakes, shapes, and gradient vector flow, doi:10.1109/83.661186
    """
    gradient = np.stack([np.gradient(edges, axis=axis) for axis in (0, 1)])
    weight = (gradient**2).sum(axis=0)
    flow = gradient.copy()
    for _ in range(parameters.gvf_iterations):
        spread = np.stack([laplace(component, mode="nearest") for component in flow])
        flow = (flow + parameters.gvf_mu * spread + weight * gradient) / (1.0 + weight)
    return np.asarray(flow)


def settle(
    points_yx: FloatArray,
    edges: FloatArray,
    flow: FloatArray,
    parameters: DemonsParameters,
) -> FloatArray:
    """Closed snake after it has moved along a flow onto the edges.

    Parameters
    ----------
    points_yx : ndarray of shape (N, 2) and dtype float
        Closed polygon, (row, column) in pixels of the edge map, pixel centres at integers.
    edges : ndarray of shape (H, W) and dtype float
        As `edge_map` returns it.
    flow : ndarray of shape (2, H, W) and dtype float
        As `gradient_vector_flow` returns it.
    parameters : DemonsParameters
        Those of the snake; tension and stiffness are the weights α and β of [1]_, of the squared first and
        second derivative along it.

    Returns
    -------
    ndarray of shape (N, 2) and dtype float
        The points in their order.

    Notes
    -----
    A step of fixed length would throw a point to and fro across the edge for ever. Near a straight edge
    the edge map is a Gaussian of the distance, so the distance is w² |∇f| / f; that is the longest step
    a point takes. Far from the edges f vanishes, and the whole step remains.

    Derivatives, not differences, make the result independent of the number of points: widely spaced points
    would otherwise cut the corners.

    References
    ----------
    .. [1] Xu and Prince 1998, Snakes, shapes, and gradient vector flow, doi:10.1109/83.661186
    """
    spacing = float(edge_lengths(points_yx).mean())
    tension, stiffness = parameters.snake_tension / spacing**2, parameters.snake_stiffness / spacing**4
    damping = _internal_damping(len(points_yx), tension, stiffness)
    points = points_yx
    for _ in range(parameters.snake_iterations):
        pushed = points + _steps(points, edges, flow, parameters.snake_step)
        points = np.fft.irfft(np.fft.rfft(pushed, axis=0) * damping[:, None], n=len(points_yx), axis=0)
    return np.asarray(points)


def _steps(points: FloatArray, edges: FloatArray, flow: FloatArray, step_px: float) -> FloatArray:
    push = np.column_stack([sample_field(component, points) for component in flow])
    strength = np.linalg.norm(push, axis=1)
    # Where the flow has not come to, it is zero and a point stays; the floor only keeps 0 / 0 away.
    floor = np.finfo(np.float64).tiny
    distance = _RIDGE_VARIANCE * strength / np.maximum(sample_field(edges, points), floor)
    length = np.minimum(step_px, distance)
    return np.asarray(push * (length / np.maximum(strength, floor))[:, None])


def _internal_damping(n_points: int, tension: float, stiffness: float) -> FloatArray:
    """Eigenvalues of the inverse of 1 + A, A the internal energy's matrix.

    A closed snake's matrix is circulant, so the Fourier transform solves the semi-implicit step.
    """
    bend = 2.0 - 2.0 * np.cos(2.0 * np.pi * np.fft.rfftfreq(n_points))
    return np.asarray(1.0 / (1.0 + tension * bend + stiffness * bend**2))


def sample_field(field: FloatArray, points_yx: FloatArray) -> FloatArray:
    """Linearly interpolated values of an image, those of its rim outside it.

    Parameters
    ----------
    field : ndarray of shape (H, W) and dtype float
    points_yx : ndarray of shape (N, 2) and dtype float
        (row, column) in pixels, pixel centres at integers.

    Returns
    -------
    ndarray of shape (N,) and dtype float
    """
    values: FloatArray = map_coordinates(field, points_yx.T, order=1, mode="nearest")
    return values

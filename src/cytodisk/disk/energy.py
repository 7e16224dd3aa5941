"""The relaxation energy of one map, its gradient and its projected Hessian: Numba kernels.

E = Σ_t a_t ψ(σ₁, σ₂), ψ = g L² + w (σ₁/σ₂ + σ₂/σ₁ - 2), L = log(σ₁ σ₂), where σ are the singular values of
the Jacobian J_t from the cell, scaled to the area of the disk, to the disk, and a_t the area share of
triangle t in the cell. E is infinite where det J ≤ 0. g is 1, or 0 where areas do not count.

The Hessian with respect to J has four eigenvectors that are known in closed form (Smith, de Goes & Kim 2019,
doi:10.1145/3241041): twist, flip and two stretches; negative eigenvalues are raised to 0.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray


class Elements(NamedTuple):
    """The triangles of a cell.

    Attributes
    ----------
    triangles : ndarray of shape (F, 3) and dtype int
    hats : ndarray of shape (F, 3, 2) and dtype float
        Gradients of their hat functions in the cell, scaled to the area of the disk.
    share : ndarray of shape (F,) and dtype float
        Their shares of the area.
    area_weight : float
        g, the weight of the area term.
    """

    triangles: IntArray
    hats: FloatArray
    share: FloatArray
    area_weight: float = 1.0


@njit(cache=True)
def jacobian(uv: FloatArray, triangle: IntArray, hats: FloatArray) -> tuple[float, float, float, float]:
    """J of one triangle from `hats` (3, 2), the gradients of its hat functions in the cell."""
    a = b = c = d = 0.0
    for k in range(3):
        u, v = uv[triangle[k], 0], uv[triangle[k], 1]
        a += u * hats[k, 0]
        b += u * hats[k, 1]
        c += v * hats[k, 0]
        d += v * hats[k, 1]
    return a, b, c, d


@njit(cache=True)
def energy(
    uv: FloatArray,
    triangles: IntArray,
    hats: FloatArray,
    share: FloatArray,
    area_weight: float,
    weight: float,
) -> float:
    """E of a map; infinite if any triangle is not positive."""
    total = 0.0
    for t in range(triangles.shape[0]):
        a, b, c, d = jacobian(uv, triangles[t], hats[t])
        det = a * d - b * c
        if not det > 0.0:
            return np.inf
        log_det = math.log(det)
        norm = a * a + b * b + c * c + d * d
        total += share[t] * (area_weight * log_det * log_det + weight * (norm / det - 2.0))
    return total


@njit(cache=True, error_model="numpy")
def _half_angle(x: float, y: float, length: float) -> tuple[float, float]:
    """(cos, sin) of half the angle of (x, y); the half angle lies within ±90°."""
    if length == 0.0:
        return 1.0, 0.0
    if x >= 0.0:
        cos = math.sqrt(0.5 * (1.0 + x / length))
        return cos, 0.5 * y / (length * cos)
    sin = math.copysign(math.sqrt(0.5 * (1.0 - x / length)), y)
    return 0.5 * y / (length * sin), sin


@njit(cache=True, error_model="numpy")
def _singular_frame(
    a: float, b: float, c: float, d: float
) -> tuple[float, float, float, float, float, float]:
    """σ₁, σ₂ and the rotations U and Vᵀ of J = U diag(σ₁, σ₂) Vᵀ as (cos, sin) each; det J > 0."""
    e, f, g, h = 0.5 * (a + d), 0.5 * (a - d), 0.5 * (c + b), 0.5 * (c - b)
    turned, mirrored = math.sqrt(e * e + h * h), math.sqrt(f * f + g * g)
    s1 = turned + mirrored
    s2 = (a * d - b * c) / s1
    cb, sb = _half_angle(e, h, turned)
    ca, sa = _half_angle(f, g, mirrored)
    return s1, s2, cb * ca - sb * sa, sb * ca + cb * sa, cb * ca + sb * sa, sb * ca - cb * sa


@njit(cache=True, error_model="numpy")
def _projected(
    s1: float, s2: float, log_det: float, area_weight: float, weight: float
) -> tuple[float, float, float, float, float]:
    """Projected Hessian in the frame of the singular vectors.

    Returns
    -------
    p, q, r : float
        That of the two stretches: [[p, q], [q, r]].
    even, odd : float
        Half the sum, and half the difference, of the eigenvalues of flip and twist.
    """
    det = s1 * s2
    slope, curvature = 2.0 * area_weight * log_det, 2.0 * area_weight
    p = (curvature - slope) / (s1 * s1) + 2.0 * weight * s2 / (s1 * s1 * s1)
    r = (curvature - slope) / (s2 * s2) + 2.0 * weight * s1 / (s2 * s2 * s2)
    q = curvature / det - weight * (1.0 / (s1 * s1) + 1.0 / (s2 * s2))
    half, mean = 0.5 * (p - r), 0.5 * (p + r)
    root = math.sqrt(half * half + q * q)
    if mean < root:
        high, low = max(mean + root, 0.0), max(mean - root, 0.0)
        middle = 0.5 * (high + low)
        along = 0.5 * (high - low) / root if root > 0.0 else 0.0
        p, q, r = middle + along * half, along * q, middle - along * half
    # (ψ₁ + ψ₂) / (σ₁ + σ₂) and (ψ₁ - ψ₂) / (σ₁ - σ₂) with the division carried out
    twist = max(slope / det - weight * ((s1 - s2) / det) ** 2, 0.0)
    flip = max(-slope / det + weight * ((s1 + s2) / det) ** 2, 0.0)
    return p, q, r, 0.5 * (flip + twist), 0.5 * (flip - twist)


@njit(cache=True, error_model="numpy")
def derivatives(
    uv: FloatArray,
    cell: Elements,
    weight: float,
    unknown: IntArray,
    place: IntArray,
    gauss: bool,
    gradient: FloatArray,
    blocks: FloatArray,
) -> None:
    """Fill the gradient (N, 2) and the 2×2 blocks of the projected Hessian.

    With `gauss` the area term counts with its Gauss-Newton Hessian, 2 ∇L ∇Lᵀ, which leaves out L ∇²L.
    `unknown` and `place` say where a vertex and a pair of corners belong, as in `blocks.BlockSystem`.
    """
    triangles, hats, share, area_weight = cell
    gradient[:] = 0.0
    blocks[:] = 0.0
    x, y = np.empty(3), np.empty(3)  # hat gradients in the frame of the singular vectors
    for t in range(triangles.shape[0]):
        a, b, c, d = jacobian(uv, triangles[t], hats[t])
        s1, s2, cu, su, cv, sv = _singular_frame(a, b, c, d)
        log_det = math.log(s1 * s2)
        p, q, r, even, odd = _projected(s1, s2, 0.0 if gauss else log_det, area_weight, weight)
        slope = 2.0 * area_weight * log_det
        slope1 = slope / s1 + weight * (1.0 / s2 - s2 / (s1 * s1))
        slope2 = slope / s2 + weight * (1.0 / s1 - s1 / (s2 * s2))
        p, q, r, even, odd = share[t] * p, share[t] * q, share[t] * r, share[t] * even, share[t] * odd
        cc, ss, cs = cu * cu, su * su, cu * su
        for k in range(3):
            x[k] = cv * hats[t, k, 0] - sv * hats[t, k, 1]
            y[k] = sv * hats[t, k, 0] + cv * hats[t, k, 1]
            n = unknown[triangles[t, k]]
            if n >= 0:
                gradient[n, 0] += share[t] * (cu * slope1 * x[k] - su * slope2 * y[k])
                gradient[n, 1] += share[t] * (su * slope1 * x[k] + cu * slope2 * y[k])
        for k in range(3):
            for l in range(3):
                block = place[t, k, l]
                if block < 0:
                    continue
                xx, xy, yx, yy = x[k] * x[l], x[k] * y[l], y[k] * x[l], y[k] * y[l]
                uu, vv = p * xx + even * yy, r * yy + even * xx
                uv_, vu = q * xy + odd * yx, q * yx + odd * xy
                # U times this block times Uᵀ
                apart, together = (uu - vv) * cs, (uv_ + vu) * cs
                blocks[block, 0, 0] += uu * cc + vv * ss - together
                blocks[block, 0, 1] += apart + uv_ * cc - vu * ss
                blocks[block, 1, 0] += apart + vu * cc - uv_ * ss
                blocks[block, 1, 1] += uu * ss + vv * cc + together


@njit(cache=True)
def largest_step(uv: FloatArray, direction: FloatArray, triangles: IntArray, hats: FloatArray) -> float:
    """First positive root of any det J(s) along uv + s · direction; infinite if there is none."""
    first = np.inf
    for t in range(triangles.shape[0]):
        a, b, c, d = jacobian(uv, triangles[t], hats[t])
        p, q, r, s = jacobian(direction, triangles[t], hats[t])
        first = min(first, first_root(a * d - b * c, a * s + d * p - b * r - c * q, p * s - q * r))
    return first


@njit(cache=True, inline="always", error_model="numpy")
def first_root(constant: float, linear: float, square: float) -> float:
    """First positive root of square s² + linear s + constant, constant > 0; infinite if there is none."""
    discriminant = linear * linear - 4.0 * square * constant
    first = np.inf
    if discriminant >= 0.0:
        half = -0.5 * (linear + math.copysign(math.sqrt(discriminant), linear))
        one = half / square if square != 0.0 else np.inf
        other = constant / half if half != 0.0 else np.inf
        first = min(one if one > 0.0 else np.inf, other if other > 0.0 else np.inf)
    return first

"""The relaxation energy of one map, its gradient and its projected Hessian: Numba kernels.

E = Σ_t a_t ψ(σ₁, σ₂), ψ = L² + w (σ₁/σ₂ + σ₂/σ₁ - 2), L = log(σ₁ σ₂), where σ are the singular values of the
Jacobian J_t from the cell, scaled to the area of the disk, to the disk, and a_t the area share of triangle t
in the cell. E is infinite where det J ≤ 0.

The Hessian with respect to J has four eigenvectors that are known in closed form (Smith, de Goes & Kim 2019,
doi:10.1145/3241041): twist, flip and two stretches; negative eigenvalues are raised to 0.
"""

import math

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray


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
def energy(uv: FloatArray, triangles: IntArray, hats: FloatArray, share: FloatArray, weight: float) -> float:
    """E of a map; infinite if any triangle is not positive."""
    total = 0.0
    for t in range(triangles.shape[0]):
        a, b, c, d = jacobian(uv, triangles[t], hats[t])
        det = a * d - b * c
        if not det > 0.0:
            return np.inf
        log_det = math.log(det)
        norm = a * a + b * b + c * c + d * d
        total += share[t] * (log_det * log_det + weight * (norm / det - 2.0))
    return total


@njit(cache=True)
def _singular_frame(
    a: float, b: float, c: float, d: float
) -> tuple[float, float, float, float, float, float]:
    """σ₁, σ₂ and the rotations U and V of J = U diag(σ₁, σ₂) Vᵀ as (cos, sin) each; det J > 0."""
    e, f, g, h = 0.5 * (a + d), 0.5 * (a - d), 0.5 * (c + b), 0.5 * (c - b)
    s1 = math.hypot(e, h) + math.hypot(f, g)
    s2 = (a * d - b * c) / s1
    alpha, beta = 0.5 * math.atan2(g, f), 0.5 * math.atan2(h, e)
    return (
        s1,
        s2,
        math.cos(beta + alpha),
        math.sin(beta + alpha),
        math.cos(beta - alpha),
        math.sin(beta - alpha),
    )


@njit(cache=True)
def _curvatures(
    s1: float, s2: float, weight: float, gauss: bool, curvature: FloatArray
) -> tuple[float, float]:
    """Fill the eigenvalues for (stretch, stretch, twist, flip); (cos, sin) of the first stretch mode."""
    det = s1 * s2
    log_det = 0.0 if gauss else math.log(det)  # Gauss-Newton: without the residual's own curvature
    psi_11 = (2.0 - 2.0 * log_det) / (s1 * s1) + 2.0 * weight * s2 / (s1 * s1 * s1)
    psi_22 = (2.0 - 2.0 * log_det) / (s2 * s2) + 2.0 * weight * s1 / (s2 * s2 * s2)
    psi_12 = 2.0 / det - weight * (1.0 / (s1 * s1) + 1.0 / (s2 * s2))
    half = 0.5 * (psi_11 - psi_22)
    root = math.hypot(half, psi_12)
    angle = 0.5 * math.atan2(psi_12, half)
    curvature[0] = 0.5 * (psi_11 + psi_22) + root
    curvature[1] = 0.5 * (psi_11 + psi_22) - root
    # (ψ₁ + ψ₂) / (σ₁ + σ₂) and (ψ₁ - ψ₂) / (σ₁ - σ₂) with the division carried out
    curvature[2] = 2.0 * log_det / det - weight * ((s1 - s2) / det) ** 2
    curvature[3] = -2.0 * log_det / det + weight * ((s1 + s2) / det) ** 2
    return math.cos(angle), math.sin(angle)


@njit(cache=True)
def derivatives(
    uv: FloatArray,
    triangles: IntArray,
    hats: FloatArray,
    share: FloatArray,
    weight: float,
    gradient: FloatArray,
    unknown: IntArray,
    first: IntArray,
    second: IntArray,
    values: FloatArray,
    gauss: bool = False,
) -> None:
    """Fill the gradient (2 n,) and the values of the upper triangle of the projected Hessian.

    With `gauss` the area term counts with its Gauss-Newton Hessian, 2 ∇L ∇Lᵀ, which leaves out L ∇²L.
    `unknown`, `first` and `second` say where a vertex pair's 2×2 block lies, as in `newton._HessianPattern`.
    """
    gradient[:] = 0.0
    values[:] = 0.0
    curvature = np.empty(4)
    modes = np.empty((4, 3, 2))  # (mode, corner): the mode's matrix applied to the corner's hat gradient
    root_half = math.sqrt(0.5)
    for t in range(triangles.shape[0]):
        a, b, c, d = jacobian(uv, triangles[t], hats[t])
        s1, s2, cu, su, cv, sv = _singular_frame(a, b, c, d)
        ce, se = _curvatures(s1, s2, weight, gauss, curvature)
        log_det = math.log(s1 * s2)
        slope1 = 2.0 * log_det / s1 + weight * (1.0 / s2 - s2 / (s1 * s1))
        slope2 = 2.0 * log_det / s2 + weight * (1.0 / s1 - s1 / (s2 * s2))
        for k in range(3):
            x = cv * hats[t, k, 0] - sv * hats[t, k, 1]
            y = sv * hats[t, k, 0] + cv * hats[t, k, 1]
            framed = (
                (ce * x, se * y),
                (-se * x, ce * y),
                (-root_half * y, root_half * x),
                (root_half * y, root_half * x),
            )
            for m in range(4):
                modes[m, k, 0] = cu * framed[m][0] - su * framed[m][1]
                modes[m, k, 1] = su * framed[m][0] + cu * framed[m][1]
            n = unknown[triangles[t, k]]
            if n >= 0:
                gradient[2 * n] += share[t] * (cu * slope1 * x - su * slope2 * y)
                gradient[2 * n + 1] += share[t] * (su * slope1 * x + cu * slope2 * y)
        for k in range(3):
            for l in range(3):
                one, two = first[t, k, l], second[t, k, l]
                if one < 0:
                    continue
                uu = cross = vu = vv = 0.0
                for m in range(4):
                    if curvature[m] > 0.0:
                        scaled_u, scaled_v = curvature[m] * modes[m, k, 0], curvature[m] * modes[m, k, 1]
                        uu += scaled_u * modes[m, l, 0]
                        cross += scaled_u * modes[m, l, 1]
                        vu += scaled_v * modes[m, l, 0]
                        vv += scaled_v * modes[m, l, 1]
                values[one] += share[t] * uu
                values[two] += share[t] * cross
                values[two + 1] += share[t] * vv
                if k != l:
                    values[one + 1] += share[t] * vu


@njit(cache=True)
def largest_step(uv: FloatArray, direction: FloatArray, triangles: IntArray, hats: FloatArray) -> float:
    """First positive root of any det J(s) along uv + s · direction; infinite if there is none."""
    first = np.inf
    for t in range(triangles.shape[0]):
        a, b, c, d = jacobian(uv, triangles[t], hats[t])
        p, q, r, s = jacobian(direction, triangles[t], hats[t])
        constant = a * d - b * c
        linear = a * s + d * p - b * r - c * q
        square = p * s - q * r
        # constant > 0: the smallest positive root of square s² + linear s + constant.
        discriminant = linear * linear - 4.0 * square * constant
        if discriminant < 0.0:
            continue
        half = -0.5 * (linear + math.copysign(math.sqrt(discriminant), linear))
        for root in (half / square if square != 0.0 else np.inf, constant / half if half != 0.0 else np.inf):
            if 0.0 < root < first:
                first = root
    return first

"""The relaxation energy with areas averaged around vertices: Numba kernels.

E = Σ_v a_v (log (A_v / a_v))² + w Σ_t a_t (‖J_t‖²_F / det J_t - 2) + β Σ_edge a_t (log det J_t)², with J_t
the Jacobian from the cell, scaled to the area of the disk, to the disk, and a_t the share of triangle t in
the cell's area. Each triangle gives its share, in cell and disk, in parts to its interior corners: a_v and
A_v are what vertex v gets. E is infinite where any det J_t ≤ 0: the second sum is a barrier. The third counts
triangles with a corner on the boundary, whose area else counts only together with that of triangles farther
in, so that the outermost windows of thin arms come out too small or too large.

All are sums of squares, the second of √(w a_t) (J₁₁ - J₂₂, J₁₂ + J₂₁) / √det J_t: 0 where angles are
kept. So all have a Gauss-Newton Hessian. That of the areas couples a vertex with its neighbours' neighbours;
a pressure at each vertex as a third unknown keeps every coupling within a triangle (`fill_step`).
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.energy import jacobian

SHAPE_CURVATURE = 1.5
"""Factor of the Gauss-Newton Hessian of the shape term.

It leaves out what bends the residuals, and near the minimum steps are up to twice too long without a factor.
"""

EDGE_WEIGHT = 0.2
"""β, the weight of each area at the edge; at 1 the triangles there would lock."""


class AveragedElements(NamedTuple):
    """The triangles of a cell, and the vertices that their areas are averaged at.

    Attributes
    ----------
    triangles : ndarray of shape (F, 3) and dtype int
    hats : ndarray of shape (F, 3, 2) and dtype float
        Gradients of their hat functions in the cell, scaled to the area of the disk.
    share : ndarray of shape (F,) and dtype float
        Their shares of the area.
    corner : ndarray of shape (F, 3) and dtype int
        Unknown at each corner; -1 at the boundary.
    parts : ndarray of shape (F, 3) and dtype float
        What each triangle gives of its share to each corner; 0 to the boundary.
    target : ndarray of shape (N,) and dtype float
        a_v, the share that each unknown gets in the cell.
    edge : ndarray of shape (F,) and dtype float
        β a_t of the triangles with a corner on the boundary, else 0.
    """

    triangles: IntArray
    hats: FloatArray
    share: FloatArray
    corner: IntArray
    parts: FloatArray
    target: FloatArray
    edge: FloatArray


def averaged_elements(
    triangles: IntArray, hats: FloatArray, share: FloatArray, unknown: IntArray
) -> AveragedElements:
    """Elements whose triangles give their shares in equal parts to their interior corners.

    Parameters
    ----------
    triangles : ndarray of shape (F, 3) and dtype int
        Each with at least one interior corner.
    hats : ndarray of shape (F, 3, 2) and dtype float
    share : ndarray of shape (F,) and dtype float
    unknown : ndarray of shape (V,) and dtype int
        Number of each vertex among the unknowns; -1 for the boundary.

    Returns
    -------
    AveragedElements
    """
    n_unknown = int(unknown.max(initial=-1)) + 1
    return AveragedElements(triangles, hats, share, *shared_out(triangles, share, unknown, n_unknown))


@njit(cache=True)
def shared_out(
    triangles: IntArray, share: FloatArray, unknown: IntArray, n_unknown: int
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """`corner`, `parts`, `target` and `edge` of elements; vertices without an unknown (-1) get no area."""
    corner, parts = np.empty(triangles.shape, dtype=np.int64), np.zeros(triangles.shape)
    target, edge = np.zeros(n_unknown), np.zeros(len(share))
    for t in range(len(share)):
        inside = 0
        for k in range(3):
            corner[t, k] = unknown[triangles[t, k]]
            inside += corner[t, k] >= 0
        if inside < 3:
            edge[t] = EDGE_WEIGHT * share[t]
        for k in range(3):
            if corner[t, k] >= 0:
                parts[t, k] = share[t] / inside
                target[corner[t, k]] += parts[t, k]
    return corner, parts, target, edge


@njit(cache=True)
def averaged_energy(uv: FloatArray, cell: AveragedElements, weight: float) -> float:
    """E of a map; infinite if any triangle is not positive."""
    triangles, hats, share, corner, parts, target, edge = cell
    area = np.zeros(len(target))
    shape = at_edge = 0.0
    for t in range(triangles.shape[0]):
        a, b, c, d = jacobian(uv, triangles[t], hats[t])
        det = a * d - b * c
        if not det > 0.0:
            return np.inf
        shape += share[t] * ((a - d) ** 2 + (b + c) ** 2) / det
        if edge[t] > 0.0:
            at_edge += edge[t] * math.log(det) ** 2
        for k in range(3):
            if corner[t, k] >= 0:
                area[corner[t, k]] += parts[t, k] * det
    total = weight * shape + at_edge
    for n in range(len(target)):
        total += target[n] * math.log(area[n] / target[n]) ** 2
    return total


@njit(cache=True, error_model="numpy")
def fill_step(
    uv: FloatArray,
    cell: AveragedElements,
    weight: float,
    place: IntArray,
    diagonal: IntArray,
    blocks: FloatArray,
    right: FloatArray,
) -> None:
    """Fill the system of a Gauss-Newton step: its 3×3 blocks and its right-hand side (N, 3).

    With R = √a_v ∇A_v / A_v and r = √a_v log (A_v / a_v), a row each vertex, and H and g the Hessian and the
    gradient of the shape term, the step dx and the pressures p = 2 (r + R dx) solve

        H dx + Rᵀ p = -g,   R dx - p / 2 = -r,

    which is the step of H + 2 RᵀR. H and g hold the areas at the edge, too. `place` and `diagonal` are those
    of `block_pattern.BlockPattern`; of the blocks on the diagonal only the upper half is filled.
    """
    triangles, hats, share, corner, parts, _, edge = cell
    right[:] = 0.0
    blocks[:] = 0.0
    slope, jacobians = _fill_areas(uv, cell, diagonal, blocks, right)
    numbers = blocks.reshape(-1)  # the nine of each block, one row after the other
    corners = np.empty((3, 7))  # gradients of det J and of two residuals of shape, and m, at each corner
    for t in range(triangles.shape[0]):
        a, b, c, d = jacobians[t, 0], jacobians[t, 1], jacobians[t, 2], jacobians[t, 3]
        det = a * d - b * c
        inverse = 1.0 / det
        root = math.sqrt(2.0 * weight * share[t] * inverse)
        r1, r2 = root * (a - d), root * (b + c)
        s1, s2 = 0.5 * r1 * inverse, 0.5 * r2 * inverse
        stiff = slant = 0.0  # of the area of a triangle at the edge
        if edge[t] > 0.0:
            stiff, slant = 2.0 * edge[t] * inverse**2, 2.0 * edge[t] * math.log(det) * inverse
        for k in range(3):
            x, y = hats[t, k, 0], hats[t, k, 1]
            g0, g1 = d * x - c * y, a * y - b * x
            e0, e1 = root * x - s1 * g0, -root * y - s1 * g1
            f0, f1 = root * y - s2 * g0, root * x - s2 * g1
            corners[k, 0], corners[k, 1] = g0, g1
            corners[k, 2], corners[k, 3], corners[k, 4], corners[k, 5] = e0, e1, f0, f1
            n = corner[t, k]
            corners[k, 6] = parts[t, k] * slope[n]  # of the boundary: 0
            if n >= 0:
                right[n, 0] -= r1 * e0 + r2 * f0 + slant * g0
                right[n, 1] -= r1 * e1 + r2 * f1 + slant * g1
        add_triangle(t, corners, stiff, place, numbers)


@njit(cache=True, error_model="numpy", inline="always")
def add_triangle(t: int, corners: FloatArray, stiff: float, place: IntArray, numbers: FloatArray) -> None:
    """Add what a triangle gives to the blocks of its corners.

    `corners` holds a row each: the gradient of det J, those of both residuals of shape, and that of the area
    by itself; `stiff` is the curvature of the area at the edge, `numbers` the nine of each block in a row.
    """
    for k in range(3):
        g0, g1, m = corners[k, 0], corners[k, 1], corners[k, 6]
        e0, e1 = SHAPE_CURVATURE * corners[k, 2], SHAPE_CURVATURE * corners[k, 3]
        f0, f1 = SHAPE_CURVATURE * corners[k, 4], SHAPE_CURVATURE * corners[k, 5]
        s0, s1 = stiff * g0, stiff * g1
        for l in range(k + 1):
            block = max(place[t, k, l], place[t, l, k])
            if block < 0:
                continue
            at = 9 * block
            turned = 1 if place[t, k, l] < 0 else 0  # the block of (l, k) is stored: this one's transpose
            h0, h1, i0, i1 = corners[l, 0], corners[l, 1], corners[l, 2], corners[l, 3]
            j0, j1, o = corners[l, 4], corners[l, 5], corners[l, 6]
            numbers[at] += e0 * i0 + f0 * j0 + s0 * h0
            numbers[at + 1 + 2 * turned] += e0 * i1 + f0 * j1 + s0 * h1
            numbers[at + 2 + 4 * turned] += g0 * o
            numbers[at + 4] += e1 * i1 + f1 * j1 + s1 * h1
            numbers[at + 5 + 2 * turned] += g1 * o
            if l < k:
                numbers[at + 3 - 2 * turned] += e1 * i0 + f1 * j0 + s1 * h0
                numbers[at + 6 - 4 * turned] += m * h0
                numbers[at + 7 - 2 * turned] += m * h1


@njit(cache=True, error_model="numpy")
def _fill_areas(
    uv: FloatArray, cell: AveragedElements, diagonal: IntArray, blocks: FloatArray, right: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Fill in what belongs to the pressures alone; √a_v / A_v of each vertex, 0 last, and the Jacobians."""
    triangles, hats, _, corner, parts, target, _ = cell
    area = np.zeros(len(target) + 1)  # the last takes what corners at the boundary, numbered -1, get: 0
    jacobians = np.empty((triangles.shape[0], 4))
    for t in range(triangles.shape[0]):
        a, b, c, d = jacobian(uv, triangles[t], hats[t])
        jacobians[t, 0], jacobians[t, 1], jacobians[t, 2], jacobians[t, 3] = a, b, c, d
        for k in range(3):
            area[corner[t, k]] += parts[t, k] * (a * d - b * c)
    slope = np.zeros(len(target) + 1)
    for n in range(len(target)):
        root = math.sqrt(target[n])
        slope[n] = root / area[n]
        right[n, 2] = -root * math.log(area[n] / target[n])
        blocks[diagonal[n], 2, 2] = -0.5
    return slope, jacobians


@njit(cache=True)
def step_of(
    found: FloatArray, right: FloatArray, vertex: IntArray, n_vertices: int
) -> tuple[FloatArray, float]:
    """Step of every vertex from what solves the system of `fill_step`, and what it saves to first order."""
    direction = np.zeros((n_vertices, 2))
    saved = 0.0
    for n in range(len(vertex)):
        direction[vertex[n], 0], direction[vertex[n], 1] = found[n, 0], found[n, 1]
        # The gradient of the areas is 2 Rᵀr, and R dx = p / 2 - r; `right` holds -g and -r.
        saved += right[n, 0] * found[n, 0] + right[n, 1] * found[n, 1]
        saved += right[n, 2] * (found[n, 2] + 2.0 * right[n, 2])
    return direction, saved

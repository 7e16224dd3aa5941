"""The relaxation energy of a cell with its nucleus: Numba kernels.

It is that of `vertex_energy`, compartment by compartment: each has its own share of the disk's area, and
triangles give their areas to the interior vertices of their compartment. Triangles of the nucleus lie in
its own unit disk, (u, v). Those of the cytoplasm lie in (θ, p), p = (1 - r²) / 2 with r the radius in the
whole disk: there dθ dp is the disk's area, both borders are straight, and so are triangles. Shape is measured
in the disk, in which dθ counts r and dp counts 1/r, at the triangle's middle, r² = 1 - 2 p.

Vertices on the nuclear outline slide along their circle: of them θ alone is free, and in the nucleus they lie
at (cos θ, sin θ).
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.energy import first_root
from cytodisk.disk.vertex_energy import add_triangle


class CompartmentElements(NamedTuple):
    """The triangles of a cell with its nucleus, and the vertices that their areas are averaged at.

    Attributes
    ----------
    triangles : ndarray of shape (F, 3) and dtype int
    hats : ndarray of shape (F, 3, 2) and dtype float
        Gradients of their hat functions in the cell, scaled so that the compartment has its area of the disk.
    share : ndarray of shape (F,) and dtype float
        Their shares of the disk's area.
    corner : ndarray of shape (F, 3) and dtype int
        Unknown whose area each corner counts for; -1 on the outlines.
    parts : ndarray of shape (F, 3) and dtype float
        What each triangle gives of its share to each corner; 0 on the outlines.
    target : ndarray of shape (N,) and dtype float
        The share that each unknown gets in the cell; 0 on the nuclear outline.
    edge : ndarray of shape (F,) and dtype float
        Weight of the area by itself of triangles at an outline, else 0.
    inside : ndarray of shape (F,) and dtype bool
        Whether each triangle lies in the nucleus.
    turned : ndarray of shape (F, 3) and dtype float
        Angle to add to that of each corner: whole turns.
    sliding : ndarray of shape (V,) and dtype bool
        Vertices on the nuclear outline.
    """

    triangles: IntArray
    hats: FloatArray
    share: FloatArray
    corner: IntArray
    parts: FloatArray
    target: FloatArray
    edge: FloatArray
    inside: BoolArray
    turned: FloatArray
    sliding: BoolArray


@njit(cache=True)
def _corner(x: float, y: float, turned: float, inside: bool, sliding: bool) -> tuple[float, float]:
    """Where a corner lies in its triangle's frame."""
    if not inside:
        return x + turned, y
    if sliding:
        return math.cos(x), math.sin(x)
    return x, y


@njit(cache=True, error_model="numpy")
def _jacobian(
    places: FloatArray,
    triangle: IntArray,
    hats: FloatArray,
    turned: FloatArray,
    inside: bool,
    sliding: BoolArray,
) -> tuple[float, float, float, float, float]:
    """J of one triangle, and the radius at its middle in the cytoplasm, 1 in the nucleus."""
    a = b = c = d = deep = 0.0
    for k in range(3):
        v = triangle[k]
        x, y = _corner(places[v, 0], places[v, 1], turned[k], inside, sliding[v])
        a += x * hats[k, 0]
        b += x * hats[k, 1]
        c += y * hats[k, 0]
        d += y * hats[k, 1]
        deep += y
    radius = 1.0 if inside else math.sqrt(1.0 - 2.0 * deep / 3.0)
    return a, b, c, d, radius


@njit(cache=True)
def compartment_energy(places: FloatArray, cell: CompartmentElements, weight: float) -> float:
    """E of a map; infinite if any triangle is not positive."""
    triangles, hats, share, corner, parts, target, edge, inside, turned, sliding = cell
    area = np.zeros(len(target))
    shape = at_edge = 0.0
    for t in range(triangles.shape[0]):
        a, b, c, d, radius = _jacobian(places, triangles[t], hats[t], turned[t], inside[t], sliding)
        det = a * d - b * c
        if not det > 0.0:
            return np.inf
        r1, r2 = radius * a - d / radius, radius * b + c / radius
        shape += share[t] * (r1 * r1 + r2 * r2) / det
        if edge[t] > 0.0:
            at_edge += edge[t] * math.log(det) ** 2
        for k in range(3):
            if corner[t, k] >= 0:
                area[corner[t, k]] += parts[t, k] * det
    total = weight * shape + at_edge
    for n in range(len(area)):
        if target[n] > 0.0:
            total += target[n] * math.log(area[n] / target[n]) ** 2
    return total


@njit(cache=True, error_model="numpy")
def fill_compartments(
    places: FloatArray,
    cell: CompartmentElements,
    weight: float,
    free: BoolArray,
    pattern: tuple[IntArray, IntArray, IntArray],
    blocks: FloatArray,
    right: FloatArray,
) -> None:
    """Fill the system of a Gauss-Newton step, as `vertex_energy.fill_step` does.

    `free` (V, 2) says which of the two numbers of a vertex may change: rows of others are those of the
    identity. `pattern` holds `unknown`, `place` and `diagonal` of `block_pattern.BlockPattern`.
    """
    unknown, place, diagonal = pattern
    triangles, hats, share, corner, parts, _, edge, inside, _, sliding = cell
    right[:] = 0.0
    blocks[:] = 0.0
    slope, jacobians = _fill_areas(places, cell, diagonal, blocks, right)
    numbers = blocks.reshape(-1)  # the nine of each block, one row after the other
    corners = np.empty((3, 7))  # gradients of det J and of two residuals of shape, and m, at each corner
    for t in range(triangles.shape[0]):
        a, b, c, d = jacobians[t, 0], jacobians[t, 1], jacobians[t, 2], jacobians[t, 3]
        radius = jacobians[t, 4]
        over = 1.0 / radius
        det = a * d - b * c
        inverse = 1.0 / det
        root = math.sqrt(2.0 * weight * share[t] * inverse)
        r1, r2 = root * (radius * a - over * d), root * (radius * b + over * c)
        s1, s2 = 0.5 * r1 * inverse, 0.5 * r2 * inverse
        by_depth = 0.0 if inside[t] else -over / 3.0  # of the radius at the middle, by p of a corner
        m1, m2 = root * (a + d * over * over) * by_depth, root * (b - c * over * over) * by_depth
        stiff = slant = 0.0
        if edge[t] > 0.0:
            stiff, slant = 2.0 * edge[t] * inverse**2, 2.0 * edge[t] * math.log(det) * inverse
        for k in range(3):
            x, y = hats[t, k, 0], hats[t, k, 1]
            vertex = triangles[t, k]
            g0, g1 = d * x - c * y, a * y - b * x
            e0, e1 = root * radius * x - s1 * g0, -root * over * y - s1 * g1 + m1
            f0, f1 = root * radius * y - s2 * g0, root * over * x - s2 * g1 + m2
            if inside[t] and sliding[vertex]:
                along_u, along_v = -math.sin(places[vertex, 0]), math.cos(places[vertex, 0])
                g0, g1 = along_u * g0 + along_v * g1, 0.0
                e0, e1 = along_u * e0 + along_v * e1, 0.0
                f0, f1 = along_u * f0 + along_v * f1, 0.0
            if not free[vertex, 0]:
                g0 = e0 = f0 = 0.0
            if not free[vertex, 1]:
                g1 = e1 = f1 = 0.0
            corners[k, 0], corners[k, 1] = g0, g1
            corners[k, 2], corners[k, 3], corners[k, 4], corners[k, 5] = e0, e1, f0, f1
            own = corner[t, k]
            corners[k, 6] = parts[t, k] * slope[own] if own >= 0 else 0.0
            n = unknown[vertex]
            if n >= 0:
                right[n, 0] -= r1 * e0 + r2 * f0 + slant * g0
                right[n, 1] -= r1 * e1 + r2 * f1 + slant * g1
        add_triangle(t, corners, stiff, place, numbers)
    for vertex in range(len(unknown)):
        n = unknown[vertex]
        if n >= 0:
            for axis in range(2):
                if not free[vertex, axis]:
                    blocks[diagonal[n], axis, axis] = 1.0


@njit(cache=True, error_model="numpy")
def _fill_areas(
    places: FloatArray, cell: CompartmentElements, diagonal: IntArray, blocks: FloatArray, right: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Fill in what belongs to the pressures alone; √a_v / A_v of each vertex, and the Jacobians."""
    triangles, hats, _, corner, parts, target, _, inside, turned, sliding = cell
    area = np.zeros(len(target))
    jacobians = np.empty((triangles.shape[0], 5))
    for t in range(triangles.shape[0]):
        a, b, c, d, radius = _jacobian(places, triangles[t], hats[t], turned[t], inside[t], sliding)
        jacobians[t, 0], jacobians[t, 1], jacobians[t, 2], jacobians[t, 3] = a, b, c, d
        jacobians[t, 4] = radius
        for k in range(3):
            if corner[t, k] >= 0:
                area[corner[t, k]] += parts[t, k] * (a * d - b * c)
    slope = np.zeros(len(target))
    for n in range(len(target)):
        blocks[diagonal[n], 2, 2] = -0.5
        if target[n] > 0.0:
            root = math.sqrt(target[n])
            slope[n] = root / area[n]
            right[n, 2] = -root * math.log(area[n] / target[n])
    return slope, jacobians


@njit(cache=True, error_model="numpy")
def largest_compartment_step(
    places: FloatArray, direction: FloatArray, cell: CompartmentElements, roots: FloatArray
) -> float:
    """First positive root of any det J(s) along places + s · direction, to first order if vertices slide.

    `roots` (F,) is filled with that of each triangle.
    """
    triangles, hats, _, _, _, _, _, inside, turned, sliding = cell
    first = np.inf
    for t in range(triangles.shape[0]):
        a, b, c, d, _ = _jacobian(places, triangles[t], hats[t], turned[t], inside[t], sliding)
        p = q = r = s = 0.0
        for k in range(3):
            vertex, x, y = triangles[t, k], hats[t, k, 0], hats[t, k, 1]
            du, dv = direction[vertex, 0], direction[vertex, 1]
            if inside[t] and sliding[vertex]:
                du, dv = -math.sin(places[vertex, 0]) * du, math.cos(places[vertex, 0]) * du
            p += du * x
            q += du * y
            r += dv * x
            s += dv * y
        roots[t] = first_root(a * d - b * c, a * s + d * p - b * r - c * q, p * s - q * r)
        first = min(first, roots[t])
    return first

"""Order-preserving matching of two outlines: the default boundary tracker."""

import math

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.motion.contour import Contour

# Steps (along here, along there) of a path through pairs of samples; their slopes bound the stretch.
_STEPS = np.array(
    [(1, 1), (1, 2), (2, 1), (2, 3), (3, 2), (1, 3), (3, 1), (1, 4), (4, 1), (1, 6), (6, 1)], dtype=np.int64
)
_COARSE_PX = 2.0
_FINE_PX = 1.0
_ROUNDS = 30
_STILL_PX = 1e-4


def match(here: Contour, there: Contour, s: FloatArray, smoothness: float = 16.0, stretch: float = 0.0, coarse_px: float = 2.0, fine_px: float = 1.0, refine: bool = True) -> FloatArray:
    coarse = max(coarse_px, min(here.length, there.length)/150.)
    n, m = _samples(here, coarse), _samples(there, coarse)
    p = here.at(here.length * np.arange(n) / n)
    q = there.at(there.length * np.arange(m) / m)
    size = 0.5 * (here.length / n + there.length / m)
    i, j = _cyclic_path(p, q, size, smoothness, stretch, _STEPS)
    path_s = i * here.length / n
    path_there = j * there.length / m
    if refine:
        n = _samples(here, fine_px)
        grid = here.length * np.arange(n) / n
        start = _periodic_interp(grid, path_s, path_there, here.length, there.length)
        sigma, rounds = _refine(
            here.at(grid), there.points_yx, there.arc, start, here.length / n, smoothness, stretch
        )
        path_s, path_there = grid, sigma
    return _periodic_interp(s, path_s, path_there, here.length, there.length)


def _samples(contour: Contour, spacing: float) -> int:
    return max(8, round(contour.length / spacing))


def _periodic_interp(s: FloatArray, x: FloatArray, y: FloatArray, period_x: float, period_y: float) -> FloatArray:
    """Monotone map of one turn onto another, continued over any number of turns."""
    turn = np.floor((s - x[0]) / period_x)
    inner = np.interp(s - turn * period_x, np.append(x, x[0] + period_x), np.append(y, y[0] + period_y))
    return inner + turn * period_y


@njit(cache=True)
def _pair_cost(p, q, i, j, a, b, size, smoothness, stretch):
    n, m = p.shape[0], q.shape[0]
    pi, qj = p[i % n], q[j % m]
    pa, qb = p[(i - a) % n], q[(j - b) % m]
    dy, dx = qj[0] - pi[0], qj[1] - pi[1]
    ey, ex = qb[0] - pa[0], qb[1] - pa[1]
    length = 0.5 * (a + b) * size
    distance = (dy * dy + dx * dx + ey * ey + ex * ex + dy * ey + dx * ex) / 3.0
    change = (dy - ey) ** 2 + (dx - ex) ** 2
    return distance * length + smoothness * change / length + stretch * (b - a) ** 2 * size*size / length


@njit(cache=True)
def _path(p, q, first, last, low, high, size, smoothness, stretch, steps):
    """Cheapest path from row `first` to row `last`; low, high bound j at both ends (equal when pinned)."""
    rows, columns = last - first + 1, high[1] - low[0] + 1
    cost = np.full((rows, columns), np.inf)
    step_of = np.full((rows, columns), -1, np.int64)
    for c in range(low[0], high[0] + 1):
        cost[0, c - low[0]] = 0.0
    for r in range(1, rows):
        for c in range(columns):
            best, chosen = np.inf, -1
            for k in range(steps.shape[0]):
                a, b = steps[k, 0], steps[k, 1]
                if r - a < 0 or c - b < 0 or not cost[r - a, c - b] < best:
                    continue
                total = cost[r - a, c - b] + _pair_cost(p, q, first + r, low[0] + c, a, b, size, smoothness, stretch)
                if total < best:
                    best, chosen = total, k
            cost[r, c], step_of[r, c] = best, chosen
    r, c = rows - 1, columns - 1
    for candidate in range(low[1] - low[0], columns):
        if cost[r, candidate] < cost[r, c]:
            c = candidate
    i, j = [first + r], [low[0] + c]
    while r > 0:
        k = step_of[r, c]
        r -= steps[k, 0]
        c -= steps[k, 1]
        i.append(first + r)
        j.append(low[0] + c)
    return np.array(i)[::-1].copy(), np.array(j)[::-1].copy()


def _cyclic_path(p, q, size, smoothness, stretch, steps):
    n, m = len(p), len(q)
    # Two turns with free ends, whose middle does not feel them, give a pair to cut the circle at.
    i, j = _path(p, q, 0, 2 * n, np.array([0, 0]), np.array([m, 3 * m]), size, smoothness, stretch, steps)
    middle = np.abs(i - n).argmin()
    i0, j0 = i[middle], j[middle]
    i, j = _path(p, q, i0, i0 + n, np.array([j0, j0 + m]), np.array([j0, j0 + m]), size, smoothness, stretch, steps)
    return i[:-1], j[:-1]


@njit(cache=True)
def _refine(p, points, arc, sigma, h, smoothness, stretch):
    n = p.shape[0]
    total = arc[-1]
    b_count = points.shape[0]
    sigma = sigma.copy()
    q = np.empty((n, 2))
    tangent = np.empty((n, 2))
    diag, off, rhs = np.empty(n), np.empty(n), np.empty(n)
    for round_ in range(60):
        for i in range(n):
            s = sigma[i] % total
            e = min(max(np.searchsorted(arc, s, side="right") - 1, 0), b_count - 1)
            f = (e + 1) % b_count
            length = arc[e + 1] - arc[e]
            share = (s - arc[e]) / length
            for k in range(2):
                tangent[i, k] = (points[f, k] - points[e, k]) / length
                q[i, k] = points[e, k] + share * (points[f, k] - points[e, k])
        w, w2 = smoothness / h, stretch / h
        for i in range(n):
            nxt, prv = (i + 1) % n, i - 1
            g, after, before = 0.0, 0.0, 0.0
            cross = 0.0
            for k in range(2):
                d = q[i, k] - p[i, k]
                da = q[nxt, k] - p[nxt, k] - d
                db = d - (q[prv, k] - p[prv, k])
                g += tangent[i, k] * (h * d + w * (db - da))
                cross += tangent[i, k] * tangent[nxt, k]
            sa = sigma[nxt] + (total if i == n - 1 else 0.0) - sigma[i]
            sb = sigma[i] - (sigma[prv] - (total if i == 0 else 0.0))
            g += w2 * (sb - sa)
            rhs[i] = -g
            diag[i] = h + 2.0 * w + 2.0 * w2
            off[i] = -w * cross - w2
        step = _solve_cyclic(diag, off, rhs)
        # No gap may shrink below a fifth of itself in one round, so order is kept.
        scale, largest = 1.0, 0.0
        for i in range(n):
            nxt = (i + 1) % n
            gap = sigma[nxt] + (total if i == n - 1 else 0.0) - sigma[i]
            shrink = step[i] - step[nxt]
            if shrink > 0.8 * gap:
                scale = min(scale, 0.8 * gap / shrink)
            largest = max(largest, abs(step[i]))
        if largest > 2.0:
            scale = min(scale, 2.0 / largest)
        for i in range(n):
            sigma[i] += scale * step[i]
        if scale * largest < 1e-3:
            break
    return sigma, round_


@njit(cache=True)
def _solve_cyclic(diag, off, rhs):
    """Symmetric cyclic tridiagonal system; off[i] couples i and i + 1, off[-1] the ends (Sherman-Morrison)."""
    n = diag.shape[0]
    gamma = -diag[0]
    d = diag.copy()
    d[0] -= gamma
    d[n - 1] -= off[n - 1] ** 2 / gamma
    u = np.zeros(n)
    u[0], u[n - 1] = gamma, off[n - 1]
    x, z = rhs.copy(), u.copy()
    c = np.empty(n)
    beta = d[0]
    x[0] /= beta
    z[0] /= beta
    for i in range(1, n):
        c[i] = off[i - 1] / beta
        beta = d[i] - off[i - 1] * c[i]
        x[i] = (x[i] - off[i - 1] * x[i - 1]) / beta
        z[i] = (z[i] - off[i - 1] * z[i - 1]) / beta
    for i in range(n - 2, -1, -1):
        x[i] -= c[i + 1] * x[i + 1]
        z[i] -= c[i + 1] * z[i + 1]
    factor = (x[0] + off[n - 1] * x[n - 1] / gamma) / (1.0 + z[0] + off[n - 1] * z[n - 1] / gamma)
    return x - factor * z

"""A depth that goes evenly with area, with the weights that keep the map to the cylinder one to one.

In arms of a cell the harmonic function g falls exponentially, and a map whose depth is g would have next to
no area there. Any increasing function F of g is harmonic, too, if the weight of each edge is divided by the
slope of F along it: then Σ w (gᵢ - gⱼ) stays what it is, 0. These weights are positive as well, so that with
θ solved anew for them (θ, F(g)) is one to one again, for every F.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from cytodisk.arrays import FloatArray
from cytodisk.geometry.mesh import triangle_areas
from cytodisk.geometry.nucleus_mesh import NucleusMesh

_KNOTS = 16  # of the depth as a function of g
_LEAST_POWER = 0.1  # of g, of which it is a power below the first of them: in arms g falls exponentially


def share_below(mesh: NucleusMesh, g: FloatArray) -> FloatArray:
    """Nearly the share of the cytoplasm's area that has less g than each vertex: a smooth function of g."""
    ring = mesh.triangles[~mesh.inside]
    areas = triangle_areas(mesh.vertices_yx, ring)
    held = np.bincount(ring.ravel(), np.repeat(areas / 3.0, 3), minlength=len(g))
    order = np.argsort(g)
    share = np.cumsum(held[order]) / held.sum()
    wanted = np.arange(1, _KNOTS) / _KNOTS
    knots = g[order][np.searchsorted(share, wanted)]
    keep = (knots > 0.0) & (knots < 1.0) & (np.diff(knots, prepend=0.0) > 0.0)
    x, y = np.append(np.log(knots[keep]), 0.0), np.append(wanted[keep], 1.0)
    if len(x) < 2:
        return g
    below = g < np.exp(x[0])
    power = min(max(np.log(y[1] / y[0]) / (x[1] - x[0]), _LEAST_POWER), 1.0)
    depth = y[0] * (g / np.exp(x[0])) ** power
    depth[~below] = PchipInterpolator(x, y)(np.log(g[~below]))
    return np.asarray(depth)


def reweighted(mesh: NucleusMesh, edge_weights: FloatArray, g: FloatArray, depth: FloatArray) -> FloatArray:
    """Weights, positive where those given are, with which an increasing function of g is harmonic, too."""
    start, end = mesh.triangles.T.ravel(), np.roll(mesh.triangles, -1, axis=1).T.ravel()
    rise, climb = np.abs(g[end] - g[start]), np.abs(depth[end] - depth[start])
    levels, first = np.unique(g, return_index=True)
    highest = np.maximum.accumulate(depth[first])
    rising = np.diff(highest, prepend=-1.0) > 0.0  # neighbouring levels may have one depth in rounding
    levels, first = levels[rising], first[rising]
    steps = np.diff(levels) / np.diff(depth[first])
    slope = np.append(steps, steps[-1:] if len(steps) else 1.0)
    level = (climb == 0.0) | (rise == 0.0)
    along = slope[np.searchsorted(levels, g[start], side="right") - 1]
    return np.asarray(edge_weights * np.where(level, along, rise / np.where(level, 1.0, climb)))

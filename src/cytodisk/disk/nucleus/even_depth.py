"""A depth that grows inwards more evenly, with the weights that keep the map to the cylinder one to one.

In arms of a cell the harmonic function g falls exponentially, and a map whose depth is g would have next to
no area there. Any increasing function F of g is harmonic, too, if the weight of each edge is divided by the
slope of F along it: then Σ w (gᵢ - gⱼ) stays what it is, 0. These weights are positive as well, so that with
θ solved anew for them (θ, F(g)) is one to one again, for every F.

In narrow bays of the nucleus 1 - g falls likewise, and doubles near 1 cannot tell its values: there g and
1 - g are solved for each, and F is a power of either at its end.

The more even the depth, the fewer steps a relaxation takes; but θ in arms is drawn towards the body by the
new weights, and with an F that makes all depths even (the share of area with less g) maps of one cell that is
meshed anew would differ more.
"""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.geometry.nucleus_mesh import NucleusMesh

POWERS = (0.7, 0.4, 0.15)
"""Of g, tried in this order until rounding turns no triangle over. With other powers
`benchmarks/nucleus_places.py` prints how well maps come out the same.
"""


def reweighted(mesh: NucleusMesh, edge_weights: FloatArray, g: FloatArray, depth: FloatArray) -> FloatArray:
    """Weights, positive where those given are, with which an increasing function of g is harmonic, too.

    Parameters
    ----------
    mesh : NucleusMesh
    edge_weights : ndarray of shape (3 F,) and dtype float
        Of edge k → k + 1 of triangle t in entry k F + t: g is harmonic with them.
    g, depth : ndarray of shape (V,) and dtype float
        The function, and an increasing function of it.

    Returns
    -------
    ndarray of shape (3 F,) and dtype float
    """
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


def reweighted_at_both_ends(
    mesh: NucleusMesh, edge_weights: FloatArray, g: FloatArray, rest: FloatArray, power: float
) -> FloatArray:
    """Weights, positive where those given are, with which F(g) = gᵖ / (gᵖ + (1 - g)ᵖ) is harmonic, too.

    Parameters
    ----------
    mesh : NucleusMesh
    edge_weights : ndarray of shape (3 F,) and dtype float
        As for `reweighted`; positive.
    g, rest : ndarray of shape (V,) and dtype float
        The function, and 1 - g to its own last digit.
    power : float
        p.

    Returns
    -------
    ndarray of shape (3 F,) and dtype float
    """
    start, end = mesh.triangles.T.ravel(), np.roll(mesh.triangles, -1, axis=1).T.ravel()
    low, high = np.maximum(g, 0.0), np.maximum(rest, 0.0)
    of_low, of_high = low**power, high**power
    depth, left = of_low / (of_low + of_high), of_high / (of_low + of_high)
    outer = low[start] < 0.5
    rise = np.abs(np.where(outer, low[end] - low[start], high[end] - high[start]))
    climb = np.abs(np.where(outer, depth[end] - depth[start], left[end] - left[start]))
    # Along an edge of one level, the slope of F⁻¹ there: g (1 - g) / (p F (1 - F)).
    spread = np.where(depth * left > 0.0, power * depth * left, 1.0)
    level = (climb == 0.0) | (rise == 0.0)
    return np.asarray(
        edge_weights * np.where(level, (low * high / spread)[start], rise / np.where(level, 1.0, climb))
    )

"""Fourier modes around the cell: how much of the edge oscillates together, with one wave around it, two, …"""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import BoolArray, ComplexArray, FloatArray


def highest_mode(sectors: int, asked: int) -> int:
    """Most waves around the cell that can be told from their mirror image."""
    return min(asked, max((sectors - 1) // 2, 0))


def sector_angles(lengths: FloatArray) -> FloatArray:
    """Middle of each sector as an angle along the edge, from the start of sector 0.

    Parameters
    ----------
    lengths : ndarray of shape (T, S) and dtype float
        Shares of the edge.

    Returns
    -------
    ndarray of shape (T, S) and dtype float
        In radians, a whole turn is the whole edge.
    """
    ends = np.cumsum(lengths, axis=1)
    return np.asarray(2.0 * np.pi * (ends - 0.5 * lengths))


def mode_weights(lengths: FloatArray, present: BoolArray, modes: int) -> ComplexArray:
    """What each sector adds to each mode.

    Parameters
    ----------
    lengths : ndarray of shape (T, S) and dtype float
        Shares of the edge.
    present : ndarray of shape (T, S) and dtype bool
        Sectors without a value are filled in linearly along the edge from the nearest that have one.
    modes : int
        The highest.

    Returns
    -------
    ndarray of shape (T, modes + 1, S) and dtype complex
        With the first axis 1 if all frames are alike. A wave cos(m θ − ω t) has ½ exp(−i ω t) in mode m.
    """
    alike = bool(present.all()) and bool((lengths == lengths[0]).all())
    if alike:
        lengths, present = lengths[:1], present[:1]
    angles = sector_angles(lengths)
    turns = np.exp(-1j * np.arange(modes + 1)[:, None] * angles[:, None, :])
    weights = np.asarray(turns * lengths[:, None, :])
    for frame in np.flatnonzero(~present.all(axis=1)):
        weights[frame] = weights[frame] @ _filling(angles[frame], present[frame])
    return weights


def modes_of(values: FloatArray, weights: ComplexArray) -> ComplexArray:
    """Modes of movies.

    Parameters
    ----------
    values : ndarray of shape (T, S, R) and dtype float
        NaN counts as 0: its weight is.
    weights : ndarray of shape (T or 1, M, S) and dtype complex

    Returns
    -------
    ndarray of shape (T, M, R) and dtype complex
    """
    values = np.nan_to_num(values, nan=0.0)
    found = np.empty((len(values), weights.shape[1], values.shape[2]), dtype=np.complex128)
    found.real = weights.real @ values
    found.imag = weights.imag @ values
    return found


def _filling(angles: FloatArray, present: BoolArray) -> FloatArray:
    """Matrix (S, S) that fills in sectors without a value linearly around the cell."""
    known = np.flatnonzero(present)
    if not known.size:
        return np.zeros((len(angles), len(angles)))
    filling = np.diag(present.astype(np.float64))
    for sector in np.flatnonzero(~present):
        place = np.searchsorted(known, sector)
        before, after = known[place - 1], known[place % len(known)]
        behind = (angles[sector] - angles[before]) % (2.0 * np.pi)
        ahead = (angles[after] - angles[sector]) % (2.0 * np.pi)
        share = behind / (behind + ahead) if behind + ahead else 0.5
        filling[sector, before] += 1.0 - share
        filling[sector, after] += share
    return filling

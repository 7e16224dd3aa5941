"""Surrogates of a source: shifted in time and turned around the cell, all of them at once by Fourier."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft

from cytodisk.analysis.prediction.source_scales import Scales
from cytodisk.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Shifts:
    """By how much each surrogate is shifted.

    Attributes
    ----------
    frames, sectors : ndarray of shape (R,) and dtype int
        On a circle of `circle_of` frames.
    """

    frames: IntArray
    sectors: IntArray

    @classmethod
    def drawn(cls, circle: int, around: int, least: int, count: int, seed: int) -> Shifts:
        """So many of all shifts, no two alike, by at least so many frames to either side."""
        of_time = np.arange(least, circle - least + 1)
        possible = len(of_time) * around
        random = np.random.default_rng(seed)
        chosen = random.choice(possible, min(count, possible), replace=False)
        return cls(of_time[chosen // around], chosen % around)


def circle_of(frames: int) -> int:
    """Frames of the circle on which sources are shifted; a few more than the movie's are faster."""
    return int(fft.next_fast_len(frames, real=True))


class ShiftedSource:
    """Products of the past of a shifted source with other columns.

    Parameters
    ----------
    source : ndarray of shape (T, S) and dtype float
        Mean 0, and 0 where it is not known.
    used : ndarray of shape (T, S) and dtype bool
        Rows of the model.
    past : int
        Lags 1 to `past` of the source are its columns.
    shifts : Shifts
    scales : Scales
        They stay in their place: what is shifted is the source divided by them.

    Notes
    -----
    A row whose past would hold both ends of the movie, which do not fit each other, has no source: all its
    lags are 0. Products are those over the whole circle, by Fourier, less those of these few rows.
    """

    def __init__(self, source: FloatArray, used: BoolArray, past: int, shifts: Shifts, scales: Scales):
        self._past, self._shifts = past, shifts
        self._frames = len(source)
        circle = circle_of(self._frames)
        self._source = _on(circle, source / scales.table)
        self._used = _on(circle, used)
        self._sector_scales = scales.sectors
        self._by_frame = _on(circle, used * scales.frames[:, None])
        lags = np.arange(1, past + 1)
        self._at = (shifts.frames[:, None] + lags) % circle, shifts.sectors[:, None]
        torn = np.concatenate([np.arange(past), np.arange(self._frames + 1, circle)])
        torn = torn[(torn > 0) | (circle > self._frames)]  # frame 0 sees the very end, if nothing is between
        self._torn = torn
        self._torn_past = np.stack([self._source[(torn - lag) % circle] for lag in lags], axis=-1)

    def products(self, tables: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Products of the source's past with columns, and with itself with each sector's mean removed.

        Parameters
        ----------
        tables : ndarray of shape (T, S, K) and dtype float
            Columns, 0 where a row is not used; each sector's mean is 0.

        Returns
        -------
        with_columns : ndarray of shape (R, past, K) and dtype float
        with_itself : ndarray of shape (R, past, past) and dtype float
        """
        count, circle = len(self._shifts.frames), len(self._source)
        scale = self._by_frame * self._sector_scales
        columns = np.empty((count, self._past, tables.shape[2]))
        spectrum = np.conj(fft.rfft2(self._source))
        whole = _on(circle, tables)
        for place in range(tables.shape[2]):
            columns[..., place] = self._around(scale * whole[..., place], spectrum)[self._at]
        itself, sums = self._with_itself(scale**2), self._sums()
        sectors = self._source.shape[1]
        for row, (shift, turn) in enumerate(zip(self._shifts.frames, self._shifts.sectors, strict=True)):
            at = (self._torn + shift) % circle
            past = np.roll(self._torn_past, turn, axis=1) * scale[at][..., None]
            flat = past.reshape(at.size * sectors, self._past)
            columns[row] -= flat.T @ whole[at].reshape(len(flat), tables.shape[2])
            itself[row] -= flat.T @ flat
            sums[row] -= past.sum(axis=0).reshape(sectors, self._past)
        weights = np.maximum(self._used.sum(axis=0), 1.0)[:, None]
        of_means = sums / np.sqrt(weights)
        return columns, itself - of_means.transpose(0, 2, 1) @ of_means

    def _around(self, table: FloatArray, spectrum: FloatArray) -> FloatArray:
        """Products of a table with what has a spectrum, at every shift."""
        return np.asarray(fft.irfft2(fft.rfft2(table) * spectrum, s=table.shape))

    def _with_itself(self, weights: FloatArray) -> FloatArray:
        """Products of the source's past with itself over the rows."""
        found = np.empty((len(self._shifts.frames), self._past, self._past))
        for apart in range(self._past):
            twice = self._source * np.roll(self._source, apart, axis=0)
            products = self._around(weights, np.conj(fft.rfft2(twice)))[self._at]
            for lag in range(self._past - apart):
                found[:, lag, lag + apart] = found[:, lag + apart, lag] = products[:, lag]
        return found

    def _sums(self) -> FloatArray:
        """Sums of the source's past over the rows of each sector, shape (R, S, past)."""
        spectrum = np.conj(fft.rfft(self._source, axis=0))
        frames, turns = self._at
        sectors = self._source.shape[1]
        found = np.empty((len(frames), sectors, self._past))
        patterns, pattern = np.unique(self._by_frame, axis=1, return_inverse=True)  # most often one
        for number, used in enumerate(patterns.T):
            sums = fft.irfft(fft.rfft(used)[:, None] * spectrum, n=len(used), axis=0)
            for place in np.nonzero(pattern == number)[0]:
                found[:, place] = self._sector_scales[place] * sums[frames, (place - turns) % sectors]
        return found


def _on(circle: int, table: FloatArray | BoolArray) -> FloatArray:
    whole = np.zeros((circle, *table.shape[1:]))
    whole[: len(table)] = table
    return whole

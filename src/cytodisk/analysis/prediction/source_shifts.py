"""Surrogates of a source: shifted in time and turned around the cell, all of them at once by Fourier."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft

from cytodisk.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Shifts:
    """By how much each surrogate is shifted.

    Attributes
    ----------
    frames, sectors : ndarray of shape (R,) and dtype int
        Frames on a circle that is `past` frames longer than the movie, where the source is empty: no row
        then sees both ends of the movie.
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
    """

    def __init__(self, source: FloatArray, used: BoolArray, past: int, shifts: Shifts):
        self._past, self._shifts = past, shifts
        self._source = np.zeros((len(source) + past, source.shape[1]))
        self._source[: len(source)] = source
        self._used = np.zeros(self._source.shape)
        self._used[: len(source)] = used
        lags = np.arange(1, past + 1)
        self._at = (shifts.frames[:, None] + lags) % len(self._source), shifts.sectors[:, None]

    def with_columns(self, tables: FloatArray) -> FloatArray:
        """Products of the source's past with columns given as tables.

        Parameters
        ----------
        tables : ndarray of shape (T, S, K) and dtype float
            0 where a row is not used.

        Returns
        -------
        ndarray of shape (R, past, K) and dtype float
        """
        spectrum = np.conj(fft.rfft2(self._source))
        found = np.empty((len(self._shifts.frames), self._past, tables.shape[2]))
        for place in range(tables.shape[2]):
            table = np.zeros_like(self._source)
            table[: len(tables)] = tables[..., place]
            products = fft.irfft2(fft.rfft2(table) * spectrum, s=self._source.shape)
            found[..., place] = products[self._at]
        return found

    def with_itself(self) -> FloatArray:
        """Products of the source's past with itself over the rows, each sector's mean removed.

        Returns
        -------
        ndarray of shape (R, past, past) and dtype float
        """
        found = np.empty((len(self._shifts.frames), self._past, self._past))
        used = fft.rfft2(self._used)
        for apart in range(self._past):
            twice = self._source * np.roll(self._source, apart, axis=0)
            products = fft.irfft2(used * np.conj(fft.rfft2(twice)), s=self._source.shape)[self._at]
            for lag in range(self._past - apart):
                found[:, lag, lag + apart] = found[:, lag + apart, lag] = products[:, lag]
        return found - self._of_means()

    def _of_means(self) -> FloatArray:
        """What the means of sectors add to the products of the source with itself."""
        total = np.zeros((len(self._shifts.frames), self._past, self._past))
        spectrum = np.conj(fft.rfft(self._source, axis=0))
        frames, sectors = self._at
        for place, count in enumerate(self._used.sum(axis=0)):
            if count == 0:
                continue
            used = fft.rfft(self._used[:, place])[:, None]
            sums = fft.irfft(used * spectrum, n=len(self._source), axis=0)
            of_sector = sums[frames, (place - sectors) % sums.shape[1]]
            total += of_sector[:, :, None] * of_sector[:, None, :] / count
        return total

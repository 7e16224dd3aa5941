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

    Notes
    -----
    A row whose past would hold both ends of the movie, which do not fit each other, has no source: all its
    lags are 0. Products are those over the whole circle, by Fourier, less those of these few rows.
    """

    def __init__(self, source: FloatArray, used: BoolArray, past: int, shifts: Shifts):
        self._past, self._shifts = past, shifts
        self._frames = len(source)
        circle = circle_of(self._frames)
        self._source = np.zeros((circle, source.shape[1]))
        self._source[: self._frames] = source
        self._used = np.zeros(self._source.shape)
        self._used[: self._frames] = used
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
        count = len(self._shifts.frames)
        columns = np.empty((count, self._past, tables.shape[2]))
        spectrum = np.conj(fft.rfft2(self._source))
        for place in range(tables.shape[2]):
            columns[..., place] = self._around(self._on_circle(tables[..., place]), spectrum)[self._at]
        itself, sums = self._with_itself(), self._sums()
        whole = np.zeros((*self._source.shape, tables.shape[2]))
        whole[: self._frames] = tables
        sectors = self._source.shape[1]
        for row, (shift, turn) in enumerate(zip(self._shifts.frames, self._shifts.sectors, strict=True)):
            at = (self._torn + shift) % len(self._source)
            past = np.roll(self._torn_past, turn, axis=1) * self._used[at][..., None]
            flat = past.reshape(at.size * sectors, self._past)
            columns[row] -= flat.T @ whole[at].reshape(len(flat), tables.shape[2])
            itself[row] -= flat.T @ flat
            sums[row] -= past.sum(axis=0).reshape(sectors, self._past)
        weights = np.maximum(self._used.sum(axis=0), 1.0)[:, None]
        of_means = sums / np.sqrt(weights)
        return columns, itself - of_means.transpose(0, 2, 1) @ of_means

    def _on_circle(self, table: FloatArray) -> FloatArray:
        whole = np.zeros_like(self._source)
        whole[: self._frames] = table
        return whole

    def _around(self, table: FloatArray, spectrum: FloatArray) -> FloatArray:
        """Products of a table with what has a spectrum, at every shift."""
        return np.asarray(fft.irfft2(fft.rfft2(table) * spectrum, s=table.shape))

    def _with_itself(self) -> FloatArray:
        """Products of the source's past with itself over the rows."""
        found = np.empty((len(self._shifts.frames), self._past, self._past))
        for apart in range(self._past):
            twice = self._source * np.roll(self._source, apart, axis=0)
            products = self._around(self._used, np.conj(fft.rfft2(twice)))[self._at]
            for lag in range(self._past - apart):
                found[:, lag, lag + apart] = found[:, lag + apart, lag] = products[:, lag]
        return found

    def _sums(self) -> FloatArray:
        """Sums of the source's past over the rows of each sector, shape (R, S, past)."""
        spectrum = np.conj(fft.rfft(self._source, axis=0))
        frames, turns = self._at
        sectors = self._source.shape[1]
        found = np.empty((len(frames), sectors, self._past))
        patterns, pattern = np.unique(self._used, axis=1, return_inverse=True)  # most often one
        for number, used in enumerate(patterns.T):
            sums = fft.irfft(fft.rfft(used)[:, None] * spectrum, n=len(used), axis=0)
            for place in np.nonzero(pattern == number)[0]:
                found[:, place] = sums[frames, (place - turns) % sectors]
        return found

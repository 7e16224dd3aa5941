"""Movies of a disk as they might have been without a wave: noise in modes around the cell and in layers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy import fft
from scipy.ndimage import gaussian_filter

from cytodisk.analysis.waves.depth_modes import DepthWaves, depth_cells
from cytodisk.analysis.waves.mode_spectrum import Bands
from cytodisk.analysis.waves.sector_spectra import SectorSpectra, fine_share
from cytodisk.analysis.waves.wave_background import background
from cytodisk.analysis.waves.wave_surrogates import BLOCK, LEAST, ROUNDS, SMOOTH, TRIALS
from cytodisk.arrays import ComplexArray, FloatArray, IntArray


class DepthNull:
    """Makes modes of surrogate movies.

    Parameters
    ----------
    modes : ndarray of shape (T, M + 1, L) and dtype complex
    values : ndarray of shape (T, S, L) and dtype float
        Of the same frames, NaN where there are none: each layer keeps its spectrum.
    slots : ndarray of shape (T,) and dtype int
        Place of each frame on an even grid.
    interval : float
        Seconds between the frames of that grid.
    found : Bands
    seed : int
    """

    def __init__(
        self,
        modes: ComplexArray,
        values: FloatArray,
        slots: IntArray,
        interval: float,
        found: Bands,
        seed: int,
    ) -> None:
        self._random = np.random.default_rng(seed)
        self._slots = slots
        self._shape = modes.shape[1:]
        on_grid = np.full((slots[-1] + 1, *values.shape[1:]), np.nan)
        on_grid[slots] = values
        self._frames = len(on_grid)
        self._spectra = SectorSpectra.of(on_grid.reshape(self._frames, -1))
        self._set_gain(modes, interval, found)

    def draw(self, count: int) -> Iterator[ComplexArray]:
        """Modes of surrogates, in blocks of shape (T, M + 1, L, R)."""
        for start in range(0, count, BLOCK):
            yield self._drawn(min(BLOCK, count - start))

    def _set_gain(self, modes: ComplexArray, interval: float, found: Bands) -> None:
        """Power of each wave at each frequency such that surrogates have the background of the movie."""
        count, layers = self._shape
        waves = DepthWaves.of(count - 1, layers)
        groups, keys = waves.groups(), waves.group_keys()

        def levels(movies: ComplexArray) -> tuple[FloatArray, FloatArray]:
            power = depth_cells(movies, found)
            fitted = background(power, found.frequencies, groups)
            mean = np.stack([fitted.level.mean(axis=1), fitted.slope.mean(axis=1)])
            return mean, power.sum(axis=1)

        wanted, sums = levels(modes[..., None])
        deep = layers // 2 + 1
        table = np.empty((2, count, deep))
        table[:, keys[:, 0], keys[:, 1]] = wanted
        table = _smooth(table)
        wanted = set_to = table[:, keys[:, 0], keys[:, 1]]
        frequency = np.abs(fft.fftfreq(2 * self._frames, interval))
        abscissa = np.log(frequency.clip(found.frequencies[0], found.frequencies[-1]))
        abscissa = abscissa - np.log(found.frequencies).mean()
        depth = np.abs(fft.fftfreq(2 * layers, 1.0 / layers)).clip(0, deep - 1)
        low, share = depth.astype(np.int64), depth % 1.0
        high = np.minimum(low + 1, deep - 1)
        for step in range(ROUNDS + 1):
            table[:, keys[:, 0], keys[:, 1]] = set_to
            fine = table[:, :, low] * (1.0 - share) + table[:, :, high] * share
            logs = fine[0] + abscissa[:, None, None] * fine[1]  # (frequency, mode, 2 layers)
            self._gain = np.exp(0.5 * np.maximum(logs - logs.max(), LEAST))[..., None]
            had, had_sums = levels(self._drawn(TRIALS))
            if step == ROUNDS // 2:
                self._spectra = self._spectra.with_fine(fine_share(sums[:, 0], had_sums))
            elif step < ROUNDS:
                set_to = set_to + np.clip(wanted - had, [[-2.0], [-1.0]], [[2.0], [1.0]])
        self._spectra = self._spectra.scaled(float(sums.sum() / had_sums.sum(axis=0).mean()))

    def _drawn(self, count: int) -> ComplexArray:
        modes, layers = self._shape
        shape = (2 * self._frames, modes, 2 * layers, count)
        noise = self._random.standard_normal(shape) + 1j * self._random.standard_normal(shape)
        noise[:, 0] = np.sqrt(2.0) * noise[:, 0].real
        spectrum = fft.fft(fft.fft(noise, axis=0), axis=2) * self._gain
        power = (self._spectra.amplitude**2).reshape(self._frames + 1, -1, layers).mean(axis=1)
        amplitude = np.sqrt(np.concatenate([power, power[-2:0:-1]]))  # (frequency, layer)
        alike = fft.ifft(spectrum, axis=2)[:, :, :layers] * amplitude[:, None, :, None]
        drawn = fft.ifft(alike, axis=0)[self._slots]
        return np.asarray(drawn)


def _smooth(table: FloatArray) -> FloatArray:
    """Levels and slopes (2, M + 1, depths) that change little from one to the next; mirrored at 0."""
    whole = np.concatenate([table[:, :0:-1], table], axis=1)
    whole = np.concatenate([whole[:, :, :0:-1], whole], axis=2)
    smoothed = gaussian_filter(whole, (0.0, SMOOTH, SMOOTH), mode="nearest")
    return np.asarray(smoothed[:, table.shape[1] - 1 :, table.shape[2] - 1 :])

"""Movies as they might have been without a wave: noise with the spectra of sectors, and neighbours as alike.

Each sector keeps how much and how fast it changes. Modes around the cell keep their power, as a straight line
over the logarithm of frequency. What is lost is power that one mode has at one period and in one direction.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy import fft
from scipy.ndimage import gaussian_filter1d

from cytodisk.analysis.waves.edge_modes import mode_weights, modes_of
from cytodisk.analysis.waves.edge_series import EdgeSeries
from cytodisk.analysis.waves.mode_spectrum import Bands, wave_cells
from cytodisk.analysis.waves.sector_spectra import SectorSpectra, fine_share
from cytodisk.analysis.waves.wave_background import background, edge_groups
from cytodisk.arrays import FloatArray, IntArray

BLOCK = 25  # surrogates made at once
TRIALS = 25  # from which the levels of modes are set
ROUNDS = 4
LEAST = -16.0  # logarithm of the power of a mode over that of the strongest
SMOOTH = 1.0  # modes over which levels are smoothed


class WaveNull:
    """Makes surrogate movies of one cell.

    Parameters
    ----------
    series : EdgeSeries
    found : Bands
        Of the frames that are used.
    seed : int

    Notes
    -----
    Spectra are those of each series followed by its mirror image, so that slow changes do not leak; see
    `phase_randomised`. The power of modes is set so that surrogates have, on average, the levels and slopes
    that the robust fit finds in the movie, which a wave at one period hardly moves.
    """

    def __init__(self, series: EdgeSeries, found: Bands, seed: int) -> None:
        self._random = np.random.default_rng(seed)
        self._used = series.used
        self._slots = frame_slots(series)
        self._missing = ~np.isfinite(series.values)
        on_grid = np.full((self._slots[-1] + 1, series.values.shape[1]), np.nan)
        on_grid[self._slots] = series.values
        self._spectra = SectorSpectra.of(on_grid)
        self._frames, self._sectors = on_grid.shape
        self._set_modes(series, found)

    def draw(self, count: int) -> Iterator[FloatArray]:
        """Surrogates of the frames that are used, in blocks of shape (T, S, R)."""
        for start in range(0, count, BLOCK):
            yield self._drawn(min(BLOCK, count - start))

    def _set_modes(self, series: EdgeSeries, found: Bands) -> None:
        """Power of each mode at each frequency such that surrogates have the background of the movie."""
        half = self._sectors // 2
        whole = max((self._sectors - 1) // 2, 0)
        used = self._used
        weights = mode_weights(series.lengths[used], ~self._missing[used], whole)
        groups = edge_groups(whole)

        def levels(movies: FloatArray) -> tuple[FloatArray, FloatArray]:
            power = wave_cells(modes_of(movies, weights), found)
            fitted = background(power, found.frequencies, groups)
            mean = np.stack([fitted.level.mean(axis=1), fitted.slope.mean(axis=1)])
            return mean, power.sum(axis=1)

        wanted, sums = levels(series.values[used][:, :, None])
        wanted = set_to = _smooth(wanted)
        number = np.arange(self._frames + 1) / (2.0 * self._frames * series.interval)
        low, high = found.frequencies[0], found.frequencies[-1]
        abscissa = np.log(number.clip(low, high)) - np.log(found.frequencies).mean()
        for step in range(ROUNDS + 1):
            logs = set_to[0, :, None] + set_to[1, :, None] * abscissa
            logs = np.maximum(logs - logs.max(), LEAST)
            last = logs[np.minimum(np.arange(half + 1), whole)]
            self._mode_gain = np.exp(0.5 * last).T  # (frequency, mode)
            had, had_sums = levels(self._drawn(TRIALS))
            if step == ROUNDS // 2:
                self._spectra = self._spectra.with_fine(fine_share(sums[:, 0], had_sums))
            elif step < ROUNDS:
                set_to = set_to + np.clip(wanted - had, [[-2.0], [-1.0]], [[2.0], [1.0]])
        self._spectra = self._spectra.scaled(float(sums.sum() / had_sums.sum(axis=0).mean()))

    def _drawn(self, count: int) -> FloatArray:
        noise = self._random.standard_normal((count, 2 * self._frames, self._sectors))
        spectrum = fft.rfft(noise, axis=1)
        modes = fft.fft(spectrum, axis=2)
        wave_numbers = np.abs(fft.fftfreq(self._sectors, 1.0 / self._sectors)).round().astype(np.int64)
        alike = fft.ifft(modes * self._mode_gain[:, wave_numbers], axis=2)
        drawn = fft.irfft(alike * self._spectra.amplitude, 2 * self._frames, axis=1)[:, self._slots]
        drawn[:, self._missing] = np.nan
        return np.asarray(np.moveaxis(drawn[:, self._used], 0, 2))


def frame_slots(series: EdgeSeries) -> IntArray:
    """Place of each frame on an even grid; frames of uneven movies that would share one follow each other."""
    slots = np.round((series.seconds - series.seconds[0]) / series.interval).astype(np.int64)
    return slots if (np.diff(slots) > 0).all() else np.arange(len(slots))


def _smooth(by_mode: FloatArray) -> FloatArray:
    """Levels and slopes (2, M + 1) that change little from mode to mode; modes below 0 are mirror images."""
    whole = np.concatenate([by_mode[:, :0:-1], by_mode], axis=1)
    return np.asarray(gaussian_filter1d(whole, SMOOTH, mode="nearest")[:, by_mode.shape[1] - 1 :])

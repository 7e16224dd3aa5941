"""Movies as they might have been without a wave: noise with the spectra of sectors, and neighbours as alike.

Each sector keeps how much and how fast it changes. Modes around the cell keep their power, as a straight line
over the logarithm of frequency. What is lost is power that one mode has at one period and in one direction.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy import fft
from scipy.ndimage import gaussian_filter1d

from cytodisk.analysis.correlation.prepared_series import interpolated
from cytodisk.analysis.waves.edge_modes import mode_weights, modes_of
from cytodisk.analysis.waves.edge_series import EdgeSeries
from cytodisk.analysis.waves.mode_spectrum import Bands, wave_cells
from cytodisk.analysis.waves.wave_background import Background, background, edge_groups
from cytodisk.arrays import FloatArray, IntArray

_BLOCK = 25  # surrogates made at once
TRIALS = 25  # from which the levels of modes are set
ROUNDS = 3
LEAST = -16.0  # logarithm of the power of a mode over that of the strongest
_OWN_SHAPE = 6.0  # a sector's own spectrum over the mean one is smoothed by frames / this
SMOOTH = 1.0
_FINE = 1.0  # bins of twice the duration by which the mean spectrum is smoothed


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
        self._amplitude = mirrored_amplitudes(on_grid)
        self._frames, self._sectors = on_grid.shape
        self._set_modes(series, found)

    def draw(self, count: int) -> Iterator[FloatArray]:
        """Surrogates of the frames that are used, in blocks of shape (T, S, R)."""
        for start in range(0, count, _BLOCK):
            yield self._drawn(min(_BLOCK, count - start))

    def _set_modes(self, series: EdgeSeries, found: Bands) -> None:
        """Power of each mode at each frequency such that surrogates have the background of the movie."""
        half = self._sectors // 2
        whole = max((self._sectors - 1) // 2, 0)
        used = self._used
        weights = mode_weights(series.lengths[used], ~self._missing[used], whole)

        groups = edge_groups(whole)

        def levels(movies: FloatArray) -> Background:
            return background(wave_cells(modes_of(movies, weights), found), found.frequencies, groups)

        wanted = levels(series.values[used][:, :, None])
        number = np.arange(self._amplitude.shape[0]) / (2.0 * self._frames * series.interval)
        low, high = found.frequencies[0], found.frequencies[-1]
        abscissa = np.log(number.clip(low, high)) - np.log(found.frequencies).mean()
        level, slope = _smooth(wanted.level[:, 0]), _smooth(wanted.slope[:, 0])
        wanted_level, wanted_slope = level, slope
        for step in range(ROUNDS + 1):
            logs = level[:, None] + slope[:, None] * abscissa
            logs = np.maximum(logs - logs.max(), LEAST)
            last = logs[np.minimum(np.arange(half + 1), whole)]
            self._mode_gain = np.exp(0.5 * last).T  # (frequency, mode)
            if step < ROUNDS:
                had = levels(self._drawn(TRIALS))
                level = level + np.clip(wanted_level - had.level.mean(axis=1), -2.0, 2.0)
                slope = slope + np.clip(wanted_slope - had.slope.mean(axis=1), -1.0, 1.0)

    def _drawn(self, count: int) -> FloatArray:
        noise = self._random.standard_normal((count, 2 * self._frames, self._sectors))
        spectrum = fft.rfft(noise, axis=1)
        modes = fft.fft(spectrum, axis=2)
        wave_numbers = np.abs(fft.fftfreq(self._sectors, 1.0 / self._sectors)).round().astype(np.int64)
        alike = fft.ifft(modes * self._mode_gain[:, wave_numbers], axis=2)
        drawn = fft.irfft(alike * self._amplitude, 2 * self._frames, axis=1)[:, self._slots]
        drawn[:, self._missing] = np.nan
        return np.asarray(np.moveaxis(drawn[:, self._used], 0, 2))


def frame_slots(series: EdgeSeries) -> IntArray:
    """Place of each frame on an even grid; frames of uneven movies that would share one follow each other."""
    slots = np.round((series.seconds - series.seconds[0]) / series.interval).astype(np.int64)
    return slots if (np.diff(slots) > 0).all() else np.arange(len(slots))


def mirrored_amplitudes(series: FloatArray) -> FloatArray:
    """Amplitudes (T + 1, S) of spectra of series (T, S) with their mirror images.

    The fine shape is the mean of all sectors', the broad shape each sector's own: a single spectrum is so
    rough that neighbours would not come out as alike as they are.
    """
    filled = interpolated(series)
    filled = np.where(np.isfinite(filled), filled, 0.0)
    centred = filled - filled.mean(axis=0)
    power = np.abs(fft.rfft(np.concatenate([centred, centred[::-1]]), axis=0)) ** 2
    power[0] = power[1]
    broad = gaussian_filter1d(power, len(series) / _OWN_SHAPE, axis=0, mode="nearest")
    mean = gaussian_filter1d(power.mean(axis=1), _FINE, mode="nearest")
    shape = broad / np.where(broad.mean(axis=1) > 0, broad.mean(axis=1), 1.0)[:, None]
    return np.asarray(np.sqrt(mean[:, None] * shape))


def _smooth(by_mode: FloatArray) -> FloatArray:
    """Levels that change little from mode to mode, as those of neighbours that are alike do."""
    whole = np.concatenate([by_mode[:0:-1], by_mode])  # modes below 0 are their mirror images
    return np.asarray(gaussian_filter1d(whole, SMOOTH, mode="nearest")[len(by_mode) - 1 :])

"""Looks for the strongest wave around a cell, and among surrogates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cytodisk.analysis.waves.edge_modes import highest_mode, mode_weights, modes_of
from cytodisk.analysis.waves.edge_series import EdgeSeries, check_around, check_shown
from cytodisk.analysis.waves.mode_spectrum import Bands, bands, refined_frequency, wave_cells
from cytodisk.analysis.waves.wave_background import Background, background, edge_groups, wave_scores
from cytodisk.analysis.waves.wave_surrogates import WaveNull
from cytodisk.analysis.waves.waves_parameters import WaveSearchParameters
from cytodisk.arrays import ComplexArray, FloatArray

_OVERLAP = 1.5  # frequencies in which the power of one is found, under the taper


@dataclass(frozen=True, eq=False)
class WaveFound:
    """The strongest wave.

    Attributes
    ----------
    mode : int
        Waves around the cell.
    frequency : float
        In 1/s.
    score : float
    null : ndarray of shape (R,) and dtype float
        Scores of surrogates.
    spectrum : ndarray of shape (K, 2 M + 1) and dtype float
        Share of the variance of each wave at each frequency that is looked for, as `wave_cells` orders them.
    frequencies : ndarray of shape (K,) and dtype float
        In 1/s.
    chance : ndarray of shape (M + 1,) and dtype float
        Share of each mode that 95 % of the surrogates stay below.
    modes : ndarray of shape (T, M + 1) and dtype complex
        Of the frames that are used.
    seconds : ndarray of shape (T,) and dtype float
        Of these frames.
    periods : tuple of float
        Shortest and longest that the movie can show, in seconds.
    """

    mode: int
    frequency: float
    score: float
    null: FloatArray
    spectrum: FloatArray
    frequencies: FloatArray
    chance: FloatArray
    modes: ComplexArray
    seconds: FloatArray
    periods: tuple[float, float]


class WaveSearch:
    """Modes, periods and scores of one cell.

    Parameters
    ----------
    series : EdgeSeries
    how : WaveSearchParameters

    Raises
    ------
    ParameterError
        As for `check_shown` and `check_around`.
    """

    def __init__(self, series: EdgeSeries, how: WaveSearchParameters) -> None:
        self.periods = check_shown(series, how)
        check_around(series)
        self.series = series
        used = series.used
        self.values, self.seconds = series.values[used], series.seconds[used]
        self.bands: Bands = bands(self.seconds, *self.periods, series.interval)
        self.highest = highest_mode(series.values.shape[1], how.max_mode)
        self._weights = mode_weights(series.lengths[used], np.isfinite(self.values), self.highest)
        self.modes: ComplexArray = modes_of(self.values[:, :, None], self._weights)[:, :, 0]
        known = np.isfinite(self.values).any(axis=0)
        self._variance = float(np.nanvar(self.values[:, known], axis=0).mean())

    def power(self, movies: FloatArray) -> FloatArray:
        """Power (K, C, R) of movies (T, S, R)."""
        return wave_cells(modes_of(movies, self._weights), self.bands)

    def shares(self, power: FloatArray) -> FloatArray:
        """Share of the variance at the frequencies that are looked for; the taper shows each in several."""
        return np.asarray(power[: self.bands.visible] / (_OVERLAP * self._variance))

    def background(self, power: FloatArray) -> Background:
        """What explains a power (K, C, R) without a wave."""
        return background(power, self.bands.frequencies, edge_groups(self.highest))

    def scores(self, excess: FloatArray, usual: FloatArray) -> FloatArray:
        """Scores (visible, 3 M + 1, R) of an excess (K, C, R) over a background (K, C, R or 1)."""
        visible = self.bands.visible
        return wave_scores(usual[:visible], excess[:visible], edge_groups(self.highest))

    def null_scores(
        self, how: WaveSearchParameters, progress: Callable[[int, int], None] | None
    ) -> tuple[FloatArray, FloatArray]:
        """Largest score of each surrogate, (R,), and the shares of modes in its variance, (M + 1, R)."""
        found: list[float] = []
        shares = []
        usual = self.background(self.power(self.values[:, :, None])).usual
        for movies in WaveNull(self.series, self.bands, how.seed).draw(how.surrogates):
            power = self.power(movies)
            found.extend(self.scores(self.background(power).excess, usual).max(axis=(0, 1)))
            shares.append(mode_shares(self.shares(power)))
            if progress is not None:
                progress(len(found), how.surrogates)
        return np.array(found), np.concatenate(shares, axis=1)


def strongest_wave(
    series: EdgeSeries, how: WaveSearchParameters, progress: Callable[[int, int], None] | None = None
) -> WaveFound:
    """The wave with the largest score, and the scores of surrogates.

    Parameters
    ----------
    series : EdgeSeries
    how : WaveSearchParameters
    progress : callable, optional
        Called with (surrogates done, in all).

    Raises
    ------
    ParameterError
        As for `check_shown` and `check_around`.
    """
    search = WaveSearch(series, how)
    power = search.power(search.values[:, :, None])
    fitted = search.background(power)
    scores = search.scores(fitted.excess, fitted.usual)[:, :, 0]
    place, wave = np.unravel_index(int(scores.argmax()), scores.shape)
    mode = wave_mode(int(wave), search.highest)
    step = 1.0 / (search.seconds[-1] - search.seconds[0])
    within = (1.0 / search.periods[1], 1.0 / search.periods[0])
    frequency = refined_frequency(
        search.modes[:, mode], search.seconds, float(search.bands.frequencies[place]), step, within
    )
    null, chance = search.null_scores(how, progress)
    return WaveFound(
        mode=mode,
        frequency=frequency,
        score=float(scores.max()),
        null=null,
        spectrum=search.shares(power)[:, :, 0],
        frequencies=search.bands.frequencies[: search.bands.visible],
        chance=np.quantile(chance, 0.95, axis=1),
        modes=search.modes,
        seconds=search.seconds,
        periods=search.periods,
    )


def mode_shares(shares: FloatArray) -> FloatArray:
    """Shares (K, 2 M + 1, …) of waves summed over frequencies and directions: (M + 1, …)."""
    summed = shares.sum(axis=0)
    highest = (len(summed) - 1) // 2
    by_mode = summed[: highest + 1].copy()
    by_mode[1:] += summed[highest + 1 :]
    return np.asarray(by_mode)


def wave_mode(wave: int, highest: int) -> int:
    """Mode of a column of scores."""
    return wave if wave <= highest else (wave - highest - 1) % highest + 1

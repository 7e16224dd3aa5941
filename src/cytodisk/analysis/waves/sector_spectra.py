"""Spectra of sectors as surrogates have them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import fft
from scipy.ndimage import gaussian_filter1d

from cytodisk.analysis.correlation.prepared_series import interpolated
from cytodisk.arrays import FloatArray

_OWN_SHAPE = 3.0  # a sector's own spectrum over the mean one is smoothed by frames / this
_DEGREE = 3  # of the polynomial that is the broad mean spectrum, in logarithms
_USUAL = 0.9  # quantile of the scatter of surrogates that a spectrum must exceed
_FINE = 1.0  # bins of twice the duration by which the fine mean spectrum is smoothed


@dataclass(frozen=True, eq=False)
class SectorSpectra:
    """Power of series with their mirror images.

    Attributes
    ----------
    broad, fine : ndarray of shape (T + 1,) and dtype float
        Mean of all sectors, as a curve and with its peaks.
    own : ndarray of shape (T + 1, S) and dtype float
        Broad spectrum of each sector over the mean one: a single spectrum is so rough that neighbours would
        not come out as alike as they are.
    fine_share : float
        How much of the peaks, 0 to 1. Surrogates scatter about their spectrum by themselves, so they would
        scatter twice with peaks that are nothing but scatter.
    scale : float
        Of power.
    """

    broad: FloatArray
    fine: FloatArray
    own: FloatArray
    fine_share: float = 0.0
    scale: float = 1.0

    @classmethod
    def of(cls, series: FloatArray) -> SectorSpectra:
        """Spectra of series (T, S) on an even grid, NaN where they have no value."""
        filled = interpolated(series)
        filled = np.where(np.isfinite(filled), filled, 0.0)
        centred = filled - filled.mean(axis=0)
        power = np.abs(fft.rfft(np.concatenate([centred, centred[::-1]]), axis=0)) ** 2
        power[0] = power[1]
        own = gaussian_filter1d(power, len(series) / _OWN_SHAPE, axis=0, mode="nearest")
        mean = power.mean(axis=1) + np.finfo(np.float64).tiny
        return cls(
            _curve(mean),
            gaussian_filter1d(mean, _FINE, mode="nearest"),
            own / np.maximum(own.mean(axis=1), np.finfo(np.float64).tiny)[:, None],
        )

    @property
    def amplitude(self) -> FloatArray:
        """Amplitudes (T + 1, S)."""
        mean = self.broad ** (1.0 - self.fine_share) * self.fine**self.fine_share
        return np.asarray(np.sqrt(self.scale * mean[:, None] * self.own))

    def with_fine(self, share: float) -> SectorSpectra:
        """With a share of the peaks."""
        return replace(self, fine_share=share)

    def scaled(self, factor: float) -> SectorSpectra:
        """With another power."""
        return replace(self, scale=self.scale * factor)


def fine_share(sums: FloatArray, by_chance: FloatArray) -> float:
    """How much of the peaks of a spectrum are more than scatter.

    Parameters
    ----------
    sums : ndarray of shape (K,) and dtype float
        Power of all modes at each frequency.
    by_chance : ndarray of shape (K, R) and dtype float
        That of surrogates without peaks.
    """
    logs, chance = np.log(sums), np.log(by_chance)
    usual = chance.mean(axis=1)
    scatter = np.quantile((chance - usual[:, None]).var(axis=0), _USUAL)
    return float(np.sqrt(np.clip(1.0 - scatter / max((logs - usual).var(), 1e-12), 0.0, 1.0)))


def _curve(power: FloatArray) -> FloatArray:
    """Smooth curve through a spectrum (T + 1,): a polynomial in logarithms; octaves count alike."""
    number = np.arange(1, len(power))
    abscissa = np.log(number)
    fitted = np.polynomial.Polynomial.fit(abscissa, np.log(power[1:]), _DEGREE, w=number**-0.5)
    return np.asarray(np.exp(fitted(np.concatenate([abscissa[:1], abscissa]))))

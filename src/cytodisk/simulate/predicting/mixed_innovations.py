"""Innovations of which an earlier series says a stated part."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError

_FREQUENCIES = 4096
_LARGEST = 1e3  # weight of what leads over the own one: a partial correlation of 0.999


@dataclass(frozen=True)
class Mixing:
    """Weights of the own innovations and of the earlier ones of another series.

    Attributes
    ----------
    own : float
        Of the own innovation of this frame.
    leading : float
        Of each earlier one of the other series.
    lags : tuple of int
        By how many frames those are earlier.
    """

    own: float
    leading: float
    lags: tuple[int, ...]

    def __call__(self, own: FloatArray, leading: FloatArray, before: int) -> FloatArray:
        """Mixed innovations.

        Parameters
        ----------
        own, leading : ndarray of shape (T, ...) and dtype float
            Of the same frames.
        before : int
            Frames at the start that only lead, at least the largest lag.

        Returns
        -------
        ndarray of shape (T - before, ...) and dtype float
        """
        stop = len(own)
        earlier = sum(leading[before - lag : stop - lag] for lag in self.lags)
        return np.asarray(self.own * own[before:] + self.leading * earlier)


def mixing(strength: float, lags: Sequence[int], at_once: float, response: FloatArray) -> Mixing:
    """Weights for which the past of one series predicts another as well as asked for.

    Parameters
    ----------
    strength : float
        Partial correlation r, given the own past; above -1, below 1.
    lags : sequence of int
        At least 1 frame.
    at_once : float
        Correlation of both own innovations in the same frame.
    response : ndarray of shape (M,) and dtype float
        Impulse response of the series, for which the mixed one gets the variance of one that is not.

    Returns
    -------
    Mixing

    Notes
    -----
    With innovations u of the one and e of the other, the mixed ones are k (e + t Σ u at the lags). Their
    spectrum is k² |...|², and the variance of their error when they are predicted from their own past alone
    is the exponential of its logarithm's mean (Szegő and Kolmogorov). With u known, it is k². The logarithm
    of the ratio of the two, -ln(1 - r²), is solved for t (Geweke 1982, doi:10.1080/01621459.1982.10477803).
    """
    turn = 2.0 * np.pi * np.arange(_FREQUENCIES) / _FREQUENCIES
    lagged = np.exp(-1j * np.outer(np.asarray(lags), turn)).sum(axis=0) / np.sqrt(len(lags))

    def spectrum(weight: float) -> FloatArray:
        return np.asarray(np.abs(weight * lagged + at_once) ** 2 + 1.0 - at_once**2)

    gain = -np.log1p(-(strength**2))
    weight = 0.0
    if strength:
        sign = np.sign(strength)
        weight = sign * brentq(lambda size: np.log(spectrum(sign * size)).mean() - gain, 0.0, _LARGEST)
    power = np.abs(np.fft.fft(response, _FREQUENCIES)) ** 2
    own = float(np.sqrt(power.mean() / (power * spectrum(weight)).mean()))
    return Mixing(own, float(own * weight / np.sqrt(len(lags))), tuple(lags))


def check_told_apart(mix: Mixing) -> None:
    """Check that two series that each take this much of the other still have innovations of their own.

    Raises
    ------
    ParameterError
        The other's part is too large: there is no model in which each is its own past and the other's.
    """
    if abs(mix.leading) * len(mix.lags) >= mix.own:
        raise ParameterError(
            "strength is too large for series that predict each other both ways at lags "
            f"{', '.join(map(str, mix.lags))}: take a smaller one, or fewer lags"
        )

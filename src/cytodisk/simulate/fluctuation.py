"""Broad-band random motion of an edge, exact at every time and without memory of earlier ones."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cytodisk.arrays import FloatArray

_RELAXATION = 10.0  # frames over which the height forgets, beyond which its spectrum is flat
_SMOOTHNESS = 1.5  # frames over which the velocity is smooth
_HIGHEST = 3.0  # radians per frame; beyond it lies less than 1e-5 of the velocity's variance
_COSINES = 240  # so many that nothing comes back within a thousand frames
_OVERLAP = 0.6  # width of a push over the distance of neighbours
_DIRECTIONS = np.linspace(-np.pi, np.pi, 2049)


@dataclass(frozen=True, eq=False)
class Fluctuation:
    """Pushes around the edge whose heights are stationary random series, each a sum of many cosines.

    Attributes
    ----------
    angle : ndarray of shape (K,) and dtype float
        Directions of the pushes from the cell's heading, in radians.
    width : float
        Standard deviation of a push along the edge, in radians.
    height : ndarray of shape (K, M) and dtype float
        Height of each cosine, in pixels.
    frequency, phase : ndarray of shape (K, M) and dtype float
        In radians per frame, and in radians.

    Notes
    -----
    A sum of cosines of random phases is the spectral representation of a stationary Gaussian process
    (Shinozuka and Deodatis, 1991, doi:10.1115/1.3119501). It is exact at any time, forwards and backwards.
    """

    angle: FloatArray
    width: float
    height: FloatArray
    frequency: FloatArray
    phase: FloatArray

    def level(self, frame: float) -> FloatArray:
        """Height of each push at a time in frames, shape (K,)."""
        return np.asarray((self.height * np.cos(self.frequency * frame + self.phase)).sum(axis=1))

    def rate(self, frame: float) -> FloatArray:
        """Change of each height per frame, shape (K,)."""
        speed = self.height * self.frequency
        return np.asarray(-(speed * np.sin(self.frequency * frame + self.phase)).sum(axis=1))

    def __call__(self, angle: FloatArray, of_pushes: FloatArray) -> FloatArray:
        """Sum of the pushes around the edge.

        Parameters
        ----------
        angle : ndarray of shape (N,) and dtype float
            From the cell's heading, in radians from -π to π.
        of_pushes : ndarray of shape (K,) and dtype float
            Level or rate of each push.

        Returns
        -------
        ndarray of shape (N,) and dtype float
            Interpolated between 2048 directions. There the squares of what the pushes count for sum to 1,
            so every place of the edge fluctuates as much as a push alone.
        """
        return np.interp(angle, _DIRECTIONS, self._shares @ of_pushes)

    @cached_property
    def _shares(self) -> FloatArray:
        """What each push counts for in each direction, shape (2049, K)."""
        bump = np.exp((np.cos(_DIRECTIONS[:, None] - self.angle) - 1.0) / self.width**2)
        return np.asarray(bump / np.sqrt((bump**2).sum(axis=1, keepdims=True)))


NO_FLUCTUATION = Fluctuation(np.zeros(0), 1.0, *np.zeros((3, 0, 0)))


def random_fluctuation(random: np.random.Generator, angle: FloatArray, deviation: float) -> Fluctuation:
    """Independent pushes with one smooth spectrum, cut into bands with a random frequency in each.

    Parameters
    ----------
    random : Generator
    angle : ndarray of shape (K,) and dtype float
        Directions of the pushes, in radians.
    deviation : float
        Standard deviation of the heights through time, in pixels.

    Returns
    -------
    Fluctuation

    Notes
    -----
    The height has the spectrum of an Ornstein-Uhlenbeck process of relaxation time 10 frames, smoothed over
    1.5 frames. What cannot wander off must come back, so the velocity's autocorrelation sums to 0: it falls
    to 0 in 3 frames and its negative part is spread thin, never below -0.15.
    """
    count = len(angle)
    band = _HIGHEST / _COSINES
    frequency = band * (np.arange(_COSINES) + random.uniform(0.0, 1.0, (count, _COSINES)))
    power = np.exp(-0.5 * (frequency * _SMOOTHNESS) ** 2) / (frequency**2 + _RELAXATION**-2)
    power /= power.sum(axis=1, keepdims=True)
    return Fluctuation(
        angle=angle,
        width=_OVERLAP * 2.0 * np.pi / count,
        height=deviation * np.sqrt(2.0 * power),
        frequency=frequency,
        phase=random.uniform(-np.pi, np.pi, (count, _COSINES)),
    )

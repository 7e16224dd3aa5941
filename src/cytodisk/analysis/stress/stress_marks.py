"""Marks of what makes two sets of series correlate that have nothing to do with each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.correlation.pairing import named_series
from cytodisk.analysis.correlation.surrogates import filtered_noise
from cytodisk.analysis.stress.energy_scans import (
    PULSE_FRAMES,
    Episode,
    Pulse,
    Ramp,
    common_pulse,
    restless_episode,
    variance_ramp,
)
from cytodisk.analysis.stress.series_energy import capped_energy, kurtosis, without_slow_changes
from cytodisk.analysis.stress.spectral_line import SharedLine, shared_line
from cytodisk.arrays import FloatArray
from cytodisk.checks import whole_number

COMMON_PULSE, RESTLESS_EPISODE, VARIANCE_CHANGE = "common pulse", "restless episode", "variance change"
STEADY_OSCILLATION, HEAVY_TAILS = "steady oscillation", "heavy tails"

SMALLEST_PULSE = 7.0
"""Times that a share of joint energy must be of what three frames have in a steady movie."""
SHARPEST_EPISODE = 0.85
"""Share of a pulse's energy among nine frames above which it is not an episode."""
SMALLEST_EPISODE, SMALLEST_CHANGE = 2.0, 1.5
"""Ratios of variance that make so much of a difference that chance correlations are found too often."""
SMALLEST_PROMINENCE, SMALLEST_LINE = 5.0, 0.25
"""Of a spectral line: power over that beside it, and share of the variance."""
LARGEST_CHANCE = 0.01
"""Probability below which a peak is a line, and no chance peak of a band or of few independent series."""
HEAVIEST_NORMAL = 3.8
"""Kurtosis of both above which tails are heavy; 3 of a normal distribution."""

_SURROGATES = 99
_ALPHA = 0.01
_MOST_SERIES = 32  # of each side, evenly chosen: more say the same
_FEWEST_FRAMES = 20
_BEFORE_AND_AFTER = 2  # frames beside a pulse that belong to it


@dataclass(frozen=True)
class StressMarks:
    """What was found in two sets of series that lets independent ones correlate.

    Attributes
    ----------
    found : tuple of str
        Of "common pulse", "restless episode", "variance change", "steady oscillation" and "heavy tails".
    pulse_share : float
        Share of the joint energy, summed over frames, that lies in the three frames with most of it.
    pulse_frames : tuple of int
        These frames, those of `b` too where it is later or earlier.
    episode_ratio : float
        Variance within the most restless episode over that outside, the smaller one of both.
    episode_frames : tuple of int
        First and last frame of the episode.
    variance_ratio : float
        Variance of the second half over that of the first, of both the one nearer to 1; 1 if they go in
        opposite directions.
    line_share : float
        Share of the variance that lies in the most prominent spectral line of both, the smaller one.
    line_period : float
        In frames.
    kurtosis : float
        The smaller one of both; 3 of a normal distribution.
    """

    found: tuple[str, ...]
    pulse_share: float
    pulse_frames: tuple[int, ...]
    episode_ratio: float
    episode_frames: tuple[int, int]
    variance_ratio: float
    line_share: float
    line_period: float
    kurtosis: float


@dataclass(frozen=True)
class _Measured:
    """Scans and kurtosis of the series, first in each array, and of surrogates after it; a line."""

    frames: int
    pulse: Pulse
    episode: Episode
    ramp: Ramp
    line: SharedLine
    kurtosis: FloatArray


def stress_marks(a: Any, b: Any, max_lag: int, *, seed: int = 0) -> StressMarks | None:
    """Look for what makes series correlate that have nothing to do with each other.

    Parameters
    ----------
    a, b : DataArray or array_like with dims (time, …)
        As for `cross_correlate`, detrended if they are correlated so.
    max_lag : int
        In frames: how far a pulse of `a` may lie from that of `b`.
    seed : int
        Of the surrogates.

    Returns
    -------
    StressMarks or None
        None where there are fewer than 20 frames, or no series that varies.

    See Also
    --------
    cross_correlate : With `statistic` "spearman" it stands most of this.

    Notes
    -----
    Energy is the mean over windows of squares, each at most 9 robust variances, so that one outlier is no
    pulse. Energies are compared with those of 99 surrogates, which are Gaussian, stationary, and keep how
    windows hang together (`filtered_noise`); a mark must be beyond all of them. Movies with real signals have
    marks too: a cell that is restless for a while moves and signals more. A mark says that the p-values are
    too small, not that there is no correlation. `benchmarks/stress.py` prints how often marks are
    found in each case, and where there is nothing.

    Examples
    --------
    >>> import cytodisk as cd
    >>> signal, velocity = cd.simulate.independent_series("ar1", 0, 80, 2, 12)
    >>> pulse = 6.0 * signal["frame"].isin([40, 41, 42])
    >>> marks = cd.stress_marks(signal + pulse, velocity + pulse, 10)
    >>> marks.found, marks.pulse_frames
    (('common pulse',), (40, 41, 42))
    >>> cd.stress_marks(signal, velocity, 10).found
    ()
    """
    first, second, _ = named_series(a, b)
    max_lag, seed = whole_number("max_lag", max_lag, 0), whole_number("seed", seed, 0)
    numbers = _frame_numbers(a, first.sizes["time"])
    tables = [_some_series(series) for series in (first, second)]
    if not all(table.shape[1] for table in tables):
        return None
    return _marks(_measure(tables[0], tables[1], max_lag, seed), numbers)


def _frame_numbers(series: Any, frames: int) -> list[int]:
    """Numbers of the frames, from 0 where the series do not have them."""
    for name in ("frame", "time"):
        if isinstance(series, xr.DataArray) and name in series.coords:
            return [int(number) for number in series[name].to_numpy()]
    return list(range(frames))


def _some_series(series: xr.DataArray) -> FloatArray:
    """Up to 32 of the series that vary and have values in enough frames, shape (T, W)."""
    columns = series.transpose("time", ...).to_numpy().reshape(series.sizes["time"], -1)
    known = np.isfinite(columns)
    enough = known.sum(axis=0) >= max(_FEWEST_FRAMES, len(columns) // 2)
    columns = columns[:, enough]
    if columns.shape[1]:
        columns = columns[:, np.nanmax(columns, axis=0) > np.nanmin(columns, axis=0)]
    count = columns.shape[1]
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_SERIES)).round().astype(int))
    return np.asarray(columns[:, chosen])


def _measure(a: FloatArray, b: FloatArray, max_lag: int, seed: int) -> _Measured:
    frames = len(a)
    max_lag = min(max_lag, frames // 4)
    line = shared_line(a, b)
    quick = [without_slow_changes(series) for series in (a, b)]
    random = np.random.default_rng([seed, 0])
    beside = [_with_surrogates(series, random) for series in quick]
    energies = [capped_energy(series) for series in beside]
    pulse = common_pulse(energies[0], energies[1], max_lag)
    if _beyond(pulse.share) and pulse.sharpness[0] >= SHARPEST_EPISODE:
        starts = int(pulse.first[0]), int(pulse.first[0] + pulse.lag[0])
        for energy, start in zip(energies, starts, strict=True):
            _smooth_over(energy, start)
    episode, ramp = restless_episode(*energies), variance_ramp(*energies)
    tails = np.minimum(*(kurtosis(series) for series in beside))
    return _Measured(frames, pulse, episode, ramp, line, tails)


def _with_surrogates(series: FloatArray, random: np.random.Generator) -> FloatArray:
    """Series (T, W) and behind them their surrogates, shape (T, W, 1 + R)."""
    noise = np.fft.rfft(random.normal(size=(2 * len(series), _SURROGATES)), axis=0)
    return np.stack(
        [np.concatenate([one[:, None], filtered_noise(one, noise)], axis=1) for one in series.T], axis=1
    )


def _smooth_over(energy: FloatArray, start: int) -> None:
    """Give the frames of a pulse, of the series and not of the surrogates, the energy of any frame."""
    around = slice(max(0, start - _BEFORE_AND_AFTER), start + PULSE_FRAMES + _BEFORE_AND_AFTER)
    energy[around, 0] = np.median(energy[:, 0])


def _beyond(values: FloatArray) -> bool:
    """Whether the first of values is larger than nearly all others."""
    return bool((1 + (values[1:] >= values[0]).sum()) <= _ALPHA * len(values))


def _marks(measured: _Measured, numbers: list[int]) -> StressMarks:
    pulse, episode, ramp, line = measured.pulse, measured.episode, measured.ramp, measured.line
    start, lag = int(pulse.first[0]), int(pulse.lag[0])
    runs = {first + k for first in (start, start + lag) for k in range(PULSE_FRAMES)}
    first, length = int(episode.first[0]), max(int(episode.frames[0]), 1)
    return StressMarks(
        tuple(_found(measured)),
        float(pulse.share[0]),
        tuple(numbers[k] for k in sorted(runs)),
        float(episode.ratio[0]),
        (numbers[first], numbers[first + length - 1]),
        float(ramp.ratio[0]),
        line.share,
        line.period,
        float(measured.kurtosis[0]),
    )


def _found(measured: _Measured) -> list[str]:
    pulse, episode, ramp, line = measured.pulse, measured.episode, measured.ramp, measured.line
    found = []
    concentrated = pulse.share[0] * measured.frames / PULSE_FRAMES >= SMALLEST_PULSE
    if concentrated and pulse.sharpness[0] >= SHARPEST_EPISODE and _beyond(pulse.share):
        found.append(COMMON_PULSE)
    ratio = float(ramp.ratio[0])
    changes = max(ratio, 1.0 / ratio) >= SMALLEST_CHANGE and _beyond(ramp.gain)
    restless = episode.ratio[0] >= SMALLEST_EPISODE and _beyond(episode.gain)
    if restless and (not changes or episode.gain[0] > ramp.gain[0]):
        found.append(RESTLESS_EPISODE)
    elif changes:
        found.append(VARIANCE_CHANGE)
    stands_out = line.prominence >= SMALLEST_PROMINENCE and line.share >= SMALLEST_LINE
    if stands_out and line.p <= LARGEST_CHANCE:
        found.append(STEADY_OSCILLATION)
    if not found and measured.kurtosis[0] >= HEAVIEST_NORMAL and _beyond(measured.kurtosis):
        found.append(HEAVY_TAILS)
    return found

"""Pairs of series whose past predicts each other as well as asked for, measured well or badly."""

from typing import Any, Literal, get_args

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.checks import one_of
from cytodisk.errors import ParameterError
from cytodisk.simulate.null_series import (
    MEMORY,
    OSCILLATION_PERIOD,
    check_sizes,
    edge_noise,
    impulse_response,
    through_time,
    window_noise,
)
from cytodisk.simulate.predicting.mixed_innovations import check_told_apart, mixing
from cytodisk.simulate.predicting.predicting_parameters import PredictingParameters
from cytodisk.simulate.waves.wave_phases import running_phase
from cytodisk.taking import takes

PredictingKind = Literal["white", "ar1", "slow", "smooth", "oscillating", "waves"]
PREDICTING_KINDS: tuple[PredictingKind, ...] = get_args(PredictingKind)

_MODES, _PERIODS = (1, 2, 3), (0.85, 1.15)  # of waves: those drawn from; times the one of oscillations
_WAVE_SHARE, _WAVE_PERSISTENCE = 0.5, 50.0  # of the variance; frames
_SOURCE, _TARGET, _DRIVER = 20, 21, 22  # streams of random numbers


@takes(PredictingParameters)
def predicting_series(
    kind: PredictingKind, seed: int, frames: int, layers: int, sectors: int, **settings: Any
) -> xr.Dataset:
    """Two series of which one predicts the other, each the other, or neither, and their driver.

    Parameters
    ----------
    kind : str
        One of `PREDICTING_KINDS`, how series go on through time: those of `independent_series`, or "waves",
        white noise on a wave that runs around the cell. Waves are half of the variance, have a period of 8.5
        to 11.5 frames, forget their phase over 50, and know nothing of each other: mode, period, direction
        and phase of each series are drawn.
    seed : int
        At least 0; the same arguments give the same series.
    frames, layers, sectors : int
        At least 1; `frames` counts those that are kept.
    **settings
        See `PredictingParameters`.

    Returns
    -------
    Dataset
        "source" (time, layer, sector), "target" (time, sector), or with layers where `layered`, and "driver"
        with the target's dims where there is one. Without NaN, of mean 0, and of variance 1 before noise and
        jitter. The attrs are `kind`, `seed`, all settings, and the truth:

        - gain, gain_back: ln of the variance of the target's (source's) error when it is predicted from its
          own past over that with the source's (target's) past too, with the driver given where there is one;
          -ln(1 - strength²), or 0. NaN where noise, jitter, coarse frames or waves leave no simple answer.

    Raises
    ------
    ParameterError
        An unknown kind, a number out of its range, or a `strength` that is too large for "both ways".

    See Also
    --------
    independent_series : Series that have nothing to do with each other.
    coupled_series : Series of one correlation at one lag.
    wave_series : Waves alone.

    Notes
    -----
    Each series is white noise, its innovations, under the impulse response of its kind. The innovations of
    what is predicted are the sum of own ones and of the other's at `lags`. So for "white", "ar1", "slow" and
    "oscillating" one-way pairs are exactly a vector autoregression, whose target has the source's past of as
    many frames as the largest lag and the kind's own order together. Neighbours' past, which is correlated
    with the source's, can take a little of the gain.

    Examples
    --------
    >>> import cytodisk as cd
    >>> pair = cd.simulate.predicting_series("ar1", 0, frames=50, layers=2, sectors=6, strength=0.5)
    >>> pair.source.dims, pair.target.dims, round(pair.attrs["gain"], 3), pair.attrs["gain_back"]
    (('time', 'layer', 'sector'), ('time', 'sector'), 0.288, 0.0)
    >>> driven = cd.simulate.predicting_series("white", 0, 50, 2, 6, coupling="common driver", layered=True)
    >>> sorted(driven.data_vars), driven.driver.dims
    (['driver', 'source', 'target'], ('time', 'layer', 'sector'))
    """
    how = PredictingParameters.of(**settings)
    kind = one_of("kind", kind, PREDICTING_KINDS)
    check_sizes(seed, frames, layers, sectors)
    if how.layer >= layers:
        raise ParameterError(f"layer must be below the {layers} layers, got {how.layer}")
    made = _innovations(kind, seed, (frames, layers, sectors), how)
    streams = {"source": _SOURCE, "target": _TARGET, "driver": _DRIVER}
    series = {name: _series(kind, [seed, streams[name]], noise) for name, noise in made.items()}
    kept = {name: values[:: how.every] for name, values in series.items()}
    measured = _measured(kept, seed, how)
    return _dataset(measured, {"kind": kind, "seed": seed} | _truth(kind, how))


def _innovations(
    kind: PredictingKind, seed: int, size: tuple[int, int, int], how: PredictingParameters
) -> dict[str, FloatArray]:
    """White noise that makes each series, with what the others say of it."""
    frames, layers, sectors = size
    before = max(how.lags) + 1
    count = (frames - 1) * how.every + MEMORY + before
    own, drives = (np.random.default_rng([seed, stream, 0]) for stream in (_TARGET, _DRIVER))
    source = window_noise(
        np.random.default_rng([seed, _SOURCE, 0]), count, (layers, sectors), how.correlation_length
    )

    def like_target(random: np.random.Generator) -> FloatArray:
        if how.layered:
            return window_noise(random, count, (layers, sectors), how.correlation_length)
        return edge_noise(random, count, sectors, how.correlation_length)

    layer = slice(None) if how.layered else how.layer
    coupled = source[:, layer].copy()
    target = how.at_once * coupled + np.sqrt(1.0 - how.at_once**2) * like_target(own)
    response = impulse_response("white" if kind == "waves" else kind)
    mix = mixing(how.strength, how.lags, how.at_once, response)
    made = {"source": source[before:], "target": target[before:]}
    if how.coupling in ("one way", "both ways"):
        made["target"] = mix(target, coupled, before)
    if how.coupling == "both ways":
        check_told_apart(mix)
        made["source"][:, layer] = mix(coupled, target, before)
    if how.coupling == "common driver":
        driver = like_target(drives)
        made["driver"] = driver[before:]
        first = mixing(how.strength, [min(how.lags)], 0.0, response)
        later = mixing(how.strength, [lag + 1 for lag in how.lags], 0.0, response)
        made["source"][:, layer] = first(coupled, driver, before)
        made["target"] = later(target, driver, before)
    return made


def _series(kind: PredictingKind, seed: list[int], noise: FloatArray) -> FloatArray:
    if kind != "waves":
        return through_time(kind, noise)
    series = through_time("white", noise)
    random = np.random.default_rng([*seed, 1])
    mode, sign = random.choice(_MODES), random.choice([-1.0, 1.0])
    step = 2.0 * np.pi / (OSCILLATION_PERIOD * random.uniform(*_PERIODS))
    phase = running_phase(random, step, _WAVE_PERSISTENCE, np.full(len(series), sign))
    around = 2.0 * np.pi * mode * np.arange(series.shape[-1]) / series.shape[-1]
    wave = np.sqrt(2.0) * np.cos(around - phase.reshape(-1, *[1] * (series.ndim - 1)))
    return np.asarray(np.sqrt(_WAVE_SHARE) * wave + np.sqrt(1.0 - _WAVE_SHARE) * series)


def _measured(series: dict[str, FloatArray], seed: int, how: PredictingParameters) -> dict[str, FloatArray]:
    """What masks that jitter and a camera make of source and target."""
    source, target = series["source"], series["target"]
    frames, _, sectors = source.shape
    jitter = edge_noise(np.random.default_rng([seed, 23]), frames + 1, sectors, how.correlation_length)
    step = np.diff(jitter, axis=0) / np.sqrt(2.0)
    source = source - how.jitter_seen * jitter[:-1, None]
    source = source + how.source_noise * np.random.default_rng([seed, 24]).normal(size=source.shape)
    target = target + how.jitter * (step[:, None] if how.layered else step)
    target = target + how.target_noise * np.random.default_rng([seed, 25]).normal(size=target.shape)
    return series | {"source": source, "target": target}


def _truth(kind: PredictingKind, how: PredictingParameters) -> dict[str, Any]:
    """Settings as attrs, with the gains."""
    gain = -float(np.log1p(-(how.strength**2)))
    told = how.coupling in ("one way", "both ways")
    gains = [gain if told else 0.0, gain if how.coupling == "both ways" else 0.0]
    of_coupled = told and how.strength != 0.0
    noisy = how.source_noise or how.target_noise or how.jitter or how.every > 1 or kind == "waves"
    if (how.jitter and how.jitter_seen) or (noisy and (of_coupled or how.coupling == "common driver")):
        gains = [np.nan, np.nan]
    settings = {name: int(value) if isinstance(value, bool) else value for name, value in how}
    return settings | {"gain": gains[0], "gain_back": gains[1]}


def _dataset(series: dict[str, FloatArray], truth: dict[str, Any]) -> xr.Dataset:
    frames, layers, sectors = (np.arange(size) for size in series["source"].shape)
    dims = {2: ("time", "sector"), 3: ("time", "layer", "sector")}
    variables = {name: (dims[values.ndim], values) for name, values in series.items()}
    coords = {"frame": ("time", frames), "layer": layers, "sector": sectors}
    return xr.Dataset(variables, coords, truth).set_xindex("frame")

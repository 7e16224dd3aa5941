"""Waves around a cell and through its inside as series of windows, without a cell or an image."""

from typing import Any, Literal, get_args

import numpy as np
import xarray as xr
from scipy.signal import lfilter

from cytodisk.arrays import ComplexArray, FloatArray
from cytodisk.checks import one_of
from cytodisk.errors import ParameterError
from cytodisk.simulate.null_series import check_sizes, window_noise
from cytodisk.simulate.waves.wave_parameters import WaveSeriesParameters
from cytodisk.simulate.waves.wave_phases import directions, running_phase, wandering
from cytodisk.taking import takes

WaveKind = Literal["running", "standing", "spiral", "inward", "outward", "none"]
WAVE_KINDS: tuple[WaveKind, ...] = get_args(WaveKind)

_WITH_MODES = ("running", "standing", "spiral")
_INWARDS = {"spiral": 1.0, "inward": 1.0, "outward": -1.0}
_BURN_IN = 20.0  # memories of the noise before the first frame


@takes(WaveSeriesParameters)
def wave_series(
    kind: WaveKind, seed: int, frames: int, sectors: int, layers: int | None = None, **settings: Any
) -> xr.DataArray:
    """A wave with known speed, period and direction in noise, or noise with its spectrum alone.

    Parameters
    ----------
    kind : str
        One of `WAVE_KINDS`. "running": crests run around the cell, in all layers at once. "standing": crests
        rise and fall where they are. "spiral": crests run around and inwards. "inward" and "outward": crests
        are rings. "none": each window goes up and down with the wave's spectrum and a phase of its own, like
        its neighbours over `correlation_length`; no crest goes on from place to place.
    seed : int
        At least 0; the same arguments give the same series.
    frames, sectors : int
        At least 1.
    layers : int, optional
        Without it there is the edge alone, which "spiral", "inward" and "outward" refuse.
    **settings
        See `WaveSeriesParameters`.

    Returns
    -------
    DataArray with dims (time, sector) or (time, layer, sector)
        Named "signal". The coordinates of time are `frame`, `time_s`, `direction` (1, -1, or 0 where nothing
        runs around) and `phase`: how far the wave has run, in radians (not for "none"). Layers have
        `depth_um` of their middles. The truth is in its attrs:

        - kind, mode, period_s, amplitude, edge_length_um, frame_interval_s as they are;
        - speed, in turns/s, and speed_um_s: of a crest around the cell in its own frame, positive towards
          higher sectors, before the first reversal; 0 where nothing runs around;
        - direction: 1, -1 or 0;
        - inward_speed_um_s: positive inwards, 0 where nothing runs inwards;
        - noise: standard deviation of the noise over the wave's; noise_memory;
        - persistence_s (infinite where the phase is kept), reversals, and drift, by which crests are
          faster on the slide.

    Raises
    ------
    ParameterError
        An unknown kind, a number out of its range, as many waves as half the sectors, as many reversals as
        frames, a kind that needs layers without them, or "running" or "spiral" with mode 0.

    See Also
    --------
    predicting_series : Pairs of series, of which one predicts the other.
    movie : A moving cell.

    Notes
    -----
    The phase of a crest is mode x angle + 2π x depth / wavelength - 2π x time / period. So crests run around
    by 1 / (mode x period) turns per second, and inwards by wavelength / period.

    Examples
    --------
    >>> import cytodisk as cd
    >>> wave = cd.simulate.wave_series("running", 0, frames=60, sectors=36, mode=2, period_s=50.0)
    >>> wave.dims, wave.attrs["speed"], wave.attrs["speed_um_s"]
    (('time', 'sector'), 0.01, 1.0)
    >>> cd.simulate.wave_series("spiral", 0, 60, 36, 4, wavelength_um=8.0).attrs["inward_speed_um_s"]
    0.08
    """
    how = WaveSeriesParameters.of(**settings)
    kind = one_of("kind", kind, WAVE_KINDS)
    check_sizes(seed, frames, 1 if layers is None else layers, sectors)
    mode = how.mode if kind in _WITH_MODES else 0
    _check_kind(kind, sectors, layers, mode)
    if how.reversals >= frames:
        raise ParameterError(f"reversals must be below the {frames} frames, got {how.reversals}")
    shape = (layers or 1, sectors)
    turning = kind in ("running", "spiral")
    direction = directions(np.random.default_rng([seed, 0]), frames, how.direction, how.reversals)
    time_s = how.frame_interval_s * np.arange(float(frames))
    runs = direction if turning else np.abs(direction)
    phase = running_phase(np.random.default_rng([seed, 1]), _step(how), _persistence(how), runs)
    pattern = how.amplitude * _pattern(kind, seed, phase, shape, how.changed(mode=mode))
    pattern = turned(pattern, how.drift * time_s)
    values = pattern + how.noise * how.amplitude * _deviation(kind, mode) * _noise(seed, frames, shape, how)
    of_time: dict[str, Any] = {"frame": ("time", np.arange(frames)), "time_s": ("time", time_s)}
    of_time["direction"] = ("time", direction if turning else np.zeros(frames))
    if kind != "none":
        of_time["phase"] = ("time", phase)
    truth = _truth(kind, seed, mode, how)
    if layers is None:
        of_edge = of_time | {"sector": np.arange(sectors)}
        return xr.DataArray(values[:, 0], of_edge, ("time", "sector"), "signal", truth)
    depth = how.layer_depth_um * (np.arange(layers) + 0.5)
    coords = of_time | {
        "layer": np.arange(layers),
        "depth_um": ("layer", depth),
        "sector": np.arange(sectors),
    }
    return xr.DataArray(values, coords, ("time", "layer", "sector"), "signal", truth)


def _check_kind(kind: WaveKind, sectors: int, layers: int | None, mode: int) -> None:
    if layers is None and kind in _INWARDS:
        raise ParameterError(f"kind {kind!r} runs through layers: pass layers")
    if kind in ("running", "spiral") and mode == 0:
        raise ParameterError(f'kind {kind!r} needs a mode of at least 1, got 0: take "standing" or "inward"')
    if mode and 2 * mode >= sectors:
        raise ParameterError(
            f"mode must be below half of the {sectors} sectors, got {mode}: take fewer waves or more sectors"
        )


def _step(how: WaveSeriesParameters) -> float:
    return 2.0 * np.pi * how.frame_interval_s / how.period_s


def _persistence(how: WaveSeriesParameters) -> float:
    """In frames."""
    return np.inf if how.persistence_s is None else how.persistence_s / how.frame_interval_s


def _pattern(
    kind: WaveKind, seed: int, phase: FloatArray, shape: tuple[int, int], how: WaveSeriesParameters
) -> FloatArray:
    """The wave without noise, of amplitude 1, in the cell's frame; shape (T, L, S)."""
    layers, sectors = shape
    if kind == "none":
        return wandering(_own_phases(seed, len(phase), shape, how), _step(how), _persistence(how)).real
    depth = how.layer_depth_um * (np.arange(layers) + 0.5)
    around = how.mode * 2.0 * np.pi * np.arange(sectors) / sectors
    inwards = _INWARDS.get(kind, 0.0) * 2.0 * np.pi * depth / how.wavelength_um
    time = phase[:, None, None]
    if kind == "standing":
        start = np.random.default_rng([seed, 2]).uniform(-np.pi, np.pi) if how.mode else 0.0
        return np.broadcast_to(np.cos(around + start) * np.cos(time), (len(phase), *shape))
    return np.asarray(np.cos(around + inwards[:, None] - time))


def _own_phases(seed: int, frames: int, shape: tuple[int, int], how: WaveSeriesParameters) -> ComplexArray:
    """Complex noise of variance 1, white in time, correlated along the edge and inwards."""
    parts = [
        window_noise(np.random.default_rng([seed, stream]), frames, shape, how.correlation_length)
        for stream in (3, 4)
    ]
    return np.asarray((parts[0] + 1j * parts[1]) / np.sqrt(2.0))


def _deviation(kind: WaveKind, mode: int) -> float:
    """Standard deviation of a wave of amplitude 1, over time and places."""
    return 0.5 if kind == "standing" and mode else float(np.sqrt(0.5))


def _noise(seed: int, frames: int, shape: tuple[int, int], how: WaveSeriesParameters) -> FloatArray:
    """Noise of variance 1, stationary from the first frame on."""
    before = int(np.ceil(_BURN_IN / (1.0 - how.noise_memory))) if how.noise_memory else 0
    white = window_noise(np.random.default_rng([seed, 5]), frames + before, shape, how.correlation_length)
    kept = lfilter([np.sqrt(1.0 - how.noise_memory**2)], [1.0, -how.noise_memory], white, axis=0)
    return np.asarray(kept[before:])


def turned(values: FloatArray, turns: FloatArray) -> FloatArray:
    """Series of windows around a cell that turns on the slide.

    Parameters
    ----------
    values : ndarray of shape (T, ..., S) and dtype float
        By sector of the cell.
    turns : ndarray of shape (T,) and dtype float
        How far the cell has turned towards higher sectors.

    Returns
    -------
    ndarray of shape (T, ..., S) and dtype float
        By sector of the slide, between sectors by their Fourier modes.
    """
    if not turns.any():
        return values
    modes = np.fft.rfft(values, axis=-1)
    by_time = turns.reshape(-1, *[1] * (values.ndim - 1))
    back = np.exp(-2j * np.pi * np.arange(modes.shape[-1]) * by_time)
    return np.asarray(np.fft.irfft(modes * back, n=values.shape[-1], axis=-1))


def _truth(kind: WaveKind, seed: int, mode: int, how: WaveSeriesParameters) -> dict[str, Any]:
    direction = how.direction if kind in ("running", "spiral") else 0
    speed = direction / (mode * how.period_s) if direction else 0.0
    shared = ("period_s", "frame_interval_s", "edge_length_um", "amplitude", "noise", "noise_memory")
    return {
        "kind": kind,
        "seed": seed,
        "mode": mode,
        "direction": direction,
        "speed": speed,
        "speed_um_s": speed * how.edge_length_um,
        "inward_speed_um_s": _INWARDS.get(kind, 0.0) * how.wavelength_um / how.period_s,
        "persistence_s": _persistence(how) * how.frame_interval_s,
        "reversals": how.reversals,
        "drift": how.drift,
    } | {name: getattr(how, name) for name in shared}

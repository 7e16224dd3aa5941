"""Activity and edge velocity as random series with known correlations, without a cell or an image."""

from typing import Any, Literal, get_args

import numpy as np
import xarray as xr
from scipy.signal import lfilter, oaconvolve

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import one_of, whole_number
from cytodisk.errors import ParameterError
from cytodisk.simulate.series_parameters import CouplingParameters, NeighbourParameters
from cytodisk.simulate.stress_series import STRESS_KINDS, StressKind, stressed
from cytodisk.taking import takes

SeriesKind = Literal["white", "ar1", "slow", "smooth", "oscillating"]
SERIES_KINDS: tuple[SeriesKind, ...] = get_args(SeriesKind)

MEMORY = 400  # frames; less than 1e-8 of "slow" is left after them
_SMOOTH_DEVIATION = 2.0  # frames
OSCILLATION_PERIOD = 10.0  # frames
_OSCILLATION_DAMPING = 0.9
_REACH = 4.0  # correlation lengths beyond which noise counts for nothing


@takes(NeighbourParameters)
def independent_series(
    kind: SeriesKind | StressKind, seed: int, frames: int, layers: int, sectors: int, **settings: Any
) -> tuple[xr.DataArray, xr.DataArray]:
    """Activity and velocity that have nothing to do with each other: every correlation found is false.

    Parameters
    ----------
    kind : str
        One of `SERIES_KINDS`, correlation through time: "white", none; "ar1" and "slow", autoregressive of
        first order with 0.8, or with 0.95, from a frame to the next; "smooth", noise under a Gaussian of
        standard deviation 2 frames; "oscillating", autoregressive of second order with a peak of its spectrum
        at a period of 10 frames. Or one of `STRESS_KINDS`, white noise with what fools a correlation, at the
        same frames in all windows and in the velocity: "pulse", 3 frames 4.5 standard deviations higher;
        "restless", three times the standard deviation in a tenth of the frames; "rising", a standard
        deviation that rises linearly to four times the first; "steady", oscillations of period 10 frames
        that never lose their phase, half of the variance; "heavy tails", Student's t with 2.5 degrees of
        freedom.
    seed : int
        At least 0; the same arguments give the same series.
    frames, layers, sectors : int
        At least 1.
    **settings
        See `NeighbourParameters`.

    Returns
    -------
    activity : DataArray with dims (time, layer, sector)
    velocity : DataArray with dims (time, sector)
        Without NaN: the last frame has a velocity too, which a measured one has not. Those of `SERIES_KINDS`
        are Gaussian and stationary from the first frame to the last, of mean 0 and variance 1.

    Raises
    ------
    ParameterError
        An unknown kind or a number out of its range.

    See Also
    --------
    coupled_series : Series that do hang together.
    predicting_series : Series that predict each other.
    wave_series : Waves along the edge.

    Notes
    -----
    Each series is a moving average of white noise with the impulse response of its kind, 400 frames long. So
    it is stationary without a burn-in, and its autocorrelation is that of the response.

    Examples
    --------
    >>> import cytodisk as cd
    >>> activity, velocity = cd.simulate.independent_series("ar1", 0, frames=50, layers=2, sectors=6)
    >>> activity.shape, velocity.shape
    ((50, 2, 6), (50, 6))
    >>> activity, velocity = cd.simulate.independent_series("pulse", 0, frames=50, layers=2, sectors=6)
    >>> bool(velocity.mean("sector").max() > 3.0)  # the pulse
    True
    """
    length = NeighbourParameters.of(**settings).correlation_length
    kind = one_of("kind", kind, SERIES_KINDS + STRESS_KINDS)
    check_sizes(seed, frames, layers, sectors)
    of_time = kind if kind in SERIES_KINDS else "white"
    velocity = _velocity(of_time, seed, frames, sectors, length)
    activity = _activity(of_time, seed, frames, (layers, sectors), length)
    if kind in STRESS_KINDS:
        activity, velocity = stressed(kind, seed, (activity, velocity))
    return _labelled(activity, velocity)


@takes(CouplingParameters)
def coupled_series(
    kind: SeriesKind,
    seed: int,
    frames: int,
    layers: int,
    sectors: int,
    *,
    lag_frames: int,
    windows: BoolArray,
    **settings: Any,
) -> tuple[xr.DataArray, xr.DataArray]:
    """Activity that follows the velocity of its sector in given windows, and only there.

    In those windows the activity at t is `strength` times the velocity at t - `lag_frames` plus independent
    noise, so that it keeps variance 1 and the correlation at that lag is `strength`. All other windows have
    the activity that `independent_series` gives them.

    Parameters
    ----------
    kind, seed, frames, layers, sectors
        See `independent_series`.
    lag_frames : int
        By how many frames activity follows velocity, at least -`frames`; negative: leads it.
    windows : array_like of shape (layers, sectors) and dtype bool
        Where.
    **settings
        See `CouplingParameters`.

    Returns
    -------
    activity : DataArray with dims (time, layer, sector)
    velocity : DataArray with dims (time, sector)

    Raises
    ------
    ParameterError
        An unknown kind, a number out of its range, or windows of another shape.

    See Also
    --------
    independent_series : Series that have nothing to do with each other.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = [[True] * 6, [False] * 6]  # the outer layer follows the edge
    >>> activity, velocity = cd.simulate.coupled_series("ar1", 0, 50, 2, 6, lag_frames=3, windows=windows)
    >>> activity.shape, velocity.shape
    ((50, 2, 6), (50, 6))
    """
    how = CouplingParameters.of(**settings)
    one_of("kind", kind, SERIES_KINDS)
    check_sizes(seed, frames, layers, sectors)
    lag_frames = whole_number("lag_frames", lag_frames, -frames)
    coupled = np.asarray(windows)
    if coupled.dtype != bool or coupled.shape != (layers, sectors):
        raise ParameterError(
            f"windows must be bool of shape ({layers}, {sectors}), got {coupled.dtype} of shape "
            f"{coupled.shape}: pass True for each window that follows the velocity"
        )
    around = abs(lag_frames)
    run = _velocity(kind, seed, frames + around, sectors, how.correlation_length)
    velocity = run[max(lag_frames, 0) :][:frames]
    followed = run[max(-lag_frames, 0) :][:frames, None, :]
    noise = _activity(kind, seed, frames, (layers, sectors), how.correlation_length)
    mixed = how.strength * followed + np.sqrt(1.0 - how.strength**2) * noise
    return _labelled(np.where(coupled, mixed, noise), velocity)


def check_sizes(seed: int, frames: int, layers: int, sectors: int) -> None:
    """Check what all simulated series are asked for.

    Raises
    ------
    ParameterError
        The seed is negative, or there is no frame, layer or sector.
    """
    whole_number("seed", seed, 0)
    for name, value in (("frames", frames), ("layers", layers), ("sectors", sectors)):
        whole_number(name, value, 1)


def _velocity(kind: SeriesKind, seed: int, frames: int, sectors: int, length: float) -> FloatArray:
    noise = edge_noise(np.random.default_rng([seed, 0]), frames + MEMORY - 1, sectors, length)
    return through_time(kind, noise)


def _activity(kind: SeriesKind, seed: int, frames: int, shape: tuple[int, int], length: float) -> FloatArray:
    noise = window_noise(np.random.default_rng([seed, 1]), frames + MEMORY - 1, shape, length)
    return through_time(kind, noise)


def edge_noise(random: np.random.Generator, frames: int, sectors: int, length: float) -> FloatArray:
    """Noise of variance 1, white in time, correlated over a length around the edge; shape (T, S)."""
    return np.asarray(random.normal(size=(frames, sectors)) @ ring_weights(sectors, length).T)


def window_noise(
    random: np.random.Generator, frames: int, shape: tuple[int, int], length: float
) -> FloatArray:
    """Noise of variance 1, white in time, correlated over a length around and inwards; shape (T, L, S)."""
    inwards, along = depth_weights(shape[0], length), ring_weights(shape[1], length)
    noise = random.normal(size=(frames, inwards.shape[1], shape[1]))
    return np.asarray(inwards @ noise @ along.T)


def through_time(kind: SeriesKind, noise: FloatArray) -> FloatArray:
    """Series of a kind from white noise that starts `MEMORY` - 1 frames earlier, of the noise's variance."""
    response = impulse_response(kind).reshape(-1, *[1] * (noise.ndim - 1))
    return np.asarray(oaconvolve(noise, response, mode="valid", axes=0))


def impulse_response(kind: SeriesKind) -> FloatArray:
    """Weights of the noise of this frame and the earlier ones, the sum of their squares 1."""
    impulse = np.eye(1, MEMORY)[0]
    turn = 2.0 * np.pi / OSCILLATION_PERIOD
    feedback = {
        "white": [1.0],
        "ar1": [1.0, -0.8],
        "slow": [1.0, -0.95],
        "oscillating": [1.0, -2.0 * _OSCILLATION_DAMPING * np.cos(turn), _OSCILLATION_DAMPING**2],
    }
    if kind == "smooth":
        time = np.arange(MEMORY) - 0.5 * MEMORY
        response = np.exp(-0.5 * (time / _SMOOTH_DEVIATION) ** 2)
    else:
        response = np.asarray(lfilter([1.0], feedback[kind], impulse))
    return np.asarray(response / np.linalg.norm(response))


def ring_weights(count: int, length: float) -> FloatArray:
    """Matrix (count, count) that correlates independent noise around a ring and keeps its variance."""
    apart = np.arange(float(count))[:, None] - np.arange(count)
    turns = np.arange(-1, 2 + int(_REACH * length / count)) * count
    turns = np.union1d(turns, -turns)
    return _unit_rows(_bell(apart[..., None] + turns, length).sum(axis=-1))


def depth_weights(count: int, length: float) -> FloatArray:
    """Matrix (count, M) that correlates independent noise along a line that goes on beyond both ends."""
    beyond = int(np.ceil(_REACH * length))
    apart = np.arange(float(count))[:, None] - np.arange(-beyond, count + beyond)
    return _unit_rows(_bell(apart, length))


def _bell(apart: FloatArray, length: float) -> FloatArray:
    """Weights whose correlation with themselves falls to exp(-1/2) over a length."""
    if not length:
        return np.where(apart == 0.0, 1.0, 0.0)
    return np.asarray(np.exp(-((apart / length) ** 2)))


def _unit_rows(weights: FloatArray) -> FloatArray:
    return np.asarray(weights / np.linalg.norm(weights, axis=1, keepdims=True))


def _labelled(activity: FloatArray, velocity: FloatArray) -> tuple[xr.DataArray, xr.DataArray]:
    dims = ("time", "layer", "sector")
    frames, layers, sectors = (np.arange(size) for size in activity.shape)
    of_edge = {"frame": ("time", frames), "sector": sectors}
    series = xr.DataArray(activity, of_edge | {"layer": layers}, dims, name="activity")
    edge = xr.DataArray(velocity, of_edge, ("time", "sector"), name="velocity", attrs={"units": "px/frame"})
    return series.set_xindex("frame"), edge.set_xindex("frame")

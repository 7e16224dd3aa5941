"""Waves on the whole disk: around the cell, inwards, outwards, or both at once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.time_steps import has_times
from cytodisk.analysis.waves.depth_modes import DepthWaves, depth_cells
from cytodisk.analysis.waves.depth_surrogates import DepthNull
from cytodisk.analysis.waves.depth_travel import DepthTravel, depth_travel
from cytodisk.analysis.waves.disk_series import DiskSeries, disk_series
from cytodisk.analysis.waves.edge_modes import sector_angles
from cytodisk.analysis.waves.edge_series import check_shown, named_values, numbers_along
from cytodisk.analysis.waves.edge_waves import ROTATING, SIGNIFICANT
from cytodisk.analysis.waves.mode_spectrum import Bands, bands, refined_frequency
from cytodisk.analysis.waves.wave_background import background, wave_scores
from cytodisk.analysis.waves.wave_order import null_orders, order_score, p_value
from cytodisk.analysis.waves.wave_phase import (
    demodulated,
    mode_field,
    pair_amplitudes,
    persistence,
    travel_direction,
)
from cytodisk.analysis.waves.wave_surrogates import frame_slots
from cytodisk.analysis.waves.waves_parameters import WaveSearchParameters
from cytodisk.arrays import ComplexArray, FloatArray
from cytodisk.taking import takes

RUNS_IN_DEPTH = 0.4  # least |direction| in depth: about a quarter of a wave from the first layer to the last


@dataclass(frozen=True, eq=False)
class DiskWave:
    """The strongest wave on a disk.

    Attributes
    ----------
    mode : int
        Waves around the cell.
    frequency : float
        In 1/s.
    score : float
    null : ndarray of shape (R,) and dtype float
    pairs : ndarray of shape (T, 2, L) and dtype complex
        Amplitudes towards higher and lower sectors, by layer.
    seconds : ndarray of shape (T,) and dtype float
    travel : DepthTravel
    periods : tuple of float
        Shortest and longest that can be seen, in seconds.
    """

    mode: int
    frequency: float
    score: float
    null: FloatArray
    pairs: ComplexArray
    seconds: FloatArray
    travel: DepthTravel
    periods: tuple[float, float]

    @property
    def direction(self) -> float:
        """Around the cell, from −1 to 1."""
        return travel_direction(np.concatenate(list(self.pairs.transpose(2, 0, 1)))) if self.mode else 0.0

    @property
    def p(self) -> float:
        """Of all waves together."""
        return p_value(self.score, self.null)


@takes(WaveSearchParameters)
def disk_waves(
    values: Any,
    frame_interval_s: float | None = None,
    edge_length_um: Any = None,
    depth_um: Any = None,
    *,
    progress: Callable[[int, int], None] | None = None,
    **settings: Any,
) -> xr.Dataset:
    """The strongest wave on the whole disk: does it run inwards, outwards, around, or both, and how fast?

    Parameters
    ----------
    values : DataArray or array_like with dims (time, layer, sector)
        A signal in windows, layers from the edge inwards; NaN where there is none.
    frame_interval_s : float, optional
        Seconds between frames; not needed where `values` has the coordinate time_s, which may be uneven.
    edge_length_um : float or array_like, optional
        As for `edge_waves`.
    depth_um : array_like, optional
        Depth of windows below the edge in µm, by layer, (layer, sector), (time, layer) or (time, layer,
        sector), of which the means by layer count. Without it the coordinate depth_um of `values`.
    progress : callable, optional
        Called with (surrogates done, in all).
    **settings
        See `WaveSearchParameters`.

    Returns
    -------
    Dataset
        mode, period_s, speed, speed_um_s, direction, persistence_s, order, p as `edge_waves` has them, for
        all layers together; inward_speed_um_s, positive inwards (NaN where depths are not known);
        inward_direction, from −1, all runs outwards, to 1, all runs inwards, near 0 for what stands or is at
        all depths at once; kind: "inwards", "outwards", "around", "spiral" (around, and inwards or outwards),
        "standing" or "none" (p above 0.05).

        By layer: layer_inward_speed_um_s, from the phase of neighbouring layers; layer_lag_s, by which the
        wave is later than in the first layer; layer_direction and layer_speed, around the cell; layer_power,
        the variance of the wave in that layer over that in all; depth_um. By time, layer and sector: phase
        and amplitude of the window's own values, wave_phase and wave_amplitude of the mode that was found. By
        surrogate: order_null.

    Raises
    ------
    ParameterError
        As for `edge_waves`, or depths do not increase from layer to layer.

    See Also
    --------
    edge_waves : In one layer.

    Notes
    -----
    Layers without any value are left out, and attrs say so. A wave that needs less than a quarter of its
    length from the first layer to the last counts as being at all depths at once.

    Examples
    --------
    >>> import cytodisk as cd
    >>> wave = cd.simulate.wave_series("inward", 0, 30, 8, 4, period_s=60.0, wavelength_um=6.0)
    >>> found = cd.disk_waves(wave, surrogates=19)
    >>> found["kind"].item(), round(found["inward_speed_um_s"].item(), 2)
    ('inwards', 0.1)
    """
    how = WaveSearchParameters.of(**settings)
    named = named_values(values, ("time", "layer", "sector"))
    series = disk_series(named, frame_interval_s, edge_length_um, depth_um)
    found = _strongest(series, how, progress)
    return _dataset(named, series, found).assign_attrs(
        how.model_dump()
        | {
            "shortest_period_s": found.periods[0],
            "longest_period_s": found.periods[1],
            "frames_used": int(series.used.sum()),
            "layers_without_values": np.delete(numbers_along(named, "layer"), series.numbers).tolist(),
        }
    )


def disk_wave_kind(mode: int, direction: float, inward_direction: float, p: float) -> str:
    """What a biologist would call it."""
    if p > SIGNIFICANT:
        return "none"
    around = mode > 0 and abs(direction) >= ROTATING
    if abs(inward_direction) < RUNS_IN_DEPTH:
        return "around" if around else "standing"
    if around:
        return "spiral"
    return "inwards" if inward_direction > 0 else "outwards"


def _strongest(
    series: DiskSeries, how: WaveSearchParameters, progress: Callable[[int, int], None] | None
) -> DiskWave:
    whole = series.whole()
    periods = check_shown(whole, how)
    used = series.used
    seconds = whole.seconds[used]
    found = bands(seconds, *periods, whole.interval)
    modes = series.modes(how.max_mode)
    waves = DepthWaves.of(modes.shape[1] - 1, modes.shape[2])
    groups = waves.groups()

    fitted = background(depth_cells(modes[..., None], found), found.frequencies, groups)

    def scores(excess: FloatArray) -> FloatArray:
        return wave_scores(fitted.usual[: found.visible], excess[: found.visible], groups)

    own = scores(fitted.excess)[:, :, 0]
    place, column = np.unravel_index(int(own.argmax()), own.shape)
    several = [cells for cells in groups if len(cells) > 1]
    count = len(waves.around)
    mode = int(waves.around[column if column < count else several[column - count][0]])
    step = 1.0 / (seconds[-1] - seconds[0])
    within = (1.0 / periods[1], 1.0 / periods[0])
    frequency = refined_frequency(modes[:, mode], seconds, float(found.frequencies[place]), step, within)

    def largest(drawn: ComplexArray) -> FloatArray:
        excess = background(depth_cells(drawn, found), found.frequencies, groups).excess
        return np.asarray(scores(excess).max(axis=(0, 1)))

    null = _null(series, modes, found, largest, how, progress)
    pairs = np.stack([pair_amplitudes(layer, seconds, frequency) for layer in modes[:, mode].T], axis=2)
    travel = depth_travel(pairs[:, 0], pairs[:, 1] if mode else None, series.depth)
    return DiskWave(mode, frequency, float(own.max()), null, pairs, seconds, travel, periods)


def _null(
    series: DiskSeries,
    modes: ComplexArray,
    found: Bands,
    score: Callable[[ComplexArray], FloatArray],
    how: WaveSearchParameters,
    progress: Callable[[int, int], None] | None,
) -> FloatArray:
    """Largest score of each surrogate."""
    whole, used = series.whole(), series.used
    slots = frame_slots(whole)[used]
    values = np.stack([layer.values[used] for layer in series.layers], axis=2)
    scores: list[float] = []
    null = DepthNull(modes, values, slots - slots[0], whole.interval, found, how.seed)
    for drawn in null.draw(how.surrogates):
        scores.extend(score(drawn))
        if progress is not None:
            progress(len(scores), how.surrogates)
    return np.array(scores)


def _dataset(named: xr.DataArray, series: DiskSeries, found: DiskWave) -> xr.Dataset:
    travel, direction = found.travel, found.direction
    turning = 2.0 * np.pi * found.frequency
    edge_um = series.layers[0].edge_um
    length = float(np.nanmean(edge_um)) if np.isfinite(edge_um).any() else np.nan
    speed = float(np.copysign(found.frequency / found.mode, direction)) if found.mode else np.nan
    to_um = 1.0 if series.is_um else np.nan
    inward = to_um * turning / travel.wave_number if travel.wave_number else np.nan
    flat = found.pairs.reshape(len(found.pairs), -1)
    scalars: dict[str, tuple[Any, str]] = {
        "mode": (found.mode, "1"),
        "period_s": (1.0 / found.frequency, "s"),
        "speed": (speed, "1/s"),
        "speed_um_s": (speed * length, "µm/s"),
        "direction": (direction, "1"),
        "inward_speed_um_s": (inward, "µm/s"),
        "inward_direction": (travel.direction, "1"),
        "kind": (disk_wave_kind(found.mode, direction, travel.direction, found.p), "1"),
        "persistence_s": (persistence(flat, found.seconds, series.layers[0].interval), "s"),
        "order": (order_score(found.score, found.null), "1"),
        "p": (found.p, "1"),
    }
    data: dict[str, Any] = {name: ((), value, {"units": unit}) for name, (value, unit) in scalars.items()}
    data |= _by_layer(named.sizes["layer"], series, found)
    field = np.stack(
        [demodulated(layer.values, layer.seconds, found.frequency) for layer in series.layers], axis=1
    )
    unit = named.attrs.get("units", "a.u.")
    for prefix, one in (("", field), ("wave_", _wave(series, found))):
        everywhere = np.full(named.shape, np.nan + 0j)
        everywhere[:, series.numbers] = one
        data[f"{prefix}phase"] = (named.dims, np.angle(everywhere), {"units": "rad"})
        data[f"{prefix}amplitude"] = (named.dims, np.abs(everywhere), {"units": unit})
    data["order_null"] = ("surrogate", null_orders(found.null), {"units": "1"})
    coords: dict[str, Any] = {"time_s": ("time", series.layers[0].seconds, {"units": "s"})}
    coords |= {name: (name, numbers_along(named, name)) for name in ("layer", "sector")}
    coords |= {name: named[name].variable for name in ("time", "frame") if has_times(named, name)}
    return xr.Dataset(data, coords)


def _wave(series: DiskSeries, found: DiskWave) -> ComplexArray:
    """The wave of the mode that was found, (T, L, S)."""
    used, layers = series.used, []
    for layer, pair in zip(series.layers, found.pairs.transpose(2, 0, 1), strict=True):
        wave = np.full(layer.values.shape, np.nan + 0j)
        angles = sector_angles(layer.lengths[used])
        wave[used] = mode_field(pair, found.seconds, found.frequency, found.mode, angles)
        layers.append(wave)
    return np.stack(layers, axis=1)


def _by_layer(count: int, series: DiskSeries, found: DiskWave) -> dict[str, Any]:
    turning = 2.0 * np.pi * found.frequency
    power = (np.abs(found.pairs) ** 2).sum(axis=(0, 1))
    directions = np.array([travel_direction(pair) for pair in found.pairs.transpose(2, 0, 1)])
    turns = found.frequency / found.mode if found.mode else np.nan
    columns = {
        "layer_inward_speed_um_s": (turning / found.travel.slope * (1.0 if series.is_um else np.nan), "µm/s"),
        "layer_lag_s": (found.travel.lag / turning, "s"),
        "layer_direction": (directions if found.mode else np.zeros_like(directions), "1"),
        "layer_speed": (np.copysign(turns, directions), "1/s"),
        "layer_power": (power / power.sum() if power.sum() else power, "1"),
        "depth_um": (series.depth if series.is_um else np.full(len(series.depth), np.nan), "µm"),
    }
    data: dict[str, Any] = {}
    for name, (values, unit) in columns.items():
        whole = np.full(count, np.nan)
        whole[series.numbers] = values
        data[name] = ("layer", whole, {"units": unit})
    return data

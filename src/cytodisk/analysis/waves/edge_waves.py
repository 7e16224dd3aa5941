"""Waves around the cell: mode, period, speed, direction, how long they last, what chance would give."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.time_steps import has_times
from cytodisk.analysis.waves.edge_modes import sector_angles
from cytodisk.analysis.waves.edge_series import (
    EdgeSeries,
    frame_times,
    named_values,
    numbers_along,
    sector_lengths,
)
from cytodisk.analysis.waves.wave_order import null_orders, order_score, p_value
from cytodisk.analysis.waves.wave_phase import (
    demodulated,
    mode_field,
    pair_amplitudes,
    persistence,
    travel_direction,
)
from cytodisk.analysis.waves.wave_search import WaveFound, mode_shares, strongest_wave
from cytodisk.analysis.waves.waves_parameters import WaveSearchParameters
from cytodisk.taking import takes

SIGNIFICANT = 0.05
ROTATING = 0.5  # least |direction| of a wave that runs: three quarters of its power run one way


@takes(WaveSearchParameters)
def edge_waves(
    values: Any,
    frame_interval_s: float | None = None,
    edge_length_um: Any = None,
    *,
    progress: Callable[[int, int], None] | None = None,
    **settings: Any,
) -> xr.Dataset:
    """The strongest wave around a cell: does it run, how fast, how long, and would chance give it?

    Parameters
    ----------
    values : DataArray or array_like with dims (time, sector)
        Edge velocity, or a signal in one layer; NaN where there is none. Sectors go once around the cell.
    frame_interval_s : float, optional
        Seconds between frames; not needed where `values` has the coordinate time_s, which may be uneven.
    edge_length_um : float or array_like, optional
        Length of the edge in µm: a number, one by time, or the length of each sector by (time, sector). With
        the last, sectors need not be equally long.
    progress : callable, optional
        Called with (surrogates done, in all).
    **settings
        See `WaveSearchParameters`.

    Returns
    -------
    Dataset
        mode, waves around the cell: with 0 the whole edge changes together; period_s; speed, in turns around
        the cell per second, positive towards higher sectors (NaN at mode 0); speed_um_s; direction, from −1
        to 1: all power runs towards lower or towards higher sectors, 0 stands; kind, "rotating", "standing",
        "oscillating" (mode 0) or "none" (p above 0.05); persistence_s, how long phase and direction keep, at
        most the movie; order, the score of order, a normal quantile: 0 ± 1 without waves; p.

        By time and sector: phase, of the wave's period in radians, 0 at a crest, and amplitude, both of the
        sector's own values; wave_phase and wave_amplitude, of the mode that was found. By `around`, the
        number of waves: power, the share of the variance that each mode has at the periods that can be seen,
        and power_threshold, which 95 % of the surrogates stay below. By frequency and `travelling`, the
        number of waves, below 0 for those that run towards lower sectors: spectrum, their share. By
        surrogate: order_null. The attrs are the settings, and shortest_period_s and longest_period_s.

    Raises
    ------
    ParameterError
        The movie is too short to show a period, constant or empty, its seconds are not known, or an argument
        does not fit.

    See Also
    --------
    disk_waves : Waves on the whole disk.

    Notes
    -----
    Speed, direction and period are those of the strongest wave whatever its p. A standing wave is two that
    run against each other; `speed` is then that of the stronger.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> time, sector = np.arange(60)[:, None], np.arange(24)
    >>> wave = np.cos(2 * np.pi * (sector / 24 - time / 20)) + np.random.default_rng(0).normal(size=(60, 24))
    >>> found = cd.edge_waves(wave, frame_interval_s=2.0, edge_length_um=80.0)
    >>> found["kind"].item(), found["mode"].item(), round(found["speed_um_s"].item(), 1)
    ('rotating', 1, 2.0)
    """
    how = WaveSearchParameters.of(**settings)
    named = named_values(values, ("time", "sector"))
    seconds = frame_times(named, frame_interval_s)
    lengths, edge_um = sector_lengths(edge_length_um, named.shape)
    series = EdgeSeries(named.to_numpy().astype(np.float64), seconds, lengths, edge_um)
    start = _first_sector(series)
    found = strongest_wave(series.from_sector(start), how, progress)
    return _dataset(named, series, found, start).assign_attrs(_attrs(named, series, found, how))


def wave_kind(mode: int, direction: float, p: float) -> str:
    """What a biologist would call it."""
    if p > SIGNIFICANT:
        return "none"
    if mode == 0:
        return "oscillating"
    return "rotating" if abs(direction) >= ROTATING else "standing"


def _first_sector(series: EdgeSeries) -> int:
    """The sector that varies most. Surrogates start there: where sector 0 is does not matter."""
    known = np.isfinite(series.values)
    count = np.maximum(known.sum(axis=0), 1)
    filled = np.where(known, series.values, 0.0)
    mean = filled.sum(axis=0) / count
    return int(np.argmax(((filled - mean * known) ** 2).sum(axis=0) / count))


def _dataset(named: xr.DataArray, series: EdgeSeries, found: WaveFound, start: int) -> xr.Dataset:
    pair = pair_amplitudes(found.modes[:, found.mode], found.seconds, found.frequency)
    direction = travel_direction(pair) if found.mode else 0.0
    p = p_value(found.score, found.null)
    speed = float(np.copysign(found.frequency / found.mode, direction)) if found.mode else np.nan
    edge_um = np.isfinite(series.edge_um)
    length = float(series.edge_um[edge_um].mean()) if edge_um.any() else np.nan
    field = demodulated(series.values, series.seconds, found.frequency)
    scalars: dict[str, tuple[Any, str]] = {
        "mode": (found.mode, "1"),
        "period_s": (1.0 / found.frequency, "s"),
        "speed": (speed, "1/s"),
        "speed_um_s": (speed * length, "µm/s"),
        "direction": (direction, "1"),
        "kind": (wave_kind(found.mode, direction, p), "1"),
        "persistence_s": (persistence(pair, found.seconds, series.interval), "s"),
        "order": (order_score(found.score, found.null), "1"),
        "p": (p, "1"),
    }
    data: dict[str, Any] = {name: ((), value, {"units": unit}) for name, (value, unit) in scalars.items()}
    data["power"] = ("around", mode_shares(found.spectrum), {"units": "1"})
    data["power_threshold"] = ("around", found.chance, {"units": "1"})
    highest = len(found.chance) - 1
    signed = np.concatenate([found.spectrum[:, :highest:-1], found.spectrum[:, : highest + 1]], axis=1)
    data["spectrum"] = (("frequency", "travelling"), signed, {"units": "1"})
    data["phase"] = (("time", "sector"), np.angle(field), {"units": "rad"})
    data["amplitude"] = (("time", "sector"), np.abs(field), {"units": named.attrs.get("units", "a.u.")})
    angles = np.roll(sector_angles(series.from_sector(start).lengths), start, axis=1)
    wave = np.full(field.shape, np.nan + 0j)
    wave[series.used] = mode_field(pair, found.seconds, found.frequency, found.mode, angles[series.used])
    data["wave_phase"] = (("time", "sector"), np.angle(wave), {"units": "rad"})
    data["wave_amplitude"] = (("time", "sector"), np.abs(wave), data["amplitude"][2])
    data["order_null"] = ("surrogate", null_orders(found.null), {"units": "1"})
    coords: dict[str, Any] = {
        "time_s": ("time", series.seconds, {"units": "s"}),
        "around": ("around", np.arange(highest + 1), {"units": "1"}),
        "travelling": ("travelling", np.arange(-highest, highest + 1), {"units": "1"}),
        "frequency": ("frequency", found.frequencies, {"units": "1/s"}),
        "sector": numbers_along(named, "sector"),
    }
    coords |= {name: named[name].variable for name in ("time", "frame") if has_times(named, name)}
    return xr.Dataset(data, coords)


def _attrs(
    named: xr.DataArray, series: EdgeSeries, found: WaveFound, how: WaveSearchParameters
) -> dict[str, Any]:
    known = np.isfinite(series.values).any(axis=0)
    return how.model_dump() | {
        "shortest_period_s": found.periods[0],
        "longest_period_s": found.periods[1],
        "frames_used": int(series.used.sum()),
        "sectors_without_values": numbers_along(named, "sector")[~known].tolist(),
    }

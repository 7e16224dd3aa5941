"""Events of protrusion and retraction of a cell's edge."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
import pandas as pd
import xarray as xr
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cytodisk.analysis.edge_area import area_by_step
from cytodisk.analysis.time_steps import frame_numbers, frame_seconds
from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.checks import number_between, whole_number
from cytodisk.errors import ParameterError

Kind: TypeAlias = Literal["protrusion", "retraction"]
KINDS: tuple[Kind, ...] = ("protrusion", "retraction")

_NOISES = 2.0  # the default threshold in standard deviations of the noise
_MAD_TO_SD = 1.4826  # of a normal distribution
_SECOND_DIFFERENCE = np.sqrt(6.0)  # its standard deviation over that of independent noise: 1 + 4 + 1


def edge_events(
    velocity: xr.DataArray,
    *,
    threshold: float | None = None,
    min_frames: int = 2,
    edge_length: xr.DataArray | None = None,
    protruded_area: xr.DataArray | None = None,
    retracted_area: xr.DataArray | None = None,
) -> pd.DataFrame:
    """Protrusion and retraction events: runs of frames in which a sector of the edge moves one way.

    An event is a longest run of frames whose velocity has one sign, of at least `min_frames`, whose
    fastest frame is faster than `threshold`. Velocity 0 belongs to none; NaN breaks an event.

    Parameters
    ----------
    velocity : DataArray with dims time and sector
        As of `edge_velocity`, or `study.activity(cell)["velocity"]`: protrusion positive, stored at t for
        the step from t to t + 1, its unit in attrs `units`; seconds in the coordinate time_s, if known.
    threshold : float, optional
        Least speed of an event's fastest frame, in the unit of the velocity. By default twice the noise,
        see `velocity_noise`.
    min_frames : int
        Steps of the shortest event.
    edge_length : DataArray with dims time and sector, optional
        Length of the sectors' edge, for the area: velocity × time × length.
    protruded_area, retracted_area : DataArray with dims time and sector, optional
        Area won and lost in each step, as of `edge_changes`; they are better than `edge_length`, which is
        then not used, as they count pixels.

    Returns
    -------
    DataFrame
        One row for each event, by onset and sector. The columns are sector; kind, "protrusion" or
        "retraction"; onset, the frame in which it starts to move, end, the frame in which it has come to rest
        or turned, and peak, the frame of the fastest step (its steps are onset … end - 1); onset_s, end_s and
        peak_s in seconds, NaN when unknown; duration, in seconds or frames; peak_velocity and mean_velocity,
        negative in a retraction; area, won positive, lost negative, NaN when nothing is passed for it;
        onset_known and end_known, False at the ends of the movie and beside NaN; complete, both known;
        patch, a number for connected events of one kind in neighbouring sectors that move in the same step.
        attrs hold `units` by column, threshold, noise, min_frames and the number of sectors.

    Raises
    ------
    ParameterError
        The velocity is not by time and sector, has no unit or skips frames; another array does not fit it;
        a number is out of its range; or the noise cannot be told from so few frames.

    See Also
    --------
    average_around : The signal around the events.
    edge_velocity : Measures the velocity.

    Notes
    -----
    Sectors that are numbered 0 … S - 1 are a whole edge, the last beside the first. In a selection of
    others, those are neighbours whose numbers are.

    References
    ----------
    Machacek and Danuser, "Morphodynamic profiling of protrusion phenotypes", 2006,
    doi:10.1529/biophysj.105.070383, for edge velocity as a map whose patches are events.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> import cytodisk as cd
    >>> velocity = np.zeros((8, 4))
    >>> velocity[2:5, 1] = 1.0  # sector 1 goes out for three steps
    >>> velocity = xr.DataArray(velocity, dims=("time", "sector"), attrs={"units": "px/frame"})
    >>> events = cd.edge_events(velocity, threshold=0.5)
    >>> events[["sector", "kind", "onset", "end"]]
       sector        kind  onset  end
    0       1  protrusion      2    5
    """
    values = _parse(velocity)
    min_frames = whole_number("min_frames", min_frames, 1)
    areas = area_by_step(velocity, edge_length, protruded_area, retracted_area)
    noise = velocity_noise(velocity)
    limit = _threshold(threshold, noise, values)
    runs = _runs(values, areas.values)
    runs = runs.take((runs.frames >= min_frames) & (np.abs(runs.peak_velocity) > limit))
    runs = runs.take(np.lexsort((runs.sector, runs.first)))
    patches = _patches(runs, values.shape, _neighbours(velocity))
    events = _table(runs, patches, velocity)
    events.attrs = {
        "units": _units(velocity, areas.unit, events),
        "threshold": limit,
        "noise": noise,
        "min_frames": int(min_frames),
        "sectors": values.shape[1],
    }
    return events


def velocity_noise(velocity: xr.DataArray) -> float:
    """Standard deviation of the noise of a velocity, from its second differences in time.

    Motion that goes on for several frames cancels in v(t - 1) - 2 v(t) + v(t + 1); noise that is new in
    every frame does not: the standard deviation of these differences, by their median size, is √6 times
    that of the noise. Where the noise is that of the positions of the edge, each of which counts in two
    velocities with opposite signs, the estimate is 29 % too high; motion that turns within
    two frames counts as noise as well.

    Parameters
    ----------
    velocity : DataArray with dims time and sector

    Returns
    -------
    float
        In the unit of the velocity; NaN when no sector has three velocities in a row.

    Raises
    ------
    ParameterError
        The velocity is not by time and sector, or has no unit.
    """
    values = _parse(velocity)
    bends = np.abs(values[:-2] - 2.0 * values[1:-1] + values[2:])
    known = bends[np.isfinite(bends)]
    return float(_MAD_TO_SD / _SECOND_DIFFERENCE * np.median(known)) if known.size else np.nan


@dataclass(frozen=True, eq=False)
class _Runs:
    """Longest runs of one sign, each array with a number a run; stop is the place behind the last."""

    sector: IntArray
    first: IntArray
    stop: IntArray
    peak: IntArray
    peak_velocity: FloatArray
    mean_velocity: FloatArray
    area: FloatArray
    onset_known: BoolArray
    end_known: BoolArray

    @property
    def frames(self) -> IntArray:
        return self.stop - self.first

    def take(self, which: BoolArray | IntArray) -> _Runs:
        return _Runs(**{name: values[which] for name, values in vars(self).items()})


def _parse(velocity: Any) -> FloatArray:
    if not isinstance(velocity, xr.DataArray) or set(velocity.dims) != {"time", "sector"}:
        came = velocity.dims if isinstance(velocity, xr.DataArray) else type(velocity).__name__
        raise ParameterError(
            f"velocity must be a DataArray with dims time and sector, got {came}: pass that of edge_velocity"
        )
    if not velocity.size:
        raise ParameterError(f"velocity is empty: it has the sizes {dict(velocity.sizes)}")
    if not velocity.attrs.get("units"):
        raise ParameterError(
            "velocity.attrs has no 'units': set it, as in velocity.assign_attrs(units='µm/s'); "
            "arithmetic may have dropped it"
        )
    if velocity.dtype.kind not in "iuf" or np.isinf(velocity).any():
        raise ParameterError("velocity must hold finite numbers, or NaN where the edge is not known")
    return np.asarray(velocity.transpose("time", "sector").to_numpy(), dtype=np.float64)


def _threshold(threshold: Any, noise: float, values: FloatArray) -> float:
    if threshold is None:
        if np.isnan(noise) and np.isfinite(values).any():
            raise ParameterError(
                "threshold cannot be told from this velocity, in which no sector has three frames in a row: "
                "pass a number"
            )
        return _NOISES * noise
    return number_between("threshold", threshold, 0.0)


def _runs(values: FloatArray, areas: FloatArray) -> _Runs:
    sign = np.nan_to_num(np.sign(values)).T
    known = np.pad(np.isfinite(values).T, ((0, 0), (1, 1)))
    changes = np.diff(np.pad(sign, ((0, 0), (1, 1)))) != 0
    sector, first = np.nonzero(changes[:, :-1] & (sign != 0))
    stop = np.nonzero(changes[:, 1:] & (sign != 0))[1] + 1
    moving = sign.ravel() != 0
    run = np.repeat(np.arange(len(first)), stop - first)
    velocity, area = values.T.ravel()[moving], areas.T.ravel()[moving]
    fastest = np.lexsort((-np.abs(velocity), run))[np.cumsum(stop - first) - (stop - first)]
    return _Runs(
        sector,
        first,
        stop,
        np.tile(np.arange(len(values)), values.shape[1])[moving][fastest],
        velocity[fastest],
        np.bincount(run, velocity, len(first)) / (stop - first),
        np.bincount(run, area, len(first)).astype(np.float64),
        known[sector, first],
        known[sector, stop + 1],
    )


def _sector_numbers(velocity: xr.DataArray) -> IntArray:
    if "sector" in velocity.coords:
        return np.asarray(velocity["sector"].to_numpy(), dtype=np.int64)
    return np.arange(velocity.sizes["sector"])


def _neighbours(velocity: xr.DataArray) -> tuple[IntArray, IntArray]:
    """Pairs of neighbouring sectors, by place."""
    numbers, count = _sector_numbers(velocity), velocity.sizes["sector"]
    left = np.flatnonzero(np.diff(numbers) == 1)
    right = left + 1
    if np.array_equal(numbers, np.arange(count)):
        left, right = np.append(left, count - 1), np.append(right, 0)
    return left, right


def _patches(runs: _Runs, shape: tuple[int, ...], neighbours: tuple[IntArray, IntArray]) -> IntArray:
    """Number of each run's patch, from 0 in the order of the runs."""
    count = len(runs.first)
    owner = np.full(shape, -1)
    for number in range(count):
        owner[runs.first[number] : runs.stop[number], runs.sector[number]] = number
    one, other = (owner[:, places].ravel() for places in neighbours)
    both = (one >= 0) & (other >= 0)
    one, other = one[both], other[both]
    alike = np.sign(runs.peak_velocity)[one] == np.sign(runs.peak_velocity)[other]
    one, other = one[alike], other[alike]
    touching = coo_array((np.ones(len(one)), (one, other)), shape=(count, count))
    found = connected_components(touching, directed=False)[1] if count else np.empty(0)
    # Components are numbered as they are come upon, which is the order of their first runs.
    return np.asarray(found, dtype=np.int64)


def _table(runs: _Runs, patches: IntArray, velocity: xr.DataArray) -> pd.DataFrame:
    start, seconds = frame_numbers(velocity, "velocity"), frame_seconds(velocity)
    frames = np.append(start, start[-1:] + 1)
    timed = bool(np.isfinite(seconds).all())
    span = seconds if timed else frames.astype(np.float64)
    sectors = _sector_numbers(velocity)
    return pd.DataFrame(
        {
            "sector": sectors[runs.sector],
            "kind": pd.Series(np.where(runs.peak_velocity < 0, KINDS[1], KINDS[0]), dtype=str),
            "onset": frames[runs.first],
            "end": frames[runs.stop],
            "peak": frames[runs.peak],
            "onset_s": seconds[runs.first],
            "end_s": seconds[runs.stop],
            "peak_s": seconds[runs.peak],
            "duration": span[runs.stop] - span[runs.first],
            "peak_velocity": runs.peak_velocity,
            "mean_velocity": runs.mean_velocity,
            "area": runs.area,
            "onset_known": runs.onset_known,
            "end_known": runs.end_known,
            "complete": runs.onset_known & runs.end_known,
            "patch": patches,
        }
    )


def _units(velocity: xr.DataArray, area_unit: str, events: pd.DataFrame) -> dict[str, str]:
    timed = bool(np.isfinite(frame_seconds(velocity)).all())
    units = dict.fromkeys(events.columns, "")
    units |= dict.fromkeys(("onset", "end", "peak"), "frame")
    units |= dict.fromkeys(("onset_s", "end_s", "peak_s"), "s")
    units |= dict.fromkeys(("peak_velocity", "mean_velocity"), str(velocity.attrs["units"]))
    return units | {"duration": "s" if timed else "frame", "area": area_unit}

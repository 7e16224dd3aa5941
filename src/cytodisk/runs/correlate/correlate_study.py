"""Correlate signals of a movie's study with the motion of the edge, or with each other, cell by cell."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.analysis.correlation.correlation_parameters import PairCorrelationParameters
from cytodisk.analysis.correlation.cross_correlation import correlation_by_layer, cross_correlate
from cytodisk.analysis.correlation.jitter_mark import JITTERED_DIFFERENCES, JITTERED_LAGS, jitter_step
from cytodisk.analysis.pairs.pair_correlation import correlate_pairs
from cytodisk.analysis.pairs.window_distances import window_distances
from cytodisk.arrays import IntArray
from cytodisk.errors import ParameterError, StationarityWarning, StudyError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.correlate.chosen_series import chosen_sectors, chosen_series
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.correlate.correlation_tables import as_table, merged, of_cell, tables_of
from cytodisk.runs.correlate.event_tables import event_tables
from cytodisk.runs.versions import installed
from cytodisk.store.correlation_store import Correlation, write_correlation
from cytodisk.store.study import Study
from cytodisk.windows.polar_windows import polar_windows

_LONGEST_LAG = 20  # frames, unless the user asks for more
_LEAST_LAG_FOR_JITTER, _LAG_FOR_JITTER = 6, 10
_SIDES = (("signal", "a"), ("with", "b"))
_PAIRED_SURROGATES = 99  # of the mean over pairs at most, which take longer than those of windows

Progress = Callable[[int, int], None]


def correlate_study(
    study: Study,
    signal: str,
    with_: str = "velocity",
    *,
    cells: list[int] | None = None,
    progress: Progress | None = None,
    parameters: CorrelateParameters | None = None,
    **settings: Any,
) -> Correlation:
    """Correlate a signal with edge velocity or another signal in all cells of a study, and write the tables.

    Parameters
    ----------
    study : Study
        Study of a movie.
    signal : str
        A channel of its tables.
    with_ : str
        "velocity", "velocity_cell_frame" or a channel. At a positive lag it follows `signal`.
    cells : list of int, optional
        All by default. A cell that cannot be correlated has a row in the table of cells that says why.
    progress : callable, optional
        Called with (steps done, in all).
    **settings
        Fields of `CorrelateParameters`: max_lag, against, rule, detrend, difference, surrogates, and others.

    Returns
    -------
    Correlation
        In STUDY/correlation/SIGNAL~WITH, or SIGNAL~WITH~NAME, in place of an earlier one.

    Raises
    ------
    StudyError
        The study is not that of a movie, or has no signal.
    ParameterError
        There is no such signal (the message lists those there are) or cell, a setting is out of range, or no
        cell could be correlated.
    """
    chosen = _cells(study, cells)
    options = CorrelateParameters.chosen(parameters, settings)
    names = channels_of(study)
    _check_names(names, signal, with_, options)
    max_lag = options.max_lag if options.max_lag is not None else _usual_lag(study, chosen)
    found: dict[str, list[pd.DataFrame]] = {}
    rows = []
    for place, cell in enumerate(chosen):
        steps = _Steps(progress, place, len(chosen), 2 if options.pairs else 1)
        try:
            tables, row = _correlate_cell(study, cell, signal, with_, max_lag, options, steps)
        except ParameterError as error:
            tables, row = {}, {"status": "refused", "reason": str(error)}
        rows.append({"cell": cell} | row)
        for name, table in tables.items():
            found.setdefault(name, []).append(of_cell(table, cell))
    if not found:
        raise ParameterError(f"no cell of {study.path} can be correlated: {rows[0]['reason']}")
    tables = {name: merged(parts) for name, parts in found.items()} | {"cells": pd.DataFrame(rows)}
    content: dict[str, Any] = options.model_dump() | {"max_lag": max_lag, "cells": chosen if cells else None}
    content["surrogates_made"] = max(int(row.get("surrogates", 0)) for row in rows)
    content["pair_surrogates"] = max(int(row.get("pair_surrogates", 0)) for row in rows)
    content["cytodisk"] = installed(("cytodisk",))["cytodisk"]
    return write_correlation(study.path, signal, with_, tables, content, options.name)


def channels_of(study: Study) -> list[str]:
    """Names of the channels that a movie's study has in its windows.

    Raises
    ------
    StudyError
        It is not that of a movie, or was made without a signal.
    """
    if not study.is_movie:
        raise StudyError(
            f"study {study.path} is not that of a movie: without time there is nothing to correlate; use "
            "cytodisk movie"
        )
    activity = study.activity(int(study.cells["cell"].iloc[0]))
    if "mean" not in activity:
        raise StudyError(f"study {study.path} has no signal: run cytodisk movie with --signal")
    return [str(name) for name in activity["channel"].to_numpy()]


def _correlate_cell(
    study: Study,
    cell: int,
    signal: str,
    with_: str,
    max_lag: int,
    options: CorrelateParameters,
    steps: _Steps,
) -> tuple[dict[str, pd.DataFrame], dict[str, Any]]:
    """Tables of one cell, and its row in the table of cells."""
    activity = chosen_series(study.activity(cell), options)
    a = activity["mean"].sel(channel=signal).load()
    b = _other(activity, with_, options).load()
    if not (np.isfinite(a).any() and np.isfinite(b).any()):
        raise ParameterError(f"cell {cell} has no values of {signal if not np.isfinite(a).any() else with_}")
    common = dict(options.part(PairCorrelationParameters))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StationarityWarning)  # the shares are in the table, and are told
        correlations = cross_correlate(
            a, b, max_lag, skip_lags=options.skip_lags, progress=steps.of_phase(0), **common
        )
        jitter = _jitter(a, b, options) if with_ in VELOCITIES else 0.0
    tables = tables_of(correlations, options)
    if options.pairs:
        tables["pairs"] = _pairs(study, cell, activity, a, with_, max_lag, options, steps.of_phase(1))
    row: dict[str, Any] = {"status": "ok", "reason": "", "frames": a.sizes["time"], "jitter": jitter}
    row["surrogates"] = correlations.attrs["surrogates"]
    row["pair_surrogates"] = tables["pairs"].attrs["surrogates"] if options.pairs else 0
    row["restarts"] = _restarts(study, cell, activity["frame"].to_numpy())
    row |= {f"drifting_{name}": correlations.attrs[f"drifting_{side}"] for name, side in _SIDES}
    row |= {"no_events_because": "", "event_threshold": np.nan, "event_noise": np.nan}
    if with_ in VELOCITIES:
        try:
            edge = chosen_series(study.activity(cell), options.changed(sectors=None))
            events = event_tables(edge, a, with_, max_lag, options)
        except ParameterError as error:
            row["no_events_because"] = str(error)
        else:
            tables |= events
            row |= {f"event_{name}": events["events"].attrs[name] for name in ("threshold", "noise")}
    return tables, row


def _other(activity: xr.Dataset, with_: str, options: CorrelateParameters) -> xr.DataArray:
    """What the signal is correlated with, by sector or by window."""
    if with_ in VELOCITIES:
        return activity[with_]
    other = activity["mean"].sel(channel=with_)
    return other.isel(layer=0, drop=True) if options.against == "edge" else other


def _restarts(study: Study, cell: int, times: IntArray) -> int:
    """How often tracking started anew within frames: a sector may then be another place of the cell."""
    rows = study.cells[(study.cells["cell"] == cell) & study.cells["frame"].isin(times[1:])]
    return int((rows["restarted"].fillna("") != "").sum())


def _jitter(a: xr.DataArray, b: xr.DataArray, options: CorrelateParameters) -> float:
    """Largest mark of jitter in any layer; 0 for none, or where its lags are left out; NaN if unknown."""
    marked = JITTERED_LAGS if not options.difference else JITTERED_DIFFERENCES
    if set(marked) <= set(options.skip_lags):
        return 0.0
    lag = min(_LAG_FOR_JITTER, a.sizes["time"] - options.min_pairs)
    if lag < _LEAST_LAG_FOR_JITTER:
        return float("nan")
    found = cross_correlate(a, b, lag, detrend=options.detrend, min_pairs=options.min_pairs)
    steps = jitter_step(correlation_by_layer(found)).to_numpy()
    return float(steps[np.abs(steps).argmax()])


def _pairs(
    study: Study,
    cell: int,
    activity: xr.Dataset,
    a: xr.DataArray,
    with_: str,
    max_lag: int,
    options: CorrelateParameters,
    progress: Progress | None,
) -> pd.DataFrame:
    parameters = study.provenance["parameters"]
    grid = polar_windows(study.provenance["layers"], parameters["sectors"], parameters["spacing"])
    b = activity["mean"].sel(channel=with_).load()
    common = dict(options.part(PairCorrelationParameters)) | {
        "surrogates": min(options.surrogates, _PAIRED_SURROGATES)
    }
    sectors = chosen_sectors(options, grid.sectors)
    distances = window_distances(study.movie(cell), grid).isel(sector=sectors, other_sector=sectors)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StationarityWarning)  # as for the windows themselves
        found = correlate_pairs(a, b, max_lag, distances=distances, progress=progress, **common)
    table = as_table(found, ("along", "distance", "lag"))
    table.attrs["surrogates"] = found.attrs["surrogates"]
    return table


def _cells(study: Study, cells: list[int] | None) -> list[int]:
    there = sorted(int(cell) for cell in study.cells["cell"].unique())
    missing = [cell for cell in cells or [] if cell not in there]
    if missing:
        raise ParameterError(
            f"cells: study {study.path} has no cell {missing[0]}, it has {len(there)} from 0"
        )
    return sorted({int(cell) for cell in cells}) if cells else there


def _check_names(names: list[str], signal: str, with_: str, options: CorrelateParameters) -> None:
    clash = sorted(set(names) & set(VELOCITIES))
    if clash:
        raise ParameterError(
            f"the study has a channel called {clash[0]!r}, as the velocity of the edge is: run cytodisk "
            "movie again with --channels to name it otherwise"
        )
    listed = ", ".join(repr(name) for name in names)
    if signal not in names:
        raise ParameterError(f"signal {signal!r} is not in the study: it has {listed}")
    if with_ not in (*names, *VELOCITIES):
        raise ParameterError(
            f"with {with_!r} is not in the study: it has {', '.join(VELOCITIES)} and the signals {listed}"
        )
    if with_ == signal and options.against == "window":
        raise ParameterError(
            f"signal {signal!r} with itself in the same window is 1: pass against 'edge' to compare it "
            "with that of the outermost layer"
        )
    if options.pairs and with_ in VELOCITIES:
        raise ParameterError(
            "pairs need two signals: velocity has no windows inside; pass with another signal"
        )


def _usual_lag(study: Study, cells: list[int]) -> int:
    """A quarter of the longest cell's frames, at most twenty."""
    frames = max(study.activity(cell).sizes["time"] for cell in cells)
    return max(1, min(_LONGEST_LAG, frames // 4))


class _Steps:
    """Percents of all cells, from steps of the phases of one."""

    def __init__(self, progress: Progress | None, place: int, cells: int, phases: int):
        self._progress, self._place, self._cells, self._phases = progress, place, cells, phases

    def of_phase(self, phase: int) -> Progress | None:
        """What to call with the steps done, and all steps, of a phase."""
        if self._progress is None:
            return None
        report, total = self._progress, 100 * self._cells
        return lambda done, steps: report(
            100 * self._place + round(100 * (phase + done / steps) / self._phases), total
        )

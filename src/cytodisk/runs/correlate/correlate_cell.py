"""One cell of a study: a signal with the motion of the edge, or with another signal."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.analysis.correlation.correlation_parameters import PairCorrelationParameters
from cytodisk.analysis.correlation.cross_correlation import cross_correlate
from cytodisk.analysis.correlation.jitter_mark import (
    JITTERED_DIFFERENCES,
    JITTERED_LAGS,
    velocity_jitter,
)
from cytodisk.analysis.pairs.pair_correlation import correlate_pairs
from cytodisk.analysis.pairs.window_distances import window_distances
from cytodisk.arrays import IntArray
from cytodisk.errors import ParameterError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.correlate.cluster_rows import with_clusters
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.correlate.correlation_tables import as_table, tables_of
from cytodisk.runs.correlate.event_tables import event_tables
from cytodisk.runs.correlate.partial_correlation import Partial, partial_correlation
from cytodisk.runs.correlate.stress_columns import stress_row
from cytodisk.runs.run_options import Progress
from cytodisk.runs.used_series.cell_controls import CellControls
from cytodisk.runs.used_series.chosen_series import chosen_sectors, chosen_series
from cytodisk.runs.used_series.jitter_of_series import drift_is_told, largest_jitter
from cytodisk.runs.used_series.progress_phases import phases
from cytodisk.store.study import Study
from cytodisk.windows.study_grid import polar_grid_of

_SIDES = (("signal", "a"), ("with", "b"))
_PAIRED_SURROGATES = 99  # of the mean over pairs at most, which take longer than those of windows


@dataclass(frozen=True)
class CellCorrelation:
    """Correlates one cell; the same for all cells of a study.

    Attributes
    ----------
    study : Study
    signal, with_ : str
    max_lag : int
        In frames.
    options : CorrelateParameters
    """

    study: Study
    signal: str
    with_: str
    max_lag: int
    options: CorrelateParameters

    def of(self, cell: int, progress: Progress | None) -> tuple[dict[str, pd.DataFrame], dict[str, Any]]:
        """Tables of one cell, and its row in the table of cells.

        Raises
        ------
        ParameterError
            The cell cannot be correlated.
        """
        options = self.options
        activity = chosen_series(self.study.activity(cell), options)
        a = activity["mean"].sel(channel=self.signal).load()
        b = _other(activity, self.with_, options).load()
        if not (np.isfinite(a).any() and np.isfinite(b).any()):
            empty = self.signal if not np.isfinite(a).any() else self.with_
            raise ParameterError(f"cell {cell} has no values of {empty}")
        asked = self._controls.asked
        steps = phases(progress, 1 + 2 * asked + options.pairs)
        common = dict(options.part(PairCorrelationParameters))
        with drift_is_told():
            correlations = cross_correlate(
                a,
                b,
                self.max_lag,
                skip_lags=options.skip_lags,
                progress=steps[0],
                **common,
                **self._clusters(cell),
            )
            jitter = self._jitter_row(a, b)
            partial, not_tested = self._partial(cell, activity, (a, b), steps) if asked else (None, "")
        tables = with_clusters(tables_of(correlations, options, partial), correlations, partial)
        if options.pairs:
            tables["pairs"] = self._pairs(cell, activity, a, steps[-1])
        row: dict[str, Any] = {"status": "ok", "reason": "", "frames": a.sizes["time"]}
        row["statistic"] = options.statistic
        row["surrogates"] = correlations.attrs["surrogates"]
        row["cluster_surrogates"] = correlations.sizes.get("cluster_surrogate", 0)
        row["pair_surrogates"] = tables["pairs"].attrs["surrogates"] if options.pairs else 0
        row["partial_frames"] = partial.frames if partial is not None else np.nan
        row["geometry_not_tested"] = not_tested
        row["restarts"] = self._restarts(cell, activity["frame"].to_numpy())
        row |= {f"drifting_{name}": correlations.attrs[f"drifting_{side}"] for name, side in _SIDES}
        events, of_events = self._events(cell, a)
        return tables | events, row | jitter | stress_row(a, b, self.max_lag, options) | of_events

    def _jitter_row(self, a: xr.DataArray, b: xr.DataArray) -> dict[str, float]:
        """What jitter of the masks makes of the correlation and of velocity."""
        if self.with_ not in VELOCITIES:
            return {"jitter": 0.0, "velocity_jitter": np.nan}
        share = velocity_jitter(b.transpose("time", ...))
        return {"jitter": _jitter(a, b, share, self.options), "velocity_jitter": share}

    def _events(self, cell: int, a: xr.DataArray) -> tuple[dict[str, pd.DataFrame], dict[str, Any]]:
        """Tables of the events of the edge, and what the row says of them."""
        row: dict[str, Any] = {"no_events_because": "", "event_threshold": np.nan, "event_noise": np.nan}
        if self.with_ not in VELOCITIES:
            return {}, row
        try:
            edge = chosen_series(self.study.activity(cell), self.options.changed(sectors=None))
            tables = event_tables(edge, a, self.with_, self.max_lag, self.options)
        except ParameterError as error:
            return {}, row | {"no_events_because": str(error)}
        known = tables["events"].attrs
        return tables, row | {f"event_{name}": known[name] for name in ("threshold", "noise")}

    @cached_property
    def _controls(self) -> CellControls:
        return CellControls(self.study, self.max_lag, self.options, self.options.control)

    def _partial(
        self,
        cell: int,
        activity: xr.Dataset,
        series: tuple[xr.DataArray, xr.DataArray],
        steps: list[Progress | None],
    ) -> tuple[Partial, str]:
        """The correlation without controls, and why geometry is not among them."""
        signals = [self.signal, *(name for name in (self.with_,) if name not in (*VELOCITIES, self.signal))]
        found = self._controls.of(cell, activity, signals, steps[1])
        if not found.there:
            return Partial(None, np.nan), found.not_tested
        of_a = found.by_channel[self.signal]
        of_b = found.by_channel.get(self.with_, xr.Dataset())
        if self.options.against == "edge" and len(of_b):
            of_b = of_b.isel(layer=0, drop=True)
        a, b = (series[0], of_a), (series[1], of_b)
        partial = partial_correlation(a, b, self.max_lag, self.options, steps[2], self._clusters(cell))
        return partial, found.not_tested or (partial.too_few if self.options.geometry else "")

    def _clusters(self, cell: int) -> dict[str, Any]:
        """What to ask for about clusters: sectors may be a part of the edge."""
        if not (self.options.clusters and self.options.surrogates):
            return {}
        return {"clusters": True, "edge_sectors": self.study.activity(cell).sizes["sector"]}

    def _restarts(self, cell: int, times: IntArray) -> int:
        """How often tracking started anew within frames: a sector may then be another place of the cell."""
        cells = self.study.cells
        rows = cells[(cells["cell"] == cell) & cells["frame"].isin(times[1:])]
        return int((rows["restarted"].fillna("") != "").sum())

    def _pairs(
        self, cell: int, activity: xr.Dataset, a: xr.DataArray, progress: Progress | None
    ) -> pd.DataFrame:
        study, options = self.study, self.options
        grid = polar_grid_of(study.provenance)
        b = activity["mean"].sel(channel=self.with_).load()
        surrogates = {"surrogates": min(options.surrogates, _PAIRED_SURROGATES)}
        common = dict(options.part(PairCorrelationParameters)) | surrogates
        sectors = chosen_sectors(options, grid.sectors)
        distances = window_distances(study.movie(cell), grid).isel(sector=sectors, other_sector=sectors)
        with drift_is_told():
            found = correlate_pairs(a, b, self.max_lag, distances=distances, progress=progress, **common)
        table = as_table(found, ("along", "distance", "lag"))
        table.attrs["surrogates"] = found.attrs["surrogates"]
        return table


def _other(activity: xr.Dataset, with_: str, options: CorrelateParameters) -> xr.DataArray:
    """What the signal is correlated with, by sector or by window."""
    if with_ in VELOCITIES:
        return activity[with_]
    other = activity["mean"].sel(channel=with_)
    return other.isel(layer=0, drop=True) if options.against == "edge" else other


def _jitter(a: xr.DataArray, b: xr.DataArray, share: float, options: CorrelateParameters) -> float:
    """Largest mark of jitter in any layer; 0 for none, or where its lags are left out; NaN if unknown."""
    marked = JITTERED_LAGS if not options.difference else JITTERED_DIFFERENCES
    if set(marked) <= set(options.skip_lags):
        return 0.0
    return largest_jitter(a, b, share, detrend=options.detrend, min_pairs=options.min_pairs)

"""One cell of a study: which of its signals predict which."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations, permutations
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.analysis.correlation.jitter_mark import velocity_jitter
from cytodisk.analysis.prediction.prediction_parameters import HeldParameters, PredictionParameters
from cytodisk.analysis.stress.stress_marks import stress_marks
from cytodisk.arrays import IntArray
from cytodisk.errors import ParameterError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.predict.cell_series import CellSeries, SeriesOfStudy, given_to
from cytodisk.runs.predict.predict_parameters import PredictParameters
from cytodisk.runs.predict.tested_link import TestedLink, links_table, tested_link
from cytodisk.runs.run_options import Progress
from cytodisk.runs.used_series.jitter_of_series import drift_is_told, largest_jitter
from cytodisk.runs.used_series.progress_phases import phases
from cytodisk.store.study import Study


@dataclass(frozen=True, eq=False)
class PredictedCell:
    """What was found in one cell.

    Attributes
    ----------
    links, lags : DataFrame
        Rows of these tables, without the number of the cell.
    row : dict
        Of the table of cells.
    tested : tuple of TestedLink
    """

    links: pd.DataFrame
    lags: pd.DataFrame
    row: dict[str, Any]
    tested: tuple[TestedLink, ...]


@dataclass(frozen=True)
class CellPrediction:
    """Tests the links of one cell; the same for all cells of a study.

    Attributes
    ----------
    study : Study
    tested : tuple of str
        Signals that are tested against each other, in both directions.
    names : tuple of str
        The same, and those that are given.
    network : bool
        Whether all others are given where nothing else was asked for.
    lag : int
        See `SeriesOfStudy`.
    options : PredictParameters
    """

    study: Study
    tested: tuple[str, ...]
    names: tuple[str, ...]
    network: bool
    lag: int
    options: PredictParameters

    def of(self, cell: int, progress: Progress | None) -> PredictedCell:
        """Links of one cell.

        Parameters
        ----------
        cell : int
        progress : callable, optional
            Called with (steps done, in all).

        Raises
        ------
        ParameterError
            No link of the cell can be tested.
        """
        pairs = list(permutations(self.tested, 2))
        options, activity = self.options, self.study.activity(cell)
        steps = phases(progress, options.geometry + (1 + options.geometry) * len(pairs))
        series = SeriesOfStudy(self.study, self.names, self.lag, options).of(cell, steps[0])
        how = PredictionParameters.of(
            **dict(options.part(HeldParameters)), edge_sectors=int(activity.sizes["sector"])
        )
        stress = self._stress(series)
        links = []
        for place, (source, target) in enumerate(pairs):
            given = given_to(source, target, self.names, options.given, self.network)
            of_link = steps[options.geometry :][(1 + options.geometry) * place :]
            both = (series.raw, series.left)
            link = tested_link(source, target, given, both, how, [of_link[0], of_link[-1]])
            links.append(replace(link, stress=stress[frozenset((source, target))]))
        if all(link.raw is None for link in links):
            raise ParameterError(f"cell {cell}: {links[0].reason}")
        layers = activity["layer"].to_numpy()
        table = pd.concat([link.rows(layers) for link in links], ignore_index=True)
        lags = [link.lag_rows(self.study.scale.frame_interval_s) for link in links]
        row = self._row(cell, series, links)
        return PredictedCell(links_table(table), pd.concat(lags, ignore_index=True), row, tuple(links))

    def _row(self, cell: int, series: CellSeries, links: Sequence[TestedLink]) -> dict[str, Any]:
        times = next(iter(series.raw.values()))["frame"].to_numpy()
        row: dict[str, Any] = {"status": "ok", "reason": "", "frames": series.frames, "gaps": series.gaps}
        row["surrogates"] = min(link.surrogates for link in links if link.raw is not None)
        row |= self._jitter(series)
        row |= {"partial_frames": series.partial_frames, "geometry_not_tested": series.not_tested}
        drifting = max((link.drifting for link in links if link.raw is not None), default=np.nan)
        return row | {"restarts": self._restarts(cell, times), "drifting": drifting}

    def _jitter(self, series: CellSeries) -> dict[str, float]:
        """What jitter of the masks makes of velocity, and of its correlation with any channel."""
        velocity = next((series.raw[name] for name in self.tested if name in VELOCITIES), None)
        if velocity is None:
            return {"jitter": 0.0, "velocity_jitter": np.nan}
        share = velocity_jitter(velocity)
        channels = [series.raw[name] for name in self.tested if name not in VELOCITIES]
        with drift_is_told():
            steps = [largest_jitter(one, velocity, share) for one in channels]
        known = [step for step in steps if np.isfinite(step)]
        return {"jitter": max(known, key=abs, default=float("nan")), "velocity_jitter": share}

    def _stress(self, series: CellSeries) -> dict[frozenset[str], str]:
        """What makes p of independent series too small, for each pair of signals."""
        found = {}
        for a, b in combinations(self.tested, 2):
            marks = stress_marks(series.raw[a], series.raw[b], self.options.max_order, seed=self.options.seed)
            found[frozenset((a, b))] = "" if marks is None else ", ".join(marks.found)
        return found

    def _restarts(self, cell: int, frames: IntArray) -> int:
        """How often tracking started anew within frames: a sector may then be another place of the cell."""
        cells = self.study.cells
        rows = cells[(cells["cell"] == cell) & cells["frame"].isin(frames[1:])]
        return int((rows["restarted"].fillna("") != "").sum())

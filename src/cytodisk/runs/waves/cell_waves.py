"""Waves of one cell of a study: along its edge or in every layer of a signal, and what is below the edge."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.analysis.controls.without_controls import FEWEST_FRAMES, without_controls
from cytodisk.analysis.correlation.jitter_mark import velocity_jitter
from cytodisk.analysis.correlation.peaks import false_discovery
from cytodisk.analysis.correlation.prepared_series import drifting_share
from cytodisk.errors import ParameterError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.run_options import Progress
from cytodisk.runs.used_series.cell_controls import CellControls, too_few_frames
from cytodisk.runs.used_series.progress_phases import phases
from cytodisk.runs.waves.cell_wave_series import WaveSeries, used_series, wave_series
from cytodisk.runs.waves.disk_rows import NOT_INSIDE, depth_table, disk_wave, inside_row
from cytodisk.runs.waves.layer_waves import NO_WAVE, LayerWaves
from cytodisk.runs.waves.wave_run_parameters import WavesParameters
from cytodisk.store.study import Study

_CELL_FRAME = "velocity_cell_frame"
_LONGEST_LAG = 20  # frames around one in which the movie's mean in the lab is without


@dataclass(frozen=True)
class CellWaves:
    """Looks for waves in one cell; the same for all cells of a study.

    Attributes
    ----------
    study : Study
    signal : str
        A velocity or a channel.
    options : WavesParameters
    """

    study: Study
    signal: str
    options: WavesParameters

    def of(self, cell: int, progress: Progress | None) -> tuple[dict[str, pd.DataFrame], dict[str, Any]]:
        """Tables of one cell, and its row in the table of cells.

        Raises
        ------
        ParameterError
            Waves cannot be looked for in it.
        """
        series = wave_series(self.study, self.signal, cell, self.options)
        steps = phases(progress, 2 + len(series.layers))
        rows, tables = self._layers(series, steps)
        chosen = self._chosen(series)
        inside, whole = self._inside(series, steps[-2])
        not_tested = self._partial(cell, series, rows, inside, steps[-1])
        row = rows[chosen] | {"layer": chosen} | self._of_cell(cell, series, chosen, rows[chosen])
        if rows[chosen]["status"] != "ok" and all(one["status"] != "ok" for one in rows.values()):
            raise ParameterError(rows[chosen]["reason"])
        layers = pd.DataFrame([{"layer": layer} | one for layer, one in rows.items()])
        found = {"layers": with_whole_numbers(layers), **tables}
        if whole is not None:
            found["depths"] = depth_table(whole, series, self._looking)
        found["phase"] = with_inside(found["phase"], whole)
        return found, row | inside | {"geometry_not_tested": not_tested}

    @cached_property
    def _looking(self) -> LayerWaves:
        return LayerWaves(self.study.scale, self.options)

    def _chosen(self, series: WaveSeries) -> int | None:
        if None in series.layers:
            return None
        if self.options.layer not in series.layers:
            raise ParameterError(
                f"layer {self.options.layer} is not in the study: it has 0:{series.layers[-1]}"
            )
        return self.options.layer

    def _layers(
        self, series: WaveSeries, steps: list[Progress | None]
    ) -> tuple[dict[int | None, dict[str, Any]], dict[str, pd.DataFrame]]:
        """A row for each layer, with its status, and the tables of those that are not refused."""
        rows: dict[int | None, dict[str, Any]] = {}
        parts: dict[str, list[pd.DataFrame]] = {"modes": [], "spectrum": [], "phase": []}
        for layer, step in zip(series.layers, steps, strict=False):
            try:
                found = self._looking.found(series.of(layer), series.way(layer), step)
            except ParameterError as error:
                rows[layer] = NO_WAVE | {"status": "refused", "reason": str(error)}
                continue
            rows[layer] = self._looking.row(found) | {"status": "ok", "reason": ""}
            for name, table in self._looking.tables(series, layer, found).items():
                parts[name].append(table)
        q = false_discovery(np.array([row["p"] for row in rows.values()], dtype=np.float64))
        for row, one in zip(rows.values(), q.tolist(), strict=True):
            row["q"] = one
        return rows, {name: pd.concat(some, ignore_index=True) for name, some in parts.items() if some}

    def _inside(
        self, series: WaveSeries, progress: Progress | None
    ) -> tuple[dict[str, Any], xr.Dataset | None]:
        """The wave through all layers: its numbers, and what `disk_waves` gives."""
        if len(series.layers) < 2:
            return dict(NOT_INSIDE), None
        try:
            found = disk_wave(series, series.values, self._looking, progress)
        except ParameterError as error:
            return NOT_INSIDE | {"no_inside_because": str(error)}, None
        return inside_row(found, self._looking), found

    def _of_cell(
        self, cell: int, series: WaveSeries, chosen: int | None, row: dict[str, Any]
    ) -> dict[str, Any]:
        """What is known of a cell beside its wave."""
        values = series.of(chosen)
        frames = values.sizes["time"]
        cells = self.study.cells
        used = series.values["frame"].to_numpy()[1:]
        there = cells[(cells["cell"] == cell) & cells["frame"].isin(used)]
        return {
            "frames": frames,
            "periods": frames / row["period"],
            "edge_length": series.edge_length,
            "surrogates": self.options.surrogates,
            "drifting": drifting_share(values),
            "jitter": velocity_jitter(values) if self.signal in VELOCITIES else math.nan,
            "restarts": int((there["restarted"].fillna("") != "").sum()),
        }

    def _partial(
        self,
        cell: int,
        series: WaveSeries,
        rows: dict[int | None, dict[str, Any]],
        inside: dict[str, Any],
        progress: Progress | None,
    ) -> str:
        """Look again for waves without what the cell's motion gives; why not, if that cannot be done."""
        waving = [layer for layer, row in rows.items() if row["kind"] != "none"]
        through = inside["inside"] not in ("", "none")
        if not (self.options.geometry and (waving or through)) or self.signal == _CELL_FRAME:
            return ""
        if self.signal in VELOCITIES and rows[None]["mode"] == 1:
            return ""  # one wave around is a motion of the whole cell: without that nothing can be left
        if self.signal in VELOCITIES and not self.study.provenance["parameters"].get("registration", True):
            return "the movie was followed without registration, so how the cell turns is not known"
        left: xr.DataArray | None
        if self.signal in VELOCITIES:
            left, why = series.activity[_CELL_FRAME].transpose("time", "sector").load(), ""
        else:
            periods = [rows[layer]["period"] for layer in waving]
            longest = max([*periods, inside["inside_period"]] if through else periods)
            left, why = self._without_geometry(cell, series, _lag(longest), progress)
        if left is None:
            return why
        for layer in waving:
            values = left if layer is None else left.sel(layer=layer, drop=True)
            try:
                again = self._looking.row(self._looking.found(values, None))
            except ParameterError as error:
                why = str(error)
                continue
            rows[layer] |= {"order_partial": again["order"], "p_partial": again["p"]}
        if through:
            try:
                inside["p_inside_partial"] = float(disk_wave(series, left, self._looking)["p"])
            except ParameterError as error:
                why = str(error)
        return why

    def _without_geometry(
        self, cell: int, series: WaveSeries, lag: int, progress: Progress | None
    ) -> tuple[xr.DataArray | None, str]:
        """A signal with the movie's mean in the lab and by depth regressed out; or why that is not there."""
        controls = CellControls(self.study, lag, used_series(self.options))
        found = controls.of(cell, series.activity, [self.signal], progress)
        if not found.there:
            return None, found.not_tested
        left = without_controls(series.values, found.by_channel[self.signal])
        frames = float(left.count("time").median())
        if frames < FEWEST_FRAMES:
            return None, too_few_frames(frames)
        return left, found.not_tested


def _lag(period: float) -> int:
    """Frames around one that the mean in the lab leaves out: a period, within limits."""
    return int(max(1, min(_LONGEST_LAG, period)))


def with_inside(phase: pd.DataFrame, whole: xr.Dataset | None) -> pd.DataFrame:
    """The table of phases with those and the amplitudes of the wave through all layers, if there is one."""
    names = ("phase", "amplitude")
    if whole is None:
        return phase.assign(**{f"{name}_inside": math.nan for name in names})
    frames = {int(frame): place for place, frame in enumerate(whole["frame"].to_numpy())}
    places = (
        phase["frame"].map(frames).to_numpy(dtype=np.int64),
        phase["layer"].to_numpy(dtype=np.int64),
        phase["sector"].to_numpy(dtype=np.int64),
    )
    values = {name: whole[f"wave_{name}"].transpose("time", "layer", "sector").to_numpy() for name in names}
    return phase.assign(**{f"{name}_inside": one[places] for name, one in values.items()})


def with_whole_numbers(table: pd.DataFrame) -> pd.DataFrame:
    """The table with columns of whole numbers that may be empty as such."""
    names = [name for name in ("layer", "mode", "inside_mode") if name in table]
    return table.astype(dict.fromkeys(names, "Int64"))

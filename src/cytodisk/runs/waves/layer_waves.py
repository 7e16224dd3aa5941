"""The waves of one layer of a cell, or of its edge, as rows of tables."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.analysis.waves.edge_waves import edge_waves
from cytodisk.analysis.waves.waves_parameters import WaveSearchParameters
from cytodisk.arrays import FloatArray
from cytodisk.runs.run_options import Progress
from cytodisk.runs.waves.cell_wave_series import WaveSeries
from cytodisk.runs.waves.wave_run_parameters import WavesParameters
from cytodisk.scale import Scale

NO_WAVE: dict[str, Any] = {
    "kind": "none",
    "way": "",
    "mode": None,
    **dict.fromkeys(
        (
            "period",
            "period_s",
            "shortest_period",
            "longest_period",
            "speed",
            "edge_speed",
            "speed_um_s",
            "direction",
            "persistence_s",
            "order",
            "p",
            "q",
            "order_partial",
            "p_partial",
        ),
        math.nan,
    ),
}
"""The row of a layer of which nothing is known."""


@dataclass(frozen=True)
class LayerWaves:
    """Looks for waves in layers; the same for all layers of a study.

    Attributes
    ----------
    scale : Scale
    options : WavesParameters
    """

    scale: Scale
    options: WavesParameters

    @property
    def step(self) -> float:
        """Seconds from frame to frame; 1 where that is unknown, and times are in frames."""
        return self.scale.time(1.0)

    def found(
        self, values: xr.DataArray, way: FloatArray | None, progress: Progress | None = None
    ) -> xr.Dataset:
        """Waves in values by (time, sector).

        Parameters
        ----------
        values : DataArray of shape (T, S)
        way : ndarray of shape (T, S) and dtype float, optional
            Length of each sector, in the unit of the study; NaN where it is not known. If there is no frame
            with all of them, speeds along the edge are NaN.
        progress : callable, optional
            Called with (steps done, in all).

        Raises
        ------
        ParameterError
            They are too few, or never change.
        """
        how = dict(self.options.part(WaveSearchParameters))
        known = way is not None and bool(np.isfinite(way).all(axis=1).any())
        return edge_waves(
            values,
            frame_interval_s=self.step,
            edge_length_um=way if known else None,
            progress=progress,
            **how,
        )

    def row(self, found: xr.Dataset) -> dict[str, Any]:
        """The numbers of a wave, as in `WAVE_COLUMNS`; q and what is partial are filled in later."""
        number = {
            name: float(found[name])
            for name in ("mode", "period_s", "speed", "direction", "persistence_s", "order", "p")
        }
        along = float(found["speed_um_s"])
        seconds = 1.0 if self.scale.frame_interval_s is not None else math.nan
        microns = seconds if self.scale.pixel_size_um is not None else math.nan
        kind = str(found["kind"].item())
        return NO_WAVE | {
            "kind": kind,
            "way": _way(number["direction"]) if kind == "rotating" else "",
            "mode": int(number["mode"]),
            "period": number["period_s"] / self.step,
            "period_s": number["period_s"] * seconds,
            "shortest_period": float(found.attrs["shortest_period_s"]) / self.step,
            "longest_period": float(found.attrs["longest_period_s"]) / self.step,
            "speed": number["speed"] * seconds,
            "edge_speed": along,
            "speed_um_s": along * microns,
            "direction": number["direction"],
            "persistence_s": number["persistence_s"] * seconds,
            "order": number["order"],
            "p": number["p"],
        }

    def tables(self, series: WaveSeries, layer: int | None, found: xr.Dataset) -> dict[str, pd.DataFrame]:
        """Power by mode, spectrum and phase of a layer."""
        tables = {
            "modes": _modes(found),
            "spectrum": self._spectrum(found),
            "phase": self._phase(series, found),
        }
        for table in tables.values():
            table.insert(0, "layer", pd.Series([layer] * len(table), table.index, dtype="Int64"))
        return tables

    def _spectrum(self, found: xr.Dataset) -> pd.DataFrame:
        """Power by mode, with its direction, and frequency."""
        table = found["spectrum"].to_series().reset_index()
        hertz = table["frequency"]
        known = self.scale.frame_interval_s is not None
        return pd.DataFrame(
            {
                "mode": table["travelling"],
                "frequency": hertz * self.step,
                "frequency_hz": hertz if known else math.nan,
                "power": table["spectrum"],
            }
        )

    def _phase(self, series: WaveSeries, found: xr.Dataset) -> pd.DataFrame:
        phase, amplitude = (
            found[name].transpose("time", "sector").to_numpy() for name in ("wave_phase", "wave_amplitude")
        )
        frames = series.values["frame"].to_numpy()
        sectors = phase.shape[1]
        step = self.scale.frame_interval_s
        return pd.DataFrame(
            {
                "frame": np.repeat(frames, sectors),
                "time_s": np.repeat(frames * (math.nan if step is None else step), sectors),
                "sector": np.tile(np.arange(sectors), len(frames)),
                "phase": phase.ravel(),
                "amplitude": amplitude.ravel(),
            }
        )


def _modes(found: xr.Dataset) -> pd.DataFrame:
    columns = {"power": "power", "threshold": "power_threshold"}
    values = {name: found[variable].to_numpy() for name, variable in columns.items()}
    return pd.DataFrame({"mode": found["around"].to_numpy(), **values})


def _way(direction: float) -> str:
    """Which way it runs as seen in the image, where y points down and sectors count from +x towards +y."""
    return "clockwise" if direction > 0 else "anticlockwise"

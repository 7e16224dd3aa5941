"""Columns of what makes independent series correlate: pulses, episodes, oscillations, heavy tails."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyarrow as pa
import xarray as xr

from cytodisk.analysis.correlation.correlation_parameters import PrepareParameters
from cytodisk.analysis.correlation.prepared_series import default_frames, prepare_series
from cytodisk.analysis.stress.stress_marks import stress_marks
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.store.tables import Column, Columns

STRESS_COLUMNS: Columns = (
    Column(
        "stress",
        pa.string(),
        "",
        "what makes p of independent series too small, with commas between: common pulse, restless episode, "
        "variance change, steady oscillation, heavy tails; empty for nothing",
    ),
    Column("pulse_share", pa.float64(), "1", "share of the joint energy of both in the three frames of most"),
    Column("pulse_frames", pa.string(), "", "these frames, and those of the other series if it is later"),
    Column("episode_ratio", pa.float64(), "1", "variance in the most restless episode over that outside"),
    Column("episode_frames", pa.string(), "", "first and last frame of that episode"),
    Column("variance_ratio", pa.float64(), "1", "variance of the second half over that of the first"),
    Column("line_share", pa.float64(), "1", "share of variance in the sharpest spectral line of both"),
    Column("line_period", pa.float64(), "frame", "period of that line"),
    Column("kurtosis", pa.float64(), "1", "fourth moment over the squared variance; 3 if normal"),
)
"""Columns of the table of cells; numbers are those of the signal or of the other, whichever shows less."""


def stress_row(
    a: xr.DataArray, b: xr.DataArray, max_lag: int, options: CorrelateParameters
) -> dict[str, Any]:
    """Values of the columns for two sets of series, prepared as they are correlated."""
    how = PrepareParameters(detrend=options.detrend, difference=options.difference)
    how = how.changed(detrend_frames=default_frames(options, max_lag))
    prepared = [series.copy(data=prepare_series(series, **how.model_dump())) for series in (a, b)]
    marks = stress_marks(prepared[0], prepared[1], max_lag, seed=options.seed)
    if marks is None:
        texts = dict.fromkeys(("stress", "pulse_frames", "episode_frames"), "")
        return texts | {column.name: np.nan for column in STRESS_COLUMNS if column.name not in texts}
    first, last = marks.episode_frames
    return {
        "stress": ", ".join(marks.found),
        "pulse_share": marks.pulse_share,
        "pulse_frames": ",".join(map(str, marks.pulse_frames)),
        "episode_ratio": marks.episode_ratio,
        "episode_frames": f"{first}:{last}",
        "variance_ratio": marks.variance_ratio,
        "line_share": marks.line_share,
        "line_period": marks.line_period,
        "kurtosis": marks.kurtosis,
    }

"""Waves of a movie's cell as `cytodisk waves` found them: order by layer, numbers of the chosen layer."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import BoolArray
from cytodisk.errors import NoValuesError, PopulationError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.population.movies.cell_layers import as_windows, reason_of
from cytodisk.runs.population.movies.time_summaries import EDGE
from cytodisk.store.study import Study

NUMBERS = "numbers"
"""Name of the attr with numbers that are compared beside the windows."""

_OF_WAVES = {"period_s": "wave_period_s", "persistence_s": "wave_persistence_s"}
_SIZES = {"speed_um_s": "wave_speed_um_s", "direction": "wave_direction"}  # which way round is by chance

WAVE_UNITS = {
    "wave_order": "1",
    "wave_speed_um_s": "µm/s",
    "wave_direction": "1",
    "wave_period_s": "s",
    "wave_persistence_s": "s",
}
"""Numbers of waves that are compared, and their units; see `numbers_of`."""


def wave_order(study: Study, cell: int, channels: Sequence[str] | None) -> xr.DataArray:
    """Order of waves by layer; numbers of the chosen layer are in `attrs["numbers"]`.

    Parameters
    ----------
    study : Study
    cell : int
    channels : sequence of str or None
        One signal: "velocity", by default, or a channel.

    Returns
    -------
    DataArray with dims (channel, layer, sector)
        The same in all sectors of a layer. Of velocity there is one layer, the edge.

    Raises
    ------
    PopulationError
        Waves were not looked for in that signal, or several are named.
    NoValuesError
        The cell was refused by `cytodisk waves`.
    """
    signal = _signal(study, channels)
    found = study.waves(signal)
    rows = found.layers[found.layers["cell"] == cell]
    if rows["order"].isna().all():
        raise NoValuesError(f"waves were not looked for: {reason_of(found.cells, cell)}")
    layer = rows["layer"].fillna(0).to_numpy(np.int64)
    values = xr.DataArray(
        rows["order"].to_numpy(np.float64)[None],
        dims=("channel", "layer"),
        coords={"channel": [signal], "layer": layer},
        name="waves",
    )
    whole = as_windows(values, study.activity(cell))
    if signal in VELOCITIES:
        whole = whole.isel(layer=[0]).assign_coords(compartment=("layer", np.array([EDGE], dtype=object)))
    numbers = numbers_of(found.cells[found.cells["cell"] == cell]).iloc[0].to_dict()
    return whole.assign_attrs({"units": "1", NUMBERS: numbers})


def numbers_of(cells: pd.DataFrame) -> pd.DataFrame:
    """Numbers of the waves of cells that can be compared.

    Parameters
    ----------
    cells : DataFrame
        The table of cells of waves.

    Returns
    -------
    DataFrame
        wave_order, a normal quantile with a mean of 0 where there is no wave; wave_speed_um_s and
        wave_direction without their sign; wave_period_s and wave_persistence_s. All but the first are NaN
        where the kind of wave is "none": they are then any.
    """
    waves = has_wave(cells)
    table: dict[str, Any] = {"wave_order": cells["order"].to_numpy(np.float64)}
    for names, size in ((_SIZES, np.abs), (_OF_WAVES, np.asarray)):
        for column, name in names.items():
            table[name] = np.where(waves, size(cells[column].to_numpy(np.float64)), np.nan)
    return pd.DataFrame(table, index=cells.index)


def has_wave(cells: pd.DataFrame) -> BoolArray:
    """Which cells have a wave beyond chance by themselves, of the table of cells of waves."""
    return np.asarray(cells["kind"].fillna("none") != "none")


def _signal(study: Study, channels: Sequence[str] | None) -> str:
    """The signal whose waves are compared."""
    there = [names[0] for names in study.wave_signals if len(names) == 1]
    if channels is not None and len(channels) > 1:
        raise PopulationError(
            f"waves are compared of one signal at a time, got {', '.join(map(repr, channels))}: name one of "
            f"them, or none for those of velocity"
        )
    wanted = "velocity" if channels is None else channels[0]
    if wanted in there:
        return wanted
    more = "" if wanted == "velocity" else f" --signal {shlex.quote(wanted)}"
    has = f"; it has those of {', '.join(map(repr, there))}" if there else ""
    raise PopulationError(
        f"study {study.path} has no waves of {wanted!r}: type cytodisk waves "
        f"{shlex.quote(str(study.path))}{more}{has}"
    )

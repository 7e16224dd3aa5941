"""What is said of each window at the cursor: cell, layer, sector, depth, area, means, velocity."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.napari.study_layers.painted_frames import PaintedFrames
from cytodisk.runs.channel_names import shown_name

_DIGITS = 5  # of numbers, that a status bar has room for
_LONGEST = 24  # letters of a channel's name


def window_features(painted: PaintedFrames, frame: int, cells: Sequence[int] | None = None) -> pd.DataFrame:
    """One row a window of a frame.

    Parameters
    ----------
    painted : PaintedFrames
    frame : int
    cells : sequence of int, optional
        By default all that have a map.

    Returns
    -------
    DataFrame
        `index` is the label of the window; numbers have 5 digits, and their units in the column's name.
        Velocity is that of the edge, in windows of the outermost layer.
    """
    shown = painted.shown(frame) if cells is None else cells
    parts = [_of_cell(painted, cell, frame) for cell in shown]
    names = list(_columns(painted))
    if not parts:
        return pd.DataFrame({name: [] for name in names})
    return pd.DataFrame({name: np.concatenate([part[name] for part in parts]) for name in names})


def _of_cell(painted: PaintedFrames, cell: int, frame: int) -> dict[str, Any]:
    grid, numbers = painted.windows.grid, painted.values.at(cell, frame)
    layers, sectors = numbers["area"].shape
    layer, sector = (place.ravel() for place in np.indices((layers, sectors)))
    found: dict[str, Any] = {
        "index": painted.first_label(cell, frame) + np.arange(layers * sectors),
        "cell": np.full(layers * sectors, cell),
        "layer": layer,
        "sector": sector,
    }
    if grid.nucleus_layers:
        found["compartment"] = np.asarray(grid.compartments, dtype=object)[layer]
    unit = painted.values.units
    for name in ("depth", "area"):
        if name in numbers:
            found[f"{name} ({unit[name]})"] = short(numbers[name]).ravel()
    for number, channel in enumerate(painted.values.channels):
        found[mean_name(channel)] = short(numbers["mean"][number]).ravel()
    if "velocity" in numbers:
        outer = np.full((layers, sectors), np.nan)
        outer[0] = short(numbers["velocity"])
        found[f"velocity ({unit['velocity']})"] = outer.ravel()
    return found


def _columns(painted: PaintedFrames) -> list[str]:
    """Names of the columns, as a frame without cells has them too."""
    for frame in painted.cells.mapped:
        for cell in painted.shown(frame):
            return list(_of_cell(painted, cell, frame))
    return ["index"]


def mean_name(channel: str) -> str:
    """Name of the column with the mean of a channel."""
    return f"mean {shown_name(channel, _LONGEST)} (a.u.)"


def short(values: FloatArray) -> FloatArray:
    """Numbers with 5 digits."""
    sizes = np.abs(np.where(np.isfinite(values) & (values != 0), values, 1.0))
    factor = 10.0 ** (_DIGITS - 1 - np.floor(np.log10(sizes)))
    return np.asarray(np.rint(values * factor) / factor)

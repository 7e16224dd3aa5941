"""Windows of a cell that is mapped without a nucleus, in a study whose other cells have one."""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.windows.polar_windows import PolarGrid

_SAME = ("cell", "frame", "time_s", "channel")  # in all windows of a cell and channel


def with_nucleus_rows(columns: dict[str, Any], grid: PolarGrid) -> dict[str, Any]:
    """Rows for the layers of the nucleus after those of each channel: every cell of a study has as many.

    Parameters
    ----------
    columns : dict of str to array
        Of the table of windows, for each channel every window, as a grid without nucleus has them.
    grid : PolarGrid
        With layers of the nucleus.

    Returns
    -------
    dict of str to array
        In the new rows numbers are NaN.
    """
    layers, sectors = grid.cytoplasm_layers, grid.sectors
    more = np.divmod(np.arange(layers * sectors, grid.n_windows), sectors)
    known: dict[str, Any] = {"layer": more[0], "sector": more[1]}
    count = len(more[0])
    known |= {"status": ["no nucleus"] * count, "compartment": ["nucleus"] * count}
    return {name: _padded(name, values, layers * sectors, known, count) for name, values in columns.items()}


def _padded(name: str, values: Any, windows: int, known: dict[str, Any], more: int) -> Any:
    parts = []
    for start in range(0, len(values), windows):
        own = values[start : start + windows]
        new = known.get(name, [own[0]] * more if name in _SAME else np.full(more, np.nan))
        parts += [own, new]
    if isinstance(values, np.ndarray):
        return np.concatenate(parts)
    return [value for part in parts for value in part]

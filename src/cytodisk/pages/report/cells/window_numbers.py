"""What the table of windows says of each cell, read in one pass."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.store.study import Study
from cytodisk.store.window_blocks import window_blocks

BY_CHANNEL, BY_WINDOW = ("mean", "sd"), ("area", "depth")


@dataclass(frozen=True, eq=False)
class WindowNumbers:
    """Numbers of windows.

    Attributes
    ----------
    channels : tuple of str
        Empty without a signal.
    means : DataFrame
        Mean of each channel over each mapped cell, windows counted by their pixels; by number of the cell.
    by_cell : dict of int to dict of str to array
        Of chosen cells: mean and sd, shape (channels, windows), area and depth, shape (windows,).
    """

    channels: tuple[str, ...]
    means: pd.DataFrame
    by_cell: dict[int, dict[str, FloatArray]]


def window_numbers(study: Study, chosen: Sequence[int], n_windows: int) -> WindowNumbers:
    """Read the table of windows, a block of rows after the other.

    Parameters
    ----------
    study : Study
        Of single cells.
    chosen : sequence of int
        Cells whose windows are kept.
    n_windows : int
        A cell.

    Returns
    -------
    WindowNumbers
    """
    totals: list[pd.DataFrame] = []
    kept: list[pd.DataFrame] = []
    wanted = np.asarray(sorted(chosen))
    for block in window_blocks(study, "cell", "channel", "n_pixels", *BY_CHANNEL, *BY_WINDOW):
        known = block[block["channel"].notna() & block["mean"].notna()]
        weighted = known[["cell", "channel", "n_pixels"]].assign(total=known["mean"] * known["n_pixels"])
        totals.append(weighted.groupby(["cell", "channel"], sort=False)[["total", "n_pixels"]].sum())
        kept.append(block[np.isin(block["cell"].to_numpy(), wanted)])
    if not totals:  # no cell is mapped
        return WindowNumbers((), pd.DataFrame(), {})
    sums = pd.concat(totals).groupby(level=["cell", "channel"], sort=False).sum()
    means = (sums["total"] / sums["n_pixels"].where(sums["n_pixels"] > 0)).unstack("channel")
    rows = pd.concat(kept)
    channels = tuple(str(name) for name in dict.fromkeys(sums.index.get_level_values("channel")))
    by_cell = {int(str(cell)): _arrays(part, n_windows) for cell, part in rows.groupby("cell", sort=False)}
    return WindowNumbers(channels, means.reindex(columns=list(channels)), by_cell)


def _arrays(rows: pd.DataFrame, n_windows: int) -> dict[str, Any]:
    arrays = {name: rows[name].to_numpy().reshape(-1, n_windows) for name in (*BY_CHANNEL, *BY_WINDOW)}
    return {name: values if name in BY_CHANNEL else values[0] for name, values in arrays.items()}

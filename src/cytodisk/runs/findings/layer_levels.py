"""Levels of a signal by layer: which layer is brightest, edge to centre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.store.study import Study
from cytodisk.store.window_blocks import has_signal, window_blocks
from cytodisk.windows.study_grid import polar_grid_of

WITHOUT_VALUES = "The signal has no value in any window."

MOST_ROWS = 5_000_000
"""Of the table of windows that are read for single cells; the first cells stand for all beyond that."""


@dataclass(frozen=True, eq=False)
class LayerLevels:
    """Mean of each channel in each layer of cells, windows counted by their pixels.

    Attributes
    ----------
    levels : DataFrame
        By (cell, channel), a column a layer; of a movie the mean over its frames.
    whole : Series
        Mean of the whole cell, by (cell, channel).
    inner : int
        The innermost layer that is not in a nucleus.
    cut : bool
        Whether there are more cells than were read.
    """

    levels: pd.DataFrame
    whole: pd.Series[float]
    inner: int
    cut: bool = False

    @property
    def has_nucleus(self) -> bool:
        """Whether layers lie in a nucleus."""
        return self.inner < self.levels.shape[1] - 1

    @property
    def channels(self) -> list[str]:
        """Names, in the order of the study."""
        return [str(name) for name in dict.fromkeys(self.levels.index.get_level_values("channel"))]

    def of(self, channel: str) -> pd.DataFrame:
        """Levels of a channel by cell, over the mean of the cell."""
        levels: Any = self.levels.xs(channel, level="channel")
        whole: Any = self.whole.xs(channel, level="channel")
        found: pd.DataFrame = levels.div(whole.where(whole > 0), axis=0)
        return found

    def edge_to_centre(self, channel: str) -> pd.Series[float]:
        """The outermost over the innermost layer outside the nucleus, by cell."""
        levels = self.levels.xs(channel, level="channel")
        inner = levels[self.inner]
        return levels[0] / inner.where(inner > 0)


def layer_levels(study: Study, cell: int | None = None) -> LayerLevels | None:
    """Levels by layer; None without a signal, or where it has no value.

    Parameters
    ----------
    study : Study
    cell : int, optional
        Of a movie: only this cell.
    """
    if not has_signal(study):
        return None
    totals, rows, cut = [], 0, False
    for block in window_blocks(study, "cell", "channel", "layer", "mean", "n_pixels"):
        if rows > MOST_ROWS and cell is None:
            cut = True
            break
        rows += len(block)
        known = block[block["mean"].notna() & block["channel"].notna()]
        known = known if cell is None else known[known["cell"] == cell]
        weighted = known.assign(total=known["mean"] * known["n_pixels"])
        totals.append(weighted.groupby(_KEYS, sort=False)[["total", "n_pixels"]].sum())
    sums: Any = pd.concat(totals).groupby(level=_KEYS, sort=False).sum() if totals else pd.DataFrame()
    if sums.empty:
        return None
    if cut:  # the last cell may be there in part
        sums = sums.drop(index=sums.index[-1][0], level="cell")
    whole = sums.groupby(level=_KEYS[:2], sort=False).sum()
    grid = polar_grid_of(study.provenance)
    levels = _over(sums).unstack("layer").reindex(columns=range(grid.layers))
    levels = levels.reindex(whole.index)
    return LayerLevels(levels, _over(whole), grid.layers - grid.nucleus_layers - 1, cut)


def has_channel(study: Study) -> bool:
    """Whether a signal was given, also one without a value: only its rows name a channel."""
    if not has_signal(study):
        return False
    first = next(window_blocks(study, "channel"), None)
    return first is not None and bool(first["channel"].notna().any())


_KEYS = ["cell", "channel", "layer"]


def _over(sums: pd.DataFrame) -> Any:
    return sums["total"] / sums["n_pixels"].where(sums["n_pixels"] > 0, np.nan)

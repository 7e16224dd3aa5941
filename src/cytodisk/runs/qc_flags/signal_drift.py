"""Slow trends of a cell's mean signal, as bleaching leaves them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.stats import kendalltau, theilslopes

from cytodisk.arrays import FloatArray
from cytodisk.store.study import Study
from cytodisk.store.window_blocks import has_signal, window_blocks

FEWEST_FRAMES = 8
"""A trend needs so many frames."""
LARGEST_CHANGE = 0.15
"""Share of the median by which the mean may change over the movie."""
STEADINESS = 0.5
"""Kendall's τ of a trend: it goes one way, rather than up and down."""

_KEYS = ["cell", "channel", "frame"]
_MOST_FRAMES = 500  # that a trend is fitted to, as time and memory grow with their square


@dataclass(frozen=True)
class Drift:
    """A channel's trend in one cell.

    Attributes
    ----------
    cell : int
    channel : str
    change : float
        From the first to the last frame, as a share of the median; negative for a loss.
    """

    cell: int
    channel: str
    change: float

    @property
    def words(self) -> str:
        """Channel and change, as "VASP −23 %"."""
        return f"{self.channel} " + f"{self.change:+.0%} over the movie".replace("-", "−")


def mean_by_frame(blocks: Iterable[pd.DataFrame]) -> pd.Series[float]:
    """Mean signal of each cell by channel and frame.

    Parameters
    ----------
    blocks : iterable of DataFrame
        Rows of `Study.windows` of a movie with a signal, with its columns `cell`, `channel`, `frame`, `mean`
        and `n_pixels`.

    Returns
    -------
    Series
        By cell, channel and time; windows count by their pixels, those without a mean not at all.
    """
    sums = [
        block.assign(sum=block["mean"] * block["n_pixels"]).groupby(_KEYS)[["sum", "n_pixels"]].sum()
        for block in (some[some["mean"].notna()] for some in blocks)
    ]
    if not sums:  # no frame has a map
        nowhere = pd.MultiIndex.from_arrays([[], [], []], names=_KEYS)
        return pd.Series(np.zeros(0), nowhere)
    total = pd.concat(sums).groupby(level=_KEYS).sum()
    mean: pd.Series[float] = total["sum"] / total["n_pixels"]
    return mean


def relative_trend(time: FloatArray, mean: FloatArray) -> float:
    """Change of a mean over a movie along its straight line, 0 where there is no steady one.

    Parameters
    ----------
    time : ndarray of shape (T,) and dtype float
        In frames.
    mean : ndarray of shape (T,) and dtype float

    Returns
    -------
    float
        As a share of the median.

    References
    ----------
    Sen, "Estimates of the regression coefficient based on Kendall's tau", 1968.
    """
    every = max(1, mean.size // _MOST_FRAMES)
    time, mean = time[::every], mean[::every]
    middle = float(np.median(mean)) if mean.size else 0.0
    if mean.size < FEWEST_FRAMES or middle == 0.0 or np.ptp(mean) == 0.0:
        return 0.0
    if abs(kendalltau(time, mean).statistic) < STEADINESS:
        return 0.0
    return float(theilslopes(mean, time)[0] * np.ptp(time) / abs(middle))


def signal_drifts(study: Study) -> list[Drift]:
    """Channels of cells whose mean changes steadily by more than `LARGEST_CHANGE`.

    In a cell that grows, the mean of a signal at its edge falls though nothing fades. So the signal by length
    of the edge has to change the same way; the smaller change of both counts.

    Parameters
    ----------
    study : Study
        Study of a movie.

    Returns
    -------
    list of Drift
        By cell, then channel; empty without a signal.
    """
    mapped = (study.cells["status"] == "ok").any()  # else the table of windows has no rows
    return list(_drifts(study)) if mapped and has_signal(study) else []


def _drifts(study: Study) -> Iterator[Drift]:
    blocks = window_blocks(study, *_KEYS, "mean", "n_pixels")
    means = mean_by_frame(blocks).rename("mean").reset_index()
    if means.empty:
        return
    means = means.merge(_area_by_edge(study.cells), on=["cell", "frame"], how="left")
    for (cell, channel), rows in means.groupby(["cell", "channel"]):
        time, mean, width = (np.asarray(rows[name], dtype=np.float64) for name in ("frame", "mean", "width"))
        by_area, by_edge = relative_trend(time, mean), relative_trend(time, mean * width)
        change = min(by_area, by_edge, key=abs) if by_area * by_edge > 0 else 0.0
        if abs(change) > LARGEST_CHANGE:
            yield Drift(int(str(cell)), str(channel), change)


def _area_by_edge(cells: pd.DataFrame) -> pd.DataFrame:
    """Area by length of the edge, by cell and frame."""
    width = cells["area"] / cells["perimeter"]
    return cells[["cell", "frame"]].assign(width=width)

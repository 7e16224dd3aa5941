"""Lines of experiments with their mean and its interval."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from scipy.special import stdtrit

from cytodisk.arrays import FloatArray

LEVEL = 0.95
BAND_OPACITY = 0.22
EXPERIMENT_LOOK: Any = {"linewidth": 0.6, "alpha": 0.7}
MEAN_LOOK: Any = {"linewidth": 1.6}
EXPERIMENT_NAME, MEAN_NAME, BAND_NAME, CELL_NAME = "experiment", "mean", "interval", "cell"


def interval_of_mean(values: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mean over the first axis, and the 95 % interval of Student's t; NaN where fewer than two are known.

    Parameters
    ----------
    values : ndarray of shape (N, …) and dtype float
        One row an experiment.

    Returns
    -------
    (ndarray, ndarray, ndarray)
        Mean, low, high, each of shape (…).
    """
    table = np.asarray(values, dtype=np.float64)
    known = np.isfinite(table)
    count = known.sum(axis=0)
    filled = np.where(known, table, 0.0)
    mean = np.divide(filled.sum(axis=0), count, out=np.full(count.shape, np.nan), where=count > 0)
    squares = np.where(known, np.square(table - mean), 0.0).sum(axis=0)
    enough = count > 1
    degrees = np.where(enough, count - 1, 1)
    half = stdtrit(degrees, 0.5 + LEVEL / 2.0) * np.sqrt(squares / degrees / np.maximum(count, 1))
    half = np.where(enough, half, np.nan)
    return mean, mean - half, mean + half


def draw_experiment_lines(
    ax: Axes,
    x: FloatArray,
    values: FloatArray,
    colour: str,
    *,
    label: str = "",
    mark: str = "",
    thin: bool = True,
) -> Line2D:
    """A thin line an experiment, a thick one for their mean, and a band for its interval.

    Parameters
    ----------
    ax : Axes
    x : ndarray of shape (P,) and dtype float
    values : ndarray of shape (N, P) and dtype float
        One row an experiment.
    colour : str
    label : str
        Of the mean.
    mark : str
        Of the points of the mean.
    thin : bool
        Draw the lines of experiments.

    Returns
    -------
    Line2D
        The mean.
    """
    mean, low, high = interval_of_mean(values)
    if np.isfinite(low).any():
        band = ax.fill_between(x, low, high, color=colour, alpha=BAND_OPACITY, linewidth=0, zorder=1.5)
        band.set_gid(BAND_NAME)
    if thin and len(values) > 1:
        for line in ax.plot(x, values.T, color=colour, zorder=2.0, **EXPERIMENT_LOOK):
            line.set_gid(EXPERIMENT_NAME)
    (line,) = ax.plot(
        x, mean, color=colour, label=label, marker=mark or None, markersize=3.0, zorder=3.0, **MEAN_LOOK
    )
    line.set_gid(MEAN_NAME)
    return line


def fit_to_lines(axes: Sequence[Axes], share: float) -> None:
    """Fit axes to their lines of means and experiments, and to bands as far as they do not dwarf these.

    Parameters
    ----------
    axes : sequence of Axes
        All get the same limits.
    share : float
        How far bands may reach beyond the lines, over the range of these.
    """
    names = (EXPERIMENT_NAME, MEAN_NAME)
    shown = [
        np.asarray(line.get_ydata(), dtype=np.float64)
        for ax in axes
        for line in ax.lines
        if line.get_gid() in names
    ]
    values = np.concatenate([np.empty(0), *shown])
    values = values[np.isfinite(values)]
    if not values.size:
        return
    low, high = float(values.min()), float(values.max())
    room = share * ((high - low) or max(abs(high), 1.0))
    bottom, top = min(ax.get_ylim()[0] for ax in axes), max(ax.get_ylim()[1] for ax in axes)
    for ax in axes:
        ax.set_ylim(max(bottom, low - room), min(top, high + room))


def mean_by_experiment(values: FloatArray, experiments: Any) -> tuple[list[str], FloatArray]:
    """Mean of the cells of each experiment, NaN left out.

    Parameters
    ----------
    values : ndarray of shape (cells, …) and dtype float
    experiments : array_like of shape (cells,)

    Returns
    -------
    (list of str, ndarray of shape (experiments, …))
    """
    names = np.asarray(experiments).astype(str)
    order = list(dict.fromkeys(names.tolist()))
    means = []
    for name in order:
        own = np.asarray(values, dtype=np.float64)[names == name]
        known = np.isfinite(own)
        count = known.sum(axis=0)
        total = np.where(known, own, 0.0).sum(axis=0)
        means.append(np.divide(total, count, out=np.full(np.shape(count), np.nan), where=count > 0))
    return order, np.stack(means)

"""Draw directions of cells on the circle: a rose, a dot a cell, and resultants as arrows."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.patches import Wedge

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.cell.disk_axes import frame_disk
from cytodisk.plot.population.experiment_lines import mean_by_experiment
from cytodisk.plot.style import LINE_COLOUR

DOTS_NAME, ROSE_NAME, EXPERIMENT_NAME, MEAN_NAME, WORDS_NAME = "cells", "rose", "experiment", "mean", "words"

_BINS = 24
_RIM, _STEP = 0.95, 0.045  # radius of the dots, and from one to the next that has the same direction
_ALIKE = 4.0  # degrees within which dots are stacked
_MOST_STACKED = 12
FEWEST_IN_ROSE = 12
"""Cells of a condition with fewer of which a rose says nothing."""

MOST_DOTS = 300
"""Cells of a condition that get a dot; more are a rose alone."""


def draw_directions(
    ax: Axes, degrees: Any, *, experiments: Any = None, color: str = "#0072B2"
) -> PathCollection:
    """Draw directions in the disk, from 0° on the right clockwise, as angles of the disk are.

    The area of a wedge is a share of the cells. An arrow that reaches the circle has resultant length 1: all
    cells have that direction; the thick one is the mean of experiments, thin ones are experiments.

    Parameters
    ----------
    ax : Axes
    degrees : array_like of shape (cells,)
        NaN: the cell has no direction.
    experiments : array_like of shape (cells,), optional
        Without it all cells are one.
    color : str

    Returns
    -------
    PathCollection
        The dots, one a cell with a direction; none of more than 300 cells, where they would hide the rose.
        Arrows have the gids "experiment" and "mean".

    Raises
    ------
    ParameterError
        It is not one number a cell, or the experiments are not as many.

    See Also
    --------
    draw_atlas : What the cells look like once they are turned by it.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> dots = cd.plot.draw_directions(ax, np.random.default_rng(0).normal(90.0, 20.0, 40))
    >>> len(dots.get_offsets())
    40
    """
    given = np.asarray(degrees, dtype=np.float64)
    names = np.zeros(len(given), dtype=np.int64) if experiments is None else np.asarray(experiments)
    if given.ndim != 1 or names.shape != given.shape:
        raise ParameterError(
            f"degrees must be one number a cell, got shape {given.shape} and experiments of {names.shape}: "
            "pass a column of each"
        )
    known = np.isfinite(given)
    angles, names = np.radians(given[known]), names[known]
    if len(angles) >= FEWEST_IN_ROSE:
        _draw_rose(ax, angles, color)
    dotted = angles if len(angles) <= MOST_DOTS else angles[:0]
    drawn = ax.scatter(*_stacked(dotted), s=3.5, color=color, linewidths=0, zorder=3.0)
    drawn.set_gid(DOTS_NAME)
    frame_disk(ax)
    words = f"{len(angles)} cells" if len(angles) != 1 else "1 cell"
    if len(angles):
        rays = np.column_stack([np.cos(angles), np.sin(angles)])
        order, means = mean_by_experiment(rays, names)
        if len(order) > 1:
            for mean in means:
                _arrow(ax, mean, EXPERIMENT_NAME, {"color": "0.45", "linewidth": 0.7})
        whole = means.mean(axis=0)
        _arrow(ax, whole, MEAN_NAME, {"color": LINE_COLOUR, "linewidth": 1.6})
        several = f", {len(order)} experiments" if len(order) > 1 else ""
        words = f"resultant length {np.hypot(*whole):.2f}\n{words}{several}"
    if missing := int((~known).sum()):
        words += f"\n{missing} without a direction"
    ax.annotate(
        words,
        (0.5, 0.0),
        xycoords="axes fraction",
        xytext=(0, -4),
        textcoords="offset points",
        ha="center",
        va="top",
        annotation_clip=False,
        gid=WORDS_NAME,
    )
    return drawn


def _draw_rose(ax: Axes, angles: FloatArray, color: str) -> None:
    step = 360.0 / _BINS
    counts = np.histogram(np.degrees(angles) % 360.0, np.linspace(0.0, 360.0, _BINS + 1))[0]
    for number, count in enumerate(counts.tolist()):
        if count:
            radius = 0.85 * np.sqrt(count / counts.max())
            wedge = Wedge((0.0, 0.0), radius, number * step, (number + 1) * step, gid=ROSE_NAME)
            wedge.set(facecolor=color, alpha=0.3, linewidth=0.4, edgecolor="white", zorder=1.0)
            ax.add_patch(wedge)


def _stacked(angles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places of dots: on the rim, further in where others have nearly the same direction."""
    bins = np.floor(np.degrees(angles) % 360.0 / _ALIKE).astype(np.int64)
    height = np.zeros(len(angles))
    seen: dict[int, int] = {}
    for place, number in enumerate(bins.tolist()):
        height[place] = min(seen.get(number, 0), _MOST_STACKED)
        seen[number] = seen.get(number, 0) + 1
    radius = _RIM - _STEP * height
    return radius * np.cos(angles), radius * np.sin(angles)


def _arrow(ax: Axes, end: FloatArray, name: str, style: dict[str, Any]) -> None:
    arrow = ax.annotate(
        "",
        (float(end[0]), float(end[1])),
        xytext=(0.0, 0.0),
        arrowprops={"arrowstyle": "-|>", "shrinkA": 0.0, "shrinkB": 0.0, "mutation_scale": 6.0} | style,
        zorder=4.0,
    )
    arrow.set_gid(name)

"""Draw a scalar of cells with the means of experiments over it: a SuperPlot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.number_words import rounded
from cytodisk.plot.population.condition_looks import Look, are_shared, checked_units, experiment_looks
from cytodisk.plot.population.experiment_key import in_order, mean_look
from cytodisk.plot.population.experiment_lines import interval_of_mean
from cytodisk.plot.style import LINE_COLOUR, plain_numbers
from cytodisk.plot.time_axis import TICK_STEPS

CELLS_NAME, EXPERIMENT_NAME, PAIR_NAME, MEAN_NAME, TEST_NAME = "cells", "experiment", "pair", "mean", "test"

_WIDEST = 0.27  # of the swarm of cells, in steps from condition to condition
_APART, _FURTHEST = 0.045, 0.16  # of the means of experiments, and the outermost of them
_MEAN_AT = 0.38  # of mean and interval, beside the swarm
_MARGIN = 0.06  # of the range of the cells
_BINS = 24
_MOST_CELLS = 1500  # of a condition that get a dot
_GOLDEN = 0.6180339887


def draw_super_plot(
    ax: Axes,
    cells: pd.DataFrame,
    scalar: str,
    *,
    conditions: Sequence[str] | None = None,
    tests: pd.DataFrame | None = None,
    label: str = "",
    paired: bool | None = None,
) -> list[PathCollection]:
    """Draw a scalar by condition: cells small, means of experiments large, beside them mean and interval.

    Parameters
    ----------
    ax : Axes
    cells : DataFrame
        condition, experiment and the scalar: a row for each cell.
    scalar : str
        Name of its column.
    conditions : sequence of str, optional
        From left to right, the control first; by default in the order of the table.
    tests : DataFrame, optional
        A row for each condition that was compared with the first: condition, p, effect_size, low and high,
        the interval of the effect size. They are written above.
    label : str
        Of the upright axis, with the unit; by default the name of the scalar.
    paired : bool, optional
        Whether an experiment of two conditions is one, whose means are joined; by default where names of
        experiments are those of several conditions.

    Returns
    -------
    list of PathCollection
        The dots of the cells, one a condition. The mean of an experiment has the gid "experiment", a line
        between the two means of an experiment "pair", mean and interval of a condition "mean".

    Raises
    ------
    ParameterError
        A column is missing, or there is no row.

    See Also
    --------
    draw_effect_sizes : Many scalars at once.
    experiment_key : Says which mark is which experiment.

    References
    ----------
    Lord et al. 2020, doi:10.1083/jcb.202001064.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> cells = pd.DataFrame(
    ...     {
    ...         "condition": np.repeat(["control", "drug"], 30),
    ...         "experiment": np.tile(["day 1", "day 2", "day 3"], 20),
    ...         "polarity": np.random.default_rng(0).normal(1.0, 0.2, 60),
    ...     }
    ... )
    >>> figure, ax = plt.subplots()
    >>> dots = cd.plot.draw_super_plot(ax, cells, "polarity")
    >>> [len(one.get_offsets()) for one in dots]
    [30, 30]
    """
    rows = checked_units(cells, "cells", (scalar,))
    names = list(dict.fromkeys(rows["condition"])) if conditions is None else [str(one) for one in conditions]
    shared = are_shared(rows) if paired is None else paired
    looks = experiment_looks(in_order(rows, names), shared=shared)
    dots, means = [], {}
    for place, name in enumerate(names):
        own = rows[rows["condition"] == name]
        dots.append(_draw_cells(ax, place, own, scalar, looks))
        means[name] = own.groupby("experiment", sort=False, observed=True)[scalar].mean().dropna()
    beside = _places(means, shared)
    if shared:
        _join(ax, [means[name] for name in names], [beside[name] for name in names])
    for place, name in enumerate(names):
        _draw_means(ax, place, means[name], beside[name], {e: looks[name, str(e)] for e in means[name].index})
    ax.set_xticks(range(len(names)), names, parse_math=False)
    ax.set_xlim(-0.5, len(names) - 0.45)
    ax.tick_params(axis="x", length=0)
    ax.set_ylabel(label or scalar, parse_math=False)
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    ax.yaxis.set_major_formatter(plain_numbers())
    _fit(ax, dots)
    if tests is not None:
        _write_tests(ax, names, tests)
    return dots


def p_words(p: float) -> str:
    """A p value as "p = 0.031"; "no p" where it is unknown."""
    return f"p = {rounded(p, 2)}" if np.isfinite(p) else "no p"


def _draw_cells(
    ax: Axes, place: int, own: pd.DataFrame, scalar: str, looks: Mapping[tuple[str, str], Look]
) -> PathCollection:
    known = own[np.isfinite(own[scalar].to_numpy(dtype=np.float64))]
    if len(known) > _MOST_CELLS:  # evenly by rank, so that the shape of the swarm is kept
        chosen = np.linspace(0, len(known) - 1, _MOST_CELLS).round().astype(np.int64)
        known = known.sort_values(scalar, kind="stable").iloc[chosen]
    values = known[scalar].to_numpy(dtype=np.float64)
    units = zip(known["condition"], known["experiment"], strict=True)
    drawn = ax.scatter(
        place + spread_beside(values, _WIDEST),
        values,
        s=2.0 if len(values) > 200 else 4.0,
        c=[looks[unit].colour for unit in units] or None,
        alpha=0.4,
        linewidths=0,
        zorder=1.5,
        rasterized=len(values) > _MOST_CELLS // 2,
    )
    drawn.set_gid(CELLS_NAME)
    return drawn


def spread_beside(values: FloatArray, widest: float) -> FloatArray:
    """How far each dot lies to the side, at most `widest`: further where many values are alike."""
    if not len(values):
        return values
    edges = np.linspace(values.min(), values.max() + 1e-12, _BINS + 1)
    counts = np.convolve(np.histogram(values, edges)[0], [0.25, 0.5, 0.25], mode="same")
    density = np.interp(values, 0.5 * (edges[1:] + edges[:-1]), counts / max(counts.max(), 1e-12))
    rank = np.argsort(np.argsort(values, kind="stable"), kind="stable")
    return np.asarray((rank * _GOLDEN % 1.0 - 0.5) * 2.0 * widest * np.maximum(density, 0.15))


def _places(means: Mapping[str, pd.Series], shared: bool) -> dict[str, dict[str, float]]:
    """How far the mean of each experiment lies to the side, by condition; the same in all if shared."""
    every = list(dict.fromkeys(str(one) for series in means.values() for one in series.index))
    places = {}
    for name, series in means.items():
        order = every if shared else [str(one) for one in series.index]
        step = min(_APART, 2.0 * _FURTHEST / max(len(order) - 1, 1))
        places[name] = {one: step * (k - 0.5 * (len(order) - 1)) for k, one in enumerate(order)}
    return places


def _draw_means(
    ax: Axes, place: int, means: pd.Series, beside: Mapping[str, float], looks: Mapping[Any, Look]
) -> None:
    for experiment, value in means.items():
        if not experiment:  # all that is known is that they are cells
            continue
        look, x = looks[experiment], place + beside[str(experiment)]
        (mark,) = ax.plot([x], [value], linewidth=0, zorder=4.0, **mean_look(look, 5.5))
        mark.set_gid(EXPERIMENT_NAME)
    if means.empty:
        return
    mean, low, high = (float(one) for one in interval_of_mean(means.to_numpy(dtype=np.float64)))
    at = place + _MEAN_AT
    if np.isfinite(low):
        ax.plot([at, at], [low, high], color=LINE_COLOUR, linewidth=0.9, gid=MEAN_NAME, zorder=3.0)
    ax.plot([at - 0.07, at + 0.07], [mean, mean], color=LINE_COLOUR, linewidth=1.4, gid=MEAN_NAME, zorder=3.0)


def _join(ax: Axes, means: Sequence[pd.Series], beside: Sequence[Mapping[str, float]]) -> None:
    """A line between the means of an experiment in conditions beside each other."""
    for place in range(len(means) - 1):
        for experiment in means[place].index.intersection(means[place + 1].index):
            ends = [float(means[place + k][experiment]) for k in (0, 1)]
            x = [place + k + beside[place + k][str(experiment)] for k in (0, 1)]
            ax.plot(x, ends, color="0.45", linewidth=0.6, zorder=2.0, gid=PAIR_NAME)


def _fit(ax: Axes, dots: Sequence[PathCollection]) -> None:
    """Fit the axes to the cells: the interval of two experiments can be many times as long."""
    values = np.concatenate([np.asarray(one.get_offsets())[:, 1] for one in dots])
    if len(values):
        room = _MARGIN * float(np.ptp(values)) or 0.5 * max(abs(float(values[0])), 1.0)
        ax.set_ylim(float(values.min()) - room, float(values.max()) + room)


def _write_tests(ax: Axes, names: Sequence[str], tests: pd.DataFrame) -> None:
    rows = tests.set_index(tests["condition"].astype(str))
    for place, name in enumerate(names):
        if name not in rows.index:
            continue
        row = rows.loc[name].to_dict()
        words = _test_words(row, " " if len(names) == 2 else "\n")
        ax.annotate(
            words,
            (0.5 if len(names) == 2 else place, 1.0),
            xycoords=ax.get_xaxis_transform(),
            xytext=(0, 3),
            textcoords="offset points",
            ha="center",
            va="bottom",
            linespacing=1.1,
            annotation_clip=False,
            gid=TEST_NAME,
        )


def _test_words(row: Mapping[Any, Any], between: str) -> str:
    """p, and the effect size with its interval as far as they are known."""
    words = p_words(float(row["p"]))
    effect, low, high = (float(row[name]) for name in ("effect_size", "low", "high"))
    if np.isfinite(effect):
        words += f"\ng = {rounded(effect, 2)}"
    if np.isfinite(low) and np.isfinite(high):
        words += f"{between}[{rounded(low, 2)}, {rounded(high, 2)}]"
    return words.replace("-", "−")

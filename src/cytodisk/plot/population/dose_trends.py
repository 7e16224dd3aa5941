"""Draw a scalar over the dose: cells, means of experiments, and the line of the trend with its band."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, TypeAlias

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.number_words import rounded
from cytodisk.plot.population.condition_looks import Look, checked_units
from cytodisk.plot.population.dose_trend_key import BAND_STYLE, TREND_STYLE, dose_looks
from cytodisk.plot.population.experiment_key import mean_look
from cytodisk.plot.population.super_plot import p_words, spread_beside
from cytodisk.plot.style import plain_numbers
from cytodisk.plot.time_axis import TICK_STEPS

CELLS_NAME, EXPERIMENT_NAME, PAIR_NAME = "cells", "experiment", "pair"
TREND_NAME, BAND_NAME, TEST_NAME = "trend", "band", "test"

STEPS = {"rank": "step", "linear": "unit", "log": "factor of 10"}
"""What the slope of a trend is for, by the scale of the dose."""

_SHARE, _LEAST = 0.16, 0.012  # of the least distance of doses, or of all, that cells fill to both sides
_MOST_TICKS = 8
_MOST_CELLS = 1500  # of a dose that get a dot
_LONGEST = 28  # of a line above the axes
_MARGIN = 0.06  # of the range of the cells

DoseScale: TypeAlias = Literal["rank", "linear", "log"]


def draw_dose_trend(
    ax: Axes,
    cells: pd.DataFrame,
    scalar: str,
    dose: str = "dose",
    *,
    scale: DoseScale = "rank",
    trend: Mapping[Any, Any] | None = None,
    label: str = "",
) -> list[PathCollection]:
    """Draw a scalar over the dose: cells small, experiments large, the line of the trend with its band.

    Parameters
    ----------
    ax : Axes
    cells : DataFrame
        condition, experiment, the dose and the scalar: a row for each cell.
    scalar, dose : str
        Names of their columns.
    scale : {"rank", "linear", "log"}
        How far doses lie apart, as it was tested. "rank": each a step from the next lower one. "linear": as
        they are. "log": by factors of 10.
    trend : mapping, optional
        slope, slope_low, slope_high and p, or p_fwer, of a trend over the dose on this scale, as a row of
        the table `scalar_trends`. Its line is drawn with its 95 % band, and p is written above.
    label : str
        Of the upright axis, with the unit; by default the name of the scalar.

    Returns
    -------
    list of PathCollection
        The dots of the cells, one a dose. The mean of an experiment at a dose has the gid "experiment", the
        line through the means of one experiment "pair", the line of the trend "trend", its band "band".

    Raises
    ------
    ParameterError
        A column is missing, no cell has a dose and a value, or a dose has no logarithm.

    See Also
    --------
    draw_super_plot : A scalar by condition.
    dose_trend_key : Says which mark is which experiment.
    dose_trend : Tests the trend.

    Notes
    -----
    The band is that of the line of least squares through the means of experiments, whose slope has the
    given interval. Where an experiment has several doses, the line is that within experiments: it goes
    through their common mean, and differences between experiments are not in the band.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> cells = pd.DataFrame(
    ...     {
    ...         "condition": np.repeat(["control", "drug"], 6),
    ...         "experiment": np.tile(["day 1", "day 2", "day 3"], 4),
    ...         "dose": np.repeat([0.0, 10.0], 6),
    ...         "polarity": np.linspace(1.0, 2.0, 12),
    ...     }
    ... )
    >>> figure, ax = plt.subplots()
    >>> trend = {"slope": 0.5, "slope_low": 0.3, "slope_high": 0.7, "p": 0.04}
    >>> dots = cd.plot.draw_dose_trend(ax, cells, "polarity", trend=trend)
    >>> [len(one.get_offsets()) for one in dots]
    [6, 6]
    """
    rows = _known(cells, scalar, dose)
    levels, level = np.unique(rows[dose].to_numpy(np.float64), return_inverse=True)
    at = _places(levels, scale)
    reach = float(np.ptp(at)) or 1.0
    apart = max(_SHARE * float(np.diff(at).min(initial=reach)), _LEAST * reach)
    dots = [_draw_cells(ax, at[k], rows.loc[level == k, scalar], apart) for k in range(len(levels))]
    known = rows.assign(x=at[level])[(rows["experiment"] != "").to_numpy()]
    units = known.groupby(["experiment", "x"], sort=False)[scalar].mean().reset_index(name="y")
    _draw_units(ax, units, dose_looks(rows, dose))
    _fit(ax, rows[scalar].to_numpy(np.float64))
    ax.set_xlim(at[0] - 2.2 * apart, at[-1] + 2.2 * apart)
    if trend is not None and len(units):
        _draw_trend(ax, units, trend)
    if trend is not None:
        _write_test(ax, trend, scale)
    _set_ticks(ax, levels, at, scale)
    ax.set_xlabel(dose_label(dose, scale), parse_math=False)
    ax.set_ylabel(label or scalar, parse_math=False)
    return dots


def dose_label(dose: str, scale: DoseScale) -> str:
    """Label of the axis of doses: the name of their column, and how far they lie apart."""
    return dose + {"rank": " (even steps)", "linear": "", "log": " (logarithmic)"}[scale]


def _known(cells: pd.DataFrame, scalar: str, dose: str) -> pd.DataFrame:
    """Cells that have a dose and a value, both as numbers."""
    rows = checked_units(cells.assign(condition=""), "cells", (dose, scalar))
    numbers = {name: pd.to_numeric(rows[name].astype(object), errors="coerce") for name in (dose, scalar)}
    rows = rows.assign(**numbers)
    known: pd.DataFrame = rows[np.isfinite(rows[[dose, scalar]].to_numpy(np.float64)).all(axis=1)]
    if known.empty:
        raise ParameterError(
            f"cells has no row with numbers in {dose!r} and {scalar!r}: pass a table with the dose of each "
            "cell"
        )
    return known


def _places(levels: FloatArray, scale: DoseScale) -> FloatArray:
    """Where doses lie on the axis, as the trend counts them."""
    if scale == "rank":
        return np.arange(1.0, len(levels) + 1.0)
    if scale == "linear":
        return levels
    if levels[0] <= 0:
        raise ParameterError(f"a dose of {levels[0]:g} has no logarithm: pass scale='rank'")
    return np.asarray(np.log10(levels))


def _draw_cells(ax: Axes, place: float, values: pd.Series, apart: float) -> PathCollection:
    own = np.sort(values.to_numpy(np.float64))
    if len(own) > _MOST_CELLS:
        own = own[np.linspace(0, len(own) - 1, _MOST_CELLS).round().astype(np.int64)]
    drawn = ax.scatter(
        place + spread_beside(own, apart),
        own,
        s=2.0 if len(own) > 200 else 4.0,
        color="0.6",
        linewidths=0,
        zorder=1.5,
        rasterized=len(own) > _MOST_CELLS // 2,
    )
    drawn.set_gid(CELLS_NAME)
    return drawn


def _draw_units(ax: Axes, units: pd.DataFrame, looks: Mapping[str, Look]) -> None:
    for name, own in units.groupby("experiment", sort=False):
        in_order = own.sort_values("x")
        if len(in_order) > 1:
            ax.plot(in_order["x"], in_order["y"], color="0.45", linewidth=0.6, zorder=2.0, gid=PAIR_NAME)
        style = mean_look(looks[str(name)], 5.0)
        ax.plot(in_order["x"], in_order["y"], linewidth=0, zorder=4.0, gid=EXPERIMENT_NAME, **style)


def _draw_trend(ax: Axes, units: pd.DataFrame, trend: Mapping[Any, Any]) -> None:
    """The line through the common mean; the band's half width at a dose follows from that of the slope."""
    slope, high = (float(trend[name]) for name in ("slope", "slope_high"))
    if not np.isfinite(slope):
        return
    x, y = (units[name].to_numpy(np.float64) for name in ("x", "y"))
    several = bool(units["experiment"].duplicated().any())
    within = x - units.groupby("experiment")["x"].transform("mean").to_numpy() if several else x - x.mean()
    ends = np.linspace(x.min(), x.max(), 101)
    line = y.mean() + slope * (ends - x.mean())
    ax.plot(ends, line, zorder=3.0, gid=TREND_NAME, **TREND_STYLE)
    if np.isfinite(high):
        half = (high - slope) * np.sqrt((within**2).mean() + (ends - x.mean()) ** 2)
        ax.fill_between(ends, line - half, line + half, zorder=1.0, gid=BAND_NAME, **BAND_STYLE)


def _write_test(ax: Axes, trend: Mapping[Any, Any], scale: DoseScale) -> None:
    p = next((float(trend[name]) for name in ("p_fwer", "p") if name in trend), np.nan)
    words = p_words(p)
    slope, low, high = (float(trend[name]) for name in ("slope", "slope_low", "slope_high"))
    if np.isfinite(slope):
        words += f"\n{_signed(slope)} per {STEPS[scale]}"
    if np.isfinite(low) and np.isfinite(high):
        interval = f"[{_signed(low)}, {_signed(high)}]"
        last = words.rpartition("\n")[2]
        words += (" " if len(last) + len(interval) < _LONGEST else "\n") + interval
    ax.annotate(
        words,
        (0.5, 1.0),
        xycoords="axes fraction",
        xytext=(0, 3),
        textcoords="offset points",
        ha="center",
        va="bottom",
        linespacing=1.1,
        annotation_clip=False,
        gid=TEST_NAME,
    )


def _signed(number: float) -> str:
    return rounded(number, 2).replace("-", "−")


def _fit(ax: Axes, values: FloatArray) -> None:
    room = _MARGIN * float(np.ptp(values)) or 0.5 * max(abs(float(values[0])), 1.0)
    ax.set_ylim(float(values.min()) - room, float(values.max()) + room)
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    ax.yaxis.set_major_formatter(plain_numbers())


def _set_ticks(ax: Axes, levels: FloatArray, at: FloatArray, scale: DoseScale) -> None:
    if scale == "linear":
        ax.xaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
        ax.xaxis.set_major_formatter(plain_numbers())
        return
    kept = [0]
    for k in range(1, len(at)):
        if at[k] - at[kept[-1]] >= np.ptp(at) / _MOST_TICKS:
            kept.append(k)
    ax.set_xticks(at[kept], [f"{levels[k]:g}" for k in kept])

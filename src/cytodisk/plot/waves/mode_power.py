"""Draw how strong waves of each number around the cell are, beside what chance gives."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.container import BarContainer

from cytodisk.errors import ParameterError
from cytodisk.plot.style import CHANCE_COLOUR, CHANCE_LINE, LINE_COLOUR

CHANCE_NAME = "chance"

_COLUMNS = {"mode", "power"}
_BAR, _BAND = 0.62, 0.9  # widths, in modes
_QUIET = "0.72"
_CHOSEN = "#0072B2"


def draw_mode_power(ax: Axes, modes: pd.DataFrame, *, chosen: int | None = None) -> BarContainer:
    """Draw the share of power of each mode as bars, with what 95 % of the surrogates stay below behind them.

    Parameters
    ----------
    ax : Axes
    modes : DataFrame
        Rows of one cell and layer of a study's `waves.modes`: mode, the number of waves around the cell, and
        power, its share; threshold, what chance gives, where it is known.
    chosen : int, optional
        The mode that the wave is said to have: its bar is dark.

    Returns
    -------
    BarContainer

    Raises
    ------
    ParameterError
        The table lacks a column, or has no rows.

    See Also
    --------
    draw_wave_spectrum : By frequency and direction too.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> modes = pd.DataFrame({"mode": [0, 1, 2], "power": [0.2, 0.7, 0.1], "threshold": [0.4, 0.5, 0.3]})
    >>> figure, ax = plt.subplots()
    >>> bars = cd.plot.draw_mode_power(ax, modes, chosen=1)
    >>> len(bars)
    3
    """
    rows = wave_rows(modes, "modes", _COLUMNS).sort_values("mode")
    numbers = rows["mode"].to_numpy(dtype=np.float64)
    if "threshold" in rows:
        _draw_chance(ax, numbers, rows["threshold"].to_numpy(dtype=np.float64))
    colours = [_CHOSEN if number == chosen else _QUIET for number in numbers]
    bars = ax.bar(numbers, rows["power"], _BAR, color=colours, edgecolor=LINE_COLOUR, linewidth=0.4, zorder=2)
    ax.set(xlabel="waves around the cell (mode)", ylabel="share of power")
    ax.set_xticks(numbers, labels=[f"{number:.0f}" for number in numbers])
    ax.set_xlim(numbers.min() - 0.6, numbers.max() + 0.6)
    ax.set_ylim(0.0, None)
    return bars


def _draw_chance(ax: Axes, numbers: Any, threshold: Any) -> None:
    """Grey bands up to what chance reaches, one a mode."""
    known = np.isfinite(threshold)
    look: Any = {"color": CHANCE_COLOUR, "edgecolor": CHANCE_LINE, "linewidth": 0.4, "zorder": 1}
    band = ax.bar(numbers[known], threshold[known], _BAND, **look)
    band.set_label(CHANCE_NAME)


def wave_rows(table: Any, name: str, columns: set[str]) -> pd.DataFrame:
    """A table of waves of one cell and layer, checked.

    Parameters
    ----------
    table : DataFrame
    name : str
        Name of the argument, for the error.
    columns : set of str
        That it must have.

    Raises
    ------
    ParameterError
        It is no table, lacks a column, has no rows, or those of several cells or layers.
    """
    if not isinstance(table, pd.DataFrame):
        raise ParameterError(f"{name} must be a table of a study's waves, got {type(table).__name__}")
    if missing := sorted(columns - set(table.columns)):
        raise ParameterError(f"{name} lacks the columns {', '.join(missing)}: pass a table of waves")
    if table.empty:
        raise ParameterError(f"{name} has no rows: pass those of a cell and layer with waves")
    for key in {"cell", "layer"} & set(table.columns):
        there = table[key].dropna().unique()
        if len(there) > 1 and key not in columns:
            raise ParameterError(f"{name} has rows of {len(there)} {key}s: pass those of one {key}")
    return table

"""Draw the coefficients of a source's past by lag."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.container import ErrorbarContainer
from matplotlib.ticker import FuncFormatter, MaxNLocator

from cytodisk.plot.correlation.lag_axis import LagUnit, signed
from cytodisk.plot.prediction.link_looks import of_pair, rows_of
from cytodisk.plot.time_axis import TICK_STEPS

_COLUMNS = {"lag", "coefficient", "low", "high"}
_LEAST_REACH = 0.1  # of the axis, so that noise alone does not fill it


def draw_lag_coefficients(
    ax: Axes,
    lags: pd.DataFrame,
    pair: tuple[str, str],
    layer: int,
    *,
    cell: int = 0,
    colour: str = "0.15",
    sure: bool = True,
    reach: float | None = None,
) -> ErrorbarContainer | None:
    """Draw how much of a source, so many frames earlier, goes into a target.

    Parameters
    ----------
    ax : Axes
    lags : DataFrame
        `lags` of a study's prediction: cell, source, target, layer, lag, coefficient, low and high; lag_s
        where the frame interval is known.
    pair : (str, str)
        Source and target.
    layer : int
    cell : int
    colour : str
    sure : bool
        Points are full; else open, as of a link that chance would give.
    reach : float, optional
        The axis goes as far up and down.

    Returns
    -------
    ErrorbarContainer or None
        Bars are 95 % intervals. None where the model has no past of the source.

    Raises
    ------
    ParameterError
        The table lacks columns, the cell or the pair.

    See Also
    --------
    draw_gain_profile : How much the past of the source tells in all.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> series = cd.simulate.predicting_series("white", 0, 80, 1, 6, strength=0.5)
    >>> found = cd.predict(series["source"], series["target"], surrogates=0)
    >>> names = {"coefficient_low": "low", "coefficient_high": "high"}
    >>> table = found[["coefficient", *names]].rename(names).to_dataframe().reset_index().dropna()
    >>> table = table.assign(cell=0, source="Rac1", target="velocity")
    >>> figure, ax = plt.subplots()
    >>> bars = cd.plot.draw_lag_coefficients(ax, table, ("Rac1", "velocity"), layer=0)
    """
    rows = rows_of(lags, cell, _COLUMNS, "lags")
    unit = LagUnit.of(rows)
    of_links = of_pair(rows, pair)
    shown = unit.shown(of_links[of_links["layer"] == layer].sort_values("lag"))
    ax.axhline(0.0, color="0.6", linewidth=0.4, zorder=0.5)
    far = float(rows["lag"].max())
    step = float(unit.shown(rows)[unit.column].max()) / far
    ax.set_xlim(0.0, step * (far + 0.6))
    ax.xaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS, integer=unit.unit == "frames"))
    largest = reach if reach is not None else coefficient_reach(of_links)
    ax.set_ylim(-largest, largest)
    ax.yaxis.set_major_locator(MaxNLocator(4, steps=TICK_STEPS, symmetric=True))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: signed(value, "g")))
    ax.set_xlabel(f"source earlier by ({unit.unit})")
    if shown.empty:
        return None
    place, middle, low, high = (
        shown[name].to_numpy(dtype=np.float64) for name in (unit.column, "coefficient", "low", "high")
    )
    look: Any = {"marker": "o", "markersize": 3.5, "markerfacecolor": colour if sure else "white"}
    return ax.errorbar(
        place, middle, [middle - low, high - middle], color=colour, linewidth=0.9, elinewidth=0.8, **look
    )


def coefficient_reach(rows: pd.DataFrame) -> float:
    """How far an axis must go for these rows of a table of lags."""
    largest = rows[["low", "high"]].abs().to_numpy(dtype=np.float64)
    return max(1.08 * float(np.nanmax(largest, initial=0.0)), _LEAST_REACH)

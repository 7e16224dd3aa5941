"""Draw the correlation of all pairs of windows by their distance and the lag."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.lag_axis import LagUnit, rows_of_cell
from cytodisk.plot.outlines import outline_sides
from cytodisk.plot.style import CHANCE_COLOUR, CHANCE_LINE, DIVERGING_COLOURS, LINE_COLOUR, colour_map
from cytodisk.plot.time_axis import TICK_STEPS

LAG_0_COLOUR, PEAK_COLOUR = "#0072B2", "#D55E00"
OUTLINE_NAME = "beyond chance"

_FEWEST = 0.5  # pairs in a bin that is drawn, over the windows: fewer are noise, mostly the farthest
_APART, _WIDTH = -0.15, 0.05  # of the longest distance: place and width of the bin at distance 0
_LEFT = -0.2
_ROOM = 1.08  # of the correlation's axis over what it holds
_BAND_OPACITY = 0.2
_LEGEND: Any = {"borderaxespad": 0.1, "handlelength": 1.0, "columnspacing": 1.0, "borderpad": 0.2}
_COLUMNS = {"cell", "along", "distance", "lag", "correlation", "lower_quartile", "upper_quartile", "n"}
_KINDS = {
    "straight": "straight distance",
    "interior": "distance inside the cell",
    "edge": "distance along the edge",
}


@dataclass(frozen=True, eq=False)
class PairTable:
    """Correlation of pairs for one kind of distance.

    Attributes
    ----------
    along : str
        Kind of distance.
    distance : ndarray of shape (D,) and dtype float
        Middles of the bins that hold pairs; the first may be 0, of windows paired with themselves.
    lag : ndarray of shape (K,) and dtype float
    correlation, lower, upper : ndarray of shape (D, K) and dtype float
        Mean over pairs, and quartiles.
    threshold : float
        NaN when it was not tested.
    lag_unit : LagUnit
    distance_unit : str
    fewest : int
        Pairs that a bin must hold, half as many as there are windows; others are left out.
    """

    along: str
    distance: FloatArray
    lag: FloatArray
    correlation: FloatArray
    lower: FloatArray
    upper: FloatArray
    threshold: float
    lag_unit: LagUnit
    distance_unit: str
    fewest: int

    @classmethod
    def of(cls, pairs: pd.DataFrame, *, along: str = "straight", cell: int = 0) -> PairTable:
        """Bins with enough pairs of one cell and kind of distance.

        Parameters
        ----------
        pairs : DataFrame
            `pairs` of a study's correlation, with the unit of distances in `attrs["units"]`.
        along : str
        cell : int

        Raises
        ------
        ParameterError
            The table lacks columns, the cell or the kind of distance.
        """
        rows = rows_of_cell(pairs, cell, _COLUMNS, "pairs")
        if along not in set(rows["along"]):
            raise ParameterError(f"along must be one of {sorted(set(rows['along']))}, got {along!r}")
        rows = rows[rows["along"] == along]
        fewest = _fewest(rows)
        rows = rows[(rows["n"] >= fewest) & rows["correlation"].notna()]
        if rows.empty:
            raise ParameterError(f"pairs has no correlation of cell {cell} along {along!r}")
        unit = LagUnit.of(rows)
        names = ("correlation", "lower_quartile", "upper_quartile")
        wide = [rows.pivot(index="distance", columns=unit.column, values=name) for name in names]
        return cls(
            along=along,
            distance=wide[0].index.to_numpy(dtype=np.float64),
            lag=wide[0].columns.to_numpy(dtype=np.float64),
            correlation=wide[0].to_numpy(dtype=np.float64),
            lower=wide[1].to_numpy(dtype=np.float64),
            upper=wide[2].to_numpy(dtype=np.float64),
            threshold=float(rows["threshold"].iloc[0]) if "threshold" in rows else np.nan,
            lag_unit=unit,
            distance_unit=str(pairs.attrs.get("units", {}).get("distance", "")),
            fewest=fewest,
        )

    @property
    def title(self) -> str:
        """What the distance is."""
        return _KINDS.get(self.along, f"distance ({self.along})")

    @property
    def label(self) -> str:
        """Of the axis of distance."""
        return f"{self.title} ({self.distance_unit})" if self.distance_unit else self.title

    @property
    def peak(self) -> int:
        """Index of the lag at which the mean's magnitude is largest, of all distances."""
        place = int(np.nanargmax(np.abs(self.correlation)))
        return place % len(self.lag)

    @property
    def width(self) -> float:
        """Of a bin: the middle of the first above 0 is half of it."""
        above = self.distance[self.distance > 0]
        return 2.0 * float(above[0]) if above.size == 1 else float(np.diff(above).min(initial=np.inf))

    @property
    def longest(self) -> float:
        """End of the last bin."""
        return float(self.distance[-1]) + 0.5 * self.width


def draw_pairs(
    axes: Sequence[Axes],
    pairs: pd.DataFrame,
    *,
    cell: int = 0,
    along: str = "straight",
    limit: float | None = None,
) -> tuple[list[Line2D], AxesImage]:
    """Draw correlation against distance at two lags, and below it against distance and lag.

    Parameters
    ----------
    axes : sequence of two Axes
        Above for the lines, below for the image.
    pairs : DataFrame
        `pairs` of a study's correlation.
    cell : int
    along : str
        Kind of distance: "straight", "interior" or "edge".
    limit : float, optional
        Colours go from -limit to limit; by default the largest |correlation|.

    Returns
    -------
    lines : list of Line2D
        Mean at lag 0, and at the lag of the largest |correlation| where that is another; coloured bands
        are the quartiles over pairs, grey is what the mean stays within, at all distances and lags, in 95 of
        100 surrogates. Distance 0, windows paired with themselves, stands apart on the left.
    image : AxesImage
        Of all distances above 0, its array of shape (lags, distances). What is beyond the grey of the
        lines has an outline, the gid of which is "beyond chance".

    Raises
    ------
    ParameterError
        The table lacks columns, the cell or the kind of distance, the axes are not two, or the limit is not
        a positive number.

    References
    ----------
    u-Unwrap, Fig. S4.
    """
    if len(axes) != 2:
        raise ParameterError(f"axes must be two, got {len(axes)}: for the lines and for the image")
    if limit is not None and not 0.0 < limit < np.inf:
        raise ParameterError(f"limit must be a positive number, got {limit!r}: None chooses it")
    table = PairTable.of(pairs, along=along, cell=cell)
    lines = _draw_lines(axes[0], table)
    image = _draw_image(axes[1], table, limit or float(np.nanmax(np.abs(table.correlation))))
    for ax in axes:
        _distance_axis(ax, table)
    axes[0].tick_params(labelbottom=False)
    axes[1].set_xlabel(table.label)
    return lines, image


def _fewest(rows: pd.DataFrame) -> int:
    """Half as many pairs as there are windows, whose square all pairs are."""
    every = rows.drop_duplicates("distance")["n"].sum()
    return max(1, int(np.ceil(_FEWEST * np.sqrt(float(every)))))


def _draw_lines(ax: Axes, table: PairTable) -> list[Line2D]:
    if np.isfinite(table.threshold):
        low, high = -table.threshold, table.threshold
        ax.axhspan(low, high, facecolor=CHANCE_COLOUR, edgecolor=CHANCE_LINE, linewidth=0.4, zorder=0)
    ax.axhline(0.0, color="0.6", linewidth=0.4, zorder=0.5)
    here, peak = int(np.abs(table.lag).argmin()), table.peak
    lines = [_draw_line(ax, table, here, LAG_0_COLOUR, "lag 0" + (" (largest)" if peak == here else ""))]
    if peak != here:
        name = f"{table.lag_unit.write(table.lag[peak])} (largest)"
        lines.append(_draw_line(ax, table, peak, PEAK_COLOUR, name))
    ax.legend(handles=lines, frameon=False, ncols=2, loc="lower left", bbox_to_anchor=(0.0, 1.0), **_LEGEND)
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    return lines


def _draw_line(ax: Axes, table: PairTable, lag: int, colour: str, name: str) -> Line2D:
    """A line with its band over the distances above 0, and a dot with its bar at 0."""
    apart = table.distance <= 0
    mean, low, high = (values[:, lag] for values in (table.correlation, table.lower, table.upper))
    away = table.distance[~apart]
    ax.fill_between(away, low[~apart], high[~apart], color=colour, alpha=_BAND_OPACITY, linewidth=0)
    (line,) = ax.plot(away, mean[~apart], color=colour, linewidth=1.0, label=name)
    if apart.any():
        x = (_APART + (0.25 if colour == PEAK_COLOUR else -0.25) * _WIDTH) * table.longest
        ax.vlines(x, low[apart], high[apart], color=colour, alpha=2 * _BAND_OPACITY, linewidth=1.6)
        ax.plot([x], mean[apart], "o", color=colour, markersize=2.6)
    return line


def _draw_image(ax: Axes, table: PairTable, limit: float) -> AxesImage:
    apart = table.distance <= 0
    step = float(np.diff(table.lag).min(initial=np.inf)) if len(table.lag) > 1 else 1.0
    down, up = table.lag[0] - 0.5 * step, table.lag[-1] + 0.5 * step
    first = float(table.distance[~apart][0]) - 0.5 * table.width
    places = [(~apart, first, table.longest)]
    if apart.any():
        left, right = ((_APART + side * 0.5 * _WIDTH) * table.longest for side in (-1, 1))
        places.append((apart, left, right))
    drawn = [_draw_block(ax, table, chosen, (left, right, down, up), limit) for chosen, left, right in places]
    ax.axhline(0.0, color="0.35", linewidth=0.5, linestyle=(0, (4, 3)))
    ax.set(ylim=(down, up), ylabel=table.lag_unit.label)
    integer = table.lag_unit.column == "lag"
    ax.yaxis.set_major_locator(MaxNLocator(6, steps=TICK_STEPS, integer=integer))
    return drawn[0]


def _draw_block(
    ax: Axes, table: PairTable, chosen: Any, extent: tuple[float, float, float, float], limit: float
) -> AxesImage:
    """Part of the image, with an outline around what is beyond the threshold."""
    values = table.correlation[chosen].T
    drawn = ax.imshow(
        np.ma.masked_invalid(values),
        cmap=colour_map(DIVERGING_COLOURS),
        vmin=-limit,
        vmax=limit,
        origin="lower",
        aspect="auto",
        extent=extent,
        interpolation="nearest",
    )
    left, right, down, up = extent
    size = np.array([(right - left) / values.shape[1], (up - down) / values.shape[0]])
    sides = outline_sides(np.abs(values) >= table.threshold) * size + np.array([left, down])
    outline = LineCollection(list(sides), colors=LINE_COLOUR, linewidths=0.6, capstyle="round")
    outline.set_gid(OUTLINE_NAME)
    ax.add_collection(outline, autolim=False)
    return drawn


def _distance_axis(ax: Axes, table: PairTable) -> None:
    longest = table.longest
    ticks = [
        tick for tick in MaxNLocator(4, steps=TICK_STEPS).tick_values(0.0, longest) if 0 <= tick <= longest
    ]
    names = [f"{tick:g}" for tick in ticks]
    apart = bool((table.distance <= 0).any())
    if apart:
        word = "sector" if table.along == "edge" else "window"
        ticks, names = [_APART * longest, *ticks], [f"same\n{word}", *names]
    ax.set_xticks(ticks, names)
    ax.set_xlim((_LEFT if apart else 0.0) * longest, longest)

"""Windows of several methods through time (the paper's Fig. 4B to D)."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.files import replacing
from cytodisk.pages.compared_layers import METHOD_STYLES, draw_measure_by_layer, write_method_key
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.activity_maps import shown_layers
from cytodisk.plot.style import (
    DOUBLE_COLUMN_MM,
    DPI,
    SIGNAL_COLOURS,
    colour_bar,
    colour_map,
    paper_style,
    signal_limits,
)
from cytodisk.plot.time_axis import TICK_STEPS, stands_alone, time_axis
from cytodisk.runs.channel_names import file_names, shown_name
from cytodisk.runs.compare_windows.compare_parameters import TITLES
from cytodisk.runs.compare_windows.comparison import Comparison
from cytodisk.store.study_folder import figures_folder

_LEFT, _TOP, _GAP, _BAR = 14.0, 11.0, 3.0, 16.0  # mm
_KEY = "By layer: medians over frames, bands are their quartiles. Through time: mean over layers, no bands."
_LONGEST_LABEL = 28  # letters along a panel's height
_MAP, _MAP_GAP, _PANEL, _PANEL_GAP = 18.0, 2.0, 36.0, 15.0


def write_compared_movie(comparison: Comparison, cell: int, channel: str | None = None) -> Path:
    """Write a page of a cell: activity maps by method, then their consistency by layer and through time.

    Without a signal there are no activity maps, and motion by layer is in the place of the correlation.

    Parameters
    ----------
    comparison : Comparison
        That of a movie.
    cell : int
    channel : str, optional
        Channel of the signal, if there is one.

    Returns
    -------
    Path
        `figures/movie_cell_00000_<channel>.png`, or `movie_cell_00000.png` without a channel.

    References
    ----------
    u-Unwrap, Fig. 4B to D.
    """
    rows = comparison.cells[(comparison.cells["cell"] == cell) & (comparison.cells["mapped"] > 0)]
    methods = [method for method in comparison.methods if method in set(rows["method"])]
    name, number = f"movie_cell_{cell:05d}", 0
    if channel is not None:
        names = _channels(comparison, cell, methods)
        number = names.index(channel)
        name += f"_{file_names(names)[number]}"
    path = figures_folder(comparison.path) / f"{name}.png"
    layers = shown_layers(comparison.provenance["parameters"]["layers"]) if channel is not None else []
    maps = _TOP + len(layers) * (_MAP + _MAP_GAP) + 8.0 if layers else 0.0
    with paper_style():
        sheet = Sheet(maps + 12.0 + _PANEL + 15.0)
        if channel is not None:
            signals = {method: comparison.activity(cell, method).isel(channel=number) for method in methods}
            _draw_maps(sheet, signals, layers, comparison.provenance["frame_interval_s"], shown_name(channel))
        write_method_key(sheet, methods, _LEFT, maps + 2.0)
        _draw_measures(sheet, comparison, cell, channel, methods, maps + 12.0)
        sheet.text(_LEFT, sheet.height_mm - 1.5, _KEY, color="0.35")
        with replacing(path) as temporary:
            sheet.figure.savefig(temporary, dpi=DPI)
    return path


def consistency_by_layer(consistency: pd.DataFrame, name: str) -> pd.DataFrame:
    """Median over frames of a measure, with its quartiles, by method and layer.

    Parameters
    ----------
    consistency : DataFrame
        Rows of `Comparison.consistency`.
    name : str
        Column of the measure.

    Returns
    -------
    DataFrame
        Columns method, layer, the measure, and it with _q25 and _q75.
    """
    groups = consistency.groupby(["method", "layer"], sort=False)[name]
    found = groups.quantile(np.array([0.25, 0.5, 0.75])).unstack()
    names = {0.25: f"{name}_q25", 0.5: name, 0.75: f"{name}_q75"}
    return found.rename(columns=names).reset_index()


def draw_displacement(
    ax: Axes, consistency: pd.DataFrame, methods: Sequence[str], unit: str, interval_s: float | None = None
) -> list[Line2D]:
    """Draw how far window centroids move from frame to frame, mean over layers, a line a method.

    Parameters
    ----------
    ax : Axes
    consistency : DataFrame
        Rows of one cell and channel.
    methods : sequence of str
    unit : str
    interval_s : float, optional
        Seconds between frames.

    Returns
    -------
    list of Line2D
    """
    first, last = int(consistency["frame"].min()), int(consistency["frame"].max())
    time = time_axis(ax, last - first + 1, interval_s, first)
    lines = []
    for method in methods:
        rows = consistency[consistency["method"] == method]
        moved = rows.groupby("frame")["centroid_displacement"].mean().reindex(range(first, last + 1))
        values = moved.to_numpy()
        # Only values that a line does not show get a mark: between gaps, or of a movie of two frames.
        style = METHOD_STYLES[method] | {"markevery": stands_alone(values)}
        lines += ax.plot(time, values, label=TITLES[method], **style)
    ax.set(ylabel=f"centroid_displacement ({unit})")
    ax.set_ylim(bottom=0.0)
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    return lines


def _draw_maps(
    sheet: Sheet,
    signals: dict[str, xr.DataArray],
    layers: Sequence[int],
    interval_s: float | None,
    channel: str,
) -> None:
    """Activity maps, a column a method and a row a layer, which has the same colours for all methods."""
    width = (DOUBLE_COLUMN_MM - _LEFT - _BAR - _GAP * (len(signals) - 1)) / len(signals)
    for row, layer in enumerate(layers):
        top = _TOP + row * (_MAP + _MAP_GAP)
        together = np.stack([values.sel(layer=layer) for values in signals.values()])
        limits = signal_limits(together, np.ones(together.shape, dtype=bool))
        for column, (method, values) in enumerate(signals.items()):
            ax = sheet.axes(_LEFT + column * (width + _GAP), top, width, _MAP)
            drawn = _draw_map(ax, values.sel(layer=layer), limits, interval_s)
            if column:
                ax.set_yticklabels([])
            else:
                ax.set_ylabel(f"layer {layer}\nsector")
            if row < len(layers) - 1:
                ax.set(xlabel="", xticklabels=[])
            if not row:
                ax.set_title(TITLES[method], loc="left")
        bar = sheet.axes(DOUBLE_COLUMN_MM - _BAR + 2.0, top, 2.0, _MAP)
        colour_bar(drawn, bar, "mean (a.u.)", extend="both")
    sheet.text(_LEFT, 3.0, f"{channel}, mean of each window; grey: the window is empty")


def _draw_map(ax: Axes, values: xr.DataArray, limits: tuple[float, float], interval_s: float | None) -> Any:
    frames, sectors = values.shape
    time_axis(ax, frames, interval_s, int(values["frame"][0]))
    ticks = MaxNLocator(5, steps=TICK_STEPS, integer=interval_s is None, prune="upper")
    ax.xaxis.set_major_locator(ticks)  # the last number would run into the next map's first
    extent = (*ax.get_xlim(), -0.5, sectors - 0.5)
    options: dict[str, Any] = {"aspect": "auto", "origin": "lower", "interpolation": "nearest"}
    drawn = ax.imshow(values.to_numpy().T, colour_map(SIGNAL_COLOURS), extent=extent, **options)
    drawn.set_clim(*limits)
    ax.yaxis.set_major_locator(MaxNLocator(3, integer=True))
    return drawn


def _draw_measures(
    sheet: Sheet, comparison: Comparison, cell: int, channel: str | None, methods: Sequence[str], top: float
) -> None:
    table = comparison.consistency
    unit = table.attrs["units"]["centroid_displacement"]
    rows = table[table["cell"] == cell]
    rows = rows[rows["channel"] == channel] if channel is not None else rows
    width = (DOUBLE_COLUMN_MM - _LEFT - 4.0 - 2 * _PANEL_GAP) / 3
    axes = [sheet.axes(_LEFT + number * (width + _PANEL_GAP), top, width, _PANEL) for number in range(3)]
    motion = "centroid_displacement"
    name, label, title = motion, f"{motion} ({unit})", "motion of windows a frame"
    if channel is not None:
        name, title = "correlation", "likeness to the next frame"
        label = textwrap.shorten(f"correlation, {shown_name(channel)}", _LONGEST_LABEL, placeholder="…")
    draw_measure_by_layer(axes[0], consistency_by_layer(rows, name), name, label, methods)
    axes[0].set_title(title, loc="left")
    axes[0].yaxis.label.set_parse_math(False)
    draw_displacement(axes[1], rows, methods, unit, comparison.provenance["frame_interval_s"])
    axes[1].set_title("motion of windows a frame", loc="left")
    found = consistency_by_layer(rows, "completeness")
    draw_measure_by_layer(axes[2], found, "completeness", "completeness", methods)
    axes[2].set_title("filled windows", loc="left")


def _channels(comparison: Comparison, cell: int, methods: Sequence[str]) -> list[str]:
    return [str(name) for name in comparison.activity(cell, methods[0])["channel"].to_numpy()]

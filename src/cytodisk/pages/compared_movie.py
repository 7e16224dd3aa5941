"""Windows of several methods through time (the paper's Fig. 4B to D)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.pages.compared_layers import (
    METHOD_STYLES,
    draw_measure_by_layer,
    key_height,
    write_method_key,
)
from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.sheet import Sheet, broken_lines
from cytodisk.plot.layer_looks import shown_layers
from cytodisk.plot.style import (
    SIGNAL_COLOURS,
    WIDE_MM,
    colour_bar,
    paper_style,
    signal_limits,
)
from cytodisk.plot.time_axis import TICK_STEPS, FrameTimes, stands_alone
from cytodisk.plot.time_raster import draw_time_raster
from cytodisk.runs.channel_names import file_names, shown_name
from cytodisk.runs.compare_windows.compare_parameters import TITLES
from cytodisk.runs.compare_windows.comparison import Comparison
from cytodisk.scale import Scale
from cytodisk.store.figures_folder import drawing

_LEFT, _TOP, _GAP, _BAR, _LINE = 14.0, 11.0, 3.0, 16.0, 3.2  # mm
_KEY = (
    "By layer: medians over frames, bands are their quartiles.",
    "Through time: mean over layers, bands from the lowest layer to the highest.",
)
_BAND_OPACITY = 0.18
_LONGEST_LABEL = 28  # letters along a panel's height
_MAP, _MAP_GAP, _PANEL, _PANEL_GAP, _PANEL_STEP = 18.0, 2.0, 32.0, 15.0, 48.0


def write_compared_movie(
    comparison: Comparison,
    cell: int,
    channel: str | None = None,
    *,
    formats: Sequence[str] = ("png",),
) -> Path:
    """Write a page of a cell: activity maps by method, then their consistency by layer and through time.

    Without a signal there are no activity maps, and motion by layer is in the place of the correlation.

    Parameters
    ----------
    comparison : Comparison
        That of a movie.
    cell : int
    channel : str, optional
        Channel of the signal, if there is one.
    formats : sequence of {"png", "pdf", "svg"}
        Text stays text in the last two.

    Returns
    -------
    Path
        `figures/movie_cell_00000_<channel>.png`, or `movie_cell_00000.png` without a channel; that
        of the first format.

    See Also
    --------
    write_comparison : Measures by layer.

    References
    ----------
    u-Unwrap, Fig. 4B to D.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=5, radius_px=12.0)
    >>> tifffile.imwrite("masks.tif", truth.masks.astype("uint8"), metadata={"axes": "TYX"})
    >>> settings = {"layers": 2, "sectors": 6, "methods": ("newton", "edge")}
    >>> comparison = cd.run_compare_windows("masks.tif", "compared", movie=True, **settings)
    >>> cd.pages.write_compared_movie(comparison, 0).name
    'movie_cell_00000.png'
    """
    chosen = chosen_formats(formats)
    rows = comparison.cells[(comparison.cells["cell"] == cell) & (comparison.cells["mapped"] > 0)]
    methods = [method for method in comparison.methods if method in set(rows["method"])]
    name, number = f"movie_cell_{cell:05d}", 0
    if channel is not None:
        names = _channels(comparison, cell, methods)
        number = names.index(channel)
        name += f"_{file_names(names)[number]}"
    layers = shown_layers(comparison.provenance["parameters"]["layers"]) if channel is not None else []
    titles = _titles(methods)
    head = _TOP + _LINE * (max(title.count("\n") for title in titles.values()) if layers else 0)
    maps = head + len(layers) * (_MAP + _MAP_GAP) + 8.0 if layers else 0.0
    with drawing(comparison.path, *(f"{name}.{kind}" for kind in chosen)) as folder, paper_style():
        top = maps + key_height(methods) + 9.0
        foot = top + 2 * _PANEL_STEP - 1.0
        sheet = Sheet(foot + 8.0)
        if channel is not None:
            signals = {method: comparison.activity(cell, method).isel(channel=number) for method in methods}
            _draw_maps(sheet, signals, layers, comparison.scale, head, titles)
            sheet.text(_LEFT, 3.0, f"{shown_name(channel)}, mean of each window; grey: the window is empty")
        write_method_key(sheet, methods, _LEFT, maps + 2.0)
        _draw_measures(sheet, comparison, cell, channel, methods, top)
        for number, words in enumerate(_KEY):
            sheet.text(_LEFT, foot + 2.0 + 3.6 * number, words, color="0.35")
        return save_in_formats(sheet, folder, name, chosen)[0]


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
    ax: Axes, consistency: pd.DataFrame, methods: Sequence[str], scale: Scale
) -> list[Line2D]:
    """Draw how far window centroids move from frame to frame, a line a method.

    It is the mean over layers; its band goes from the layer that moves least to that which moves most.

    Parameters
    ----------
    ax : Axes
    consistency : DataFrame
        Rows of one cell and channel.
    methods : sequence of str
    scale : Scale
        Of the displacements and of time.

    Returns
    -------
    list of Line2D
    """
    first, last = int(consistency["frame"].min()), int(consistency["frame"].max())
    time = FrameTimes(first, last - first + 1, scale.frame_interval_s).set_axis(ax)
    lines = []
    for method in methods:
        rows = consistency[consistency["method"] == method]
        by_frame = rows.groupby("frame")["centroid_displacement"].agg(["mean", "min", "max"])
        by_frame = by_frame.reindex(range(first, last + 1))
        values = by_frame["mean"].to_numpy()
        # Only values that a line does not show get a mark: between gaps, or of a movie of two frames.
        style = METHOD_STYLES[method] | {"markevery": stands_alone(values)}
        lines += ax.plot(time, values, label=TITLES[method], **style)
        band: Any = {"color": style["color"], "alpha": _BAND_OPACITY, "linewidth": 0.0}
        ax.fill_between(time, by_frame["min"].to_numpy(), by_frame["max"].to_numpy(), **band)
    ax.set(ylabel=f"movement of windows ({scale.length_unit})")
    ax.set_ylim(bottom=0.0)
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    return lines


def _draw_maps(
    sheet: Sheet,
    signals: dict[str, xr.DataArray],
    layers: Sequence[int],
    scale: Scale,
    head: float,
    titles: dict[str, str],
) -> None:
    """Activity maps, a column a method and a row a layer, which has the same colours for all methods."""
    width = _width(len(signals))
    for row, layer in enumerate(layers):
        top = head + row * (_MAP + _MAP_GAP)
        limits = signal_limits(np.stack([values.sel(layer=layer) for values in signals.values()]))
        for column, (method, values) in enumerate(signals.items()):
            ax = sheet.axes(_LEFT + column * (width + _GAP), top, width, _MAP)
            drawn = _draw_map(ax, values.sel(layer=layer), limits, scale)
            if column:
                ax.set_yticklabels([])
            else:
                ax.set_ylabel(f"layer {layer}\nsector")
            if row < len(layers) - 1:
                ax.set(xlabel="", xticklabels=[])
            if not row:
                ax.set_title(titles[method], loc="left")
        bar = sheet.axes(WIDE_MM - _BAR + 2.0, top, 2.0, _MAP)
        colour_bar(drawn, bar, "mean (a.u.)", extend="both")


def _width(columns: int) -> float:
    """Of one of so many maps beside each other, in mm."""
    return (WIDE_MM - _LEFT - _BAR - _GAP * (columns - 1)) / columns


def _titles(methods: Sequence[str]) -> dict[str, str]:
    """Names of methods in as many lines as the widths of their maps ask for."""
    room = 0.8 * _width(len(methods))  # titles are larger than other text, and need a gap
    return {method: "\n".join(broken_lines(TITLES[method].split(" "), " ", room)) for method in methods}


def _draw_map(ax: Axes, values: xr.DataArray, limits: tuple[float, float], scale: Scale) -> AxesImage:
    times, span = FrameTimes.of(values, "values", scale), (-0.5, values.sizes["sector"] - 0.5)
    drawn = draw_time_raster(ax, values.to_numpy(), times, span, limits, SIGNAL_COLOURS, "nearest")
    ticks = MaxNLocator(5, steps=TICK_STEPS, integer=times.interval_s is None, prune="upper")
    ax.xaxis.set_major_locator(ticks)  # the last number would run into the next map's first
    ax.yaxis.set_major_locator(MaxNLocator(3, integer=True))
    return drawn


def _draw_measures(
    sheet: Sheet, comparison: Comparison, cell: int, channel: str | None, methods: Sequence[str], top: float
) -> None:
    table = comparison.consistency
    unit = table.attrs["units"]["centroid_displacement"]
    rows = table[table["cell"] == cell]
    rows = rows[rows["channel"] == channel] if channel is not None else rows
    width = (WIDE_MM - _LEFT - 4.0 - _PANEL_GAP) / 2
    places = [divmod(number, 2) for number in range(3)]
    axes = [
        sheet.axes(_LEFT + column * (width + _PANEL_GAP), top + row * _PANEL_STEP, width, _PANEL)
        for row, column in places
    ]
    motion = "centroid_displacement"
    name, label, title = motion, f"{motion} ({unit})", "motion of windows a frame"
    if channel is not None:
        name, title = "correlation", "likeness to the next frame"
        label = f"correlation, {shown_name(channel, _LONGEST_LABEL - 13)}"
    draw_measure_by_layer(axes[0], consistency_by_layer(rows, name), name, label, methods)
    axes[0].set_title(title, loc="left")
    axes[0].yaxis.label.set_parse_math(False)
    draw_displacement(axes[1], rows, methods, comparison.scale)
    axes[1].set_title("motion of windows a frame", loc="left")
    found = consistency_by_layer(rows, "completeness")
    draw_measure_by_layer(axes[2], found, "completeness", "completeness", methods)
    axes[2].set_title("filled windows", loc="left")


def _channels(comparison: Comparison, cell: int, methods: Sequence[str]) -> list[str]:
    return [str(name) for name in comparison.activity(cell, methods[0])["channel"].to_numpy()]

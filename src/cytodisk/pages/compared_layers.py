"""Figures of a comparison of windows: completeness and regularity by layer (the paper's Fig. 3B)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.style import paper_style
from cytodisk.plot.time_axis import TICK_STEPS
from cytodisk.runs.compare_windows.compare_parameters import TITLES
from cytodisk.runs.compare_windows.comparison import Comparison
from cytodisk.store.figures_folder import drawing

# Colours that the colour-blind can tell apart (Okabe and Ito), and a mark beside. Where lines lie on each
# other the thinner ones, and those with gaps, are in front, so that each is seen.
METHOD_STYLES: dict[str, dict[str, Any]] = {
    "newton": {"color": "#0072B2", "marker": "o", "linewidth": 2.2, "markersize": 4.6, "zorder": 2.1},
    "newton-triangles": {"color": "#E69F00", "marker": "P", "linestyle": (0, (5, 1.5)), "zorder": 2.15}
    | {"linewidth": 1.4, "markersize": 3.4},
    "harmonic": {"color": "#56B4E9", "marker": "s", "linestyle": (0, (3, 2)), "zorder": 2.2}
    | {"linewidth": 1.2, "markersize": 3.2},
    "advection": {"color": "#009E73", "marker": "^", "linestyle": (0, (1.2, 2)), "zorder": 2.3}
    | {"linewidth": 1.0, "markersize": 2.0},
    "edge": {"color": "#D55E00", "marker": "D", "linewidth": 1.0, "markersize": 2.5, "zorder": 2.4},
    "springs": {"color": "#8C510A", "marker": "d", "linestyle": (0, (6, 1.2, 1.2, 1.2)), "zorder": 2.42}
    | {"linewidth": 1.1, "markersize": 2.7},
    "registered": {"color": "#4D4D4D", "marker": "X", "linestyle": (0, (2, 1)), "zorder": 2.35}
    | {"linewidth": 1.1, "markersize": 2.9},
    "rings": {"color": "#CC79A7", "marker": "v", "linestyle": (0, (4, 1, 1, 1)), "zorder": 2.5}
    | {"linewidth": 1.0, "markersize": 2.5},
    "nucleus-rings": {"color": "#D55E00", "marker": "D", "linewidth": 1.2, "markersize": 3.2, "zorder": 2.2},
    "interpolated-rings": {"color": "#CC79A7", "marker": "v", "linestyle": (0, (4, 1, 1, 1)), "zorder": 2.3}
    | {"linewidth": 1.2, "markersize": 3.2},
}

FIGURE = "comparison"
# Column of the table by layer, and its name in words.
PANELS = (
    ("completeness", "completeness"),
    ("area_cv", "CV of area"),
    ("eccentricity_cv", "CV of eccentricity"),
    ("eccentricity", "mean eccentricity"),
)
NUCLEUS_PANELS = (
    PANELS[0],
    ("relative_area", "area over the mean"),
    PANELS[1],
    PANELS[3],
)
"""With nuclei: the second is the mean area of a layer's windows over that of its compartment."""
_PANEL, _HEIGHT, _STEP, _LEFT, _GAP = 42.0, 33.0, 49.0, 13.0, 16.0  # mm
_ABREAST, _KEY_ABREAST, _KEY_LINE = 2, 2, 3.9  # panels and methods beside each other; mm


def write_comparison(comparison: Comparison, *, formats: Sequence[str] = ("png",)) -> Path:
    """Write `figures/comparison.png`: completeness, spread of area and eccentricity, and length, by layer.

    With nuclei mean areas of layers are in the place of the spread of eccentricity, and a line stands between
    the layers of the cytoplasm and those of the nucleus.

    Parameters
    ----------
    comparison : Comparison
    formats : sequence of {"png", "pdf", "svg"}
        Text stays text in the last two.

    Returns
    -------
    Path
        That of the first format.

    See Also
    --------
    write_compared_cells : The windows in the cells.
    write_compared_movie : Through time.

    References
    ----------
    u-Unwrap, Fig. 3B.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> tifffile.imwrite("mask.tif", cd.simulate.disk(12).astype("uint8"))
    >>> settings = {"layers": 2, "sectors": 6, "methods": ("newton", "edge")}
    >>> comparison = cd.run_compare_windows("mask.tif", "compared", **settings)
    >>> cd.pages.write_comparison(comparison).name
    'comparison.png'
    """
    chosen = chosen_formats(formats)
    names = [f"{FIGURE}.{kind}" for kind in chosen]
    with drawing(comparison.path, *names) as folder, paper_style():
        top = key_height(comparison.methods) + 6.0
        foot = top + 2 * _STEP - 2.0
        sheet = Sheet(foot + 2 * _KEY_LINE)
        for number, (name, title) in enumerate(NUCLEUS_PANELS if comparison.has_nuclei else PANELS):
            row, column = divmod(number, _ABREAST)
            ax = sheet.axes(_LEFT + column * (_PANEL + _GAP), top + row * _STEP, _PANEL, _HEIGHT)
            draw_measure_by_layer(ax, comparison.by_layer, name, title, comparison.methods)
            if comparison.has_nuclei:
                _draw_nucleus_border(ax, comparison.by_layer, name_it=not number)
        write_method_key(sheet, comparison.methods, _LEFT)
        tried = int(comparison.by_method["tried"].max())
        what = "frames" if comparison.is_movie else "cells"
        lines = (
            f"{tried} {what}. Completeness: share of filled windows, all {what} together;",
            f"other lines: median over {what}; bands: their quartiles",
        )
        for number, words in enumerate(lines):
            sheet.text(_LEFT, foot + 2.0 + _KEY_LINE * number, words, color="0.35")
        return save_in_formats(sheet, folder, FIGURE, chosen)[0]


def draw_measure_by_layer(
    ax: Axes, by_layer: pd.DataFrame, name: str, label: str, methods: Sequence[str]
) -> list[Line2D]:
    """Draw a measure by layer, a line a method, with a band from quartile to quartile.

    Parameters
    ----------
    ax : Axes
    by_layer : DataFrame
        `Comparison.by_layer`, or a table with the columns method, layer, and the measure with its quartiles.
    name : str
        Column of the measure; its quartiles end in _q25 and _q75.
    label : str
    methods : sequence of str

    Returns
    -------
    list of Line2D
        One a method.
    """
    lines = []
    for method in methods:
        rows = by_layer[by_layer["method"] == method]
        style = METHOD_STYLES[method]
        layer = rows["layer"]
        band = {"color": style["color"], "alpha": 0.18, "linewidth": 0.0}
        ax.fill_between(layer, rows[f"{name}_q25"], rows[f"{name}_q75"], **band)
        lines += ax.plot(layer, rows[name], label=TITLES[method], clip_on=False, **style)
    ax.set(xlabel="layer (0 at the edge)", ylabel=label)
    if not (by_layer[f"{name}_q25"] < 0).any():  # correlations may be negative
        ax.set_ylim(bottom=0.0)
    if name == "completeness":
        ax.set_ylim(0.0, 1.0)
    if len(by_layer):
        ax.set_xlim(-0.5, float(by_layer["layer"].max()) + 0.5)
    ax.xaxis.set_major_locator(MaxNLocator(6, integer=True))
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    return lines


def _draw_nucleus_border(ax: Axes, by_layer: pd.DataFrame, name_it: bool) -> None:
    """A line between the layers of the cytoplasm and those of the nucleus."""
    first = by_layer.loc[by_layer["compartment"] == "nucleus", "layer"].min()
    ax.axvline(first - 0.5, color="0.5", linewidth=0.6, zorder=1.0)
    if name_it:
        look: dict[str, Any] = {"color": "0.35", "va": "bottom", "transform": ax.get_xaxis_transform()}
        ax.text(first - 0.8, 0.03, "cytoplasm", ha="right", **look)
        ax.text(first - 0.2, 0.03, "nucleus", ha="left", **look)


def write_method_key(sheet: Sheet, methods: Sequence[str], left: float, top: float = 1.5) -> None:
    """Write which line is which method.

    Parameters
    ----------
    sheet : Sheet
    methods : sequence of str
    left, top : float
        In millimetres from the sheet's upper left corner.
    """
    handles = [Line2D([], [], label=TITLES[method], **METHOD_STYLES[method]) for method in methods]
    sheet.key(left, top, handles, _KEY_ABREAST, handlelength=2.6)


def key_height(methods: Sequence[str]) -> float:
    """Height of what `write_method_key` writes, in mm."""
    return _KEY_LINE * -(-len(methods) // _KEY_ABREAST)


def spread_over(values: Any, count: int) -> list[int]:
    """Places of a few values, from the smallest to the largest, evenly by rank.

    Parameters
    ----------
    values : array_like of shape (N,)
        NaN is never chosen.
    count : int

    Returns
    -------
    list of int
        At most `count`, by increasing value.
    """
    found = np.asarray(values, dtype=np.float64)
    order = np.argsort(found, kind="stable")[: int(np.isfinite(found).sum())]
    ranks = np.unique(np.linspace(0, len(order) - 1, min(count, len(order))).round().astype(int))
    return [int(order[rank]) for rank in ranks]

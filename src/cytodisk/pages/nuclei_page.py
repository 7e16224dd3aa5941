"""The picture of all cells with their nuclei: each channel from the nucleus to the membrane."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.pages.figure_formats import save_by_ending
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.nucleus.nucleus_profile import CHANNEL_COLOURS, shade_compartments
from cytodisk.plot.style import paper_style
from cytodisk.plot.time_axis import TICK_STEPS
from cytodisk.runs.channel_names import shown_name
from cytodisk.store.nuclei.summary_columns import (
    CYTOPLASM_MEAN,
    PERINUCLEAR_SHARE,
    PERIPHERAL_SHARE,
    RATIO,
    channels_among,
    column_of,
)

MOST_CELLS = 300
"""Cells up to which each gets a line."""

_LEFT, _GAP, _RIGHT, _TOP, _PANEL, _BELOW = 12.0, 12.0, 9.0, 21.0, 34.0, 20.0  # mm
_ABREAST = 2  # panels
_FEW_CHANNELS = 2  # up to which shares stand beside the ratios
_LONGEST_CHANNEL = 20
_FEW_TIMES = 4.0  # largest over least ratio up to which the axis is linear
_SPREAD = 0.16  # of dots beside each other, in places of the axis


def write_nuclei_figure(path: Path, cells: pd.DataFrame, profile: pd.DataFrame | None) -> Path | None:
    """Write the picture; None if no cell has a nucleus and a signal.

    Parameters
    ----------
    path : Path
        Ends in `.png`, `.pdf` or `.svg`; 119 mm wide.
    cells : DataFrame
        Of a study without time.
    profile : DataFrame or None
        Its `nuclear_profile`; without it the lines by layer are left out, as for very many cells.

    Returns
    -------
    Path or None
    """
    names = [name for name in channels_among(map(str, cells)) if cells[column_of(RATIO, name)].notna().any()]
    names = names[: len(CHANNEL_COLOURS)]
    if not names:
        return None
    count = 0 if profile is None else len(names)
    rows = -(-count // _ABREAST)
    shares_below = len(names) > _FEW_CHANNELS
    with paper_style():
        step = _PANEL + _BELOW
        sheet = Sheet(_TOP + (rows + 1 + shares_below) * step + 2.0)
        measured = int(cells[column_of(RATIO, names[0])].notna().sum())
        words = "1 cell with its nucleus" if measured == 1 else f"{measured} cells with their nuclei"
        sheet.title(4.0, 5.0, words)
        sheet.text(
            4.0,
            8.6,
            "a thin line or a dot is a cell; thick: mean of cells; background as in the image",
            color="0.3",
        )
        half = (sheet.width_mm - _LEFT - _RIGHT - _GAP) / _ABREAST
        whole = sheet.width_mm - _LEFT - _RIGHT
        if profile is not None:
            for number, (name, colour) in enumerate(zip(names, CHANNEL_COLOURS, strict=False)):
                row, column = divmod(number, _ABREAST)
                ax = sheet.axes(_LEFT + column * (half + _GAP), _TOP + row * step, half, _PANEL)
                _draw_profiles(ax, cells, profile, name, colour)
                ax.set_ylabel("" if column else "mean / mean of the cytoplasm")
        top = _TOP + rows * step
        _draw_ratios(sheet.axes(_LEFT, top, whole if shares_below else half, _PANEL), cells, names)
        if shares_below:
            _draw_shares(sheet.axes(_LEFT, top + step, whole, _PANEL), cells, names)
        else:
            _draw_shares(sheet.axes(_LEFT + half + _GAP, top, half, _PANEL), cells, names)
        return save_by_ending(sheet, Path(path))


def _draw_profiles(ax: Axes, cells: pd.DataFrame, profile: pd.DataFrame, name: str, colour: str) -> None:
    own = profile[profile["channel"] == name]
    means = own.pivot(index="cell", columns="layer", values="mean")
    inner = own.groupby("layer")["compartment"].agg(lambda found: bool((found == "nucleus").all()))
    whole = cells.set_index("cell")[column_of(CYTOPLASM_MEAN, name)].reindex(means.index)
    table = means[whole > 0].div(whole[whole > 0], axis=0)
    lines = table.to_numpy()
    count, nucleus = means.shape[1], int(inner.sum())
    places = count - 0.5 - np.arange(count)
    shade_compartments(ax, (0.0, float(nucleus), float(count)))
    ax.plot(places, lines.T, color=colour, linewidth=0.35, alpha=0.4)
    ax.plot(places, table.mean().to_numpy(), "o-", color=colour, linewidth=1.6, markersize=2.8)
    ax.set_xticks(places[:: -(-count // 10)], [str(k) for k in range(0, count, -(-count // 10))])
    ax.set(xlim=(0, count), xlabel="layer, 0 at the membrane")
    ax.set_ylim(bottom=float(np.nanmin(lines, initial=0.0)))
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    ax.set_title(shown_name(name, _LONGEST_CHANNEL), color=colour, weight="bold", pad=12)


def _draw_ratios(ax: Axes, cells: pd.DataFrame, names: list[str]) -> None:
    columns = [cells[column_of(RATIO, name)].dropna().to_numpy() for name in names]
    for k, (values, colour) in enumerate(zip(columns, CHANNEL_COLOURS, strict=False)):
        _dots(ax, float(k), values, colour)
    least, most = (pick(float(pick(values)) for values in columns) for pick in (min, max))
    if least > 0.0 and most > _FEW_TIMES * least:
        ax.set_yscale("log", base=2)
        ax.yaxis.set_major_formatter("{x:g}")
    else:
        ax.set_ylim(bottom=min(0.0, least))
    ax.axhline(1.0, color="0.4", linewidth=0.6, linestyle=(0, (3, 2)), zorder=0)
    ax.set_xticks(range(len(names)), [shown_name(name, _LONGEST_CHANNEL) for name in names])
    ax.set(
        xlim=(-0.5, len(names) - 0.5), ylabel="mean of nucleus / of cytoplasm", title="nucleus to cytoplasm"
    )


def _draw_shares(ax: Axes, cells: pd.DataFrame, names: list[str]) -> None:
    for k, (name, colour) in enumerate(zip(names, CHANNEL_COLOURS, strict=False)):
        for place, share in ((k - 0.25, PERINUCLEAR_SHARE), (k + 0.25, PERIPHERAL_SHARE)):
            _dots(ax, place, cells[column_of(share, name)].dropna().to_numpy(), colour, 0.4 * _SPREAD)
    ax.axhline(1.0 / 3.0, color="0.4", linewidth=0.6, linestyle=(0, (3, 2)), zorder=0)
    ax.annotate("even", (1.0, 1.0 / 3.0), xycoords=ax.get_yaxis_transform(), va="center", color="0.4")
    places = [k + side for k in range(len(names)) for side in (-0.25, 0.25)]
    shown = [shown_name(name, _LONGEST_CHANNEL) for name in names]
    ax.set_xticks(places, ["nucleus", "membrane"] * len(names), rotation=90)
    for k, name in enumerate(shown):
        ax.annotate(
            name,
            (k, 0.0),
            xycoords=ax.get_xaxis_transform(),
            xytext=(0, -49),
            textcoords="offset points",
            ha="center",
            va="top",
        )
    ax.set(xlim=(-0.5, len(names) - 0.5), ylabel="share of the cytoplasm's signal")
    ax.set_ylim(bottom=0.0)
    ax.set_title("thirds at the nucleus and at the membrane")


def _dots(ax: Axes, place: float, values: FloatArray, colour: str, spread: float = _SPREAD) -> None:
    """A dot a cell, side by side in the order of the cells, and a bar at their mean."""
    if not len(values):
        return
    beside = (np.arange(len(values)) * 0.618 % 1.0 - 0.5) * 2.0 * spread
    ax.scatter(place + beside, values, s=5.0, color=colour, alpha=0.6, linewidths=0)
    ax.hlines(values.mean(), place - 1.4 * spread, place + 1.4 * spread, color="0.1", linewidth=1.2)

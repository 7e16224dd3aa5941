"""Windows of several methods on a few cells of a comparison (the paper's Fig. 3A)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from cytodisk.errors import ParameterError
from cytodisk.pages.compared_layers import spread_over
from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.sheet import Sheet, broken_lines
from cytodisk.plot.cell.window_labels import draw_label_image
from cytodisk.plot.field_of_view import frame_field
from cytodisk.plot.outline_sides import outline_sides
from cytodisk.plot.style import WIDE_MM, paper_style
from cytodisk.runs.compare_windows.compare_parameters import ON_A_MAP, TITLES
from cytodisk.runs.compare_windows.comparison import Comparison
from cytodisk.store.figures_folder import drawing

_MOST_CELLS = 5
_WIDEST = 32.0  # mm, of a cell
_LEFT, _TOP, _GAP, _LINE = 9.0, 15.0, 2.0, 3.3  # mm
_COVERED_BY_CHORDS = 0.98  # interpolated rings are polygons, which cut a little off
_KEY = (
    "Dark: layer at the edge, yellow: at the centre; every other sector is paler; white: in no window. "
    "Percent: filled windows, that is with a part of the cell (completeness). Turned over: triangles of a "
    "map that is not one to one."
)

_NUCLEUS_KEY = (
    "Dark brown: layer at the edge, yellow: at the nucleus, blue: in the nucleus, whose outline is black; "
    "every other sector is paler. Percent: filled windows (completeness). Turned over: triangles between "
    "rings that cross each other."
)


def write_compared_cells(
    comparison: Comparison, cells: Sequence[int] | None = None, *, formats: Sequence[str] = ("png",)
) -> Path | None:
    """Write `figures/cells.png`: up to five cells, a row a method.

    Layers have colours from the edge (dark) to the centre (light), and every other sector is paler; what lies
    in no window is white.

    Parameters
    ----------
    comparison : Comparison
        Not that of a movie.
    cells : sequence of int, optional
        Which cells, at most five, in this order; by default they go from the smallest area error of the map
        to the largest.
    formats : sequence of {"png", "pdf", "svg"}
        Text stays text in the last two.

    Returns
    -------
    Path or None
        That of the first format; None if no cell has windows.

    Raises
    ------
    ParameterError
        There are more than five, or no such cell with windows.

    See Also
    --------
    write_comparison : Measures by layer.

    References
    ----------
    u-Unwrap, Fig. 3A.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> tifffile.imwrite("mask.tif", cd.simulate.disk(12).astype("uint8"))
    >>> settings = {"layers": 2, "sectors": 6, "methods": ("newton", "edge")}
    >>> comparison = cd.run_compare_windows("mask.tif", "compared", **settings)
    >>> cd.pages.write_compared_cells(comparison).name
    'cells.png'
    """
    chosen = chosen_cells(comparison) if cells is None else _asked_for(comparison, cells)
    if not chosen:
        return None
    kinds = chosen_formats(formats)
    size = min((WIDE_MM - _LEFT - 2.0 - _GAP * (len(chosen) - 1)) / len(chosen), _WIDEST)
    outcomes = {
        (cell, method): _outcome(comparison, cell, method) for cell in chosen for method in comparison.methods
    }
    step = size + _LINE * max(len(lines) for lines in outcomes.values()) + _GAP
    key = (_NUCLEUS_KEY if comparison.has_nuclei else _KEY).split(" ")
    notes = broken_lines(key, " ", WIDE_MM - _LEFT - 2.0)
    with drawing(comparison.path, *(f"cells.{kind}" for kind in kinds)) as folder, paper_style():
        foot = _TOP + len(comparison.methods) * step + 2.0
        sheet = Sheet(foot + 3.5 * len(notes))
        for column, cell in enumerate(chosen):
            labels = comparison.labels(cell)
            left = _LEFT + column * (size + _GAP)
            _write(sheet, left, _TOP - 4.5, _cell_name(comparison.cells, cell))
            for row, method in enumerate(comparison.methods):
                top = _TOP + row * step
                ax = sheet.axes(left, top, size, size)
                _draw_labels(ax, labels.get(method), labels["mask"], comparison)
                if "nucleus" in labels:
                    _draw_nucleus(ax, labels["nucleus"])
                _write(sheet, left, top + size + 2.8, outcomes[cell, method], color="0.35")
        for row, method in enumerate(comparison.methods):
            middle = _TOP + row * step + size / 2
            sheet.text(2.0, middle, _method_name(method, size), rotation=90, va="center", ha="left")
        sheet.panel_title(_LEFT, 4.0, _title(comparison, chosen, cells is None))
        _write(sheet, _LEFT, foot + 1.5, notes, color="0.35")
        return save_in_formats(sheet, folder, "cells", kinds)[0]


def _write(sheet: Sheet, left: float, top: float, lines: Sequence[str], **style: Any) -> None:
    for number, words in enumerate(lines):
        sheet.text(left, top + _LINE * number, words, **style)


def _method_name(method: str, room_mm: float) -> str:
    """Its name in one line or two beside a cell of that height."""
    return "\n".join(broken_lines(TITLES[method].split(" "), " ", room_mm))


def chosen_cells(comparison: Comparison) -> list[int]:
    """Up to five cells, spread over the area error of the first map, or else over empty windows.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    list of int
        From the simplest on.
    """
    method = _ordered_by(comparison)
    if method is None:
        return []
    rows = comparison.cells[(comparison.cells["mapped"] > 0) & (comparison.cells["method"] == method)]
    measure = rows["area_distortion" if method in ON_A_MAP else "empty_windows"]
    return [int(rows["cell"].iloc[place]) for place in spread_over(measure, _MOST_CELLS)]


def check_cells(cells: Sequence[int]) -> None:
    """Raise ParameterError unless there is room for so many cells.

    Parameters
    ----------
    cells : sequence of int
    """
    if not 0 < len(cells) <= _MOST_CELLS:
        raise ParameterError(f"cells: got {len(cells)}: name one to {_MOST_CELLS}, as many as fit the page")


def _asked_for(comparison: Comparison, cells: Sequence[int]) -> list[int]:
    check_cells(cells)
    known = comparison.cells.loc[comparison.cells["mapped"] > 0, "cell"].unique()
    missing = [cell for cell in cells if cell not in known]
    if missing:
        raise ParameterError(
            f"cells: {missing[0]} has no windows in comparison {comparison.path}, whose cells are numbered "
            f"{known.min()} to {known.max()}: name others"
        )
    return list(cells)


def _ordered_by(comparison: Comparison) -> str | None:
    """The first method with a map, or else the first, of those that have windows."""
    with_windows = set(comparison.cells.loc[comparison.cells["mapped"] > 0, "method"])
    by_map = [method for method in comparison.methods if method in ON_A_MAP]
    return next((method for method in (*by_map, *comparison.methods) if method in with_windows), None)


def _title(comparison: Comparison, chosen: Sequence[int], by_order: bool) -> str:
    if not by_order:
        return f"{len(chosen)} chosen cell{'s' if len(chosen) > 1 else ''}"
    method, number = _ordered_by(comparison), comparison.cells["cell"].nunique()
    measure = f"area error of {TITLES[method]}" if method in ON_A_MAP else "number of empty windows"
    if len(chosen) == 1:
        return f"1 of {number} cells" if number > 1 else "the cell"
    return f"{len(chosen)} of {number} cells, from the smallest to the largest {measure}"


def _draw_labels(ax: Axes, labels: Any, mask: Any, comparison: Comparison) -> None:
    """Windows of a cell in the middle of square axes; white where it has none."""
    nucleus_layers = comparison.provenance["parameters"].get("nucleus_layers", 0)
    draw_label_image(ax, labels, mask, _grid(comparison), nucleus_layers)
    middle, side = 0.5 * np.array(mask.shape) - 0.5, 0.5 * max(mask.shape) + 1
    (top, left), (bottom, right) = (middle - side).tolist(), (middle + side).tolist()
    frame_field(ax, (top, bottom, left, right))


def _draw_nucleus(ax: Axes, nucleus: Any) -> None:
    """The outline of a nucleus along the sides of its pixels."""
    sides: Any = list(outline_sides(nucleus) - 0.5)
    ax.add_collection(LineCollection(sides, colors="black", linewidths=0.4))


def _grid(comparison: Comparison) -> tuple[int, int]:
    settings = comparison.provenance["parameters"]
    return settings["layers"] + settings.get("nucleus_layers", 0), settings["sectors"]


def _cell_name(cells: pd.DataFrame, cell: int) -> list[str]:
    rows = cells[(cells["cell"] == cell) & cells["area_px"].notna()]
    return [f"cell {cell}", f"{rows['area_px'].iloc[0]:.0f} px²"]


def _outcome(comparison: Comparison, cell: int, method: str) -> list[str]:
    """What came out, in lines that fit below a cell."""
    cells = comparison.cells
    (row,) = cells[(cells["cell"] == cell) & (cells["method"] == method)].to_dict("records")
    if not row["mapped"]:
        return ["no map"]
    layers, sectors = _grid(comparison)
    lines = [f"{1 - row['empty_windows'] / (layers * sectors):.0%}"]
    if row["coverage"] < (_COVERED_BY_CHORDS if comparison.has_nuclei else 0.995):
        lines.append(f"{row['coverage']:.0%} of the area")
    if row["certificate_valid"] is False or row["flipped"] > 0:
        lines.append(f"{row['flipped']:.0f} turned over")
    return lines

"""The picture of many cells: how many were mapped, and how well."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError
from cytodisk.pages.figure_formats import save_by_ending
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.cell.area_distortion import DISTORTION_LABEL, distortion_limit, draw_area_distortion
from cytodisk.plot.style import STATUS_COLOURS, colour_bar, paper_style
from cytodisk.scale import Scale

_NEEDED = ("status", "area", "area_distortion")
_MOST_BINS = 30
_FEW_DECADES = 50  # largest over least area up to which there is room for labels between powers of 10
_THUMBNAILS, _ABREAST = 6, 3
_TALL, _CELLS_TOP, _CELLS = 32.0, 108.0, 80.0  # mm
_THUMBNAIL_LIMIT = 1.0  # log2, so that one bad cell does not bleach the others
_DISTORTION = "area distortion, mean |log λ|"


def write_overview(path: Path, cells: pd.DataFrame, masks: Callable[[int], DiskMap] | None = None) -> Path:
    """Write the picture of many cells: status counts, area distortion, area distortion against area.

    Parameters
    ----------
    path : Path
        Ends in `.png`, `.pdf` or `.svg`; 119 mm wide.
    cells : DataFrame
        One row a cell, columns status ("ok", "refused", …), area and area_distortion (NaN where there is no
        map). With a column label, rows where it is 0 are files or images without a cell: they are counted in
        words. `attrs["units"]["area"]` is the area's unit, px² without; `attrs["pixel_size_um"]` gives scale
        bars in µm.
    masks : callable, optional
        Gives the map at a row's position. With it, six cells are drawn, from the least to the most distorted.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ParameterError
        The table has no rows or lacks a column.
    StudyError
        The file cannot be written.

    See Also
    --------
    write_cell_figures : One cell.

    Examples
    --------
    >>> from pathlib import Path
    >>> import tifffile
    >>> import cytodisk as cd
    >>> tifffile.imwrite("labels.tif", cd.simulate.label_image(cells=3))
    >>> study = cd.run_map("labels.tif", "out", layers=2, sectors=6)
    >>> cd.pages.write_overview(Path("overview.png"), study.cells).name
    'overview.png'
    """
    missing = [column for column in _NEEDED if column not in cells.columns]
    if missing:
        raise ParameterError(f"cells lacks the columns {missing}: pass the table of cells of a study")
    if cells.empty:
        raise ParameterError("cells has no rows: pass the table of at least one cell")
    distortion, area = (
        pd.to_numeric(cells[name], errors="coerce").to_numpy(np.float64, na_value=np.nan)
        for name in ("area_distortion", "area")
    )
    mapped = (cells["status"] == "ok").to_numpy() & np.isfinite(distortion)
    chosen = _spread_out(distortion, mapped) if masks is not None else np.empty(0, dtype=np.int64)
    with paper_style():
        sheet = Sheet(_CELLS_TOP - 5.0 + (_CELLS if len(chosen) else 0.0))
        without = (cells["label"] == 0).to_numpy() if "label" in cells.columns else np.zeros(len(cells), bool)
        _draw_status(sheet.axes(19.0, 8.0, 24.0, _TALL), cells["status"][~without].astype(str), without.sum())
        _draw_histogram(sheet.axes(63.0, 8.0, 50.0, _TALL), distortion[mapped])
        unit = cells.attrs.get("units", {}).get("area", "px²")
        _draw_against_area(
            sheet.axes(19.0, 8.0 + _TALL + 19.0, 94.0, _TALL), area[mapped], distortion[mapped], unit
        )
        if masks is not None and len(chosen):
            disks = [masks(int(row)) for row in chosen]
            _draw_cells(sheet, _CELLS_TOP, disks, Scale.of(cells))
        return save_by_ending(sheet, Path(path))


def _draw_status(ax: Axes, status: pd.Series, without: int) -> None:
    counts = status.value_counts()
    names = [*STATUS_COLOURS, *(name for name in counts.index if name not in STATUS_COLOURS)]
    numbers = [int(counts.get(name, 0)) for name in names]
    bars = ax.barh(names, numbers, height=0.6, color=[STATUS_COLOURS.get(name, "0.3") for name in names])
    ax.bar_label(bars, padding=2)
    ax.invert_yaxis()
    ax.spines["left"].set_visible(False)
    ax.tick_params(axis="y", length=0)
    ax.set_xlim(0, 1.25 * max(1, *numbers))
    ax.xaxis.set_major_locator(MaxNLocator(3, integer=True))
    ax.set(xlabel="cells", title=f"status (and {without} without a cell)" if without else "status")


def _draw_histogram(ax: Axes, distortion: FloatArray) -> None:
    ax.set_title("area distortion")
    if not distortion.size:
        _say_none(ax)
        return
    bins = int(np.clip(np.sqrt(distortion.size) * 2, 8, _MOST_BINS))
    top = 1.05 * distortion.max() if distortion.max() > 0 else 0.1
    ax.hist(
        distortion,
        bins=np.linspace(0.0, top, bins + 1).tolist(),
        color=STATUS_COLOURS["ok"],
        edgecolor="white",
        linewidth=0.3,
    )
    ax.axvline(float(np.median(distortion)), color="0.15", linewidth=0.8, linestyle=(0, (3, 2)))
    ax.set_title(f"area distortion, median {np.median(distortion):.3f} (dashed)")
    ax.xaxis.set_major_locator(MaxNLocator(4))
    ax.yaxis.set_major_locator(MaxNLocator(5, integer=True))
    ax.set(xlabel=_DISTORTION, ylabel="cells")


def _draw_against_area(ax: Axes, area: FloatArray, distortion: FloatArray, unit: str) -> None:
    ax.set_title("area distortion against area")
    if not distortion.size:
        _say_none(ax)
        return
    size = 14.0 if len(area) < 100 else 5.0
    ax.scatter(area, distortion, s=size, color=STATUS_COLOURS["ok"], alpha=0.6, linewidths=0)
    positive = area[area > 0]
    if positive.size and positive.max() > 10 * positive.min():
        ax.set_xscale("log")
        few = positive.max() < _FEW_DECADES * positive.min()
        ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if few else (1.0,)))
        ax.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        ax.xaxis.set_minor_formatter(NullFormatter())  # its labels would lie over each other
    ax.set_ylim(0, 1.1 * distortion.max() if distortion.max() > 0 else 0.1)
    ax.set(xlabel=f"area ({unit})", ylabel=_DISTORTION)


def _draw_cells(sheet: Sheet, top: float, disks: list[DiskMap], scale: Scale) -> None:
    """Thumbnails in the same colours."""
    limit = min(max(distortion_limit(disk.distortion) for disk in disks), _THUMBNAIL_LIMIT)
    sheet.text(5.0, top - 2.0, "cells from the least to the most distorted, with area distortion")
    for k, disk in enumerate(disks):
        left, above = 5.0 + 32.0 * (k % _ABREAST), top + 38.0 * (k // _ABREAST)
        drawn = draw_area_distortion(sheet.axes(left, above, 29.0, 27.0), disk, scale=scale, limit=limit)
        sheet.text(left + 14.5, above + 34.0, f"{disk.distortion.area:.3f}", ha="center")
    colour_bar(drawn, sheet.axes(103.0, top, 2.2, 34.0), DISTORTION_LABEL, extend="both")


def _spread_out(distortion: FloatArray, mapped: FloatArray) -> IntArray:
    """Rows of a few cells, evenly spread over the order of their distortion."""
    rows = np.flatnonzero(mapped)
    order = rows[np.argsort(distortion[rows], kind="stable")]
    if not order.size:
        return order
    return np.asarray(order[np.unique(np.linspace(0, len(order) - 1, _THUMBNAILS).round().astype(int))])


def _say_none(ax: Axes) -> None:
    ax.set_axis_off()
    ax.text(0.5, 0.5, "no cell was mapped", transform=ax.transAxes, ha="center", va="center", color="0.4")

"""The page of how well windows correspond through time: correlation, displacement, completeness."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from cytodisk.arrays import FloatArray
from cytodisk.pages.cell_movie import HEADING_MM, LEFT_MM, CellMovie
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.activity_maps import shown_layers
from cytodisk.plot.layer_lines import draw_by_layer, layer_colours
from cytodisk.plot.style import DOUBLE_COLUMN_MM

_MOST_CORRELATIONS = 2
_HIGH_CORRELATION = 0.9
_PANEL, _ROW, _AXIS = 34.0, 49.0, 14.0  # mm: height of a panel, of a row, room for the labels of an axis


@dataclass(frozen=True, eq=False)
class Measure:
    """A measure by frame and layer, and how it is drawn.

    Attributes
    ----------
    title, label : str
        The label with its unit.
    values : ndarray of shape (T, L)
    low, high : float or None
        Ends of its axis where they are known.
    """

    title: str
    label: str
    values: FloatArray
    low: float | None = None
    high: float | None = None


def consistency_sheet(movie: CellMovie) -> Sheet | None:
    """Correlation of consecutive frames, displacement of windows, and completeness where it is not whole.

    Parameters
    ----------
    movie : CellMovie

    Returns
    -------
    Sheet or None
        None when no two frames can be compared.
    """
    measures = consistency_measures(movie)
    if not measures:
        return None
    columns = {1: 1, 3: 3}.get(len(measures), 2)
    width = (DOUBLE_COLUMN_MM - 2 * LEFT_MM - _AXIS * columns) / columns
    top = HEADING_MM + 10.0
    sheet = Sheet(top + -(-len(measures) // columns) * _ROW - 3.0)
    movie.write_heading(sheet, "consistency of windows from a frame to the next")
    layers = shown_layers(movie.grid.layers)
    for number, measure in enumerate(measures):
        row, column = divmod(number, columns)
        left = LEFT_MM + _AXIS - 2.0 + column * (width + _AXIS)
        ax = sheet.axes(left, top + row * _ROW, width, _PANEL)
        draw_by_layer(
            ax,
            measure.values,
            layers,
            measure.label,
            frame_interval_s=movie.interval_s,
            first_frame=movie.first,
        )
        ax.set_ylim(measure.low, measure.high)
        ax.set_title(measure.title, loc="left", parse_math=False)
    _write_key(sheet, layers, movie.grid.layers)
    return sheet


def consistency_measures(movie: CellMovie) -> list[Measure]:
    """Measures of a cell that have numbers.

    Parameters
    ----------
    movie : CellMovie

    Returns
    -------
    list of Measure
        Correlation of the first channels, displacement, and completeness if it is below 1 anywhere.
    """
    table = movie.study.consistency
    if table is None:
        return []
    unit = table.attrs["units"]["centroid_displacement"]
    rows = table[table["cell"] == movie.cell]
    found = []
    for number, name in enumerate(movie.channels[:_MOST_CORRELATIONS]):
        title = f"correlation of {movie.shown_name(number)}"
        values = _by_frame(movie, rows[rows["channel"] == name], "correlation")
        # Correlations that are all near 1 should look so.
        low = _HIGH_CORRELATION if np.nanmin(values, initial=1.0) > _HIGH_CORRELATION else None
        found.append(Measure(title, "correlation with next frame", values, low, 1.0))
    moved = _by_frame(movie, rows, "centroid_displacement")
    found.append(Measure("mean displacement of centroids", f"displacement ({unit})", moved, low=0.0))
    complete = _by_frame(movie, rows, "completeness")
    if np.nanmin(complete, initial=1.0) < 1.0:
        found.append(Measure("completeness", "share of windows with pixels", complete))
    return [measure for measure in found if np.isfinite(measure.values).any()]


def _by_frame(movie: CellMovie, rows: pd.DataFrame, name: str) -> FloatArray:
    """A column of the table by frame and layer; of several channels the first, as geometry has none."""
    wide = rows.pivot_table(index="frame", columns="layer", values=name, dropna=False, aggfunc="first")
    times, layers = range(movie.first, movie.first + movie.frames), range(movie.grid.layers)
    return wide.reindex(index=times, columns=layers).to_numpy(dtype=np.float64)


def _write_key(sheet: Sheet, layers: Sequence[int], count: int) -> None:
    places = {count - 1: " (centre)", 0: " (edge)"}
    handles = [
        Line2D([], [], color=colour, linewidth=1.5, label=f"layer {layer}{places.get(layer, '')}")
        for layer, colour in zip(layers, layer_colours(layers), strict=True)
    ]
    across, up = LEFT_MM / sheet.width_mm, 1.0 - (HEADING_MM - 1.5) / sheet.height_mm
    sheet.figure.legend(
        handles=handles, ncols=4, frameon=False, loc="upper left", bbox_to_anchor=(across, up), borderpad=0.0
    )

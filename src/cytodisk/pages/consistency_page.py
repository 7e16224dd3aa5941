"""The page of how well windows correspond through time: correlation, displacement, completeness."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.lines import Line2D

from cytodisk.pages.drawn_movie import LEFT_MM, DrawnMovie
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.layer_looks import layer_colours, layer_dashes, layer_names, shown_layers
from cytodisk.plot.movie.layer_lines import draw_by_layer
from cytodisk.plot.style import WIDE_MM
from cytodisk.windows.layer_coords import layer_coords

_MOST_CORRELATIONS = 2
_HIGH_CORRELATION = 0.9
_PANEL, _ROW, _AXIS = 34.0, 49.0, 14.0  # mm: height of a panel, of a row, room for the labels of an axis
_KEY_COLUMNS, _KEY_LINE = 2, 3.6  # names of layers side by side; mm, height of a line


@dataclass(frozen=True, eq=False)
class Measure:
    """A measure by frame and layer, and how it is drawn.

    Attributes
    ----------
    title, label : str
        The label with its unit.
    values : DataArray with dims time and layer
    low, high : float or None
        Ends of its axis where they are known.
    """

    title: str
    label: str
    values: xr.DataArray
    low: float | None = None
    high: float | None = None


def consistency_sheet(movie: DrawnMovie) -> Sheet | None:
    """Correlation of consecutive frames, displacement of windows, and completeness where it is not whole.

    Parameters
    ----------
    movie : DrawnMovie

    Returns
    -------
    Sheet or None
        None when no two frames can be compared.
    """
    measures = consistency_measures(movie)
    if not measures:
        return None
    columns = min(len(measures), 2)
    width = (WIDE_MM - 2 * LEFT_MM - _AXIS * columns) / columns
    layers = shown_layers(movie.grid.layers, movie.cytoplasm_layers)
    top = movie.heading_mm + 6.5 + _KEY_LINE * -(-len(layers) // _KEY_COLUMNS)
    sheet = Sheet(top + -(-len(measures) // columns) * _ROW - 3.0)
    movie.write_heading(sheet, "consistency of windows from a frame to the next")
    for number, measure in enumerate(measures):
        row, column = divmod(number, columns)
        left = LEFT_MM + _AXIS - 2.0 + column * (width + _AXIS)
        ax = sheet.axes(left, top + row * _ROW, width, _PANEL)
        draw_by_layer(ax, measure.values, layers, measure.label, scale=movie.scale)
        ax.set_ylim(measure.low, measure.high)
        ax.set_title(measure.title, loc="left", parse_math=False)
    _write_key(sheet, layers, movie)
    return sheet


def consistency_measures(movie: DrawnMovie) -> list[Measure]:
    """Measures of a cell that have numbers.

    Parameters
    ----------
    movie : DrawnMovie

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
        low = _HIGH_CORRELATION if np.nanmin(values.to_numpy(), initial=1.0) > _HIGH_CORRELATION else None
        found.append(Measure(title, "correlation with next frame", values, low, 1.0))
    moved = _by_frame(movie, rows, "centroid_displacement").assign_attrs(units=unit)
    found.append(Measure("mean displacement of centroids", "displacement", moved, low=0.0))
    complete = _by_frame(movie, rows, "completeness")
    if np.nanmin(complete.to_numpy(), initial=1.0) < 1.0:
        found.append(Measure("completeness", "share of windows with pixels", complete))
    return [measure for measure in found if np.isfinite(measure.values).any()]


def _by_frame(movie: DrawnMovie, rows: pd.DataFrame, name: str) -> xr.DataArray:
    """A column of the table by frame and layer; of several channels the first, as geometry has none."""
    wide = rows.pivot_table(index="frame", columns="layer", values=name, dropna=False, aggfunc="first")
    frames, layers = range(movie.first, movie.first + movie.frames), range(movie.grid.layers)
    values = wide.reindex(index=frames, columns=layers).to_numpy(dtype=np.float64)
    coords = layer_coords(movie.grid) | {"frame": ("time", list(frames))}
    return xr.DataArray(values, coords, ("time", "layer"))


def _write_key(sheet: Sheet, layers: Sequence[int], movie: DrawnMovie) -> None:
    names = layer_names(layers, movie.grid.layers, movie.depths)
    colours = layer_colours(layers, movie.cytoplasm_layers)
    handles = [
        Line2D([], [], color=colour, linewidth=0.9, linestyle=dashes, label=name)
        for colour, dashes, name in zip(colours, layer_dashes(layers), names, strict=True)
    ]
    sheet.key(LEFT_MM, movie.heading_mm - 1.5, handles, columns=_KEY_COLUMNS)

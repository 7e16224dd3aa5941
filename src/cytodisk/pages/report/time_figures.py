"""The page's figures through time, and what several figures show: one axis, marks, the highlighted window."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.pages.report.bokeh_parts import (
    MISSING,
    add_colour_bar,
    add_image,
    bare_figure,
    bokeh,
    colour_mapper,
    numbers,
    palette,
    source_of,
    title_of,
)
from cytodisk.pages.report.shown_cell import ShownCell, strip_range
from cytodisk.plot.movie.activity_maps import top_speed
from cytodisk.plot.style import DIVERGING_COLOURS

LINE_COLOUR = "#0072B2"  # of Okabe and Ito, as that of the windows: told apart by all

_LEFT, _WIDTH = 54, 512  # px: room for the axes, and width of the frames
_MAP, _STRIP = 118, 44  # px: heights of the frames
_MOST_DOTS = 100  # frames that a line shows as dots


def shared_parts(cell: ShownCell) -> dict[str, Any]:
    """What several figures show: the range of time, the moments marked on it, and the highlighted window."""
    models, step, half = bokeh().models, cell.times.per_frame, 0.5 * cell.every
    marks: dict[str, Any] = {"dimension": "height", "location": float("nan")}
    moment, row = source_of(x=[], y=[]), source_of(y=[])
    moment.name, row.name = "highlight", "row"
    lost = np.array([frame for frame, reason in zip(cell.frames, cell.reasons, strict=True) if reason])
    missing = source_of(left=(lost - half) * step, right=(lost + half) * step)
    missing.name = "missing"
    return {
        "time": models.Range1d((cell.frames[0] - half) * step, (cell.frames[-1] + half) * step),
        "marks": [
            models.Span(name="now", line_color="white", line_width=3.5, line_alpha=0.9, **marks),
            models.Span(name="now", line_color="black", line_width=1.4, **marks),
            models.Span(name="under", line_color="black", line_width=1, line_dash="dotted", **marks),
        ],
        "moment": moment,
        "row": row,
        "missing": missing,
        "wedges": source_of(**wedges_of(cell)),  # that do not change with the frame
        "chosen": models.IndexFilter(name="chosen", indices=[]),
    }


def wedges_of(cell: ShownCell) -> dict[str, Any]:
    """The windows as wedges; angles run against the clock in Bokeh, on a page where v goes down."""
    grid = cell.disk_grid
    layer, sector = np.divmod(np.arange(grid.n_windows), grid.sectors)
    radii, angles = grid.radii.astype(np.float32), grid.angles.astype(np.float32)
    return {
        "inner": radii[layer + 1],
        "outer": radii[layer],
        "start": -angles[sector + 1],
        "end": -angles[sector],
    }


def _time_figure(
    cell: ShownCell, y: tuple[float, float], height: int, shared: dict[str, Any], bottom: bool
) -> Any:
    plot = bare_figure((0.0, 1.0), y, _WIDTH, height, min_border_left=_LEFT)
    plot.x_range = shared["time"]
    plot.xaxis.axis_label = cell.times.label
    plot.xaxis.visible = bottom
    return plot


def time_map(
    cell: ShownCell, colours: Sequence[str], guide: str, shared: dict[str, Any], *, bottom: bool = False
) -> Any:
    """Time × sector; `guide` is the colour of the lines along the highlighted sector."""
    sectors, time = cell.grid.sectors, shared["time"]
    plot = _time_figure(cell, (-0.5, sectors - 0.5), _MAP, shared, bottom)
    plot.yaxis.axis_label = "sector"
    plot.yaxis.ticker = bokeh().models.FixedTicker(ticks=sorted({round(k * sectors / 4) for k in range(4)}))
    mapper = colour_mapper(colours)
    place = (time.start, -0.5, time.end - time.start, sectors)
    add_image(plot, "pixels", np.full((1, 1), np.nan, dtype=np.float32), place, mapper)
    plot.hspan("y", source=shared["row"], line_color=guide, line_width=0.8)
    for mark in shared["marks"]:
        plot.add_layout(mark)
    for colour, width in (("black", 3.5), ("white", 1.5)):  # white on black stands out from every colour
        plot.line("x", "y", source=shared["moment"], line_color=colour, line_width=width, line_join="miter")
    add_colour_bar(plot, mapper)
    return plot


def velocity_map(cell: ShownCell, shared: dict[str, Any]) -> Any:
    plot = time_map(cell, palette(DIVERGING_COLOURS), "black", shared, bottom=True)
    limit = top_speed(cell.activity["velocity"].to_numpy())
    plot.select_one({"name": "colours"}).update(low=-limit, high=limit)
    plot.select_one({"name": "unit"}).text = cell.unit("velocity")
    velocity = cell.shown["velocity"].transpose("sector", "time").to_numpy()
    plot.select_one({"name": "pixels"}).data["image"] = [velocity.astype(np.float32)]
    return plot


def time_strip(
    cell: ShownCell, title: str, values: FloatArray, shared: dict[str, Any], *, bottom: bool = False
) -> Any:
    """One number against time."""
    plot = _time_figure(cell, strip_range(values), _STRIP, shared, bottom)
    plot.title = title_of(None, title)
    plot.min_border_top = 0
    plot.yaxis.formatter = numbers()
    plot.yaxis.ticker = bokeh().models.BasicTicker(desired_num_ticks=2, mantissas=[1, 2, 5])
    plot.ygrid.visible = True
    plot.ygrid.grid_line_color = "#eeeeee"
    style = {"top": 1e12, "bottom": -1e12, "color": MISSING, "line_color": None}
    plot.quad("left", "right", source=shared["missing"], **style)
    line = source_of(x=cell.times.at, y=np.asarray(values, dtype=np.float64))
    line.name = "line"
    plot.line("x", "y", source=line, line_color=LINE_COLOUR, line_width=1.4)
    plot.scatter("x", "y", source=line, size=3 if len(cell.frames) <= _MOST_DOTS else 1, color=LINE_COLOUR)
    for mark in shared["marks"]:
        plot.add_layout(mark)
    return plot

"""The page's figures: axes, colour bars and empty glyphs that its scripts fill."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_hex

from cytodisk.arrays import FloatArray
from cytodisk.pages.report.bokeh_parts import (
    MISSING,
    add_colour_bar,
    add_image,
    bare_figure,
    bokeh,
    colour_mapper,
    numbers,
    source_of,
    title_of,
)
from cytodisk.pages.report.pictures import Box
from cytodisk.pages.report.shown_cell import ShownCell, strip_range
from cytodisk.plot.movie.activity_maps import top_speed
from cytodisk.plot.style import DIVERGING_COLOURS, SIGNAL_COLOURS, nice_length
from cytodisk.scale import Scale

if TYPE_CHECKING:
    from bokeh.models import Plot

_LEFT, _RIGHT_FRAME = 54, 512  # px: room for the axes of the right column, and width of its frames
_SQUARE = 262  # px: height of the views on the left
_MAP, _STRIP = 118, 44  # px: heights of frames on the right
_WINDOW, _LAYER = "#D55E00", "#0072B2"  # of Okabe and Ito, told apart by all
_MOST_DOTS = 100  # frames that a line shows as dots
_MOST_LINES = 1500  # windows whose borders are drawn on a disk
_WEDGE = (0, 0, "inner", "outer", "start", "end")  # middle, and columns of the source


def palette(name: str) -> list[str]:
    """256 colours of a colour map as "#rrggbb"."""
    return [to_hex(colour) for colour in mpl.colormaps[name](np.linspace(0, 1, 256))]


def library_script() -> str:
    """Source of BokehJS without widgets, tables and formulas."""
    resources = bokeh().resources.Resources(mode="inline", components=["bokeh"])
    return "\n".join(resources.js_raw)


def figures_of(cell: ShownCell, box: Box, *, correlated: bool) -> dict[str, Any]:
    """All figures as one document for `Bokeh.embed.embed_items`, and where each is to stand.

    Parameters
    ----------
    cell : ShownCell
    box : Box
        Box of the pictures.
    correlated : bool
        Whether there are correlations to show.

    Returns
    -------
    dict
        "documents", and "items" with the element of each figure, "figure-" and its name.
    """
    shared = _shared_parts(cell)
    plots: dict[str, Plot] = {
        "cell": _cell(box, cell.scale),
        "disk": _disk(cell, palette(SIGNAL_COLOURS), shared),
        "activity": _map(cell, palette(SIGNAL_COLOURS), "white", shared),
        "velocity": _velocity(cell, shared),
    }
    if correlated:
        plots["peaks"] = _disk(cell, palette(DIVERGING_COLOURS), shared, doubtful=True)
        plots["curve"] = _curve(cell)
    units = cell.study.cells.attrs["units"]
    titles = {
        "area": f"area ({units['area']})",
        "tracking_residual": f"tracking residual ({units['tracking_residual']})",
        "area_distortion": "area distortion, mean |ln λ|",
    }
    plots |= {
        name.split("_")[-1]: _strip(cell, title, cell.quality[name].to_numpy(), shared)
        for name, title in titles.items()
    }
    mean = cell.whole_mean(0) if cell.channels else np.full(len(cell.frames), np.nan)
    plots["intensity"] = _strip(cell, "mean intensity of the cell (a.u.)", mean, shared, bottom=True)
    document = bokeh().document.Document()
    for name, plot in plots.items():
        plot.name = name
        document.add_root(plot)
    roots = {plot.id: f"figure-{name}" for name, plot in plots.items()}
    item = {"docid": "page", "roots": roots, "root_ids": list(roots)}
    return {"documents": {"page": document.to_json(deferred=False)}, "items": [item]}


def _shared_parts(cell: ShownCell) -> dict[str, Any]:
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
        "wedges": source_of(**_wedges(cell)),  # that do not change with the frame
        "chosen": models.IndexFilter(name="chosen", indices=[]),
    }


def _cell(box: Box, scale: Scale) -> Any:
    top, left = box.top - 0.5, box.left - 0.5
    shrink = min(_SQUARE / box.height, (_SQUARE - 8) / box.width)
    plot = bare_figure(
        (left, left + box.width),
        (top + box.height, top),
        round(box.width * shrink),
        round(box.height * shrink),
    )
    plot.axis.visible = False
    mapper, place = colour_mapper(palette(SIGNAL_COLOURS)), (left, top, box.width, box.height)
    add_image(plot, "pixels", np.full((1, 1), np.nan, dtype=np.float32), place, mapper)
    add_image(plot, "lines", np.zeros((1, 1), dtype=np.uint32), place)
    _scale_bar(plot, box, scale)
    add_colour_bar(plot, mapper)
    return plot


def _scale_bar(plot: Any, box: Box, scale: Scale) -> None:
    size = scale.length(1.0)
    length = nice_length(0.3 * box.width * size)
    x, y = box.left + 0.04 * box.width, box.top + 0.955 * box.height
    ends = [x, x + length / size], [y, y]
    plot.line(*ends, line_color="black", line_width=6)
    plot.line(*ends, line_color="white", line_width=3)
    plot.text(
        [x + 0.5 * length / size],
        [y - 0.02 * box.height],
        [f"{length:g} {scale.length_unit}"],
        text_color="white",
        text_align="center",
        text_baseline="bottom",
        text_font_size="13px",
        background_fill_color="black",
        background_fill_alpha=0.5,
        padding=2,
    )


def _disk(cell: ShownCell, colours: Sequence[str], shared: dict[str, Any], *, doubtful: bool = False) -> Any:
    """The unit disk, v down as y in the image; some windows can be pale and hatched."""
    plot = bare_figure((-1.16, 1.16), (1.16, -1.16), _SQUARE - 22, _SQUARE - 22)
    plot.axis.visible = False
    mapper = colour_mapper(colours)
    source = source_of(**_wedges(cell), value=np.full(cell.grid.n_windows, np.nan, dtype=np.float32))
    source.name = "pixels"
    lined = cell.grid.n_windows <= _MOST_LINES
    lines = {"line_color": "white", "line_alpha": 0.3, "line_width": 0.6} if lined else {"line_color": None}
    fill = {"field": "value", "transform": mapper}
    plot.annular_wedge(*_WEDGE, source=source, fill_color=fill, **lines)
    if doubtful:
        hatch = {"hatch_pattern": "right_diagonal_line", "hatch_color": "#9a9a9a", "hatch_scale": 8.0}
        where = _where(bokeh().models.IndexFilter(name="doubtful", indices=[]))
        style = {"fill_color": "white", "fill_alpha": 0.55, "line_color": None}
        plot.annular_wedge(*_WEDGE, source=source, view=where, **style, **hatch)
    for colour, width in (("black", 4.5), ("white", 2.0)):
        style = {"fill_color": None, "line_color": colour, "line_width": width, "line_join": "miter"}
        plot.annular_wedge(*_WEDGE, source=shared["wedges"], view=_where(shared["chosen"]), **style)
    plot.circle(0, 0, radius=1.0, fill_color=None, line_color="#777777")
    _number_sectors(plot, cell.grid.sectors)
    add_colour_bar(plot, mapper)
    return plot


def _wedges(cell: ShownCell) -> dict[str, Any]:
    """The windows as wedges; angles run against the clock in Bokeh, on a page where v goes down."""
    grid = cell.grid
    layer, sector = np.divmod(np.arange(grid.n_windows), grid.sectors)
    radii, angles = grid.radii.astype(np.float32), grid.angles.astype(np.float32)
    return {
        "inner": radii[layer + 1],
        "outer": radii[layer],
        "start": -angles[sector + 1],
        "end": -angles[sector],
    }


def _where(filter_: Any) -> Any:
    return bokeh().models.CDSView(filter=filter_)


def _number_sectors(plot: Any, sectors: int) -> None:
    shown = sorted({round(k * sectors / 4) % sectors for k in range(4)})
    angle = 2 * np.pi * (np.array(shown) + 0.5) / sectors
    plot.text(
        1.09 * np.cos(angle),
        1.09 * np.sin(angle),
        [str(number) for number in shown],
        text_align="center",
        text_baseline="middle",
        text_font_size="10px",
        text_color="#555555",
    )


def _time_figure(
    cell: ShownCell, y: tuple[float, float], height: int, shared: dict[str, Any], bottom: bool
) -> Any:
    plot = bare_figure((0.0, 1.0), y, _RIGHT_FRAME, height, min_border_left=_LEFT)
    plot.x_range = shared["time"]
    plot.xaxis.axis_label = cell.times.label
    plot.xaxis.visible = bottom
    return plot


def _map(
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


def _velocity(cell: ShownCell, shared: dict[str, Any]) -> Any:
    plot = _map(cell, palette(DIVERGING_COLOURS), "black", shared, bottom=True)
    limit = top_speed(cell.activity["velocity"].to_numpy())
    plot.select_one({"name": "colours"}).update(low=-limit, high=limit)
    plot.select_one({"name": "unit"}).text = cell.unit("velocity")
    velocity = cell.shown["velocity"].transpose("sector", "time").to_numpy()
    plot.select_one({"name": "pixels"}).data["image"] = [velocity.astype(np.float32)]
    return plot


def _strip(
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
    plot.line("x", "y", source=line, line_color=_LAYER, line_width=1.4)
    plot.scatter("x", "y", source=line, size=3 if len(cell.frames) <= _MOST_DOTS else 1, color=_LAYER)
    for mark in shared["marks"]:
        plot.add_layout(mark)
    return plot


def _curve(cell: ShownCell) -> Any:
    """Correlation against lag."""
    unit = cell.scale.time_unit
    plot = bare_figure((-1.0, 1.0), (-1.0, 1.0), _SQUARE - 20, _SQUARE - 66, min_border_left=_LEFT)
    plot.xaxis.axis_label = f"lag ({unit})"
    plot.yaxis.axis_label = "correlation r"
    for name, columns in (
        ("null", ("lag", "low", "high")),
        ("band", ("lag", "low", "high")),
        ("layer", ("lag", "r")),
        ("window", ("lag", "r")),
        ("peak", ("lag", "r")),
    ):
        source = source_of(**{column: [] for column in columns})
        source.name = name
        _curve_glyph(plot, name, source)
    for dimension in ("height", "width"):
        span = bokeh().models.Span(dimension=dimension, location=0, line_color="#999999", line_width=0.8)
        plot.add_layout(span)
    return plot


def _curve_glyph(plot: Any, name: str, source: Any) -> None:
    if name == "null":
        plot.varea("lag", "low", "high", source=source, fill_color="#e4e4e4")
    elif name == "band":
        plot.varea("lag", "low", "high", source=source, fill_color=_WINDOW, fill_alpha=0.22)
    elif name == "layer":
        plot.line("lag", "r", source=source, line_color=_LAYER, line_width=2, line_dash="dashed")
    elif name == "window":
        plot.line("lag", "r", source=source, line_color=_WINDOW, line_width=2)
    else:
        plot.scatter("lag", "r", source=source, size=8, fill_color="white", line_color=_WINDOW, line_width=2)

"""The page's figures: axes, colour bars and empty glyphs that its scripts fill."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from cytodisk.pages.report.bokeh_parts import (
    add_colour_bar,
    add_image,
    bare_figure,
    bokeh,
    colour_mapper,
    palette,
    source_of,
)
from cytodisk.pages.report.pictures import Box
from cytodisk.pages.report.profile_figure import profile_figure
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.pages.report.time_figures import (
    LINE_COLOUR,
    shared_parts,
    time_map,
    time_strip,
    velocity_map,
    wedges_of,
)
from cytodisk.plot.layer_looks import NUCLEUS_LINE
from cytodisk.plot.style import DIVERGING_COLOURS, SIGNAL_COLOURS, nice_length
from cytodisk.scale import Scale

_SQUARE = 262  # px: height of the views on the left
_WINDOW = "#D55E00"  # of Okabe and Ito
_MOST_LINES = 1500  # windows whose borders are drawn on a disk
_WEDGE = (0, 0, "inner", "outer", "start", "end")  # middle, and columns of the source


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
    shared = shared_parts(cell)
    plots: dict[str, Any] = {
        "cell": _cell(box, cell.scale),
        "disk": _disk(cell, palette(SIGNAL_COLOURS), shared),
        "activity": time_map(cell, palette(SIGNAL_COLOURS), "white", shared),
        "velocity": velocity_map(cell, shared),
    }
    if cell.grid.nucleus_layers:
        plots["profile"] = profile_figure(cell)
    if correlated:
        plots["peaks"] = _disk(cell, palette(DIVERGING_COLOURS), shared, hatched=True)
        plots["curve"] = _curve(cell)
    units = cell.study.cells.attrs["units"]
    titles = {
        "area": f"area ({units['area']})",
        "tracking_residual": f"tracking residual ({units['tracking_residual']})",
        "area_distortion": "area distortion, mean |ln λ|",
    }
    plots |= {
        name.split("_")[-1]: time_strip(cell, title, cell.quality[name].to_numpy(), shared)
        for name, title in titles.items()
    }
    mean = cell.whole_mean(0) if cell.channels else np.full(len(cell.frames), np.nan)
    plots["intensity"] = time_strip(cell, "mean intensity of the cell (a.u.)", mean, shared, bottom=True)
    document = bokeh().document.Document()
    for name, plot in plots.items():
        plot.name = name
        document.add_root(plot)
    roots = {plot.id: f"figure-{name}" for name, plot in plots.items()}
    item = {"docid": "page", "roots": roots, "root_ids": list(roots)}
    return {"documents": {"page": document.to_json(deferred=False)}, "items": [item]}


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


def _disk(cell: ShownCell, colours: Sequence[str], shared: dict[str, Any], *, hatched: bool = False) -> Any:
    """The unit disk, v down as y in the image; some windows can be pale and hatched."""
    plot = bare_figure((-1.16, 1.16), (1.16, -1.16), _SQUARE - 22, _SQUARE - 22)
    plot.axis.visible = False
    mapper = colour_mapper(colours)
    source = source_of(**wedges_of(cell), value=np.full(cell.grid.n_windows, np.nan, dtype=np.float32))
    source.name = "pixels"
    lined = cell.grid.n_windows <= _MOST_LINES
    lines = {"line_color": "white", "line_alpha": 0.3, "line_width": 0.6} if lined else {"line_color": None}
    fill = {"field": "value", "transform": mapper}
    plot.annular_wedge(*_WEDGE, source=source, fill_color=fill, **lines)
    if hatched:
        hatch = {"hatch_pattern": "right_diagonal_line", "hatch_color": "#9a9a9a", "hatch_scale": 8.0}
        where = _where(bokeh().models.IndexFilter(name="not_significant", indices=[]))
        style = {"fill_color": "white", "fill_alpha": 0.55, "line_color": None}
        plot.annular_wedge(*_WEDGE, source=source, view=where, **style, **hatch)
    for colour, width in (("black", 4.5), ("white", 2.0)):
        style = {"fill_color": None, "line_color": colour, "line_width": width, "line_join": "miter"}
        plot.annular_wedge(*_WEDGE, source=shared["wedges"], view=_where(shared["chosen"]), **style)
    plot.circle(0, 0, radius=1.0, fill_color=None, line_color="#777777")
    if cell.grid.nucleus_layers:
        radius = float(cell.disk_grid.radii[cell.grid.cytoplasm_layers])
        plot.circle(0, 0, radius=radius, fill_color=None, line_color=NUCLEUS_LINE, line_width=1.5)
    _number_sectors(plot, cell.grid.sectors)
    add_colour_bar(plot, mapper)
    return plot


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


def _curve(cell: ShownCell) -> Any:
    """Correlation against lag."""
    unit = cell.scale.time_unit
    plot = bare_figure((-1.0, 1.0), (-1.0, 1.0), _SQUARE - 20, _SQUARE - 66, min_border_left=54)
    plot.xaxis.axis_label = f"lag ({unit})"
    plot.yaxis.axis_label = "correlation r"
    for name, columns in (
        ("null", ("lag", "low", "high")),
        ("band", ("lag", "low", "high")),
        ("layer", ("lag", "r")),
        ("without", ("lag", "r")),
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
        plot.line("lag", "r", source=source, line_color=LINE_COLOUR, line_width=2, line_dash="dashed")
    elif name == "without":
        plot.line("lag", "r", source=source, line_color=LINE_COLOUR, line_width=1, line_dash="dotted")
    elif name == "window":
        plot.line("lag", "r", source=source, line_color=_WINDOW, line_width=2)
    else:
        plot.scatter("lag", "r", source=source, size=8, fill_color="white", line_color=_WINDOW, line_width=2)

"""The page's figures: axes, colour bars and empty glyphs that its scripts fill."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_hex

from cytodisk.pages.report.bokeh_parts import (
    MISSING,
    add_colour_bar,
    add_outline,
    add_pixels,
    bare_figure,
    bokeh,
    colour_mapper,
    numbers,
    source_of,
    title_of,
)
from cytodisk.pages.report.pictures import Box
from cytodisk.pages.report.shown_cell import ShownCell
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


def palette(name: str) -> list[str]:
    """256 colours of a colour map as "#rrggbb"."""
    return [to_hex(colour) for colour in mpl.colormaps[name](np.linspace(0, 1, 256))]


def library_script() -> str:
    """Source of BokehJS without widgets, tables and formulas."""
    resources = bokeh().resources.Resources(mode="inline", components=["bokeh"])
    return "\n".join(resources.js_raw)


def figures_of(cell: ShownCell, box: Box, *, correlated: bool) -> dict[str, Any]:
    """All figures as JSON for `Bokeh.embed.embed_item`, by name."""
    plots: dict[str, Plot] = {
        "cell": _cell(box, cell.scale),
        "disk": _disk(cell, palette(SIGNAL_COLOURS)),
        "activity": _map(cell, palette(SIGNAL_COLOURS), "white", bottom=False),
        "velocity": _map(cell, palette(DIVERGING_COLOURS), "black", bottom=True),
    }
    if correlated:
        plots["peaks"] = _disk(cell, palette(DIVERGING_COLOURS))
        plots["curve"] = _curve(cell)
    units = cell.study.cells.attrs["units"]
    plots |= {
        "area": _strip(cell, f"area ({units['area']})"),
        "residual": _strip(cell, f"tracking residual ({units['tracking_residual']})"),
        "distortion": _strip(cell, "area distortion, mean |ln λ|"),
        "intensity": _strip(cell, "mean intensity of the cell (a.u.)", bottom=True),
    }
    return {name: bokeh().embed.json_item(plot) for name, plot in plots.items()}


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
    add_pixels(plot, left, top, box.width, box.height)
    _scale_bar(plot, box, scale)
    add_colour_bar(plot, colour_mapper(palette(SIGNAL_COLOURS)))
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


def _disk(cell: ShownCell, colours: Sequence[str]) -> Any:
    """The unit disk, v down as y in the image."""
    plot = bare_figure((-1.16, 1.16), (1.16, -1.16), _SQUARE - 22, _SQUARE - 22)
    plot.axis.visible = False
    add_pixels(plot, -1, -1, 2, 2)
    _disk_lines(plot, cell)
    sectors = cell.grid.sectors
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
    add_outline(plot)
    add_colour_bar(plot, colour_mapper(colours))
    return plot


def _disk_lines(plot: Any, cell: ShownCell) -> None:
    turn = np.linspace(0, 2 * np.pi, 181)
    plot.line(np.cos(turn), np.sin(turn), line_color="#ffffff", line_width=2.5)
    plot.line(np.cos(turn), np.sin(turn), line_color="#777777", line_width=1)
    if cell.grid.n_windows > _MOST_LINES:
        return
    radii = cell.grid.radii[1:-1]
    plot.multi_line(
        [radius * np.cos(turn) for radius in radii],
        [radius * np.sin(turn) for radius in radii],
        line_color="white",
        line_alpha=0.35,
        line_width=0.6,
    )
    angles, inner = cell.grid.angles[:-1], 0.0
    plot.segment(
        inner * np.cos(angles),
        inner * np.sin(angles),
        np.cos(angles),
        np.sin(angles),
        line_color="white",
        line_alpha=0.25,
        line_width=0.6,
    )


def _time_figure(cell: ShownCell, y: tuple[float, float], height: int, bottom: bool) -> Any:
    step, half = cell.times.per_frame, 0.5 * cell.every
    x = (cell.frames[0] - half) * step, (cell.frames[-1] + half) * step
    plot = bare_figure(x, y, _RIGHT_FRAME, height, min_border_left=_LEFT)
    plot.xaxis.axis_label = cell.times.label
    plot.xaxis.visible = bottom
    return plot


def _time_marks(plot: Any) -> None:
    """Lines at the frame that is shown and at the one under the pointer."""
    span = bokeh().models.Span
    common = {"dimension": "height", "location": float("nan")}
    plot.add_layout(span(name="now", line_color="white", line_width=3.5, line_alpha=0.9, **common))
    plot.add_layout(span(name="now", line_color="black", line_width=1.4, **common))
    plot.add_layout(span(name="under", line_color="black", line_width=1, line_dash="dotted", **common))


def _map(cell: ShownCell, colours: Sequence[str], guide: str, *, bottom: bool) -> Any:
    """Time × sector; `guide` is the colour of the lines along the highlighted sector."""
    sectors = cell.grid.sectors
    plot = _time_figure(cell, (-0.5, sectors - 0.5), _MAP, bottom)
    plot.yaxis.axis_label = "sector"
    plot.yaxis.ticker = bokeh().models.FixedTicker(ticks=sorted({round(k * sectors / 4) for k in range(4)}))
    mapper = colour_mapper(colours)
    source = source_of(
        image=[np.full((1, 1), np.nan, dtype=np.float32)],
        x=[plot.x_range.start],
        y=[-0.5],
        dw=[plot.x_range.end - plot.x_range.start],
        dh=[sectors],
    )
    source.name = "pixels"
    plot.image(image="image", x="x", y="y", dw="dw", dh="dh", source=source, color_mapper=mapper)
    for _ in range(2):  # above and below the highlighted sector
        plot.add_layout(
            bokeh().models.Span(
                name="row", dimension="width", location=float("nan"), line_color=guide, line_width=0.8
            )
        )
    _time_marks(plot)
    add_outline(plot, 3.5, 1.5)
    add_colour_bar(plot, mapper)
    return plot


def _strip(cell: ShownCell, title: str, *, bottom: bool = False) -> Any:
    """One number against time."""
    plot = _time_figure(cell, (0.0, 1.0), _STRIP, bottom)
    plot.title = title_of(None, title)
    plot.min_border_top = 0
    plot.yaxis.formatter = numbers()
    plot.yaxis.ticker = bokeh().models.BasicTicker(desired_num_ticks=2, mantissas=[1, 2, 5])
    plot.ygrid.visible = True
    plot.ygrid.grid_line_color = "#eeeeee"
    missing = source_of(left=[], right=[])
    missing.name = "missing"
    plot.quad("left", "right", top=1e12, bottom=-1e12, source=missing, color=MISSING, line_color=None)
    line = source_of(x=[], y=[])
    line.name = "line"
    plot.line("x", "y", source=line, line_color=_LAYER, line_width=1.4)
    plot.scatter("x", "y", source=line, size=3 if len(cell.frames) <= _MOST_DOTS else 1, color=_LAYER)
    _time_marks(plot)
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

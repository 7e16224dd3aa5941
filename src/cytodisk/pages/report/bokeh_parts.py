"""Parts that all figures of the page are made of; the one module that imports Bokeh."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.colors import to_hex

from cytodisk.errors import MissingPartError

MISSING = "#d9d9d9"
FONT = "11px"
INK = "#333333"


def bokeh() -> Any:
    """The plotting library.

    Raises
    ------
    MissingPartError
        It is not installed.
    """
    try:
        import bokeh.document
        import bokeh.models
        import bokeh.plotting
        import bokeh.resources
    except ImportError as error:
        raise MissingPartError.of("the report page needs Bokeh", "report") from error
    return bokeh


def bare_figure(
    x: tuple[float, float], y: tuple[float, float], width: int, height: int, **options: Any
) -> Any:
    """A bare figure; `width` and `height` are those of the frame inside the axes."""
    plot = bokeh().plotting.figure(
        frame_width=width,
        frame_height=height,
        x_range=bokeh().models.Range1d(*x),
        y_range=bokeh().models.Range1d(*y),
        tools="",
        toolbar_location=None,
        outline_line_color=None,
        background_fill_color="#ffffff",
        border_fill_color="#ffffff",
        min_border=4,
        **options,
    )
    plot.grid.visible = False
    plot.toolbar.active_drag = None
    plot.axis.major_label_text_font_size = FONT
    plot.axis.axis_label_text_font_size = FONT
    plot.axis.axis_label_text_font_style = "normal"
    plot.axis.axis_label_standoff = 4
    plot.axis.major_label_text_color = INK
    plot.axis.axis_label_text_color = INK
    plot.axis.minor_tick_line_color = None
    plot.axis.major_tick_in = 0
    plot.axis.axis_line_color = "#999999"
    plot.axis.major_tick_line_color = "#999999"
    return plot


def source_of(**columns: Any) -> Any:
    return bokeh().models.ColumnDataSource(data=columns)


def add_image(
    plot: Any, name: str, values: Any, place: tuple[float, float, float, float], mapper: Any = None
) -> None:
    """An image whose source has a name; of numbers by a colour mapper, or else of RGBA."""
    x, y, width, height = place
    source = source_of(image=[values], x=[x], y=[y], dw=[width], dh=[height])
    source.name = name
    columns = {"image": "image", "x": "x", "y": "y", "dw": "dw", "dh": "dh", "source": source}
    if mapper is None:
        plot.image_rgba(**columns)
    else:
        plot.image(**columns, color_mapper=mapper)


def add_colour_bar(plot: Any, mapper: Any) -> None:
    """A colour bar, and beside it a title called "unit" that the scripts fill."""
    bar = bokeh().models.ColorBar(
        color_mapper=mapper,
        width=10,
        label_standoff=5,
        padding=3,
        margin=2,
        ticker=bokeh().models.BasicTicker(desired_num_ticks=4),
        formatter=numbers(),
        major_label_text_font_size=FONT,
        major_tick_line_color="#666666",
        major_tick_in=0,
        major_tick_out=3,
        background_fill_color=None,
    )
    plot.add_layout(bar, "right")
    plot.add_layout(title_of("unit", "a.u.", "center"), "right")


def numbers() -> Any:
    return bokeh().models.BasicTickFormatter(power_limit_low=-4, power_limit_high=6)


def title_of(name: str | None, text: str, align: str = "left") -> Any:
    return bokeh().models.Title(
        name=name,
        text=text,
        text_font_size=FONT,
        text_font_style="normal",
        text_color=INK,
        standoff=1,
        align=align,
    )


def palette(name: str) -> list[str]:
    """256 colours of a colour map as "#rrggbb"."""
    return [to_hex(colour) for colour in mpl.colormaps[name](np.linspace(0, 1, 256))]


def colour_mapper(colours: Sequence[str]) -> Any:
    return bokeh().models.LinearColorMapper(
        name="colours", palette=list(colours), low=0.0, high=1.0, nan_color=MISSING
    )

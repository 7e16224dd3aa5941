"""The page's profile of a cell with its nucleus: a signal by layer, from the nucleus to the membrane."""

from __future__ import annotations

from typing import Any

from matplotlib.colors import to_hex

from cytodisk.number_words import rounded
from cytodisk.pages.report.bokeh_parts import FONT, bare_figure, bokeh, numbers, source_of
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.pages.report.time_figures import LINE_COLOUR
from cytodisk.plot.layer_looks import CYTOPLASM_COLOURS, NUCLEUS_COLOURS

_WIDTH, _HEIGHT, _LEFT = 560, 130, 62  # px
_SHADE = 0.35


def profile_figure(cell: ShownCell) -> Any:
    """Layer from right to left, 0 at the membrane; the scripts fill line and band, and set the upright range.

    Parameters
    ----------
    cell : ShownCell
        With layers of a nucleus.

    Returns
    -------
    figure
    """
    models, grid = bokeh().models, cell.grid
    top, outline = float(grid.layers), float(grid.nucleus_layers)
    plot = bare_figure((0.0, top), (0.0, 1.0), _WIDTH, _HEIGHT, min_border_left=_LEFT, min_border_right=24)
    for left, right, colours in ((0.0, outline, NUCLEUS_COLOURS), (outline, top, CYTOPLASM_COLOURS)):
        shade = {"fill_color": to_hex(colours(1.0)), "fill_alpha": _SHADE, "line_color": None}
        plot.add_layout(models.BoxAnnotation(left=left, right=right, level="underlay", **shade))
    for border in (outline, top):
        plot.add_layout(models.Span(dimension="height", location=border, line_color="#333333"))
    for name, columns in (("band", ("x", "low", "high")), ("line", ("x", "y")), ("chosen", ("x", "y"))):
        source = source_of(**{column: [] for column in columns})
        source.name = name
        if name == "band":
            plot.varea("x", "low", "high", source=source, fill_color=LINE_COLOUR, fill_alpha=0.2)
        elif name == "line":
            plot.line("x", "y", source=source, line_color=LINE_COLOUR, line_width=1.6)
            plot.scatter("x", "y", source=source, size=5, color=LINE_COLOUR)
        else:
            plot.scatter("x", "y", source=source, size=11, fill_color=None, line_color="black", line_width=2)
    places = [top - 0.5 - layer for layer in range(grid.layers)]
    depths = cell.median_depths
    plot.xaxis.ticker = models.FixedTicker(ticks=places)
    plot.xaxis.major_label_overrides = {
        place: f"{layer}\n{rounded(depth, 2) if depth == depth else ''}"
        for layer, (place, depth) in enumerate(zip(places, depths, strict=True))
    }
    plot.xaxis.axis_label = f"layer, and below it its depth ({cell.depths.attrs['units']})"
    plot.yaxis.formatter = numbers()
    plot.yaxis.ticker = models.BasicTicker(desired_num_ticks=4)
    names = {"text_font_size": FONT, "text_color": "#333333", "y": _HEIGHT - 4, "y_units": "screen"}
    for x, words in ((0.5 * outline, "nucleus"), (0.5 * (outline + top), "cytoplasm")):
        label = models.Label(x=x, text=words, text_align="center", text_baseline="top", **names)
        plot.add_layout(label)
    return plot

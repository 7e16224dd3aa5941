"""Pages about shapes for the folder of a study: the landscape of shapes, and the extremes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from cytodisk.arrays import BoolArray
from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.shape.shape_plane import draw_shape_landscape, known_scores, plane_limits, spread_cells
from cytodisk.plot.shape.shape_rows import cells_along, draw_shape_examples, least_median_most
from cytodisk.plot.style import colour_bar, paper_style
from cytodisk.scale import Scale

_ALONG = 7  # example cells beside the landscape
_WIDE, _FLATTEST = 66.0, 0.8  # of the landscape in mm; least height over width, for the examples beside it
_EXTREMES_WIDE, _EXTREMES_TALL = 84.0, 150.0  # in mm, at most
_ABOVE, _ALONG_LEFT = 13.0, 73.0  # mm
_ROWS = ("least", "median", "most")


def cells_to_draw(score: pd.DataFrame) -> list[int]:
    """Cells whose masks `write_shape_figures` needs.

    Parameters
    ----------
    score : DataFrame
        As `complexity_score` returns it.

    Returns
    -------
    list of int
    """
    extremes = [cell for row in least_median_most(score) for cell in row]
    return sorted({*spread_cells(score), *cells_along(score, _ALONG), *extremes})


def write_shape_figures(
    folder: Path,
    score: pd.DataFrame,
    masks: Mapping[int, BoolArray],
    scale: Scale | None = None,
    *,
    formats: Sequence[str] = ("png",),
) -> list[Path]:
    """Draw the landscape of shapes and the least, median and most complex cells.

    Parameters
    ----------
    folder : Path
        Gets `complexity` and `extremes`, with the ending of each format.
    score : DataFrame
        As `complexity_score` returns it.
    masks : mapping of int to ndarray of shape (h, w) and dtype bool
        Masks of the cells that `cells_to_draw` names.
    scale : Scale, optional
        Without a pixel size the scale bar is in px.
    formats : sequence of {"png", "pdf", "svg"}
        Text stays text in the last two.

    Returns
    -------
    list of Path

    Raises
    ------
    ParameterError
        A format is unknown.

    Examples
    --------
    >>> from pathlib import Path
    >>> import numpy as np
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> masks = {cell: cd.simulate.random_smooth(cell, radius=12) for cell in range(12)}
    >>> plane = np.random.default_rng(0).normal(size=(12, 2)) * [3, 1]
    >>> score = pd.DataFrame(plane, columns=["umap_1", "umap_2"])
    >>> score = score.assign(cell=range(12), complexity=plane[:, 0])  # as complexity_score returns it
    >>> [path.name for path in cd.pages.write_shape_figures(Path("."), score, masks)]
    ['complexity.png', 'extremes.png']
    """
    chosen = chosen_formats(formats)
    with paper_style():
        pages = {
            "complexity": _landscape_page(score, masks),
            "extremes": _extremes_page(score, masks, scale),
        }
        written = [save_in_formats(page, folder, name, chosen) for name, page in pages.items()]
    return [path for paths in written for path in paths]


def _landscape_page(score: pd.DataFrame, masks: Mapping[int, BoolArray]) -> Sheet:
    known = known_scores(score)
    low, high = plane_limits(known)
    width, height = high - low
    tall = float(_WIDE * min(max(height / width, _FLATTEST), 1.0))
    sheet = Sheet(tall + _ABOVE + 7.0)
    title = f"{len(known)} shapes, alike ones close together; arrow: principal axis"
    sheet.panel_title(4.0, 5.0, title)
    ax = sheet.axes(4.0, _ABOVE, _WIDE, tall)
    dots, _ = draw_shape_landscape(ax, score, masks)
    spare = max(0.0, float(width * tall / _WIDE - height))
    ax.set_ylim(low[1] - 0.5 * spare, high[1] + 0.5 * spare)
    sheet.panel_title(_ALONG_LEFT, 10.0, "at even steps of rank")
    along = cells_along(score, _ALONG)[::-1]
    strip = sheet.axes(_ALONG_LEFT, _ABOVE, 17.0, tall)
    drawn = draw_shape_examples(strip, score, masks, [[cell] for cell in along], one_scale=False)
    values = known.set_index("cell")["complexity"]
    for cell, path in zip(along, drawn.get_paths(), strict=True):
        strip.annotate(
            f"{values[cell]:.1f}".replace("-", "−"),
            (strip.get_xlim()[1], float(path.get_extents().intervaly.mean())),
            xytext=(2, 0),
            textcoords="offset points",
            va="center",
        )
    colour_bar(dots, sheet.axes(101.0, _ABOVE, 2.2, min(40.0, tall)), "complexity")
    return sheet


def _extremes_page(score: pd.DataFrame, masks: Mapping[int, BoolArray], scale: Scale | None) -> Sheet:
    rows = least_median_most(score)
    trial = Figure().add_subplot()
    draw_shape_examples(trial, score, masks, rows)
    right, bottom = trial.get_xlim()[1], trial.get_ylim()[0]
    tall = min(_EXTREMES_WIDE * bottom / right, _EXTREMES_TALL)
    sheet = Sheet(tall + 18.0)
    sheet.panel_title(4.0, 5.0, "Least, median and most complex cells, at one scale")
    ax = sheet.axes(14.0, 9.0, tall * right / bottom, tall)
    drawn = draw_shape_examples(ax, score, masks, rows, scale=scale)
    for name, path in zip(_ROWS, drawn.get_paths()[:: len(rows[0])], strict=True):
        ax.annotate(
            name,
            (0.0, float(path.get_extents().intervaly.mean())),
            xytext=(-2, 0),
            textcoords="offset points",
            ha="right",
            va="center",
        )
    colour_bar(drawn, sheet.axes(101.0, 9.0, 2.2, 34.0), "complexity")
    return sheet

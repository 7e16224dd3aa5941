"""Cells side by side by their outlines: along the score of complexity, or rows of chosen ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.outline import trace_outline
from cytodisk.plot.shape.shape_plane import Masks, colour_range, known_scores
from cytodisk.plot.style import LINE_COLOUR, SIGNAL_COLOURS, scale_bar
from cytodisk.scale import Scale

_GAP = 0.12  # of the largest cell, between cells


def draw_shape_examples(
    ax: Axes,
    score: pd.DataFrame,
    masks: Masks,
    rows: Sequence[Sequence[int]],
    *,
    one_scale: bool = True,
    scale: Scale | None = None,
) -> PolyCollection:
    """Draw rows of cells by their outlines, coloured by complexity.

    Parameters
    ----------
    ax : Axes
    score : DataFrame
        As `complexity_score` returns it.
    masks : mapping or sequence
        `masks[cell]` is the mask of a cell.
    rows : sequence of sequences of int
        Cells, from the top row to the bottom one.
    one_scale : bool
        Draw all at one scale, with a scale bar; or each to the same size.
    scale : Scale, optional
        Of the masks; without a pixel size the scale bar is in px.

    Returns
    -------
    PolyCollection
        A polygon a cell, in pixels where they have one scale.

    Raises
    ------
    ParameterError
        There are no cells to draw, or one has no complexity.

    See Also
    --------
    draw_shape_landscape : All cells in their plane.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> masks = {cell: cd.simulate.random_smooth(cell, radius=12) for cell in range(4)}
    >>> score = pd.DataFrame({"cell": range(4), "complexity": [0.1, 0.4, 0.7, 0.9]})
    >>> score = score.assign(umap_1=0.0, umap_2=0.0)  # as complexity_score returns it
    >>> figure, ax = plt.subplots()
    >>> outlines = cd.plot.draw_shape_examples(ax, score, masks, [[0, 1], [2, 3]])
    >>> len(outlines.get_paths())
    4
    """
    known = known_scores(score).set_index("cell")["complexity"]
    cells = [cell for row in rows for cell in row]
    if not cells:
        raise ParameterError("rows holds no cell: pass lists of cells")
    unknown = [cell for cell in cells if cell not in known.index]
    if unknown:
        raise ParameterError(f"rows names cell {unknown[0]}, which has no complexity")
    outlines = {cell: _centred(masks[cell]) for cell in cells}
    if not one_scale:
        outlines = {cell: outline / np.ptp(outline, axis=0).max() for cell, outline in outlines.items()}
    places, (height, width) = _layout(outlines, rows)
    drawn = PolyCollection(
        [(outlines[cell] + places[cell])[:, ::-1] for cell in cells],
        cmap=SIGNAL_COLOURS,
        norm=colour_range(known_scores(score)),
        edgecolors=LINE_COLOUR,
        linewidths=0.4,
    )
    drawn.set_array(known[cells].to_numpy())
    ax.add_collection(drawn)
    ax.set(xlim=(0.0, width), ylim=(height, 0.0))
    ax.set_aspect("equal")
    ax.set_axis_off()
    if one_scale:
        scale_bar(ax, scale)
    return drawn


def _layout(
    outlines: dict[int, FloatArray], rows: Sequence[Sequence[int]]
) -> tuple[dict[int, FloatArray], tuple[float, float]]:
    """Middle of each cell's box, in rows and columns as large as they need, and height and width of all."""
    sizes = {cell: np.ptp(outline, axis=0) for cell, outline in outlines.items()}
    gap = _GAP * max(float(size.max()) for size in sizes.values())
    columns = [[row[n] for row in rows if n < len(row)] for n in range(max(map(len, rows)))]
    heights = np.array([max(sizes[cell][0] for cell in row) for row in rows]) + gap
    widths = np.array([max(sizes[cell][1] for cell in column) for column in columns]) + gap
    down, right = np.cumsum(heights) - 0.5 * heights, np.cumsum(widths) - 0.5 * widths
    places = {cell: np.array([down[n], right[k]]) for n, row in enumerate(rows) for k, cell in enumerate(row)}
    return places, (float(heights.sum()), float(widths.sum()))


def cells_along(score: pd.DataFrame, count: int) -> list[int]:
    """Cells at even steps of rank, from the least to the most complex one.

    Parameters
    ----------
    score : DataFrame
    count : int

    Returns
    -------
    list of int
        No more than there are.
    """
    ranked = known_scores(score).sort_values("complexity", kind="stable")["cell"].to_numpy()
    at = np.unique(np.linspace(0, len(ranked) - 1, count).round().astype(np.int64))
    return [int(cell) for cell in ranked[at]]


def least_median_most(score: pd.DataFrame, count: int = 5) -> list[list[int]]:
    """The least, the median and the most complex cells, each in the order of complexity.

    Parameters
    ----------
    score : DataFrame
    count : int
        Of each.

    Returns
    -------
    list of three lists of int
    """
    ranked = [int(cell) for cell in known_scores(score).sort_values("complexity", kind="stable")["cell"]]
    count = min(count, len(ranked) // 3)
    first = (len(ranked) - count) // 2
    return [ranked[:count], ranked[first : first + count], ranked[-count:]]


def _centred(mask: Any) -> FloatArray:
    """Pixel outline of a cell with the middle of its box at (0, 0), shape (N, 2), (row, column) in pixels."""
    outline = trace_outline(np.pad(clean_mask(mask)[0], 1))
    return np.asarray(outline - 0.5 * (outline.min(axis=0) + outline.max(axis=0)))

"""The plane in which alike shapes are close together, with the axis of complexity."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection, PolyCollection
from matplotlib.colors import Normalize

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.polygon import smooth_closed
from cytodisk.plot.style import LINE_COLOUR, SIGNAL_COLOURS

Masks: TypeAlias = Mapping[int, Any] | Sequence[Any] | np.ndarray[Any, Any]

_PLACES = 15  # outlines side by side at most
_FILL = 0.95  # of a place that an outline takes
_MARGIN = 0.06  # of the larger side of the plane


def draw_shape_landscape(
    ax: Axes, score: pd.DataFrame, masks: Masks | None = None, *, places: int = _PLACES
) -> tuple[PathCollection, PolyCollection]:
    """Draw cells in the UMAP plane, coloured by complexity, with the principal axis as an arrow.

    Parameters
    ----------
    ax : Axes
        Both directions get one scale.
    score : DataFrame
        As `complexity_score` returns it, or `shapes.parquet`.
    masks : mapping or sequence, optional
        `masks[cell]` is the mask of a cell. As many cells as have room are drawn by their outlines, all to
        one size, if a mapping has them; the others are dots.
    places : int
        Outlines side by side.

    Returns
    -------
    (PathCollection, PolyCollection)
        Dots and outlines.

    Raises
    ------
    ParameterError
        No cell has a complexity.

    See Also
    --------
    draw_shape_examples : Cells by their outlines.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> plane = np.random.default_rng(0).normal(size=(12, 2)) * [3, 1]
    >>> score = pd.DataFrame(plane, columns=["umap_1", "umap_2"])
    >>> score = score.assign(cell=range(12), complexity=plane[:, 0])  # as complexity_score returns it
    >>> figure, ax = plt.subplots()
    >>> dots, outlines = cd.plot.draw_shape_landscape(ax, score)
    >>> len(dots.get_offsets())
    12
    """
    known = known_scores(score)
    colours: dict[str, Any] = {"cmap": SIGNAL_COLOURS, "norm": colour_range(known)}
    plane = known[["umap_1", "umap_2"]].to_numpy()
    low, high = plane_limits(known)
    shown = {} if masks is None else _outlines(known, masks, places)
    drawn = known["cell"].isin(shown).to_numpy()
    values = known["complexity"].to_numpy()
    first, second = plane[~drawn].T
    dots = ax.scatter(first, second, s=5, c=values[~drawn], linewidths=0, zorder=1, **colours)
    size = _FILL * float((high - low).max()) / places
    polygons = [
        shown[cell][:, ::-1] * [size, -size] + place
        for cell, place in zip(known["cell"][drawn], plane[drawn], strict=True)
    ]
    outlines = PolyCollection(polygons, edgecolors=LINE_COLOUR, linewidths=0.3, zorder=3, **colours)
    outlines.set_array(values[drawn])
    ax.add_collection(outlines)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    ax.set(xlabel="UMAP 1", ylabel="UMAP 2", xticks=[], yticks=[])
    _draw_axis(ax, known)
    return dots, outlines


def known_scores(score: pd.DataFrame) -> pd.DataFrame:
    """The cells that have a complexity.

    Parameters
    ----------
    score : DataFrame

    Returns
    -------
    DataFrame

    Raises
    ------
    ParameterError
        There are none, or a column is missing.
    """
    missing = [name for name in ("cell", "complexity", "umap_1", "umap_2") if name not in score]
    if missing:
        raise ParameterError(f"score has no column {missing[0]!r}: pass the table of complexity_score")
    known = score[score["complexity"].notna()]
    if known.empty:
        raise ParameterError("score has no cell with a complexity: it takes at least 10 cells")
    return known


def plane_limits(score: pd.DataFrame) -> tuple[FloatArray, FloatArray]:
    """Lower and upper limits of the plane (umap_1, umap_2) with a margin, each of shape (2,)."""
    plane = known_scores(score)[["umap_1", "umap_2"]].to_numpy()
    low, high = plane.min(axis=0), plane.max(axis=0)
    margin = _MARGIN * float((high - low).max())
    return low - margin, high + margin


def colour_range(score: pd.DataFrame) -> Normalize:
    """Range of complexity that colours stand for."""
    return Normalize(float(score["complexity"].min()), float(score["complexity"].max()))


def principal_direction(score: pd.DataFrame) -> FloatArray:
    """Direction (umap_1, umap_2) along which complexity grows, of length 1."""
    direction, *_ = np.linalg.lstsq(
        score[["umap_1", "umap_2"]].to_numpy(), score["complexity"].to_numpy(), rcond=None
    )
    return np.asarray(direction / np.linalg.norm(direction))


def spread_cells(score: pd.DataFrame, places: int = _PLACES) -> list[int]:
    """Cells that have room for an outline in the plane, the least and the most complex ones first.

    Parameters
    ----------
    score : DataFrame
    places : int
        Outlines side by side.

    Returns
    -------
    list of int
    """
    known = known_scores(score)
    low, high = plane_limits(known)
    room = float((high - low).max()) / places
    known = known.iloc[np.argsort(-known["complexity"].abs().to_numpy(), kind="stable")]
    chosen: list[int] = []
    taken = np.empty((0, 2))
    for cell, place in zip(known["cell"], known[["umap_1", "umap_2"]].to_numpy(), strict=True):
        if not len(taken) or np.hypot(*(taken - place).T).min() >= room:
            chosen.append(int(cell))
            taken = np.vstack([taken, place])
    return chosen


def unit_outline(mask: Any) -> FloatArray:
    """Smoothed outline of a cell around (0, 0), its longer side 1, shape (N, 2), (row, column)."""
    outline = smooth_closed(trace_outline(np.pad(clean_mask(mask)[0], 1)), 1.0)
    low, high = outline.min(axis=0), outline.max(axis=0)
    return np.asarray((outline - 0.5 * (low + high)) / (high - low).max())


def _outlines(known: pd.DataFrame, masks: Masks, places: int) -> dict[int, FloatArray]:
    there = [cell for cell in spread_cells(known, places) if not isinstance(masks, Mapping) or cell in masks]
    return {cell: unit_outline(masks[cell]) for cell in there}


def _draw_axis(ax: Axes, known: pd.DataFrame) -> None:
    """An arrow along the principal axis, from the least to the most complex cell."""
    direction = principal_direction(known)
    ends = np.outer([known["complexity"].min(), known["complexity"].max()], direction)
    arrow: dict[str, Any] = {
        "arrowstyle": "-|>",
        "color": "#D55E00",
        "linewidth": 1.2,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    note = ax.annotate("", ends[1], ends[0], arrowprops=arrow, zorder=2)
    note.set_gid("principal axis")

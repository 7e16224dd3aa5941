"""The level of each cell that `Population.normalise` takes out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from cytodisk.arrays import FloatArray
from cytodisk.errors import PopulationError
from cytodisk.population.cell_scaling import CellScaling
from cytodisk.population.comparison_parameters import Normalisation
from cytodisk.population.ratios import ratio

BACKGROUND = "background_{}"
_EVEN = 1e-9  # a spread over the windows below this share of the level is rounding


@dataclass(frozen=True)
class CellLevels:
    """What is done to the cells' values now, and why some cannot be normalised."""

    scaling: CellScaling
    status: NDArray[np.object_]


def cell_levels(
    method: str,
    blocks: Iterator[tuple[slice, FloatArray]],
    scaling: CellScaling,
    cells: pd.DataFrame,
    channels: Sequence[str],
    weights: Callable[[slice], FloatArray],
) -> CellLevels:
    """Scaling of cells after one more step of normalising.

    Parameters
    ----------
    method : str
        See `Population.normalise`.
    blocks : iterator of (slice, ndarray)
        Values as they are now.
    scaling : CellScaling
        That they have now.
    cells : DataFrame
    channels : sequence of str
    weights : callable
        Of rows: the areas of their windows.

    Returns
    -------
    CellLevels

    Raises
    ------
    PopulationError
        There is no such method, or no column of background.
    """
    if method not in get_args(Normalisation):
        words = ", ".join(repr(name) for name in get_args(Normalisation))
        raise PopulationError(f"normalise: {method!r} is none of {words}")
    status = np.full(len(cells), "", dtype=object)
    if method == "none":
        return CellLevels(scaling, status)
    if method == "background":
        return CellLevels(_without_background(scaling, cells, channels), status)
    centre, factor = np.zeros(scaling.factor.shape), np.ones(scaling.factor.shape)
    for rows, block in blocks:
        mean, sd, area = _moments(block, weights(rows))
        if method == "z-score":
            usable = sd > _EVEN * np.abs(mean)
            centre[rows], factor[rows] = mean, ratio(1.0, sd, usable)
        else:
            usable = mean > 0.0
            windows = area if method == "cell total" else 1.0
            factor[rows] = ratio(1.0, mean * windows, usable)
        status[rows][~usable.all(axis=1)] = (
            "all windows have one value" if method == "z-score" else "its mean is not above 0"
        )
    return CellLevels(scaling.scaled_on(centre, factor), status)


def _moments(block: FloatArray, weights: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mean and sd over the windows of cells and channels, and the number of windows that have a value."""
    weight = np.where(np.isfinite(block), weights[:, None], 0.0)
    total = weight.sum(axis=(2, 3))
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = (np.nan_to_num(block) * weight).sum(axis=(2, 3)) / total
        away = np.nan_to_num(block - mean[:, :, None, None])
        sd = np.sqrt((away**2 * weight).sum(axis=(2, 3)) / total)
    return mean, sd, (weight > 0).sum(axis=(2, 3)).astype(np.float64)


def _without_background(scaling: CellScaling, cells: pd.DataFrame, channels: Sequence[str]) -> CellScaling:
    missing = [BACKGROUND.format(name) for name in channels if BACKGROUND.format(name) not in cells]
    if missing:
        raise PopulationError(
            f"normalise: cells has no column {missing[0]}: add the background of each cell, such as the "
            "signal beside it, to the table, or use another method"
        )
    given: Any = cells[[BACKGROUND.format(name) for name in channels]]
    numbers = given.apply(pd.to_numeric, errors="coerce").to_numpy(dtype=np.float64)
    if not np.isfinite(numbers).all():
        row = int(np.flatnonzero(~np.isfinite(numbers).all(axis=1))[0])
        raise PopulationError(f"normalise: row {row} of cells has no number as its background")
    if scaling.centre.any() or (scaling.factor != 1.0).any():
        raise PopulationError("normalise: take the background away first, then normalise by the cell")
    return replace(scaling, background=scaling.background + numbers)

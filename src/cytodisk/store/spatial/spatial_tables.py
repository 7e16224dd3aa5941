"""Tables of the windows and of the cells of a study, a row for each shape, a column for each channel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import AnyArray, FloatArray
from cytodisk.population.group_columns import CONDITION, EXPERIMENT
from cytodisk.population.plain_columns import categories, plain_column, with_plain_names
from cytodisk.store.spatial.spatial_parts import cell_number, window_number
from cytodisk.store.spatial.study_places import MappedStudy, StudyImage

REGION, INSTANCE = "region", "instance_id"
"""Columns that say which element, and which shape or label in it, a row belongs to."""

_PLACE = ["cell", "frame"]
_STATISTICS = ("sd", "min", "max")
_NOT_OF_WINDOWS = ("cell", "frame", "channel", "mean", *_STATISTICS, "n_nan", "centroid_y", "centroid_x")
_OF_SECTORS = ("velocity", "velocity_error")
_CENTRE = 0.5  # of the first pixel, from the image's corner


@dataclass(frozen=True)
class SpatialTable:
    """What becomes an AnnData.

    Attributes
    ----------
    values : ndarray of shape (rows, channels)
        Means.
    layers : dict of str to ndarray
        Other statistics of the same shape.
    obs, var : DataFrame
    places : ndarray of shape (rows, 2)
        (x, y) in pixels from the image's corner.
    """

    values: FloatArray
    layers: dict[str, FloatArray]
    obs: pd.DataFrame
    var: pd.DataFrame
    places: FloatArray


def window_table(study: MappedStudy, images: Sequence[StudyImage], n_windows: int) -> SpatialTable:
    """A row for each window of the images' cells.

    Parameters
    ----------
    study : Study
    images : sequence of StudyImage
    n_windows : int
        Of each cell.

    Returns
    -------
    SpatialTable
    """
    rows = _rows_of(study.windows, images)
    first, blocks = _by_channel(rows)
    window = first["layer"] * (first["sector"].max() + 1) + first["sector"]
    columns: dict[str, Any] = {
        REGION: _regions(first, images, "windows"),
        INSTANCE: window_number(first["cell"].to_numpy(), window.to_numpy(), n_windows),
        **_of_cells(study, first),
    }
    of_windows = [name for name in first if name not in _NOT_OF_WINDOWS]
    columns |= {str(name): plain_column(first[name]) for name in of_windows}
    columns |= _of_edge(study, first)
    names = [
        f"{at}cell{cell}_layer{layer}_sector{sector}"
        for at, cell, layer, sector in zip(
            _prefixes(first, images), first["cell"], first["layer"], first["sector"], strict=True
        )
    ]
    obs = with_plain_names(pd.DataFrame(columns, index=range(len(first))), names)
    layers = {name: _stacked(blocks, name, len(first)) for name in _STATISTICS if blocks}
    return SpatialTable(_stacked(blocks, "mean", len(first)), layers, obs, _var(blocks), _centroids(first))


def cell_table(study: MappedStudy, images: Sequence[StudyImage]) -> SpatialTable:
    """A row for each of the images' cells, with the means of its windows, weighted by their pixels.

    Parameters
    ----------
    study : Study
    images : sequence of StudyImage

    Returns
    -------
    SpatialTable
    """
    cells = pd.concat([image.rows for image in images], ignore_index=True)
    _, blocks = _by_channel(_rows_of(study.windows, images))
    means = [_cell_means(block, cells) for block in blocks.values()]
    columns: dict[str, Any] = {
        REGION: _regions(cells, images, "cells"),
        INSTANCE: cell_number(cells["cell"].to_numpy()),
    }
    columns |= {str(name): plain_column(cells[name]) for name in cells}
    names = [f"{at}cell{cell}" for at, cell in zip(_prefixes(cells, images), cells["cell"], strict=True)]
    obs = with_plain_names(pd.DataFrame(columns, index=range(len(cells))), names)
    values: FloatArray = np.column_stack(means) if means else np.empty((len(cells), 0))
    return SpatialTable(values, {}, obs, _var(blocks), _centroids(cells))


def _rows_of(windows: pd.DataFrame, images: Sequence[StudyImage]) -> pd.DataFrame:
    """The rows of windows of the images' cells, in the images' order, then by channel."""
    chosen = pd.concat([image.rows[_PLACE] for image in images], ignore_index=True)
    order = pd.MultiIndex.from_frame(chosen)
    at = order.get_indexer(pd.MultiIndex.from_frame(windows[_PLACE]))
    rows = windows.assign(_at=at)[at >= 0]
    return rows.sort_values(["_at", "layer", "sector"], kind="stable").drop(columns="_at")


def _by_channel(rows: pd.DataFrame) -> tuple[pd.DataFrame, dict[str, pd.DataFrame]]:
    """A row a window, and the rows of each channel in the same order; none without a signal."""
    names = list(dict.fromkeys(rows["channel"].dropna()))
    if not names:
        return rows.reset_index(drop=True), {}
    blocks = {str(name): rows[rows["channel"] == name].reset_index(drop=True) for name in names}
    return next(iter(blocks.values())), blocks


def _stacked(blocks: dict[str, pd.DataFrame], name: str, rows: int) -> FloatArray:
    if not blocks:
        return np.empty((rows, 0))
    return np.column_stack([block[name].to_numpy(dtype=np.float64) for block in blocks.values()])


def _cell_means(block: pd.DataFrame, cells: pd.DataFrame) -> AnyArray:
    pixels = block["n_pixels"].to_numpy()
    total = block[_PLACE].assign(total=np.where(pixels > 0, block["mean"] * pixels, 0.0), pixels=pixels)
    sums = total.groupby(_PLACE, sort=False)[["total", "pixels"]].sum(min_count=1)
    found = sums.reindex(pd.MultiIndex.from_frame(cells[_PLACE]))
    return (found["total"] / found["pixels"]).to_numpy()


def _regions(rows: pd.DataFrame, images: Sequence[StudyImage], element: str) -> pd.Categorical:
    names = [element_name(element, image.name) for image in images]
    return categories([names[at] for at in _image_of(rows, images)], names)


def element_name(element: str, image: str) -> str:
    """Name of an element of an image, as "windows_frame_012"."""
    return f"{element}_{image}" if image else element


def _prefixes(rows: pd.DataFrame, images: Sequence[StudyImage]) -> list[str]:
    names = [f"{image.name}_" if image.name else "" for image in images]
    return [names[at] for at in _image_of(rows, images)]


def _image_of(rows: pd.DataFrame, images: Sequence[StudyImage]) -> AnyArray:
    """Which of the images each row lies in."""
    number = {
        (cell, frame): at
        for at, image in enumerate(images)
        for cell, frame in zip(image.rows["cell"], image.rows["frame"], strict=True)
    }
    return np.array([number[key] for key in zip(rows["cell"], rows["frame"], strict=True)], dtype=np.intp)


def _of_cells(study: MappedStudy, rows: pd.DataFrame) -> dict[str, Any]:
    """What is known of each window's cell."""
    known = [name for name in ("source", "label", CONDITION, EXPERIMENT) if name in study.cells]
    table = study.cells.set_index(_PLACE)[known]
    found = table.reindex(pd.MultiIndex.from_frame(rows[_PLACE])).reset_index(drop=True)
    own = {"cell": rows["cell"].to_numpy(), "frame": rows["frame"].to_numpy()}
    return own | {name: plain_column(found[name]) for name in known}


def _of_edge(study: MappedStudy, rows: pd.DataFrame) -> dict[str, Any]:
    """In a movie, the velocity of the edge in the window's sector."""
    if not study.is_movie:
        return {}
    key = [*_PLACE, "sector"]
    found = study.edge.set_index(key)[list(_OF_SECTORS)].reindex(pd.MultiIndex.from_frame(rows[key]))
    return {name: found[name].to_numpy() for name in _OF_SECTORS}


def _var(blocks: dict[str, pd.DataFrame]) -> pd.DataFrame:
    return with_plain_names(pd.DataFrame(index=range(len(blocks))), list(blocks))


def _centroids(rows: pd.DataFrame) -> FloatArray:
    return rows[["centroid_x", "centroid_y"]].to_numpy(dtype=np.float64) + _CENTRE

"""Window means of cells of `cytodisk map`, read into one array."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import CytodiskError, PopulationError, ReadError
from cytodisk.memory import free_bytes
from cytodisk.runs.population.opening.alike_settings import setting_of
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.opening.layer_depths import LayerDepths
from cytodisk.runs.population.opening.noted_cells import LeftOut
from cytodisk.runs.population.opening.row_moments import RowMoments
from cytodisk.runs.population.opening.seen_windows import SeenWindows
from cytodisk.runs.population.opening.streamed_windows import GEOMETRY, WindowTable
from cytodisk.store.provenance_file import PROVENANCE
from cytodisk.store.table_file import REMEDY
from cytodisk.windows.grid_parameters import PolarGridParameters
from cytodisk.windows.polar_windows import PolarGrid, polar_grid

MOST_DOUBLE = 600_000_000
"""Bytes of values and areas above which they are kept in single precision."""


class CellArrays(NamedTuple):
    """What the windows of all cells hold.

    Attributes
    ----------
    values : ndarray of shape (cells, channels, layers, sectors)
    areas : ndarray of shape (cells, layers, sectors)
    depths : ndarray of shape (cells, layers)
        Mean distance of the windows of each layer to the edge, NaN where it is unknown.
    turn : ndarray of shape (cells,)
        See `RowMoments.turn`.
    axis, axis_strength : ndarray of shape (cells,)
        See `RowMoments.long_axis`.
    """

    values: FloatArray
    areas: FloatArray
    depths: FloatArray
    turn: FloatArray
    axis: FloatArray
    axis_strength: FloatArray

    def of(self, kept: BoolArray) -> CellArrays:
        """Those of some of the cells; the same arrays where all are kept."""
        return self if kept.all() else CellArrays(*(array[kept] for array in self))


def grid_of(study: FoundStudy) -> PolarGrid:
    """The grid of a study's windows; raises ReadError where the study's parameters are none of a grid."""
    given = {name: setting_of(study, name) for name in PolarGridParameters.model_fields}
    if given["depth_um"] is not None:
        given = {"sectors": given["sectors"], "depth_um": tuple(given["depth_um"])} | {
            "nucleus_layers": given["nucleus_layers"]
        }
    try:
        return polar_grid(PolarGridParameters.of(**given))
    except CytodiskError as error:
        raise ReadError(f"{study.folder / PROVENANCE}: parameters: {error}: {REMEDY}") from error


def window_table(study: FoundStudy) -> WindowTable:
    """The table of windows of a study."""
    grid = grid_of(study)
    return WindowTable.of(study.folder, grid.layers, grid.sectors)


def precision(cells: int, channels: int, windows: int) -> Any:
    """float64, or float32 where that would take too much memory."""
    return np.float64 if cells * (channels + 1) * windows * 8 <= MOST_DOUBLE else np.float32


def read_map_values(
    studies: Sequence[FoundStudy], cells: pd.DataFrame, channels: Sequence[str], left_out: LeftOut
) -> tuple[CellArrays, pd.DataFrame]:
    """Means of the windows of all cells.

    Parameters
    ----------
    studies : sequence of FoundStudy
        With one grid.
    cells : DataFrame
        In the order of the studies.
    channels : sequence of str
    left_out : LeftOut
        Gets the cells without values.

    Returns
    -------
    arrays : CellArrays
    cells : DataFrame
        Those that have values.

    Raises
    ------
    ReadError
        A table is damaged: a window of a cell stands twice, or not at all.
    """
    grid = grid_of(studies[0])
    kind = precision(len(cells), len(channels), grid.n_windows)
    _check_memory(len(cells) * (len(channels) + 1) * grid.n_windows * np.dtype(kind).itemsize)
    arrays = CellArrays(
        np.full((len(cells), len(channels), grid.layers, grid.sectors), np.nan, dtype=kind),
        np.full((len(cells), grid.layers, grid.sectors), np.nan, dtype=kind),
        *(np.full(shape, np.nan) for shape in [(len(cells), grid.layers), *[len(cells)] * 3]),
    )
    incomplete = np.zeros((len(cells), len(channels)), dtype=bool)
    of_study = cells.groupby("input", sort=False).indices
    for study in studies:
        if study.name in of_study:
            rows = of_study[study.name]
            own = slice(int(rows[0]), int(rows[-1]) + 1)
            part = CellArrays(*(array[own] for array in arrays))
            incomplete[own] = _fill(part, study, cells.iloc[own], channels)
    reason = _reasons(arrays.values, incomplete, channels)
    kept = reason == ""
    left_out.add_cells(cells[~kept], pd.Series(reason[~kept]))
    chosen = cells[kept].reset_index(drop=True)
    chosen.attrs = dict(cells.attrs)
    return arrays.of(kept), chosen


def _check_memory(needed: int) -> None:
    if needed > (free := free_bytes()):
        raise PopulationError(
            f"the windows of all cells need {needed / 1e9:.1f} GB of memory, {free / 1e9:.1f} GB are free: "
            "name some channels (--channel), or map with fewer windows"
        )


def _fill(part: CellArrays, study: FoundStudy, cells: pd.DataFrame, channels: Sequence[str]) -> BoolArray:
    """Read a study into its part of the arrays; which cells lack a channel as a whole."""
    table = window_table(study)
    numbers = cells["number"].to_numpy(np.int64)
    keys = pd.DataFrame({"cell": numbers, "frame": cells["frame"].to_numpy()})
    moments = RowMoments(cells[["centroid_y", "centroid_x"]].to_numpy(np.float64), table.sectors)
    depths = LayerDepths(len(cells), table.layers)
    seen = SeenWindows(table.path, numbers, part.values.shape)
    values = part.values.reshape(-1)  # a view
    for block in table.blocks(keys, channels, "mean", "depth", *GEOMETRY):
        values[seen.add(block)] = block.numbers["mean"]
        first = block.where(block.channel == 0)
        part.areas[first.row, first.layer, first.sector] = first.numbers["area"]
        moments.add(first)
        depths.add(first)
    part.depths[:], part.turn[:] = depths.means, moments.turn
    part.axis[:], part.axis_strength[:] = moments.long_axis()
    return seen.lacking()


def _reasons(values: FloatArray, lacking: BoolArray, channels: Sequence[str]) -> Any:
    """Why cells cannot be used, "" for those that can."""
    reason = np.full(len(values), "", dtype=object)
    for k, name in enumerate(channels):
        step = max(1, 4_000_000 // max(1, int(np.prod(values.shape[2:]))))
        for start in range(0, len(values), step):
            rows = slice(start, start + step)
            nothing = ~np.isfinite(values[rows, k]).any(axis=(1, 2))
            words = np.where(lacking[rows, k], f"it has no channel {name}", f"all windows of {name} are NaN")
            reason[rows] = np.where((reason[rows] == "") & nothing, words, reason[rows])
    return reason

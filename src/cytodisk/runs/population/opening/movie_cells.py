"""Cells of movies: what each contributes, and one row for each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.errors import NoValuesError, PopulationError
from cytodisk.runs.population.movie_values import movie_values
from cytodisk.runs.population.movies.wave_summaries import NUMBERS
from cytodisk.runs.population.opening.disk_directions import movie_directions
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.opening.joined_cells import FRAMES, PLACES, with_columns
from cytodisk.runs.population.opening.layer_depths import LayerDepths, median_of_cells
from cytodisk.runs.population.opening.map_values import window_table
from cytodisk.runs.population.opening.noted_cells import LeftOut
from cytodisk.runs.population.opening.row_moments import RowMoments
from cytodisk.runs.population.opening.streamed_windows import GEOMETRY
from cytodisk.store.study import Study

_KEYS = ["input", "number"]


def rows_by_cell(frames: pd.DataFrame) -> pd.DataFrame:
    """One row a cell out of one row a frame.

    Parameters
    ----------
    frames : DataFrame
        As `joined_rows` returns it.

    Returns
    -------
    DataFrame
        Numbers are means over frames with a map, how many they are is in frames; texts are those of the first
        frame. A cell without any map has the status and reason of its first frame. QC flags are those of all
        frames.
    """
    ok = frames["status"] == "ok"
    grouped = frames.groupby(_KEYS, sort=False)
    found = frames.sort_values("status", key=lambda status: status != "ok", kind="stable")
    found = found.groupby(_KEYS, sort=False).first().reset_index()
    index = pd.MultiIndex.from_frame(found[_KEYS])
    numbers = [name for name in frames if name not in PLACES and frames[name].dtype.kind == "f"]
    means = frames[ok].groupby(_KEYS, sort=False)[numbers].mean().reindex(index)
    for name in numbers:
        found[name] = means[name].to_numpy()
    found[FRAMES] = ok.groupby([frames[name] for name in _KEYS], sort=False).sum().reindex(index).to_numpy()
    found["frame"] = grouped["frame"].min().reindex(index).to_numpy()
    found["qc_flags"] = grouped["qc_flags"].agg(_joined).reindex(index).to_numpy()
    found.attrs = dict(frames.attrs)
    order = frames[_KEYS].drop_duplicates()
    places = pd.MultiIndex.from_frame(order)
    return found.set_index(index).loc[places].reset_index(drop=True)[[*found.columns]]


def _joined(flags: pd.Series[str]) -> str:
    return "; ".join(dict.fromkeys(flag for text in flags.fillna("") for flag in text.split("; ") if flag))


def read_movie_values(
    studies: Sequence[FoundStudy],
    cells: pd.DataFrame,
    frames: pd.DataFrame,
    channels: Sequence[str] | None,
    summary: str,
    left_out: LeftOut,
) -> tuple[xr.DataArray, xr.DataArray | None, pd.DataFrame]:
    """Values of cells of movies.

    Parameters
    ----------
    studies : sequence of FoundStudy
    cells, frames : DataFrame
        One row a cell; one row a frame of a cell.
    channels : sequence of str, optional
    summary : str
        See `movie_values`.
    left_out : LeftOut
        Gets the cells without values.

    Returns
    -------
    values : DataArray with dims (cell, channel, layer, sector or lag)
    areas : DataArray with dims (cell, layer, sector), or None
    cells : DataFrame
        Those that have values, with directions in the disk.

    Raises
    ------
    PopulationError
        No cell has values, or cells have values of different shapes.
    """
    parts: list[xr.DataArray] = []
    kept: list[int] = []
    directions: list[dict[str, float]] = []
    depths: list[Any] = []
    rows_of, frames_of = (table.groupby("input", sort=False).indices for table in (cells, frames))
    for found in (study for study in studies if study.name in rows_of):
        own = frames.iloc[frames_of[found.name]].rename(columns={"number": "cell"})
        study = Study(found.folder, own, found.provenance)
        having = _summed_up(study, cells.iloc[rows_of[found.name]], channels, summary, left_out)
        if having:
            rows = [int(rows_of[found.name][k]) for k in having]
            of_cells, deep = _directions_and_depths(found, study, cells.iloc[rows])
            parts += having.values()
            kept += rows
            directions += of_cells
            depths.append(deep)
    if not parts:
        raise PopulationError(
            f"no cell has values for {summary!r} ({left_out.rows[-1]['reason']}): choose another summary"
        )
    chosen = cells.iloc[kept].reset_index(drop=True)
    numbers = pd.DataFrame([part.attrs.get(NUMBERS, {}) for part in parts], index=chosen.index)
    chosen = with_columns(chosen, pd.DataFrame(directions, index=chosen.index).join(numbers))
    values, areas = _stacked(parts, chosen)
    deep = median_of_cells(np.concatenate(depths))
    if values.sizes["layer"] == len(deep):
        values = values.assign_coords(depth=("layer", deep, {"units": studies[0].length_unit}))
    return values, areas, chosen


def _summed_up(
    study: Study, cells: pd.DataFrame, channels: Sequence[str] | None, summary: str, left_out: LeftOut
) -> dict[int, xr.DataArray]:
    """Values of those cells of a study that have some, by row; why the others have none is noted."""
    found = {}
    for row, number in enumerate(cells["number"]):
        try:
            values = movie_values(study, int(number), summary, channels=channels)
        except NoValuesError as error:
            left_out.add_cells(cells.iloc[[row]], str(error))
            continue
        if np.isfinite(values).any():
            found[row] = values
        else:
            left_out.add_cells(cells.iloc[[row]], f"all windows are NaN in its {summary}")
    return found


def _stacked(parts: list[xr.DataArray], cells: pd.DataFrame) -> tuple[xr.DataArray, xr.DataArray | None]:
    first = parts[0]
    for part, cell in zip(parts, cells["cell"], strict=True):
        for name in first.dims:
            if part.sizes.get(name) != first.sizes[name] or list(part[name].values) != list(
                first[name].values
            ):
                raise PopulationError(
                    f"{name}s of cell {cell} are {_listed(part, name)}, of cell {cells['cell'].iloc[0]} "
                    f"{_listed(first, name)}: run the movies with the same settings, at one frame interval"
                )
    values = xr.DataArray(
        np.stack([part.values for part in parts]),
        dims=("cell", *first.dims),
        coords={name: first[name] for name in (*first.dims, "compartment") if name in first.coords},
        attrs={"units": first.attrs.get("units", "a.u.")},
        name=first.name,
    )
    if not all("area" in part.coords for part in parts):
        return values, None
    areas = np.stack([part["area"].values for part in parts])
    return values, xr.DataArray(areas, dims=("cell", "layer", first.dims[-1]))


def _listed(part: xr.DataArray, name: Any) -> str:
    return ", ".join(map(str, part[name].values[:4])) if name in part.coords else "none"


def _directions_and_depths(
    found: FoundStudy, study: Study, cells: pd.DataFrame
) -> tuple[list[dict[str, float]], Any]:
    """Directions in the disk of some cells of a study, and depths of their layers (cells, layers)."""
    table = window_table(found)
    frames = study.cells[(study.cells["status"] == "ok") & study.cells["cell"].isin(cells["number"])]
    frames = frames.sort_values(["cell", "frame"]).reset_index(drop=True)
    moments = RowMoments(frames[["centroid_y", "centroid_x"]].to_numpy(np.float64), table.sectors)
    depths = LayerDepths(len(frames), table.layers)
    for block in table.blocks(frames[["cell", "frame"]], table.channels()[:1], "depth", *GEOMETRY):
        moments.add(block)
        depths.add(block)
    axis, long = moments.long_axis()
    frames = frames.assign(turn=moments.turn, axis=axis, long=long)
    edge = study.edge
    directions = [
        movie_directions(
            frames[frames["cell"] == cell],
            edge.loc[edge["cell"] == cell, ["sector", "velocity"]],
            table.sectors,
        )
        for cell in cells["number"]
    ]
    deep = pd.DataFrame(depths.means).groupby(frames["cell"]).mean()
    return directions, deep.loc[cells["number"]].to_numpy()

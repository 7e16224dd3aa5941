"""Cells of `cytodisk map` as the parts of a population."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.errors import PopulationError
from cytodisk.runs.population.opening.chosen_scalars import chosen_scalars
from cytodisk.runs.population.opening.common_channels import chosen_channels
from cytodisk.runs.population.opening.disk_directions import image_directions
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.opening.joined_cells import with_columns
from cytodisk.runs.population.opening.layer_depths import median_of_cells
from cytodisk.runs.population.opening.map_values import CellArrays, grid_of, read_map_values
from cytodisk.runs.population.opening.opened_cells import OpenedCells, Wanted
from cytodisk.store.table_file import units_in


def map_population(
    studies: Sequence[FoundStudy], cells: pd.DataFrame, frames: pd.DataFrame, wanted: Wanted
) -> OpenedCells:
    """Window means, areas and directions of cells.

    Parameters
    ----------
    studies : sequence of FoundStudy
        Of `cytodisk map`, alike.
    cells, frames : DataFrame
        Usable cells; all cells.
    wanted : Wanted

    Returns
    -------
    OpenedCells

    Raises
    ------
    PopulationError
        A summary that only movies have; a channel that is missing; a scalar that is none.
    """
    if wanted.summary != "mean":
        raise PopulationError(
            f"summary {wanted.summary!r} is one of movies, and {studies[0].name} is of images: leave it out"
        )
    channels = chosen_channels(studies, wanted.channels)
    arrays, cells = read_map_values(studies, cells, channels, wanted.left_out)
    cells = with_columns(cells, image_directions(cells, arrays.turn, arrays.axis, arrays.axis_strength))
    values, areas = _labelled(arrays, studies[0], channels)
    return OpenedCells(values, areas, cells, chosen_scalars(cells, channels, wanted.scalars))


def _labelled(
    arrays: CellArrays, study: FoundStudy, channels: Sequence[str]
) -> tuple[xr.DataArray, xr.DataArray]:
    grid = grid_of(study)
    length = units_in(study.provenance)[0] or "px"
    layers = {
        "layer": np.arange(grid.layers),
        "compartment": ("layer", grid.compartments.astype(object)),
        "depth": ("layer", median_of_cells(arrays.depths), {"units": length}),
        "sector": np.arange(grid.sectors),
    }
    attrs = {"units": "a.u."}
    if arrays.values.dtype == np.float32:
        needed = (arrays.values.size + arrays.areas.size) * 8 / 1e9
        attrs["precision"] = f"single: in double they would take {needed:.1f} GB"
    values = xr.DataArray(
        arrays.values,
        dims=("cell", "channel", "layer", "sector"),
        coords={"channel": list(channels), **layers},
        name="mean",
        attrs=attrs,
    )
    areas = xr.DataArray(
        arrays.areas, dims=("cell", "layer", "sector"), name="area", attrs={"units": f"{length}²"}
    )
    return values, areas

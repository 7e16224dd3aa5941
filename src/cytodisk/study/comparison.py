"""What a comparison found: its tables, and what they say over all cells."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.errors import ReadError
from cytodisk.files import replacing
from cytodisk.io.provenance_file import read_provenance
from cytodisk.io.study_folder import CELLS, CONSISTENCY, MAPS, part_key
from cytodisk.io.tables import read_table

BY_LAYER_FILE, BY_METHOD_FILE = "comparison.csv", "comparison_methods.csv"
_TRIED = ("ok", "no map", "partly")  # what the others are is no cell
_SPREAD = ("area_cv", "eccentricity_cv")


@dataclass(frozen=True)
class Comparison:
    """The reading side of a comparison.

    Attributes
    ----------
    path : Path
    cells : DataFrame
        One row a cell and method, with its status and the reason.
    layers : DataFrame
        One row a cell, frame, method and layer.
    provenance : dict
    """

    path: Path
    cells: pd.DataFrame
    layers: pd.DataFrame
    provenance: dict[str, Any]

    def __repr__(self) -> str:
        return f"<Comparison {self.path}: {self.cells['cell'].nunique()} cells, {', '.join(self.methods)}>"

    @property
    def methods(self) -> tuple[str, ...]:
        """Methods in the order they were asked for."""
        return tuple(self.provenance["parameters"]["methods"])

    @property
    def is_movie(self) -> bool:
        """Whether cells were followed through time."""
        return self.provenance.get("run") == "movie comparison"

    @cached_property
    def consistency(self) -> pd.DataFrame:
        """For a movie, one row a cell, method, time, channel and layer."""
        if not self.is_movie:
            raise ReadError(f"comparison {self.path} is not that of a movie: it has no {CONSISTENCY}")
        return read_table(self.path / CONSISTENCY)

    @cached_property
    def by_layer(self) -> pd.DataFrame:
        """One row a method and layer, over all cells; see `layer_summary`."""
        return layer_summary(self.cells, self.layers, self.methods)

    @cached_property
    def by_method(self) -> pd.DataFrame:
        """One row a method, over all cells; see `method_summary`."""
        return method_summary(self.cells, self.layers, self.methods)

    def labels(self, cell: int) -> dict[str, Any]:
        """Which part of a cell is in which window: "mask", and by method an int array, -1 for none.

        In cells of up to 4000 pixels each pixel is divided into 4×4.
        """
        path = self.path / MAPS / f"windows_{part_key(cell)}.npz"
        try:
            with np.load(path) as file:
                return {name: file[name] for name in file.files}
        except OSError as error:
            raise ReadError(f"cell {cell} has no windows in comparison {self.path}") from error

    def activity(self, cell: int, method: str) -> xr.DataArray:
        """For a movie, the signal in the windows of a method, dims (time, channel, layer, sector)."""
        path = self.path / MAPS / f"activity_{part_key(cell)}_{method}.npz"
        try:
            with np.load(path) as file:
                _, _, layers, sectors = file["mean"].shape
                coords = {"time": file["time"], "channel": file["channel"]}
                coords |= {"layer": np.arange(layers), "sector": np.arange(sectors)}
                return xr.DataArray(file["mean"], coords, ("time", "channel", "layer", "sector"))
        except OSError as error:
            raise ReadError(f"cell {cell} has no activity by {method} in comparison {self.path}") from error


def open_comparison(path: str | os.PathLike[str]) -> Comparison:
    """Read what `cytodisk compare` wrote.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    Comparison

    Raises
    ------
    ReadError
        The folder holds no complete comparison.
    """
    folder = Path(path)
    provenance = read_provenance(folder)
    if provenance is None or "comparison" not in str(provenance.get("run")):
        raise ReadError(f"{folder} holds no comparison: pass a folder that cytodisk compare wrote")
    if provenance.get("status") != "complete":
        raise ReadError(f"comparison {folder} is not complete: run the same command again with --resume")
    return Comparison(folder, read_table(folder / CELLS), read_table(folder / "layers.parquet"), provenance)


def write_summaries(path: Path) -> None:
    """Write the two summaries of a complete comparison as CSV files.

    Parameters
    ----------
    path : Path
        Its folder.
    """
    found = open_comparison(path)
    for name, table in ((BY_LAYER_FILE, found.by_layer), (BY_METHOD_FILE, found.by_method)):
        with replacing(path / name) as temporary:
            table.to_csv(temporary, index=False, float_format="%.6g")


def layer_summary(cells: pd.DataFrame, layers: pd.DataFrame, methods: tuple[str, ...]) -> pd.DataFrame:
    """Measures of each method and layer over all cells, or all frames of a movie.

    Parameters
    ----------
    cells, layers : DataFrame
        Of a comparison.
    methods : tuple of str

    Returns
    -------
    DataFrame
        completeness is the share of windows with signal of all cells that were tried, so that a cell that
        could not be mapped counts as empty; completeness_mapped that of the mapped ones alone, with its
        quartiles over cells. Of area_cv and eccentricity_cv the median and quartiles over cells; of
        eccentricity and layer_pieces the median; of pieces and one_piece the mean.
    """
    rows = []
    for method in methods:
        tried, mapped = _counts(cells, method)
        own = layers[layers["method"] == method]
        for layer, group in own.groupby("layer"):
            row: dict[str, Any] = {"method": method, "layer": layer, "tried": tried, "mapped": mapped}
            row["completeness"] = group["completeness"].sum() / tried
            row["completeness_mapped"] = group["completeness"].mean()
            row |= _quartiles(group["completeness"], "completeness")
            for name in _SPREAD:
                row[name] = group[name].median()
                row |= _quartiles(group[name], name)
            row |= {name: group[name].median() for name in ("eccentricity", "layer_pieces")}
            row |= {name: group[name].mean() for name in ("pieces", "one_piece")}
            rows.append(row)
    return pd.DataFrame(rows)


def method_summary(cells: pd.DataFrame, layers: pd.DataFrame, methods: tuple[str, ...]) -> pd.DataFrame:
    """What each method made of all cells, or all frames of a movie.

    Parameters
    ----------
    cells, layers : DataFrame
        Of a comparison.
    methods : tuple of str

    Returns
    -------
    DataFrame
        tried, mapped, invalid_maps (null where there is no map), flipped triangles, area error (mean |log λ|,
        median over cells with quartiles), coverage (of all mapped cells' area), lost_px, empty_windows,
        completeness over all windows of all cells tried and of those mapped, medians of area_cv and
        eccentricity_cv over cells and layers, median seconds.
    """
    rows = []
    for method in methods:
        tried, mapped = _counts(cells, method)
        own = layers[layers["method"] == method]
        done = cells[(cells["method"] == method) & (cells["mapped"] > 0)]
        row: dict[str, Any] = {"method": method, "tried": tried, "mapped": mapped}
        row |= {name: done[name].sum(min_count=1) for name in ("invalid_maps", "flipped")}
        row["area_error"] = done["area_distortion"].median()
        row |= _quartiles(done["area_distortion"], "area_error")
        row["coverage"] = np.average(done["coverage"], weights=done["area_px"]) if len(done) else np.nan
        row |= {name: done[name].sum() for name in ("lost_px", "empty_windows")}
        n_layers = own["layer"].nunique()
        row["completeness"] = own["completeness"].sum() / (tried * n_layers) if n_layers else 0.0
        row["completeness_mapped"] = own["completeness"].mean()
        row |= {name: own[name].median() for name in _SPREAD}
        row["seconds"] = done["seconds"].median()
        rows.append(row)
    return pd.DataFrame(rows)


def _counts(cells: pd.DataFrame, method: str) -> tuple[int, int]:
    """Cells, or frames, that were tried, and those mapped."""
    own = cells[(cells["method"] == method) & cells["status"].isin(_TRIED)]
    return int(own["frames"].sum()), int(own["mapped"].sum())


def _quartiles(values: pd.Series[float], name: str) -> dict[str, float]:
    return {f"{name}_q25": float(values.quantile(0.25)), f"{name}_q75": float(values.quantile(0.75))}

"""What a comparison found: its tables, and what they say over all cells."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.array_archive import reading_arrays
from cytodisk.errors import EarlierVersionWarning, ReadError
from cytodisk.parameter_words import short_words
from cytodisk.runs.compare_windows.compare_columns import (
    BY_LAYER,
    BY_METHOD,
    COLUMNS_FILE,
    THROUGH_TIME,
    describe_columns,
    units_of,
)
from cytodisk.runs.compare_windows.compare_parameters import TITLES
from cytodisk.runs.compare_windows.compare_summaries import layer_summary, method_summary, movie_summary
from cytodisk.runs.compare_windows.compare_tables import (
    COMPARED_CELLS,
    COMPARED_MOVIE,
    COMPARED_NUCLEI,
    REGISTERED,
)
from cytodisk.scale import Scale
from cytodisk.store.csv_tables import write_csv
from cytodisk.store.provenance_file import PROVENANCE, other_maps, read_complete
from cytodisk.store.study import CONSISTENCY
from cytodisk.store.study_folder import StudyFolder, part_key
from cytodisk.store.study_kind import CELLS, MAPS
from cytodisk.store.table_file import REMEDY, read_checked, units_in
from cytodisk.store.tables import read_table

_MOST_SIDE, _MOST_WINDOWS = 1_000_000, 10_000_000


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

    See Also
    --------
    run_compare_windows : Makes one.
    open_comparison : Reads one.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> tifffile.imwrite("mask.tif", cd.simulate.disk(12).astype("uint8"))
    >>> settings = {"layers": 2, "sectors": 6, "methods": ("newton", "edge")}
    >>> comparison = cd.run_compare_windows("mask.tif", "compared", **settings)
    >>> comparison.methods, comparison.cells["status"].tolist()
    (('newton', 'edge'), ['ok', 'ok'])
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

    @property
    def has_nuclei(self) -> bool:
        """Whether cells were compared with their nuclei."""
        return self.provenance.get("run") == COMPARED_NUCLEI.run

    @property
    def scale(self) -> Scale:
        """µm per pixel and seconds per frame, as far as the run knew them."""
        return Scale(self.provenance.get("pixel_size_um"), self.provenance.get("frame_interval_s"))

    @cached_property
    def consistency(self) -> pd.DataFrame:
        """For a movie, one row a cell, method, frame, channel and layer."""
        if not self.is_movie:
            raise ReadError(f"comparison {self.path} is not that of a movie: it has no {CONSISTENCY}")
        columns = COMPARED_MOVIE.others["consistency"]
        return read_checked(self.path / CONSISTENCY, columns, units=units_in(self.provenance))

    @cached_property
    def by_layer(self) -> pd.DataFrame:
        """One row a method and layer, over all cells; see `layer_summary`."""
        return self._with_units(layer_summary(self.cells, self.layers, self.methods), BY_LAYER)

    @cached_property
    def by_method(self) -> pd.DataFrame:
        """One row a method, over all cells; see `method_summary`."""
        return self._with_units(method_summary(self.cells, self.layers, self.methods), BY_METHOD)

    @cached_property
    def through_time(self) -> pd.DataFrame:
        """For a movie, one row a method, channel and layer, and one for all layers; see `movie_summary`."""
        return self._with_units(movie_summary(self.consistency, self.methods), THROUGH_TIME)

    @property
    def summaries(self) -> dict[str, pd.DataFrame]:
        """What stands in CSV files, by their names."""
        tables = {BY_LAYER: self.by_layer, BY_METHOD: self.by_method}
        if self.is_movie:
            tables[THROUGH_TIME] = self.through_time
        tables[COLUMNS_FILE] = describe_columns(tables, self.provenance.get("length_unit", "px"))
        return tables

    def _with_units(self, table: pd.DataFrame, name: str) -> pd.DataFrame:
        table.attrs["units"] = units_of(table, name, self.provenance.get("length_unit", "px"))
        return table

    def labels(self, cell: int) -> dict[str, Any]:
        """Which pixel of a cell is in which window: "mask", and by method an int array, -1 for none.

        With nuclei there is the mask "nucleus", too. In cells of up to 4000 pixels each pixel is divided
        into 4×4.
        """
        path = self.path / MAPS / f"windows_{part_key(cell)}.npz"
        if not path.exists():
            raise ReadError(f"cell {cell} has no windows in comparison {self.path}")
        with reading_arrays(path, "the windows of a comparison", REMEDY) as file:
            mask = file.truths("mask", (None, None), most=(_MOST_SIDE, _MOST_SIDE))
            masks = {"mask": mask}
            if self.has_nuclei:
                masks["nucleus"] = file.truths("nucleus", mask.shape, most=mask.shape)
            others = (name for name in file.names if name not in masks)
            labels = {name: file.integers(name, mask.shape, least=-1, most=_MOST_WINDOWS) for name in others}
        return masks | labels

    def activity(self, cell: int, method: str) -> xr.DataArray:
        """For a movie, the signal in the windows of a method, dims (time, channel, layer, sector)."""
        path = self.path / MAPS / f"activity_{part_key(cell)}_{method}.npz"
        if not path.exists():
            raise ReadError(f"cell {cell} has no activity by {method} in comparison {self.path}")
        with reading_arrays(path, "the activity of a comparison", REMEDY) as file:
            frames = file.integers("frame", (None,), least=0, most=_MOST_SIDE)
            channels = file.texts("channel", (None,))
            mean = file.numbers("mean", (len(frames), len(channels), None, None))
            if (np.diff(frames) <= 0).any() or len(set(channels)) < len(channels):
                raise file.fault(
                    "frame" if len(set(channels)) == len(channels) else "channel", "repeats itself"
                )
        _, _, layers, sectors = mean.shape
        coords = self.scale.time_coords(frames) | {"channel": channels}
        coords |= {"layer": np.arange(layers), "sector": np.arange(sectors)}
        dims = ("time", "channel", "layer", "sector")
        values = xr.DataArray(mean, coords, dims, attrs={"units": "a.u."} | self.scale.attrs)
        return values.set_xindex("frame")


def open_comparison(path: str | os.PathLike[str]) -> Comparison:
    """Read what `cytodisk compare-windows` wrote.

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

    Warns
    -----
    EarlierVersionWarning
        Its maps are of another version.

    See Also
    --------
    run_compare_windows : Writes the comparison.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> tifffile.imwrite("mask.tif", cd.simulate.disk(12).astype("uint8"))
    >>> settings = {"layers": 2, "sectors": 6, "methods": ("newton", "edge")}
    >>> _ = cd.run_compare_windows("mask.tif", "compared", **settings)
    >>> comparison = cd.open_comparison("compared")
    >>> comparison.methods
    ('newton', 'edge')
    >>> comparison.by_layer["completeness"].tolist()
    [1.0, 1.0, 1.0, 1.0]
    """
    folder = Path(path)
    kinds = {kind.run: kind for kind in (COMPARED_CELLS, COMPARED_MOVIE, COMPARED_NUCLEI)}
    provenance = read_complete(folder, *kinds)
    if words := other_maps(provenance):
        warnings.warn(f"comparison {folder}: {words}", EarlierVersionWarning, stacklevel=2)
    methods = provenance.get("parameters", {}).get("methods")
    if not isinstance(methods, list) or not methods or not set(map(str, methods)) <= set(TITLES):
        raise ReadError(
            f"{folder / PROVENANCE}: parameters.methods names none, got {short_words(methods)}: {REMEDY}"
        )
    kind, units = kinds[provenance["run"]], units_in(provenance)
    needed = tuple(column for column in kind.cells if column not in REGISTERED)
    cells = read_checked(folder / CELLS, needed, REGISTERED, units=units)
    layers = read_checked(folder / "layers.parquet", kind.others["layers"], units=units)
    return Comparison(folder, cells, layers, provenance)


def write_summaries(folder: StudyFolder) -> None:
    """Write the summaries of a comparison, and what their columns are, as CSV files.

    Parameters
    ----------
    folder : StudyFolder
        All tables stand.
    """
    path = folder.path
    tables = read_table(path / CELLS), read_table(path / "layers.parquet")
    for name, table in Comparison(path, *tables, folder.provenance).summaries.items():
        write_csv(table, path / name)

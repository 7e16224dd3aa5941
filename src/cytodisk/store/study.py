"""Read a study: tables, maps, activity and movies of a finished run."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd
import xarray as xr

from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.loading import load_map
from cytodisk.errors import EarlierVersionWarning, ReadError
from cytodisk.motion.disk_movie import DiskMovie, FrameRecord
from cytodisk.motion.frame_file import load_boundary
from cytodisk.scale import Scale
from cytodisk.store.activity_store import open_activity
from cytodisk.store.nuclei.profile_table import profile_table
from cytodisk.store.provenance_file import PROVENANCE, other_maps, read_complete
from cytodisk.store.results.study_results import StudyResults
from cytodisk.store.spatial.spatial_study import SpatialStudy
from cytodisk.store.study_folder import part_key
from cytodisk.store.study_kind import ACTIVITY, CELLS, MAPS
from cytodisk.store.table_file import REMEDY, check_heads, read_cells, read_checked, rows_of_cell, units_in
from cytodisk.store.tables import CONSISTENCY_COLUMNS, EDGE_COLUMNS, Columns
from cytodisk.store.window_columns import NUCLEUS_WINDOW_COLUMNS, WINDOW_COLUMNS
from cytodisk.store.written_files import recorded, unchanged

WINDOWS, EDGE, CONSISTENCY = "windows.parquet", "edge.parquet", "consistency.parquet"


@dataclass(frozen=True)
class Study(SpatialStudy, StudyResults):
    """The reading side of a study.

    Attributes
    ----------
    path : Path
    cells : DataFrame
        One row a cell, or a frame of a cell, with its status and the reason; units in
        `cells.attrs["units"]`.
    provenance : dict
        Versions, inputs with their hashes, parameters, times.

    See Also
    --------
    open_study : Opens one.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=5, radius_px=12.0)
    >>> tifffile.imwrite("masks.tif", truth.masks.astype("uint8"), metadata={"axes": "TYX"})
    >>> study = cd.run_movie("masks.tif", "out", layers=2, sectors=6)
    >>> study.is_movie, study.movie(0)[2].certificate.valid
    (True, True)
    >>> study.edge.shape[0]  # frames × sectors
    30
    """

    path: Path
    cells: pd.DataFrame
    provenance: dict[str, Any]

    def __repr__(self) -> str:
        what = f"{len(self.cells)} cells"
        if self.is_movie:
            what = f"{self.cells['cell'].nunique()} cells in {self.cells['frame'].nunique()} frames"
        return f"<Study {self.path}: {what}>"

    @property
    def scale(self) -> Scale:
        """µm per pixel and seconds per frame of the run; None where unknown."""
        return Scale(self.provenance.get("pixel_size_um"), self.provenance.get("frame_interval_s"))

    @cached_property
    def windows(self) -> pd.DataFrame:
        """One row a cell, frame, channel, layer and sector; units in `attrs["units"]`."""
        return self._table(WINDOWS, WINDOW_COLUMNS, "layer", "sector", optional=NUCLEUS_WINDOW_COLUMNS)

    @cached_property
    def nuclear_profile(self) -> pd.DataFrame:
        """For cells with nuclei, one row a cell, frame, channel and layer: see `nuclear_profile`."""
        return profile_table(self.path, self.windows)

    @cached_property
    def edge(self) -> pd.DataFrame:
        """For a movie, one row a cell, frame and sector: edge velocity, areas won and lost."""
        return self._movie_table(EDGE, EDGE_COLUMNS, "sector")

    @cached_property
    def consistency(self) -> pd.DataFrame:
        """For a movie, one row a cell, frame, channel and layer: the paper's measures."""
        return self._movie_table(CONSISTENCY, CONSISTENCY_COLUMNS, "layer")

    @property
    def is_movie(self) -> bool:
        """Whether the run was that of a movie."""
        return self.provenance.get("run") == "movie"

    def _movie_table(self, name: str, columns: Columns, *block: str) -> pd.DataFrame:
        if not self.is_movie:
            raise ReadError(f"study {self.path} is not that of a movie: it has no {name}")
        return self._table(name, columns, *block)

    def _table(self, name: str, columns: Columns, *block: str, optional: Columns = ()) -> pd.DataFrame:
        units = units_in(self.provenance)
        return read_checked(self.path / name, columns, optional, units=units, block=block)

    def map(self, cell: int, frame: int | None = None) -> DiskMap:
        """Read the map of one cell, in one frame of a movie.

        Parameters
        ----------
        cell : int
            Its number in the tables.
        frame : int, optional
            Number of the frame, for a movie.

        Returns
        -------
        DiskMap

        Raises
        ------
        ReadError
            There is no such map, as the row in `cells` says.
        """
        if self.is_movie != (frame is not None):
            raise ReadError(
                f"study {self.path}: pass {'cell and frame' if self.is_movie else 'the cell alone'}"
            )
        key = part_key(cell, frame)
        rows = self._rows_of(cell)
        if frame is not None:
            rows = rows[rows["frame"] == frame]
            if rows.empty:
                raise ReadError(f"cell {cell} of {self.path} is not in frame {frame}")
        path = self._map_path(key)
        if not path.exists():
            place = "" if frame is None else f", frame {frame},"
            reason = rows["reason"].iloc[0] or "it was not kept: run again without --no-maps"
            raise ReadError(f"cell {cell}{place} of {self.path} has no map: {reason}")
        return self._load(path)

    def activity(self, cell: int = 0) -> xr.Dataset:
        """Activity of one cell of a movie, read from disk when asked for.

        Parameters
        ----------
        cell : int

        Returns
        -------
        Dataset with dims (time, channel, layer, sector)
            Statistics of the signal and geometry of the windows; edge velocity and areas by (time, sector);
            status and reason by frame. Units are in the attrs of each variable.

        Raises
        ------
        ReadError
            The study is not a movie's, or has no such cell.
        """
        rows = self._rows_of(cell)
        found = open_activity(self.path / ACTIVITY, cell)
        if found["frame"].values.tolist() != sorted(rows["frame"]):
            raise ReadError(f"{self.path / ACTIVITY}: cell {cell} has other frames than in {CELLS}: {REMEDY}")
        return unchanged(found, self.path / ACTIVITY, self._marks)

    def movie(self, cell: int = 0) -> DiskMovie:
        """Maps of one cell through time, each read from disk when asked for.

        Parameters
        ----------
        cell : int

        Returns
        -------
        DiskMovie
            Its frame 0 is the first frame of the recording, which the cell may enter later.

        Raises
        ------
        ReadError
            The study is not a movie's, or has no such cell.
        """
        rows = self._rows_of(cell)
        if not self.is_movie:
            raise ReadError(f"study {self.path} is not that of a movie: use map({cell})")
        at = {int(row["frame"]): row for _, row in rows.iterrows()}
        records = [self._record(cell, frame, at.get(frame)) for frame in range(max(at) + 1)]
        height, width = self.provenance["image_shape"]

        def load(frame: int) -> DiskMap:
            return self._load(self._map_path(part_key(cell, frame)))

        return DiskMovie(tuple(records), (height, width), self.scale, load)

    def _record(self, cell: int, frame: int, row: Any) -> FrameRecord:
        if row is None:
            return FrameRecord("missing", f"cell {cell} is not in frame {frame} yet", None)
        if row["status"] != "ok":
            return FrameRecord(row["status"], row["reason"], None)
        path = self._map_path(part_key(cell, frame))
        held = str(row.get("nucleus_held") or "")
        return FrameRecord("ok", "", lambda: unchanged(load_boundary(path), path, self._marks), held)

    def _load(self, path: Path) -> DiskMap:
        return unchanged(replace(load_map(path), scale=self.scale), path, self._marks)

    @cached_property
    def _marks(self) -> dict[Path, str]:
        return {self.path / name: mark for name, mark in recorded(self.provenance).items()}

    def _map_path(self, key: str) -> Path:
        return self.path / MAPS / f"cell_{key}.npz"

    def _rows_of(self, cell: int) -> pd.DataFrame:
        return rows_of_cell(self.cells, cell, self.path)


def open_study(path: str | os.PathLike[str]) -> Study:
    """Read a study folder.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    Study

    Raises
    ------
    ReadError
        The folder does not exist, is not a study of `cytodisk map` or `cytodisk movie`, is damaged, was
        written by another version in another way, or its run is not complete.

    Warns
    -----
    EarlierVersionWarning
        Its maps are of another version: windows lie at other places than in studies made now.

    See Also
    --------
    run_map, run_movie : Write a study.
    open_shapes : Read what run_shapes wrote.
    open_comparison : Read what run_compare_windows wrote.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> tifffile.imwrite("mask.tif", cd.simulate.disk(12).astype("uint8"))
    >>> _ = cd.run_map("mask.tif", "out", layers=3, sectors=8)  # or: cytodisk map mask.tif -o out …
    >>> study = cd.open_study("out")
    >>> study.cells["status"].tolist(), len(study.windows)
    (['ok'], 24)
    >>> study.map(0).certificate.valid
    True
    """
    folder = Path(path)
    provenance = read_complete(folder, "map", "movie")
    names = (CELLS, WINDOWS, EDGE, CONSISTENCY) if provenance["run"] == "movie" else (CELLS, WINDOWS)
    if provenance["run"] == "movie" and "image_shape" not in provenance:
        raise ReadError(f"{folder / PROVENANCE}: image_shape is missing: {REMEDY}")
    check_heads(folder / name for name in names)
    study = Study(folder, read_cells(folder, provenance), provenance)
    if words := other_maps(provenance):
        warnings.warn(f"study {folder}: {words}", EarlierVersionWarning, stacklevel=2)
    return study

"""Read a table of a study as one that somebody may have edited: columns, types, units, keys and rows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from cytodisk.errors import ReadError
from cytodisk.memory import free_bytes
from cytodisk.parameter_words import short_words
from cytodisk.reading_files import reading_file
from cytodisk.store.nuclei.nucleus_columns import NUCLEUS_COLUMNS
from cytodisk.store.nuclei.summary_columns import PLACE_COLUMNS, channel_columns, channels_among
from cytodisk.store.study_kind import CELLS
from cytodisk.store.tables import CELL_COLUMNS, SOURCE, TRACK_COLUMNS, Column, Columns, unit_of
from cytodisk.store.window_columns import WINDOW_SIZE_COLUMNS

REMEDY = "take it from a copy of the study, or run the same command again with --overwrite"
_MOST = 1_000_000  # cells, frames, layers or sectors: names of files have at most six digits
_KEYS = ("cell", "frame", "layer", "sector")
_FILLED = (*_KEYS, "status")
_SMALL = 10**8  # bytes that there always are
_BYTES_A_VALUE = 8
_OF_ANY_VALUE = 50_000  # times smaller than a column in memory, as one of a single value is


@contextmanager
def opened_table(path: Path, remedy: str = REMEDY) -> Iterator[Any]:
    """A Parquet file whose size in memory has been compared with what is free.

    Parameters
    ----------
    path : Path
    remedy : str

    Yields
    ------
    pyarrow.parquet.ParquetFile

    Raises
    ------
    ReadError
        It is missing or damaged, or claims more rows than memory holds; also for what is read in the block.
    """
    with reading_file(path, "a table that cytodisk wrote", remedy):
        if path.exists() and not path.is_file():
            raise ReadError(f"{path} is no file: {remedy}")
        with pq.ParquetFile(path) as file:
            needed = file.metadata.num_rows * max(file.metadata.num_columns, 1) * _BYTES_A_VALUE
            if needed > _SMALL and (needed > free_bytes() or needed > _OF_ANY_VALUE * path.stat().st_size):
                raise ReadError(
                    f"{path} says it has {file.metadata.num_rows} rows, more than it can hold or than memory "
                    f"can: {remedy}"
                )
            yield file


def read_checked(
    path: Path,
    needed: Columns,
    optional: Columns = (),
    *,
    units: Sequence[str] = (),
    block: Sequence[str] = (),
    remedy: str = REMEDY,
    finite: bool = True,
    may_be_empty: Sequence[str] = (),
) -> pd.DataFrame:
    """A table with the units of its columns in `attrs["units"]`.

    Parameters
    ----------
    path : Path
    needed : tuple of Column
        Columns that it must have.
    optional : tuple of Column
        Columns that are checked where they are there.
    units : (str, str), optional
        Units of length and velocity that the study is in.
    block : sequence of str
        Keys of which each block of rows has every value in order, such as ("layer", "sector").
    remedy : str
    finite : bool
        Infinite numbers are faults.
    may_be_empty : sequence of str
        Keys that a row can do without.

    Returns
    -------
    DataFrame

    Raises
    ------
    ReadError
        It is not such a table; the message names the column, what stands there and what to do.
    """
    with opened_table(path, remedy) as file:
        found = file.schema_arrow
        for column in needed:
            if column.name not in found.names:
                raise ReadError(f"{path}: column {column.name} is missing: {remedy}")
        for column in (*needed, *optional):
            if column.name in found.names:
                _check_field(path, column, found, units, remedy)
        if len(set(found.names)) < len(found.names):
            raise ReadError(f"{path}: a column stands twice: {remedy}")
        table = file.read()
        known = [column for column in (*needed, *optional) if column.name in found.names]
        for column in known:
            place = found.get_field_index(column.name)
            field = found.field(place).with_type(column.kind)
            table = table.set_column(place, field, table.column(place).cast(column.kind))
        frame: pd.DataFrame = table.to_pandas()
        unit_by_name = {one.name: (one.metadata or {}).get(b"unit", b"").decode() for one in found}
    for column in known:
        _check_values(path, column, frame, remedy, finite)
        if column.name in _FILLED and column.name not in may_be_empty and frame[column.name].isna().any():
            row = frame[column.name].isna().argmax()
            raise ReadError(f"{path}: column {column.name} is empty in row {row}: {remedy}")
    _check_blocks(path, frame, block, remedy)
    frame.attrs["units"] = unit_by_name  # at the end: pandas copies attrs with each column that is taken
    return frame


def _check_field(path: Path, column: Column, found: Any, units: Sequence[str], remedy: str) -> None:
    """Type and unit of a column, as the schema says."""
    field = found.field(column.name)
    if not _is_alike(field.type, column.kind):
        raise ReadError(f"{path}: column {column.name} has type {field.type}, not {column.kind}: {remedy}")
    if units and any(word in column.unit for word in ("length", "velocity")):
        unit, given = unit_of(column, *units), (field.metadata or {}).get(b"unit", b"").decode()
        if unit != given:
            raise ReadError(f"{path}: column {column.name} is in {given!r}, the study in {unit!r}: {remedy}")


def _is_alike(found: Any, wanted: Any) -> bool:
    """Whether a column of one type can be read as another without loss; one of nulls alone as any."""
    same = (pa.types.is_floating, pa.types.is_integer, pa.types.is_boolean)
    texts = all(pa.types.is_string(one) or pa.types.is_large_string(one) for one in (found, wanted))
    return bool(
        found == wanted or pa.types.is_null(found) or texts or any(one(found) and one(wanted) for one in same)
    )


def _check_values(path: Path, column: Column, frame: pd.DataFrame, remedy: str, finite: bool) -> None:
    """Keys are numbers from 0; no number is infinite."""
    values = frame[column.name]
    wrong: Any = None
    if column.name in _KEYS and pa.types.is_integer(column.kind) and len(values):
        wrong = values[(values < 0) | (values >= _MOST)]
    elif finite and pa.types.is_floating(column.kind):
        wrong = values[np.isinf(values.to_numpy())]
    if wrong is not None and len(wrong):
        words = f"{short_words(wrong.iloc[0])} in row {wrong.index[0]}"
        raise ReadError(f"{path}: column {column.name} has {words}, which cannot be: {remedy}")


def _check_blocks(path: Path, frame: pd.DataFrame, block: Sequence[str], remedy: str) -> None:
    """Each cell, frame and channel has a row for every window, in order."""
    if not block or not len(frame):
        return
    sizes = [int(frame[name].max()) + 1 for name in block]
    wanted = np.indices(sizes).reshape(len(sizes), -1)
    n = wanted.shape[1]
    outer = [name for name in ("cell", "frame") if name in frame]
    whole = len(frame) % n == 0
    for name, values in zip(block, wanted, strict=True):
        whole = whole and bool((frame[name].to_numpy().reshape(-1, n) == values).all())
    for name in outer:
        rows = frame[name].to_numpy().reshape(-1, n) if whole else np.empty((0, 1))
        whole = whole and bool((rows == rows[:, :1]).all())
    if not whole:
        words = (
            f"its rows are not all {' × '.join(map(str, sizes))} of each cell, in order of {', '.join(block)}"
        )
        raise ReadError(f"{path}: {words}: {remedy}")


def read_cells(folder: Path, provenance: dict[str, Any]) -> pd.DataFrame:
    """The table of cells of a study; a movie has each cell once in a frame."""
    optional = (SOURCE, *TRACK_COLUMNS, *WINDOW_SIZE_COLUMNS, *NUCLEUS_COLUMNS, *PLACE_COLUMNS)
    with opened_table(folder / CELLS) as file:
        optional = (*optional, *channel_columns(channels_among(file.schema_arrow.names)))
    cells = read_checked(folder / CELLS, CELL_COLUMNS, optional, units=units_in(provenance))
    if not len(cells):
        raise ReadError(f"{folder / CELLS} has no rows: {REMEDY}")
    twice = cells[["cell", "frame"]].duplicated()
    if twice.any():
        row = cells[twice].iloc[0]
        raise ReadError(
            f"{folder / CELLS}: cell {row['cell']} stands twice in frame {row['frame']}: {REMEDY}"
        )
    return cells


def rows_of_cell(cells: pd.DataFrame, cell: int, folder: Path) -> pd.DataFrame:
    """The rows of one cell in the table of cells of a study; raises ReadError if there are none."""
    rows = cells[cells["cell"] == cell]
    if rows.empty:
        first, last = cells["cell"].min(), cells["cell"].max()
        there = f"only cell {first}" if first == last else f"the cells {first} to {last}"
        raise ReadError(f"study {folder} has no cell {cell}: it has {there}")
    return rows


def check_heads(paths: Iterable[Path]) -> None:
    """Raise ReadError where a table is missing or damaged, as far as its head tells."""
    for path in paths:
        with opened_table(path):
            pass


def units_in(provenance: dict[str, Any]) -> tuple[str, str]:
    """Units of length and velocity of a study."""
    return str(provenance.get("length_unit", "")), str(provenance.get("velocity_unit", ""))

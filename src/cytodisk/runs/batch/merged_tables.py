"""The studies of a batch → one set of tables, streamed, in the order of the batch file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa

from cytodisk.errors import StudyError
from cytodisk.runs.batch.batch_file import Batch
from cytodisk.runs.batch.batch_input import BatchInput, Value
from cytodisk.runs.batch.input_columns import INPUT, INPUT_COLUMNS, UNITS
from cytodisk.runs.batch.input_row import InputRow, read_row
from cytodisk.runs.batch.merged_groups import MergedGroups, match_batch, opened_table
from cytodisk.runs.map.map_kind import MAP
from cytodisk.runs.movie.movie_kind import MOVIE
from cytodisk.store.columns_file import COLUMNS_CSV, write_columns_file
from cytodisk.store.csv_tables import csv_of, parquet_to_csv
from cytodisk.store.merging import merge_tables, write_rows
from cytodisk.store.nuclei.summary_columns import channel_columns, channels_among
from cytodisk.store.tables import Column, Columns, schema
from cytodisk.store.targets import Store

_MOST = 2**63  # longer numbers are such as those on a label
_TIMES = ("seconds",)  # columns with running times, which differ from run to run
INPUTS = "inputs"


@dataclass(frozen=True)
class _Done:
    """An input with a study, the units of its tables, and how many of its cells have QC flags."""

    item: BatchInput
    units: tuple[str, str]
    qc_flags: int


def merge_batch(store: Store, batch: Batch, saw: Callable[[InputRow], None], csv: bool = False) -> list[str]:
    """Write the merged tables, and what their columns are.

    They depend on the inputs alone, to the last bit: not on the number of workers, nor on whether the run was
    stopped and resumed. So columns with running times are not in them.

    Parameters
    ----------
    store : Store
        With a row for every input.
    batch : Batch
    saw : callable
        Called with the row of each input.
    csv : bool
        Write every table as CSV too, not that of inputs alone.

    Returns
    -------
    list of str
        What a user should know of the tables.

    Raises
    ------
    StudyError
        A row or a study is missing, or the tables cannot be written.
    """
    groups = None if batch.groups is None else match_batch(store, batch.groups, batch.inputs)
    own = _own_columns(batch)
    done: list[_Done] = []
    with store.work_folder() as folder:
        file, columns = folder / f"{INPUTS}.parquet", (*own, *INPUT_COLUMNS)
        columns_schema = schema(columns, "")
        write_rows(_input_rows(store, batch, done, saw, groups), columns_schema, file)
        parquet_to_csv(file, folder / csv_of(file.name))
        names = [csv_of(file.name), file.name]
        told = [*_told(INPUTS, columns, columns_schema)]
        merged = _tables(batch)
        merged["cells"] = (*merged["cells"], *_channel_columns(store, done))
        for name, measured in merged.items():
            having = [one for one in done if _has_table(one.item, name)]
            columns = (*own, *_unit_columns(measured), *measured)
            columns_schema = _schema(columns, having)
            file = folder / f"{name}.parquet"
            merge_tables(_parts(store, having, name, batch, columns_schema, groups), columns_schema, file)
            names.append(file.name)
            if csv:
                parquet_to_csv(file, folder / csv_of(file.name))
                names.append(csv_of(file.name))
            told += _told(name, columns, columns_schema)
        write_columns_file(folder, told)
        for name in (*names, COLUMNS_CSV):
            store.put_file(folder / name, name)
    return [*_remarks(done), *(() if groups is None else groups.warnings)]


def _has_table(item: BatchInput, name: str) -> bool:
    kind = MOVIE if item.kind == MOVIE.run else MAP
    return name in (kind.tables if item.nuclei is None else kind.with_nuclei.tables)


def _remarks(done: Sequence[_Done]) -> Iterator[str]:
    if any(len({one.units[k] for one in done} - {""}) > 1 for k in range(2)):
        yield (
            "inputs have different units: the columns length_unit and velocity_unit say which row has which; "
            "give pixel_size_um and frame_interval_s to all inputs"
        )
    flagged = sum(one.qc_flags > 0 for one in done)
    if flagged:
        have = "1 input has" if flagged == 1 else f"{flagged} inputs have"
        yield (
            f"{have} cells with QC flags: column qc_flags of inputs.csv counts them, that of cells.parquet "
            "says what they are"
        )


def _own_columns(batch: Batch) -> Columns:
    """The input's name, and the columns that the user gives."""
    types = [_type([item.columns[k] for item in batch.inputs]) for k in range(len(batch.columns))]
    own = {name: Column(name, kind, "", "your own") for name, kind in zip(batch.columns, types, strict=True)}
    if batch.groups is not None:  # a column of both has no value in the batch file
        own |= {column.name: column for column in batch.groups.columns}
    return (INPUT, *own.values())


def _unit_columns(columns: Columns) -> Columns:
    """Columns for the units of each row, of those quantities that a table has."""
    units = " ".join(column.unit for column in columns)
    return tuple(column for column in UNITS if column.name.removesuffix("_unit") in units)


def _type(values: Sequence[Value]) -> Any:
    given = [value for value in values if value is not None]
    if given and all(isinstance(value, bool) for value in given):
        return pa.bool_()
    if any(isinstance(value, bool | str) for value in given) or not given:
        return pa.string()
    if any(isinstance(value, int) and abs(value) >= _MOST for value in given):
        return pa.string()
    return pa.int64() if all(isinstance(value, int) for value in given) else pa.float64()


def _values(batch: Batch, item: BatchInput, own: Any) -> dict[str, Any]:
    """The user's columns of an input, as the types of the table want them."""
    texts = {
        name: str(value) if value is not None and pa.types.is_string(own.field(name).type) else value
        for name, value in zip(batch.columns, item.columns, strict=True)
    }
    return {"input": item.name} | texts


def _input_rows(
    store: Store,
    batch: Batch,
    done: list[_Done],
    saw: Callable[[InputRow], None],
    groups: MergedGroups | None,
) -> Iterator[dict[str, Any]]:
    """Rows of the table of inputs; on the way, those that have a study are noted."""
    own = schema(_own_columns(batch), "")
    for item in batch.inputs:
        row = read_row(store, item.name)
        if row is None:
            raise StudyError(f"input {item.name} has not been done: run the same command again with --resume")
        saw(row)
        if row.complete:
            done.append(_Done(item, (row.length_unit, row.velocity_unit), row.qc_flags))
        of_groups = {} if groups is None else groups.of_input(item.name)
        yield _values(batch, item, own) | of_groups | _columns_of(row) | _paths(batch, item)


def _columns_of(row: InputRow) -> dict[str, Any]:
    names = (column.name for column in INPUT_COLUMNS)
    return {name: getattr(row, name) for name in names if name not in ("masks", "signal", "nuclei")}


def _paths(batch: Batch, item: BatchInput) -> dict[str, str | None]:
    folder = batch.path.absolute().parent
    return dict.fromkeys(("masks", "signal", "nuclei")) | {
        role: _shown(path, folder) for role, path in item.files.items()
    }


def _shown(path: Path, folder: Path) -> str:
    return (path.relative_to(folder) if path.is_relative_to(folder) else path).as_posix()


def _told(name: str, columns: Columns, found: Any) -> Iterator[tuple[str, str, str, str]]:
    """Rows of the file of columns for a table, with the units that its schema has."""
    for column in columns:
        unit = found.field(column.name).metadata[b"unit"].decode()
        yield f"{name}.parquet", column.name, unit, column.meaning


def _schema(columns: Columns, done: Sequence[_Done]) -> Any:
    """Arrow schema with the units of all inputs: as "px² or µm²" where they differ."""
    schemas = [schema(columns, *units) for units in sorted({one.units for one in done}) or [("", "")]]
    fields = []
    for field in schemas[0]:
        found = [one.field(field.name).metadata[b"unit"].decode() for one in schemas]
        fields.append(field.with_metadata({"unit": " or ".join(dict.fromkeys(filter(None, found)))}))
    return pa.schema(fields)


def _tables(batch: Batch) -> dict[str, Columns]:
    """Columns of the merged tables: all that any kind of input has."""
    kinds = {item.kind for item in batch.inputs}
    with_nuclei = {item.kind for item in batch.inputs if item.nuclei is not None}
    kept = [
        (study.with_nuclei if study.run in with_nuclei else study).tables
        for study in (MAP, MOVIE)
        if study.run in kinds
    ]
    merged: dict[str, dict[str, Any]] = {}
    for tables in kept:
        for name, columns in tables.items():
            known = merged.setdefault(name, {})
            known |= {column.name: column for column in columns if column.name not in (*known, *_TIMES)}
    return {name: tuple(columns.values()) for name, columns in merged.items()}


def _parts(
    store: Store,
    done: Sequence[_Done],
    name: str,
    batch: Batch,
    columns: Any,
    groups: MergedGroups | None,
) -> Iterator[Any]:
    """A table of all studies, a row group at a time."""
    for one in done:
        length_unit, velocity_unit = one.units
        given = _values(batch, one.item, columns)
        given |= {"length_unit": length_unit, "velocity_unit": velocity_unit}
        with opened_table(store, one.item.name, name) as file:
            for group in range(file.num_row_groups):
                table = file.read_row_group(group, use_threads=False)
                by_row = {} if groups is None else groups.of_rows(one.item.name, table)
                yield _widened(table, given | by_row, columns)


def _channel_columns(store: Store, done: Sequence[_Done]) -> Columns:
    """Columns of cells on the channels that any study with nuclei has."""
    channels: dict[str, None] = {}
    for one in done:
        if one.item.nuclei is not None:
            with opened_table(store, one.item.name, "cells") as file:
                channels |= dict.fromkeys(channels_among(file.schema_arrow.names))
    return channel_columns(list(channels))


def _column(given: Any, kind: Any, rows: int) -> Any:
    """One value, or one a row, as a column."""
    return given if isinstance(given, pa.Array) else pa.repeat(pa.scalar(given, kind), rows)


def _widened(table: Any, given: dict[str, Any], columns: Any) -> Any:
    """A study's table with the input's columns in front, and nulls for what only others have."""
    found = set(table.column_names)
    arrays = [
        table.column(field.name).cast(field.type)
        if field.name in found
        else _column(given.get(field.name), field.type, len(table))
        for field in columns
    ]
    return pa.table(arrays, schema=columns)

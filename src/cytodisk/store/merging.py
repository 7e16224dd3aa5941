"""Many small tables → one file, without ever holding all of it in memory."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

ROWS_AT_ONCE = 50_000
_PACKED = pa.ipc.IpcWriteOptions(compression="lz4")
_PARTS_AT_ONCE = 500  # a table of a few rows takes as much memory as one of hundreds
_CELLS_AT_ONCE = 1000  # dicts, which take far more room than columns


def merge_tables(parts: Iterable[Any], schema: Any, target: Path) -> None:
    """Write tables one below the other.

    Parameters
    ----------
    parts : iterable of pyarrow.Table
        Read one by one.
    schema : pyarrow.Schema
        What all of them have.
    target : Path
    """
    waiting: list[Any] = []
    rows = 0
    with pq.ParquetWriter(target, schema, use_dictionary=repeating(schema)) as writer:
        for part in parts:
            waiting.append(part)
            rows += len(part)
            if rows >= ROWS_AT_ONCE or len(waiting) == _PARTS_AT_ONCE:
                waiting = [pa.concat_tables(waiting).combine_chunks()]
            if rows >= ROWS_AT_ONCE:
                writer.write_table(*waiting)
                waiting, rows = [], 0
        if waiting:
            writer.write_table(pa.concat_tables(waiting).combine_chunks())


def write_part(table: Any, target: Path) -> None:
    """Write a small table that is to be merged: as Arrow has it, which is quicker than Parquet."""
    with pa.OSFile(str(target), "wb") as file, pa.ipc.new_file(file, table.schema, options=_PACKED) as writer:
        writer.write_table(table)


def read_part(path: Path) -> Any:
    """A table that `write_part` wrote."""
    with pa.OSFile(str(path), "rb") as file, pa.ipc.open_file(file) as reader:
        return reader.read_all()


def repeating(schema: Any) -> list[str]:
    """Columns whose values repeat: a dictionary of measured numbers takes time and saves no room."""
    return [field.name for field in schema if not pa.types.is_floating(field.type)]


def write_rows(rows: Iterable[dict[str, Any]], schema: Any, target: Path) -> None:
    """Write rows as a table.

    Parameters
    ----------
    rows : iterable of dict
        Missing values are null; what the schema does not have is left out.
    schema : pyarrow.Schema
    target : Path
    """
    rest = iter(rows)
    with pq.ParquetWriter(target, schema) as writer:
        while some := list(islice(rest, _CELLS_AT_ONCE)):
            values = [{name: row.get(name) for name in schema.names} for row in some]
            writer.write_table(pa.Table.from_pylist(values, schema=schema))

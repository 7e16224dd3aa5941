"""Tables as CSV, which any program reads: in blocks, numbers in full, and text that no program runs."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import IO, Any

import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from cytodisk.errors import StudyError
from cytodisk.files import replacing
from cytodisk.store.provenance_file import PROVENANCE, read_provenance
from cytodisk.store.written_files import recorded

_ROWS_AT_ONCE = 20_000
# A spreadsheet runs a cell that begins so, also with an apostrophe or blanks in front, or in full width.
_FORMULA = r"^'*(?:[\t\r\n]|[ \t\r\n\f\v]*[=+\-@＝＋－＠])"
_NUMBER = r"^[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?$"
_WHOLE = r"^(-?[0-9]+)$"
_QUOTED = '[",;\r\n]'


def text_made_harmless(text: str) -> str:
    """A text as a CSV file has it: with an apostrophe in front if a spreadsheet would take it for a formula.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
        What `text_as_meant` turns back. A number, such as "-5", stays as it is.

    References
    ----------
    OWASP, CSV Injection.
    """
    risky = re.match(_FORMULA, text) is not None and re.fullmatch(_NUMBER, text) is None
    return f"'{text}" if risky else text


def text_as_meant(text: str) -> str:
    """A text out of a CSV file, without the apostrophe that `text_made_harmless` put there."""
    return text[1:] if text.startswith("'") and re.match(_FORMULA, text) else text


def csv_of(table: str) -> str:
    """Name of the CSV file beside a table, as "cells.csv" beside "cells.parquet"."""
    return f"{table.removesuffix('.parquet')}.csv"


def write_csv(frame: pd.DataFrame, path: Path) -> None:
    """Write a table that is in memory as CSV.

    Parameters
    ----------
    frame : DataFrame
        Its index is left out.
    path : Path
        Is replaced when all is written.
    """
    table = pa.Table.from_pandas(pd.DataFrame(frame, copy=False), preserve_index=False)
    with replacing(path) as temporary, temporary.open("wb") as file:
        _write(file, table.schema.names, table.to_batches(_ROWS_AT_ONCE))


def parquet_to_csv(table: Path, path: Path) -> None:
    """Write a Parquet table as CSV, a block of rows in memory at a time.

    A missing value and NaN are empty fields, a number has all digits that it takes to read the same number.

    Parameters
    ----------
    table : Path
    path : Path
        Is replaced when all is written.
    """
    with pq.ParquetFile(table) as source, replacing(path) as temporary, temporary.open("wb") as file:
        _write(file, source.schema_arrow.names, _blocks(source))


def _blocks(source: Any) -> Iterator[Any]:
    """The rows of a Parquet file; no group of rows is read before the last one is written."""
    for group in range(source.num_row_groups):
        yield from source.read_row_group(group, use_threads=False).to_batches(_ROWS_AT_ONCE)


def _write(file: IO[bytes], names: Iterable[str], blocks: Iterable[Any]) -> None:
    head = pa.record_batch([pa.array([name]) for name in names], names=list(names))
    for block in chain([head], blocks):
        for line in _lines(block):
            file.write(line)


def _lines(block: Any) -> Iterator[bytes]:
    """The rows of a block, as CSV."""
    fields = [_fields(column) for column in block.columns]
    if not fields or not len(block):
        return
    joined = pc.binary_join_element_wise(*fields, ",", null_handling="replace", null_replacement="")
    yield ("\n".join(joined.to_pylist()) + "\n").encode()


def _fields(column: Any) -> Any:
    """The values of a column as they stand in the file."""
    if pa.types.is_floating(column.type):
        known = pc.if_else(pc.is_nan(column), pa.scalar(None, column.type), column)
        text = known.cast(pa.string())
        has_whole = pc.any(pc.equal(known, pc.floor(known))).as_py()
        return pc.replace_substring_regex(text, _WHOLE, r"\1.0") if has_whole else text
    text = column.cast(pa.string())
    if pa.types.is_integer(column.type) or pa.types.is_boolean(column.type):
        return text
    risky = pc.and_(
        pc.match_substring_regex(text, _FORMULA), pc.invert(pc.match_substring_regex(text, _NUMBER))
    )
    harmless = pc.if_else(risky, pc.binary_join_element_wise("'", text, ""), text)
    quoted = pc.binary_join_element_wise('"', pc.replace_substring(harmless, '"', '""'), '"', "")
    return pc.if_else(pc.match_substring_regex(harmless, _QUOTED), quoted, harmless)


def check_csv_room(folder: Path, tables: Iterable[str]) -> None:
    """Refuse to write over CSV files that no run wrote.

    Parameters
    ----------
    folder : Path
        Of a study, or one that is yet to be made.
    tables : iterable of str
        Names of the Parquet files.

    Raises
    ------
    StudyError
        A file stands where a CSV table is to go, and the provenance does not name it.
    """
    there = read_provenance(folder)
    if there is None and os.path.lexists(folder / PROVENANCE):
        return  # the run is refused, for this reason
    ours = recorded(there or {})
    others = [name for name in map(csv_of, tables) if name not in ours and os.path.lexists(folder / name)]
    if others:
        raise StudyError(other_csv_words(str(folder / others[0])))


def other_csv_words(file: str) -> str:
    """What is wrong with a file that stands where a CSV table is to go."""
    return f"{file} was not written by cytodisk, and --csv would replace it: move it, or leave --csv out"


def has_csv_tables(folder: Path, tables: Iterable[str]) -> bool:
    """Whether an earlier run wrote all tables of a study as CSV too, so that they must follow the tables."""
    ours = recorded(read_provenance(folder) or {})
    return all(csv_of(name) in ours for name in tables)

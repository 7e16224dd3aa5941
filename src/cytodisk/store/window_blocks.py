"""Read a study's largest table block by block, so that memory does not grow with the movie."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import pandas as pd

from cytodisk.store.merging import ROWS_AT_ONCE
from cytodisk.store.study import WINDOWS, Study
from cytodisk.store.table_file import opened_table


def has_signal(study: Study) -> bool:
    """Whether the table of windows holds means of a signal."""
    if _is_read(study):
        return "mean" in study.windows
    with opened_table(study.path / WINDOWS) as file:
        return "mean" in file.schema_arrow.names


def window_blocks(study: Study, *columns: str) -> Iterator[pd.DataFrame]:
    """Some columns of `Study.windows`, a block of rows after the other.

    Parameters
    ----------
    study : Study
    *columns : str

    Yields
    ------
    DataFrame
        The whole at once where the table is in memory already.
    """
    if _is_read(study):
        yield study.windows[list(columns)]
        return
    with opened_table(study.path / WINDOWS) as file:
        for block in row_blocks(file, columns, ROWS_AT_ONCE):
            yield block.to_pandas()


def row_blocks(file: Any, columns: Sequence[str], rows: int) -> Iterator[Any]:
    """Some columns of a Parquet file, a block of rows after the other.

    Parameters
    ----------
    file : pyarrow.parquet.ParquetFile
    columns : sequence of str
    rows : int
        Most in a block.

    Yields
    ------
    pyarrow.RecordBatch

    Notes
    -----
    Each row group is read on its own: a reader of all groups keeps what it has read until its end.
    """
    for group in range(file.num_row_groups):
        yield from file.iter_batches(rows, [group], columns=list(columns), use_threads=False)


def _is_read(study: Study) -> bool:
    return "windows" in vars(study)

"""What a table of groups says of all cells of a batch, by input, cell and frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from cytodisk.errors import ParameterError, StudyError
from cytodisk.runs.batch.batch_groups import masks_of
from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.batch.input_row import read_row, row_key, study_key
from cytodisk.runs.groups.groups import Groups
from cytodisk.store.tables import Columns
from cytodisk.store.targets import Store

_NEEDED = ("cell", "source", "frame", "label")
_FRAMES = 10**6  # no cell has as many: names of files have at most six digits


@dataclass(frozen=True, eq=False)
class MergedGroups:
    """The columns of a table of groups for the rows of merged tables.

    Attributes
    ----------
    columns : tuple of Column
    values : dict of str to DataFrame
        By the name of the input; a row a cell or a frame of a cell, by `cell` × 1 000 000 + `frame`.
    warnings : tuple of str
    """

    columns: Columns
    values: dict[str, pd.DataFrame]
    warnings: tuple[str, ...]

    def of_rows(self, name: str, table: Any) -> dict[str, Any]:
        """The values for the rows of a table of an input's study, as Arrow arrays by column."""
        if "cell" not in table.column_names:
            return {}
        keys = _keys(table.select([k for k in ("cell", "frame") if k in table.column_names]).to_pandas())
        at = self.values[name].index.get_indexer(keys)
        at = pa.array(at, pa.int64(), mask=at < 0)  # of a nucleus without a cell, for one
        arrays = {column.name: _array(self.values[name][column.name], column.kind) for column in self.columns}
        return {name: array.take(at) for name, array in arrays.items()}

    def of_input(self, name: str) -> dict[str, Any]:
        """The values that all cells of an input share; None for others."""
        values = self.values[name]
        shared = {}
        for column in self.columns:
            different = _array(values[column.name], column.kind).unique().to_pylist()
            shared[column.name] = different[0] if len(different) == 1 else None
        return shared


def match_batch(store: Store, groups: Groups, inputs: Sequence[BatchInput]) -> MergedGroups:
    """What a table of groups says of the cells of a batch.

    Parameters
    ----------
    store : Store
        With a row for every input.
    groups : Groups
    inputs : sequence of BatchInput

    Returns
    -------
    MergedGroups

    Raises
    ------
    ParameterError
        It does not fit the cells.
    StudyError
        A study cannot be read.
    """
    parts = [_cells(store, item) for item in inputs]
    cells = pd.concat(parts, ignore_index=True)
    try:
        found = groups.match(cells.assign(cell=cells.groupby(["input", "cell"], sort=False).ngroup()))
    except ParameterError as error:
        raise ParameterError(
            f"{error}\n  all inputs are done: mend the table, and run the same command with --resume"
        ) from error
    values = found.values.set_index(_keys(cells))
    sizes = np.cumsum([0, *map(len, parts)])
    by_input = {
        item.name: values.iloc[first:last]
        for item, first, last in zip(inputs, sizes[:-1], sizes[1:], strict=True)
    }
    return MergedGroups(groups.columns, by_input, found.warnings)


def _cells(store: Store, item: BatchInput) -> pd.DataFrame:
    """The cells of an input's study; a row without a cell for one that has none."""
    row = read_row(store, item.name)
    cells = pd.DataFrame({"cell": [-1], "frame": [0], "label": [0]})
    if row is not None and row.complete:
        with opened_table(store, item.name, "cells") as file:
            names = [name for name in _NEEDED if name in file.schema_arrow.names]
            cells = file.read(names, use_threads=False).to_pandas()
    if "source" not in cells:
        cells["source"] = item.masks.name
    paths = {source: str(masks_of(item, source)) for source in cells["source"].unique()}
    return cells.assign(input=item.name, path=cells["source"].map(paths))


def _keys(cells: pd.DataFrame) -> Any:
    """Numbers of rows: of the cell, with that of the frame behind it."""
    cell = cells["cell"].fillna(-1).to_numpy(dtype=np.int64)
    frame = cells["frame"].to_numpy(dtype=np.int64) if "frame" in cells else 0
    return pd.Index(cell * _FRAMES + frame)


def _array(values: Any, kind: Any) -> Any:
    return pa.array(values, kind, from_pandas=True)


@contextmanager
def opened_table(store: Store, name: str, table: str) -> Iterator[Any]:
    """A table of an input's study as a Parquet file; raises StudyError where it is damaged."""
    try:
        with store.open(f"{study_key(name)}/{table}.parquet") as opened, pq.ParquetFile(opened) as file:
            yield file
    except (pa.ArrowException, StudyError) as error:
        raise StudyError(
            f"the study of input {name} is damaged: {error}: remove {study_key(name)} and "
            f"{row_key(name)}, and run the same command with --resume: then it is done anew"
        ) from error

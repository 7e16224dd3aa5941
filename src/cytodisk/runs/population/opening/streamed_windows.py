"""Windows of studies → arrays, block by block, whatever the order of the rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import ReadError
from cytodisk.reading_files import reading_file
from cytodisk.store.study import WINDOWS
from cytodisk.store.table_file import REMEDY
from cytodisk.store.window_blocks import row_blocks

ROWS_AT_ONCE = 500_000
PLACE = ("cell", "frame", "channel", "layer", "sector")
GEOMETRY = ("area", "centroid_y", "centroid_x")
_LARGEST = 2**31


class WindowBlock(NamedTuple):
    """Some rows of a table of windows, as arrays.

    Attributes
    ----------
    row : ndarray of dtype int64
        Place of the cell, or of the frame of a cell, in a table.
    channel : ndarray of dtype int64
        Place of the channel among those that are read.
    layer, sector : ndarray of dtype int64
    numbers : dict of str to ndarray of dtype float64
        Measured columns, by name.
    """

    row: IntArray
    channel: IntArray
    layer: IntArray
    sector: IntArray
    numbers: dict[str, FloatArray]

    def where(self, chosen: Any) -> WindowBlock:
        """Some of the rows."""
        numbers = {name: values[chosen] for name, values in self.numbers.items()}
        return WindowBlock(
            self.row[chosen], self.channel[chosen], self.layer[chosen], self.sector[chosen], numbers
        )


@dataclass(frozen=True)
class WindowTable:
    """The table of windows of a study, read in blocks.

    Attributes
    ----------
    path : Path
    layers, sectors : int
        That the study's grid has.
    """

    path: Path
    layers: int
    sectors: int

    @classmethod
    def of(cls, folder: Path, layers: int, sectors: int) -> WindowTable:
        """That of a study folder."""
        return cls(folder / WINDOWS, layers, sectors)

    def channels(self) -> list[str]:
        """Names of the channels in their order; none if the study has no signal.

        Raises
        ------
        ReadError
            The table is missing or damaged.
        """
        found: dict[str, None] = {}
        for table in self._tables(["channel"]):
            column = table.column("channel").combine_chunks()
            names = column.dictionary.to_pylist()
            used = np.unique(column.indices.drop_null().to_numpy(zero_copy_only=False))
            found |= {str(names[k]): None for k in used if names[k] is not None}
        return list(found)

    def blocks(self, keys: pd.DataFrame, channels: Sequence[str], *columns: str) -> Iterator[WindowBlock]:
        """Rows of some cells and channels.

        Parameters
        ----------
        keys : DataFrame
            Columns cell and frame, in the order that `row` counts.
        channels : sequence of str
            Others are left out.
        *columns : str
            Measured columns to read.

        Yields
        ------
        WindowBlock

        Raises
        ------
        ReadError
            The table is damaged, or a layer or sector is none of the grid's.
        """
        found = _Lookup.of(keys)
        for table in self._tables([*PLACE, *columns]):
            row = found.places(*(self._whole(table, name) for name in PLACE[:2]))
            column = table.column("channel").combine_chunks()
            at = {name: k for k, name in enumerate(channels)}
            lookup = np.array([at.get(name, -1) for name in column.dictionary.to_pylist()] + [-1])
            channel = lookup[column.indices.fill_null(-1).to_numpy(zero_copy_only=False)]
            layer, sector = self._whole(table, "layer"), self._whole(table, "sector")
            self._check_place(layer, sector)
            chosen = np.flatnonzero((row >= 0) & (channel >= 0))
            numbers = {name: self._numbers(table, name) for name in columns}
            yield WindowBlock(row, channel, layer, sector, numbers).where(chosen)

    def _tables(self, columns: list[str]) -> Iterator[Any]:
        with (
            reading_file(self.path, "a table of windows", REMEDY),
            pq.ParquetFile(self.path, read_dictionary=["channel"]) as file,
        ):
            there = set(file.schema_arrow.names)
            if missing := [name for name in columns if name not in there]:
                raise ReadError(f"{self.path}: column {missing[0]} is missing: {REMEDY}")
            for batch in row_blocks(file, columns, ROWS_AT_ONCE):
                yield _with_dictionary(pa.Table.from_batches([batch]))

    def _whole(self, table: Any, name: str) -> IntArray:
        column = table.column(name)
        if column.null_count or not pa.types.is_integer(column.type):
            words = "is empty in some rows" if column.null_count else f"holds {column.type}, no whole numbers"
            raise ReadError(f"{self.path}: column {name} {words}: {REMEDY}")
        return np.asarray(column.to_numpy(), dtype=np.int64)

    def _numbers(self, table: Any, name: str) -> FloatArray:
        column = table.column(name)
        if not (pa.types.is_floating(column.type) or pa.types.is_integer(column.type)):
            raise ReadError(f"{self.path}: column {name} holds {column.type}, no numbers: {REMEDY}")
        values = np.asarray(column.to_numpy(), dtype=np.float64)
        if np.isinf(values).any():
            raise ReadError(f"{self.path}: column {name} has infinite numbers, which cannot be: {REMEDY}")
        return values

    def _check_place(self, layer: IntArray, sector: IntArray) -> None:
        for name, values, number in (("layer", layer, self.layers), ("sector", sector, self.sectors)):
            if len(values) and (values.min() < 0 or values.max() >= number):
                wrong = values[(values < 0) | (values >= number)][0]
                raise ReadError(
                    f"{self.path}: {name} {wrong} is none of the {number} of the study's grid: {REMEDY}"
                )


def _with_dictionary(table: Any) -> Any:
    """The table with channels as numbers, also where the file has them in another form."""
    column = table.column("channel")
    if pa.types.is_dictionary(column.type):
        return table
    names = column.cast(pa.string()).dictionary_encode()
    return table.set_column(table.column_names.index("channel"), "channel", names)


@dataclass(frozen=True)
class _Lookup:
    """Where (cell, frame) stands in a table."""

    keys: IntArray
    order: IntArray
    width: int

    @classmethod
    def of(cls, keys: pd.DataFrame) -> _Lookup:
        width = int(keys["frame"].max()) + 1 if len(keys) else 1
        joined = keys["cell"].to_numpy(np.int64) * width + keys["frame"].to_numpy(np.int64)
        order = np.argsort(joined, kind="stable")
        return cls(joined[order], order, width)

    def places(self, cell: IntArray, frame: IntArray) -> IntArray:
        """Rows of the table; -1 for what it does not have."""
        if not len(self.keys):
            return np.full(len(cell), -1)
        known = (cell >= 0) & (cell < _LARGEST) & (frame >= 0) & (frame < self.width)
        joined = np.where(known, cell * self.width + frame, -1)
        at = np.minimum(np.searchsorted(self.keys, joined), len(self.keys) - 1)
        return np.where(self.keys[at] == joined, self.order[at], -1)

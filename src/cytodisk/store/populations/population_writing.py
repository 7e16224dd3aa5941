"""Write the tables of a population, each with the columns and units that it is to have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from cytodisk.files import replacing
from cytodisk.store.columns_file import write_columns_file
from cytodisk.store.populations.place_columns import SIGNAL
from cytodisk.store.populations.population_columns import population_tables
from cytodisk.store.populations.population_study import CURVES
from cytodisk.store.study_folder import StudyFolder
from cytodisk.store.tables import Column, Columns, unit_of

LAG_UNIT, SIGNAL_UNIT, MORE = "lag_unit", "signal_unit", "more columns of cells"  # of the provenance


def write_population_table(
    folder: StudyFolder, name: str, table: pd.DataFrame, more: Mapping[str, Column] | None = None
) -> None:
    """Write one table whole.

    Parameters
    ----------
    folder : StudyFolder
        Its provenance has the units.
    name : str
        One of the tables of its kind.
    table : DataFrame
        Columns that are missing are empty; those that the kind does not have must be in `more`.
    more : dict of str to Column, optional
        Columns that stand behind those of the kind.
    """
    columns = (*folder.kind.tables[name], *(more or {}).values())
    arrays = [_array(table, column) for column in columns]
    fields = [
        pa.field(column.name, array.type, metadata={"unit": _unit(column, folder.provenance)})
        for column, array in zip(columns, arrays, strict=True)
    ]
    with replacing(folder.path / f"{name}.parquet") as temporary:
        pq.write_table(pa.table(arrays, schema=pa.schema(fields)), temporary)


def write_population_columns(folder: StudyFolder) -> None:
    """Write what the columns of all tables mean.

    Parameters
    ----------
    folder : StudyFolder
        All tables stand.
    """
    rows = [
        (f"{name}.parquet", column.name, _unit(column, folder.provenance), column.meaning)
        for name, columns in population_tables(bool(folder.provenance.get(CURVES))).items()
        for column in columns
    ]
    more = [
        ("cells.parquet", str(name), str(unit), str(meaning))
        for name, unit, meaning in folder.provenance.get(MORE, [])
    ]
    after = sum(row[0] == "cells.parquet" for row in rows)
    write_columns_file(folder.path, [*rows[:after], *more, *rows[after:]])


def _array(table: pd.DataFrame, column: Column) -> Any:
    if column.name not in table:
        return pa.nulls(len(table), column.kind)
    values = table[column.name]
    if pa.types.is_string(column.kind):
        texts = [
            None if missing else str(value) for value, missing in zip(values, values.isna(), strict=True)
        ]
        return pa.array(texts, column.kind)
    return pa.Array.from_pandas(values, type=column.kind)


def _unit(column: Column, provenance: Mapping[str, Any]) -> str:
    own = {SIGNAL: SIGNAL_UNIT, "lag": LAG_UNIT}
    if column.unit in own:
        return str(provenance.get(own[column.unit], ""))
    return unit_of(column, str(provenance.get("length_unit", "")))


def columns_of(
    table: pd.DataFrame, known: Columns, meanings: Mapping[str, tuple[str, str]]
) -> dict[str, Column]:
    """What stands in a table beside known columns, with its type.

    Parameters
    ----------
    table : DataFrame
    known : tuple of Column
    meanings : dict of str to (str, str)
        Unit and meaning by name, of those that have one.

    Returns
    -------
    dict of str to Column
    """
    names = {column.name for column in known}
    return {
        str(name): Column(
            str(name), _kind(table[name]), *meanings.get(str(name), ("", "column of the input"))
        )
        for name in table.columns
        if name not in names
    }


def _kind(values: pd.Series[Any]) -> Any:
    if pd.api.types.is_bool_dtype(values):
        return pa.bool_()
    if pd.api.types.is_integer_dtype(values):
        return pa.int64()
    return pa.float64() if pd.api.types.is_numeric_dtype(values) else pa.string()

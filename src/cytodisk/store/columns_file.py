"""The file beside the tables of a folder that says what each of their columns means."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.store.csv_tables import write_csv
from cytodisk.store.tables import Columns, unit_of

COLUMNS_CSV = "columns.csv"


def write_columns(folder: Path, tables: Mapping[str, Columns], provenance: Mapping[str, Any]) -> None:
    """Write table, column, unit and meaning of each column of the tables in a folder.

    Parameters
    ----------
    folder : Path
    tables : dict of str to tuple of Column
        By name of the table.
    provenance : dict
        Of the study, with its units.
    """
    units = [str(provenance.get(name, "")) for name in ("length_unit", "velocity_unit")]
    rows = [
        (f"{name}.parquet", column.name, unit_of(column, *units), column.meaning)
        for name, columns in tables.items()
        for column in columns
    ]
    write_columns_file(folder, rows)


def write_columns_file(folder: Path, rows: Sequence[tuple[str, str, str, str]]) -> None:
    """Write the file from its rows: table, column, unit and meaning."""
    table = pd.DataFrame(rows, columns=["table", "column", "unit", "meaning"])
    write_csv(table, folder / COLUMNS_CSV)

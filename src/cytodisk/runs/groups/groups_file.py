"""Read a table of groups: a CSV file whose rows say which cells are of which condition and experiment."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

from cytodisk.checks import is_path
from cytodisk.errors import ReadError
from cytodisk.runs.given_tables.given_table import (
    GivenTable,
    given_text,
    number_type,
    read_given_table,
    refuse_commas,
    unreadable_words,
)
from cytodisk.runs.given_tables.table_faults import Faults
from cytodisk.runs.given_tables.taken_names import RENAMED, TABLE_NAMES, renamed_words
from cytodisk.runs.groups.group_slips import empty_warnings, name_warnings, spelling_warnings
from cytodisk.runs.groups.groups import CONDITION, EXPERIMENT, WHAT, Groups
from cytodisk.runs.groups.known_cells import FILE, KEYS
from cytodisk.store.tables import Column

_MEANT = {"label": "cell", "source": "file", "input": "file"}  # what tables of results call the keys
_OF_BATCHES = ("masks", "signal", "nuclei", "length_unit", "velocity_unit")  # columns of merged tables
_TEXTS = (CONDITION, EXPERIMENT)
_EXACT = 2**53  # longer numbers are such as those on a label
_LABEL = r"[0-9]{1,18}(\.0*)?"
_MEANINGS = {CONDITION: "what was done to the cell", EXPERIMENT: "independent repetition that the cell is of"}


def read_groups(path: str | os.PathLike[str]) -> Groups:
    """Read a table of groups.

    Parameters
    ----------
    path : path-like
        CSV with commas, semicolons or tabs. Its columns `file` (name, path, or name without ending; of a
        batch also the name of an input), `cell` (label in the file) and `frame` (position in a stack, from 0)
        say which cells a row is about; it needs one of them. An empty field there stands for all. All other
        columns are values of these cells.

    Returns
    -------
    Groups

    Raises
    ------
    ReadError
        The file is missing, or cannot be read.
    ParameterError
        It is no such table; all faults are said at once.

    Examples
    --------
    >>> from pathlib import Path
    >>> import pandas as pd
    >>> from cytodisk.runs.groups.groups_file import read_groups
    >>> _ = Path("groups.csv").write_text("file,condition\\na.tif,control\\nb.tif,drug\\n")
    >>> groups = read_groups("groups.csv")
    >>> groups.of(pd.DataFrame({"source": ["b.tif", "a.tif"], "label": [1, 1], "frame": [0, 0]}))
      condition
    0      drug
    1   control
    """
    is_path("groups", path)
    file, faults = Path(path), Faults()
    try:
        text = given_text(file)
    except (OSError, ValueError) as error:
        raise ReadError(f"{WHAT} {file} {unreadable_words(error)}") from error
    table = read_given_table(file, text, faults)
    faults.raise_if_any(file, WHAT)
    table = GivenTable(table.name, table.fields.rename(columns=_known_name), table.lines)
    _check_names(table, faults)
    faults.raise_if_any(file, WHAT)
    keys = pd.DataFrame({key: _key(table, key, faults) for key in KEYS if key in table.fields})
    _check_rows(table, [key for key in KEYS if key in table.fields], faults)
    names = [str(name) for name in table.fields if name not in KEYS]
    columns, values = [], {}
    for name in names:
        values[name], kind = _values(table, name, faults)
        columns.append(Column(name, kind, "", _MEANINGS.get(name, "your own, from the table of groups")))
    faults.raise_if_any(file, WHAT)
    texts = {name: values[name] for name in _TEXTS if name in values}
    told = [*name_warnings(table, _TEXTS), *spelling_warnings(file.name, texts)]
    told += empty_warnings(table, EXPERIMENT)
    return Groups(file, tuple(columns), keys, pd.DataFrame(values), table.lines, tuple(told))


def _known_name(name: str) -> str:
    """A name as it is meant: keys, condition and experiment in any case."""
    lower = name.lower()
    return lower if lower in (*KEYS, *_TEXTS) else name


def _check_names(table: GivenTable, faults: Faults) -> None:
    names, place = [str(name) for name in table.fields], f"{table.name} line 1"
    if not names:
        faults.add(table.name, "has no rows: write columns such as file,condition,experiment")
        return
    twice = sorted({name for name in names if names.count(name) > 1})
    for name in twice:
        faults.add(place, f"column {name!r} stands twice, in other cases: keep one")
    for name in names:
        if name in RENAMED:
            faults.add(place, renamed_words(name))
        elif name in _MEANT:
            faults.add(place, f"column {name!r} is called {_MEANT[name]} in a {WHAT}: rename it")
        elif name not in KEYS and name in (*TABLE_NAMES, *_OF_BATCHES):
            faults.add(place, f"column {name!r} is one that the tables have anyway: choose another name")
        elif not name.isprintable():
            faults.add(place, f"column {name!r} has a name that cannot be printed: rename it")
    if not any(key in names for key in (*KEYS, *_MEANT)):
        faults.add(
            place,
            f"has no column that says which cells: name one file, cell or frame; it has {', '.join(names)}",
        )
    if all(name in KEYS for name in names):
        faults.add(place, "says nothing of the cells: add a column condition, experiment, or your own")
    if not len(table.fields):
        faults.add(table.name, "has no rows below the names")


def _key(table: GivenTable, key: str, faults: Faults) -> pd.Series[Any]:
    """A column of keys, in which nothing stands for all."""
    texts = table.fields[key]
    if key == FILE:
        return texts.where(texts != "", None).astype("object")
    given = (texts != "").to_numpy()
    wrong = np.flatnonzero(given & ~texts.str.fullmatch(_LABEL).to_numpy(dtype=bool)).tolist()
    what = "label of the cell in its file" if key == "cell" else "number of the frame, from 0"
    faults.add_rows(
        wrong,
        lambda row: (table.place(row), f"{key} must be a whole number ({what}), got {texts.iloc[row]!r}"),
    )
    if wrong:
        return pd.Series(pd.NA, texts.index, dtype="Int64")
    whole = texts.str.replace(r"\.0*$", "", regex=True)
    numbers = pd.to_numeric(whole.where(given, "0")).astype("Int64")
    return numbers.where(given, pd.NA)


def _check_rows(table: GivenTable, keys: list[str], faults: Faults) -> None:
    """Each row is about some cells, and says their condition if there is such a column."""
    bare = np.flatnonzero((table.fields[keys] == "").all(axis=1).to_numpy()).tolist()
    words = f"does not say which cells: fill in {' or '.join(keys)}"
    faults.add_rows(bare, lambda row: (table.place(row), words))
    if CONDITION in table.fields:
        empty = np.flatnonzero((table.fields[CONDITION] == "").to_numpy()).tolist()
        words = "the condition is empty: fill it in, or take the row out of the table"
        faults.add_rows(empty, lambda row: (table.place(row), words))


def _values(table: GivenTable, name: str, faults: Faults) -> tuple[pd.Series[Any], Any]:
    """The values of a column and their type in tables; a text is None where the field is empty."""
    texts = table.fields[name]
    if name not in _TEXTS:
        refuse_commas(table, name, faults)
        kind = number_type(texts)
        if kind is not None:
            numbers = pd.to_numeric(texts.where(texts != "", None).astype("object"), errors="coerce")
            if kind is int and bool((numbers.abs().fillna(0) < _EXACT).all()):
                return numbers.astype("Int64"), pa.int64()
            if kind is float and bool(np.isfinite(numbers.dropna()).all()):
                return numbers.astype(float), pa.float64()
    return texts.astype("object").where(texts != "", None), pa.string()

"""The batch file: TOML, perhaps with a table of inputs beside it, → inputs, all checked."""

from __future__ import annotations

import csv
import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path
from typing import Any

from cytodisk.errors import ParameterError, words_of
from cytodisk.files import real_path
from cytodisk.number_words import comma_advice, comma_in_toml, without_comma
from cytodisk.reading_files import text_of
from cytodisk.runs.batch.batch_faults import Faults
from cytodisk.runs.batch.batch_file_rows import COLUMNS, KEYS, PARAMETERS_OF, FileRow, RowReader
from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.batch.input_columns import OWN_COLUMNS
from cytodisk.runs.channel_names import common_signal_name
from cytodisk.store.csv_tables import text_as_meant
from cytodisk.store.nuclei.nucleus_columns import NUCLEI_COLUMNS, NUCLEUS_COLUMNS
from cytodisk.store.tables import (
    CONSISTENCY_COLUMNS,
    EDGE_COLUMNS,
    SOURCE_COLUMNS,
    TRACK_COLUMNS,
)
from cytodisk.store.window_columns import NUCLEUS_WINDOW_COLUMNS, WINDOW_COLUMNS, WINDOW_SIZE_COLUMNS

_SIZES = ("pixel_size_um", "frame_interval_s")
_CELLS = (*SOURCE_COLUMNS, *TRACK_COLUMNS, *WINDOW_SIZE_COLUMNS)
_OF_NUCLEI = (*NUCLEUS_COLUMNS, *NUCLEI_COLUMNS, *NUCLEUS_WINDOW_COLUMNS)
_TABLES = (_CELLS, WINDOW_COLUMNS, EDGE_COLUMNS, CONSISTENCY_COLUMNS, _OF_NUCLEI)
_WHOLE = r"[+-]?(0|[1-9][0-9]*)"
_NUMBER = _WHOLE + r"(\.[0-9]*)?([eE][+-]?[0-9]+)?"
_LONGEST_NUMBER = 100  # characters; what is longer stays a text
_TAKEN = {*KEYS, *OWN_COLUMNS, *(column.name for columns in _TABLES for column in columns)}


@dataclass(frozen=True)
class Batch:
    """What a batch file says.

    Attributes
    ----------
    path : Path
    table : Path or None
        The table of inputs that it names.
    inputs : tuple of BatchInput
        In the order of the file; no two have one name.
    columns : tuple of str
        Names of the columns that inputs carry: "condition", "replicate" and those of the user.
    """

    path: Path
    table: Path | None
    inputs: tuple[BatchInput, ...]
    columns: tuple[str, ...]


def read_batch(path: Path) -> Batch:
    """Read a batch file and find its inputs.

    Parameters
    ----------
    path : Path
        TOML with [study] (kind, columns, table), [parameters] and [[inputs]].

    Returns
    -------
    Batch

    Raises
    ------
    ParameterError
        The file cannot be read, or anything in it cannot be used; all faults are said at once.
    """
    text = _read(path, "batch file")
    try:
        content = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # numbers of thousands of digits, deep nesting
        words = comma_in_toml(text) or f"is no TOML: {error}"
        raise ParameterError(f"batch file {path}: {words}") from error
    faults = Faults()
    faults.add_unknown("top", "table", content, ("study", "parameters", "inputs"))
    study, parameters = _section(content, "study", faults), _section(content, "parameters", faults)
    faults.add_unknown("[study]", "name", study, ("kind", "columns", "table"))
    kind = study.get("kind", "movie")
    if kind not in tuple(PARAMETERS_OF):
        faults.add("[study]", f"kind must be movie or map, got {kind!r}")
        kind = "movie"
    faults.add_unknown("[parameters]", "parameter", parameters, PARAMETERS_OF[kind].model_fields)
    columns = _columns(study.get("columns", []), faults)
    rows = list(_inputs_of(content.get("inputs", []), text, faults))
    table = None if "table" not in study else path.absolute().parent / str(study["table"])
    if table is not None:
        rows += _rows_of_table(table, columns, faults)
    faults.raise_if_any(path)  # what follows would only repeat it
    if not rows:
        raise ParameterError(f"batch file {path} has no inputs: add [[inputs]], or a table in [study]")
    reader = RowReader(path.absolute().parent, kind, parameters, columns, faults)
    inputs = tuple(_all_different(reader, rows))
    faults.raise_if_any(path)
    name = common_signal_name([item.signal for item in inputs if item.signal is not None])
    return Batch(path, table, tuple(replace(item, signal_name=name) for item in inputs), columns)


def _read(path: Path, what: str) -> str:
    try:
        return text_of(path)
    except (OSError, ValueError) as error:
        raise ParameterError(f"{what} {path} cannot be read: {words_of(error)}") from error


def _section(content: dict[str, Any], name: str, faults: Faults) -> dict[str, Any]:
    section = content.get(name, {})
    if isinstance(section, dict):
        return section
    faults.add(f"[{name}]", f"must be a table, got {section!r}")
    return {}


def _columns(given: Any, faults: Faults) -> tuple[str, ...]:
    if not isinstance(given, list) or any(not isinstance(name, str) or not name for name in given):
        faults.add("[study]", f"columns must be a list of names, got {given!r}")
        return COLUMNS
    for name in given:
        if name in _TAKEN:
            faults.add("[study]", f"column {name!r} is one that the tables have anyway: choose another name")
    for name in (name for name, number in Counter(given).items() if number > 1):
        faults.add("[study]", f"column {name!r} stands twice")
    return (*COLUMNS, *given)


def _inputs_of(given: Any, text: str, faults: Faults) -> Iterator[FileRow]:
    if not isinstance(given, list) or any(not isinstance(values, dict) for values in given):
        faults.add("[[inputs]]", f"must be tables, got {str(given)[:60]}")
        return
    lines = [
        number for number, line in enumerate(text.splitlines(), 1) if re.match(r"\s*\[\[\s*inputs", line)
    ]
    for number, values in enumerate(given):
        line = f" (line {lines[number]})" if len(lines) == len(given) else ""
        yield FileRow(f"[[inputs]] {number + 1}{line}", values)


def _rows_of_table(table: Path, columns: tuple[str, ...], faults: Faults) -> list[FileRow]:
    """Rows of a CSV file; an empty field is one that is not given."""
    text = _read(table, "table of inputs")
    separator = max(",;\t", key=text.lstrip().partition("\n")[0].count)
    reader = csv.reader(StringIO(text), delimiter=separator, strict=True)
    stripped = ([field.strip() for field in fields] for fields in reader)
    filled = (list(map(text_as_meant, fields)) for fields in stripped if any(fields))
    rows = []
    try:
        names = next(filled, [])
        for name in (name for name, number in Counter(filter(None, names)).items() if number > 1):
            faults.add(f"{table.name} line {reader.line_num}", f"column {name!r} stands twice")
        for fields in filled:
            place = f"{table.name} line {reader.line_num}"
            if any(fields[len(names) :]):
                advice = "put quotes around a field with a comma, and write numbers with a point (0.2)"
                faults.add(place, f"has more fields than the {len(names)} of the first line: {advice}")
            given: dict[str, Any] = {name: field for name, field in zip(names, fields, strict=False) if field}
            if "" in given:
                faults.add(place, f"{given.pop('')!r} stands in a column without a name: name or remove it")
            if "channels" in given:
                given |= {"channels": [part.strip() for part in re.split("[,;|]", given["channels"])]}
            for name in (name for name in _SIZES if re.fullmatch(_NUMBER, str(given.get(name)))):
                given[name] = float(given[name])
            rows.append(FileRow(place, given))
    except csv.Error as error:
        faults.add(f"{table.name} line {reader.line_num}", f"is no CSV: {error}")
    _refuse_commas(rows, columns, faults)
    return _with_numbers(rows, columns)


def _refuse_commas(rows: list[FileRow], columns: Iterable[str], faults: Faults) -> None:
    """A fault for columns of numbers of which some have a comma: they would be texts."""
    for column in columns:
        given = [row for row in rows if column in row.values]
        commas = [row for row in given if without_comma(row.values[column])]
        if commas and all(re.fullmatch(_NUMBER, row.values[column]) for row in given if row not in commas):
            advice = comma_advice(commas[0].values[column])
            others = f" (and {len(commas) - 1} more lines)" if len(commas) > 1 else ""
            faults.add(commas[0].place, f"{column} {commas[0].values[column]!r}{others}: {advice}")


def _with_numbers(rows: list[FileRow], columns: Iterable[str]) -> list[FileRow]:
    """Columns in which all fields are numbers become numbers: "1", but not "001" or "1_2"."""
    for column in columns:
        given = [row.values for row in rows if column in row.values]
        if any(len(values[column]) > _LONGEST_NUMBER for values in given):
            continue
        for kind, pattern in ((int, _WHOLE), (float, _NUMBER)):
            if all(re.fullmatch(pattern, values[column]) for values in given):
                for values in given:
                    values[column] = kind(values[column])
                break
    return rows


def _all_different(reader: RowReader, rows: Iterable[FileRow]) -> Iterator[BatchInput]:
    """Inputs of all rows; a name or a mask file that came before is a fault."""
    names: dict[str, str] = {}
    files: dict[Path, str] = {}
    for row in rows:
        for item in reader.inputs(row):
            place = f"{row.place}, {item.masks.name}"
            file = real_path(item.masks)
            if file in files:
                reader.faults.add(place, f"the masks {item.masks} are an input already, in {files[file]}")
            elif item.name.casefold() in names:
                reader.faults.add(
                    place,
                    f"the name {item.name!r} is taken by {names[item.name.casefold()]}: give a name, as "
                    'name = "{folder}-{stem}"',
                )
            files.setdefault(file, row.place)
            names.setdefault(item.name.casefold(), place)
            yield item

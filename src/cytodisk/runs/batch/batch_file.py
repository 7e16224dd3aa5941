"""The batch file: TOML, perhaps with a table of inputs beside it, → inputs, all checked."""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from cytodisk.errors import ParameterError
from cytodisk.files import real_path
from cytodisk.number_words import comma_in_toml
from cytodisk.runs.batch.batch_file_rows import COLUMNS, KEYS, PARAMETERS_OF, FileRow, RowReader
from cytodisk.runs.batch.batch_groups import read_batch_groups
from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.batch.input_columns import OWN_COLUMNS
from cytodisk.runs.channel_names import common_signal_name
from cytodisk.runs.given_tables.given_table import (
    NUMBER,
    given_text,
    number_type,
    read_given_table,
    refuse_commas,
    unreadable_words,
)
from cytodisk.runs.given_tables.table_faults import Faults
from cytodisk.runs.given_tables.taken_names import RENAMED, TABLE_NAMES, renamed_words
from cytodisk.runs.groups.groups import Groups

_SIZES = ("pixel_size_um", "frame_interval_s")
_TAKEN = {*KEYS, *OWN_COLUMNS, *TABLE_NAMES}


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
        Names of the columns that inputs carry: "condition", "experiment" and those of the user.
    groups : Groups or None
        What was done to which cell, for cells of one input that differ.
    """

    path: Path
    table: Path | None
    inputs: tuple[BatchInput, ...]
    columns: tuple[str, ...]
    groups: Groups | None = None


def read_batch(path: Path, groups: Path | None = None) -> Batch:
    """Read a batch file and find its inputs.

    Parameters
    ----------
    path : Path
        TOML with [study] (kind, columns, table, groups), [parameters] and [[inputs]].
    groups : Path, optional
        Table of groups, in the place of the one that the file names.

    Returns
    -------
    Batch

    Raises
    ------
    ParameterError
        The file cannot be read, or anything in it cannot be used; all faults are said at once.
    ReadError
        The table of groups cannot be read.
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
    faults.add_unknown("[study]", "name", study, ("kind", "columns", "table", "groups"))
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
    if groups is None and "groups" in study:
        groups = path.absolute().parent / str(study["groups"])
    of_groups = None if groups is None else read_batch_groups(groups, inputs, columns)
    return Batch(path, table, tuple(replace(item, signal_name=name) for item in inputs), columns, of_groups)


def _read(path: Path, what: str) -> str:
    try:
        return given_text(path)
    except (OSError, ValueError) as error:
        raise ParameterError(f"{what} {path} {unreadable_words(error)}") from error


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
        if name in RENAMED:
            faults.add("[study]", f"{renamed_words(name)}, and take it out here: it is always there")
        elif name in _TAKEN:
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
    given = read_given_table(table, _read(table, "table of inputs"), faults)
    own = [name for name in columns if name in given.fields and name not in COLUMNS]
    kinds = {name: kind for name in own if (kind := number_type(given.fields[name])) is not None}
    kinds |= dict.fromkeys(_SIZES, float)
    rows = []
    for number, fields in enumerate(given.fields.to_dict("records")):
        values: dict[str, Any] = {str(name): field for name, field in fields.items() if field}
        if "channels" in values:
            values |= {"channels": [part.strip() for part in re.split("[,;|]", values["channels"])]}
        for name, kind in kinds.items():
            if name in values and re.fullmatch(NUMBER, values[name]):
                values[name] = kind(values[name])
        rows.append(FileRow(given.place(number), values))
    for name in own:
        refuse_commas(given, name, faults)
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

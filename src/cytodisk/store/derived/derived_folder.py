"""A folder of what was computed from a study: its tables, their columns in words, and its settings."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar
from urllib.parse import quote

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from cytodisk.errors import ReadError, StudyError
from cytodisk.files import flush, make_folder, temporary_name
from cytodisk.reading_files import checked, json_of, reading_file, text_of
from cytodisk.store.columns_file import write_columns
from cytodisk.store.csv_tables import parquet_to_csv
from cytodisk.store.provenance_file import read_provenance
from cytodisk.store.table_file import read_checked
from cytodisk.store.tables import Column, Columns, write_table
from cytodisk.store.written_files import recorded, writing_files

if TYPE_CHECKING:
    from pydantic import TypeAdapter

SETTINGS = "settings.json"
TABLES = "tables"  # in the settings: names and types of the columns of each table
_LONGEST_NAME, _MARK = 70, 12  # characters: three such names make one of a folder, which has up to 255


class DerivedFolder:
    """A folder with tables that were computed from a study, which are read when asked for.

    Attributes
    ----------
    path : Path
    settings : dict
        What was asked for, the version of cytodisk, and names and types of the columns of the tables.
    command : str
        The command that writes such a folder.
    may_be_empty : tuple of str
        Keys that rows of its tables can do without, as the layer in what is told of the edge.
    needed : dict of str to tuple of str
        Columns by table that readers ask for, which a table of an earlier version may lack.
    """

    path: Path
    settings: dict[str, Any]
    command: ClassVar[str]
    may_be_empty: ClassVar[tuple[str, ...]] = ()
    needed: ClassVar[Mapping[str, tuple[str, ...]]] = {}

    def _optional(self, name: str) -> pd.DataFrame | None:
        return self._table(name) if (self.path / f"{name}.parquet").exists() else None

    def _table(self, name: str) -> pd.DataFrame:
        told = self.settings.get(TABLES, {}).get(name, {})
        columns = tuple(Column(column, pa.type_for_alias(kind), "", "") for column, kind in told.items())
        file = self.path / f"{name}.parquet"
        how: Any = {"remedy": remedy(self.command), "finite": False, "may_be_empty": self.may_be_empty}
        table = read_checked(file, columns, **how)
        if missing := [one for one in self.needed.get(name, ()) if one not in table]:
            raise ReadError(
                f"{file}: column {missing[0]} is missing, which an earlier cytodisk did not write: "
                f"run {self.command} again"
            )
        return table


def remedy(command: str) -> str:
    """What to do about a damaged folder that a command wrote."""
    return f"remove the folder that it stands in, and run {command} again"


def folder_name(names: Sequence[str]) -> str:
    """Name of a folder for some names, "~" between them.

    Parameters
    ----------
    names : sequence of str
        What no file name can hold is written with %, and long names are cut.
    """
    return "~".join(quoted(name) for name in names)


def quoted(name: str) -> str:
    """A name as a part of that of a folder."""
    words = quote(name, safe=" +-,()", errors="surrogatepass").replace("~", "%7E")
    if len(words) > _LONGEST_NAME:  # what tells it from others that begin alike is its hash
        mark = hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:_MARK]
        words = f"{words[: _LONGEST_NAME - _MARK - 1]}+{mark}"
    return f"%2E{words[1:]}" if words.startswith(".") else words  # a dot in front hides a folder


def write_derived(
    study: Path,
    target: Path,
    tables: Mapping[str, pd.DataFrame],
    columns: Mapping[str, Columns],
    settings: Mapping[str, Any],
    csv: bool = False,
) -> None:
    """Write such a folder whole, in place of the one that was there; its files are noted as the study's.

    Parameters
    ----------
    study : Path
    target : Path
        The folder, in a folder of the study, such as "correlation/Rac1~velocity".
    tables : dict of str to DataFrame
        With units in `attrs`.
    columns : dict of str to tuple of Column
        What the columns of these tables, and perhaps of others, mean.
    settings : dict
    csv : bool
        Write every table as CSV too.

    Raises
    ------
    StudyError
        The folder cannot be written, or is a link: what lies behind it may be another's.
    """
    if target.is_symlink():
        raise StudyError(f"cannot write {target}: it is a link to {target.readlink()}; remove the link")
    content = {**settings, TABLES: {}}
    temporary = target.with_name(temporary_name())
    place = target.relative_to(study).as_posix()
    try:
        make_folder(temporary)
        for table_name, table in tables.items():
            file = temporary / f"{table_name}.parquet"
            write_table(table, file)
            content[TABLES][table_name] = {one.name: str(one.type) for one in pq.read_schema(file)}
            if csv:
                parquet_to_csv(file, file.with_suffix(".csv"))
        told = {
            table_name: tuple(column for column in columns[table_name] if column.name in table)
            for table_name, table in tables.items()
        }
        write_columns(temporary, told, read_provenance(study) or {})
        text = json.dumps(content, indent=2, ensure_ascii=False)
        (temporary / SETTINGS).write_text(text + "\n", encoding="utf-8")
        flush(temporary.iterdir())
        there = [name for name in recorded(read_provenance(study) or {}) if name.startswith(f"{place}/")]
        new = [f"{place}/{file.name}" for file in temporary.iterdir()]
        with writing_files(study, *dict.fromkeys([*new, *there])):
            _exchange(target, temporary, [name.removeprefix(f"{place}/") for name in there])
    except OSError as error:
        raise StudyError(f"cannot write {target}: {error.strerror or error}") from error
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def read_settings(
    path: Path, shape: Callable[[], TypeAdapter[Any]], what: str, command: str
) -> dict[str, Any] | None:
    """Settings of such a folder; None where there is none.

    Parameters
    ----------
    path : Path
        The folder.
    shape : callable
        Returns the type that its settings have, as `correlation_settings`.
    what : str
        What the settings are those of, as "a correlation".
    command : str
        The command that writes it.

    Raises
    ------
    ReadError
        They are damaged.
    """
    file = path / SETTINGS
    if not file.exists():
        return None
    with reading_file(file, f"the settings of {what}", remedy(command)):
        found: dict[str, Any] = json_of(text_of(file))
        checked(found, shape, str(file), remedy(command))
    return found


def _exchange(target: Path, new: Path, own: Collection[str]) -> None:
    """Put a folder in the place of another, which is there until the new one is, or comes back.

    Of the old one what is `own` is removed; other files move to the new one.
    """
    old = target.with_name(f".old~{target.name}")
    if old.exists() and not target.exists():
        old.replace(target)  # an earlier process died between the two steps below
    _dissolve(old, target, own)
    if target.exists():
        target.replace(old)
    try:
        new.replace(target)
    except BaseException:
        if old.exists():
            old.replace(target)
        raise
    _dissolve(old, target, own)


def _dissolve(old: Path, target: Path, own: Collection[str]) -> None:
    """Remove a folder that was replaced, but for files that are not its study's: these move."""
    if not old.exists():
        return
    for file in [file for file in old.rglob("*") if not file.is_dir() or file.is_symlink()]:
        name = file.relative_to(old).as_posix()
        if name not in own:
            make_folder((target / name).parent)
            file.replace(target / name)
    shutil.rmtree(old)

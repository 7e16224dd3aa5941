"""Correlations of a study on disk: a folder for each pair of names, with its tables and settings."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from cytodisk.errors import ReadError, StudyError
from cytodisk.files import flush, make_folder, temporary_name
from cytodisk.reading_files import checked, json_of, reading_file, text_of
from cytodisk.store.columns_file import write_columns
from cytodisk.store.csv_tables import parquet_to_csv
from cytodisk.store.json_shapes import correlation_settings
from cytodisk.store.provenance_file import read_provenance
from cytodisk.store.table_file import read_checked
from cytodisk.store.tables import Column, Columns, write_table
from cytodisk.store.written_files import recorded, writing_files

CORRELATION = "correlation"
SETTINGS = "settings.json"
TABLES = "tables"  # in the settings: names and types of the columns of each table
_REMEDY = "remove the folder that it stands in, and run cytodisk correlate again"
_LONGEST_NAME, _MARK = 70, 12  # characters: three such names make one of a folder, which has up to 255


@dataclass(frozen=True)
class CorrelationFolder:
    """A folder with the tables of a correlation, which are read when asked for.

    Attributes
    ----------
    path : Path
    signal, with_, name : str
        See `Correlation`.
    settings : dict
    """

    path: Path
    signal: str
    with_: str
    name: str
    settings: dict[str, Any]

    def _optional(self, name: str) -> pd.DataFrame | None:
        return self._table(name) if (self.path / f"{name}.parquet").exists() else None

    def _table(self, name: str) -> pd.DataFrame:
        told = self.settings.get(TABLES, {}).get(name, {})
        columns = tuple(Column(column, pa.type_for_alias(kind), "", "") for column, kind in told.items())
        return read_checked(self.path / f"{name}.parquet", columns, remedy=_REMEDY, finite=False)


@dataclass(frozen=True)
class Correlation(CorrelationFolder):
    """A correlation of a study, read from disk; tables are read when asked for.

    Every table has its units by column in `attrs["units"]`.

    Attributes
    ----------
    path : Path
        Its folder.
    signal, with_ : str
        What was correlated. Positive lag: `with_` comes after `signal`.
    name : str
        Name of a variant; empty for none.
    settings : dict
        What was asked for, and the version of cytodisk.
    """

    @cached_property
    def cells(self) -> pd.DataFrame:
        """One row a cell of the study: status, the reason if it was left out, share of drifting series."""
        return self._table("cells")

    @cached_property
    def windows(self) -> pd.DataFrame:
        """One row a window: correlation at the peak, its lag, n, confidence, p and q."""
        return self._table("windows")

    @cached_property
    def layers(self) -> pd.DataFrame:
        """One row a layer: the peak of the mean over sectors, its lag, p, q and threshold."""
        return self._table("layers")

    @cached_property
    def clusters(self) -> pd.DataFrame | None:
        """One row a cluster: lag, sign, p, its layers and sectors in words; None when they were not made."""
        return self._optional("clusters")

    @cached_property
    def curves(self) -> pd.DataFrame:
        """One row a window and lag."""
        return self._table("curves")

    @cached_property
    def layer_curves(self) -> pd.DataFrame:
        """One row a layer and lag: mean over sectors, quartiles, threshold."""
        return self._table("layer_curves")

    @cached_property
    def pairs(self) -> pd.DataFrame | None:
        """One row a kind of distance, distance and lag; None when pairs were not asked for."""
        return self._optional("pairs")

    @cached_property
    def events(self) -> pd.DataFrame | None:
        """One row for each event of the edge; None unless `with_` is a velocity."""
        return self._optional("events")

    @cached_property
    def event_averages(self) -> pd.DataFrame | None:
        """One row for each kind of event, layer and delay: the signal around onsets; None as for `events`."""
        return self._optional("event_averages")


def correlation_path(study: Path, signal: str, with_: str, name: str = "") -> Path:
    """Folder of a correlation; what no file name can hold is written with %, and long names are cut."""
    names = (signal, with_, name) if name else (signal, with_)
    return study / CORRELATION / "~".join(_quoted(part) for part in names)


def write_correlation(
    study: Path,
    signal: str,
    with_: str,
    tables: Mapping[str, pd.DataFrame],
    columns: Mapping[str, Columns],
    settings: dict[str, Any],
    name: str = "",
    csv: bool = False,
) -> Correlation:
    """Write a correlation whole, in place of the one that was there.

    Parameters
    ----------
    study : Path
    signal, with_ : str
    tables : dict of str to DataFrame
        With units in `attrs`.
    columns : dict of str to tuple of Column
        What the columns of these tables, and perhaps of others, mean.
    settings : dict
    name : str
        Name of a variant, which stands beside the others.
    csv : bool
        Write every table as CSV too.

    Returns
    -------
    Correlation

    Raises
    ------
    StudyError
        The folder cannot be written, or is a link: what lies behind it may be another's.
    """
    target = correlation_path(study, signal, with_, name)
    if target.is_symlink():
        raise StudyError(f"cannot write {target}: it is a link to {target.readlink()}; remove the link")
    content = {"signal": signal, "with": with_, "name": name} | settings | {TABLES: {}}
    temporary = target.with_name(temporary_name())
    place = f"{CORRELATION}/{target.name}"
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
    return read_correlation(study, signal, with_, name)


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


def read_correlation(study: Path, signal: str, with_: str, name: str = "") -> Correlation:
    """Open a correlation.

    Raises
    ------
    ReadError
        It is not there; the message lists those that are.
    """
    path = correlation_path(study, signal, with_, name)
    settings = _settings(path)
    if settings is None:
        there = [titled(*names) for names in list_correlations(study)]
        advice = f"it has {'; '.join(there)}" if there else "run cytodisk correlate first"
        raise ReadError(f"study {study} has no correlation of {titled(signal, with_, name)}: {advice}")
    return Correlation(path, signal, with_, name, settings)


def list_correlations(study: Path) -> list[tuple[str, ...]]:
    """What was correlated, in the order of the folders: (signal, with), or (signal, with, name)."""
    found = [_settings(path) for path in sorted((study / CORRELATION).glob("[!.]*~*"))]
    names = [(known["signal"], known["with"], known.get("name", "")) for known in found if known is not None]
    return [one if one[2] else one[:2] for one in names]


def titled(signal: str, with_: str, name: str = "") -> str:
    """A correlation in words, such as "Rac1 with velocity (linear)"."""
    return f"{signal} with {with_}" + (f" ({name})" if name else "")


def _settings(path: Path) -> dict[str, Any] | None:
    file = path / SETTINGS
    if not file.exists():
        return None
    with reading_file(file, "the settings of a correlation", _REMEDY):
        found: dict[str, Any] = json_of(text_of(file))
        checked(found, correlation_settings, str(file), _REMEDY)
    return found


def _quoted(name: str) -> str:
    quoted = quote(name, safe=" +-,()", errors="surrogatepass").replace("~", "%7E")
    if len(quoted) > _LONGEST_NAME:  # what tells it from others that begin alike is its hash
        mark = hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:_MARK]
        quoted = f"{quoted[: _LONGEST_NAME - _MARK - 1]}+{mark}"
    return f"%2E{quoted[1:]}" if quoted.startswith(".") else quoted  # a dot in front hides a folder

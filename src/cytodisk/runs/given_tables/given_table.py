"""A table that a user wrote as CSV, in a spreadsheet or by hand: its fields as texts, by column."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from io import StringIO
from itertools import islice, zip_longest
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import IntArray
from cytodisk.errors import words_of
from cytodisk.number_words import comma_advice, without_comma
from cytodisk.reading_files import text_of
from cytodisk.runs.given_tables.table_faults import Faults
from cytodisk.store.csv_tables import text_as_meant

WHOLE = r"[+-]?(0|[1-9][0-9]*)"
NUMBER = WHOLE + r"(\.[0-9]*)?([eE][+-]?[0-9]+)?"
_LONGEST_NUMBER = 100  # characters; what is longer stays a text
_SEPARATORS = ",;\t"
_ROWS_AT_ONCE = 10_000  # as lists, which take far more room than columns


@dataclass(frozen=True, eq=False)
class GivenTable:
    """The rows of a table that are not blank.

    Attributes
    ----------
    name : str
        Of the file.
    fields : DataFrame
        Texts by the names of the first line, without spaces around them; "" where a field is empty.
    lines : ndarray of shape (rows,) and dtype int
        Where each row ends in the file, from 1.
    """

    name: str
    fields: pd.DataFrame
    lines: IntArray

    def place(self, row: int) -> str:
        """Where a row stands, in words."""
        return f"{self.name} line {self.lines[row]}"


def given_text(path: Path) -> str:
    """The text of a table.

    Raises
    ------
    OSError, ValueError
        It cannot be read, or is no text; the message says what to save.
    """
    try:
        return text_of(path)
    except UnicodeDecodeError as error:
        content = path.read_bytes()[:4]
        what = "an Excel workbook" if content.startswith(b"PK\x03\x04") else "not in UTF-8"
        raise ValueError(f"it is {what}: save it as CSV (in Excel: CSV UTF-8)") from error


def read_given_table(path: Path, text: str, faults: Faults) -> GivenTable:
    """The fields of a table; separators are commas, semicolons or tabs.

    Parameters
    ----------
    path : Path
        For messages.
    text : str
        As `given_text` returns it.
    faults : Faults
        Gets all that makes it no table: columns with one name, rows with more fields than names.

    Returns
    -------
    GivenTable
    """
    separator, text, skipped = _separated(text)
    reader = csv.reader(StringIO(text), delimiter=separator, strict=True)
    lines: list[int] = []
    columns: list[list[str]] = []
    try:
        while rows := list(islice(_with_lines(reader, lines), _ROWS_AT_ONCE)):
            _append(columns, rows, len(lines) - len(rows))
    except csv.Error as error:
        faults.add(f"{path.name} line {reader.line_num + skipped}", f"is no CSV: {error}")
    whole = pd.DataFrame({k: _meant(pd.Series(texts, dtype="str")) for k, texts in enumerate(columns)})
    filled = np.flatnonzero((whole != "").any(axis=1).to_numpy()) if columns else np.empty(0, dtype=np.int64)
    if not len(filled):
        return GivenTable(path.name, pd.DataFrame(), np.empty(0, dtype=np.int64))
    head, *rest = filled.tolist()
    names = [str(name) for name in whole.iloc[head]]
    numbers = np.array(lines)[: len(whole)] + skipped
    table = GivenTable(path.name, whole.iloc[rest].reset_index(drop=True), numbers[rest])
    for name in (name for name, number in Counter(filter(None, names)).items() if number > 1):
        faults.add(f"{path.name} line {numbers[head]}", f"column {name!r} stands twice")
    _refuse_strays(table, names, faults)
    kept = [place for place, name in enumerate(names) if name and name not in names[:place]]
    fields = table.fields[kept].set_axis([names[place] for place in kept], axis="columns")
    return GivenTable(path.name, fields, table.lines)


def _with_lines(reader: Any, lines: list[int]) -> Iterator[list[str]]:
    """The rows of a CSV file; the line that each ends in goes to the list."""
    for fields in reader:
        lines.append(reader.line_num)
        yield fields


def _append(columns: list[list[str]], rows: list[list[str]], before: int) -> None:
    """Append rows to columns of fields; a row that is short has empty ones."""
    block = list(zip_longest(*rows, fillvalue=""))
    columns += [[""] * before for _ in block[len(columns) :]]
    for place, column in enumerate(columns):
        column.extend(block[place] if place < len(block) else [""] * len(rows))


def _separated(text: str) -> tuple[str, str, int]:
    """The separator, the text after a line that says it, and how many lines that took."""
    told = re.match(r"sep=([,;\t])\r?\n", text, re.IGNORECASE)
    if told is not None:  # which Excel reads
        return told[1], text[told.end() :], 1
    return max(_SEPARATORS, key=text.lstrip().partition("\n")[0].count), text, 0


def _meant(column: Any) -> Any:
    """Texts of a column without spaces around them, and without the apostrophe of a made-harmless formula."""
    texts = column.str.strip()
    marked = texts.str.startswith("'")
    return texts.where(~marked, texts[marked].map(text_as_meant)) if marked.any() else texts


def _refuse_strays(table: GivenTable, names: list[str], faults: Faults) -> None:
    """Faults for fields of no column: beyond the last name, or in a column without one."""
    last = max((place for place, name in enumerate(names) if name), default=-1)
    advice = "put quotes around a field with a comma, and write numbers with a point (0.2)"
    beyond = (table.fields.iloc[:, last + 1 :] != "").any(axis=1).to_numpy()
    for row in np.flatnonzero(beyond).tolist():
        faults.add(table.place(row), f"has more fields than the {last + 1} of the first line: {advice}")
    for place in (place for place, name in enumerate(names[:last]) if not name):
        values = table.fields.iloc[:, place]
        for row in np.flatnonzero((values != "").to_numpy()).tolist():
            faults.add(
                table.place(row),
                f"{values.iloc[row]!r} stands in a column without a name: name or remove it",
            )


def refuse_commas(table: GivenTable, column: str, faults: Faults) -> None:
    """A fault for a column of numbers of which some have a comma: it would be one of texts.

    Parameters
    ----------
    table : GivenTable
    column : str
    faults : Faults
    """
    values = table.fields[column]
    different = [text for text in pd.unique(values) if text]
    commas = [text for text in different if without_comma(text)]
    others = (text for text in different if text not in commas)
    if not commas or not all(re.fullmatch(NUMBER, text) for text in others):
        return
    rows = np.flatnonzero(values.isin(commas).to_numpy())
    first = values.iloc[rows[0]]
    more = f" (and {len(rows) - 1} more lines)" if len(rows) > 1 else ""
    faults.add(table.place(rows[0]), f"{column} {first!r}{more}: {comma_advice(first)}")


def number_type(texts: pd.Series) -> type[int] | type[float] | None:
    """What a column of texts holds if all are numbers: "1", but not "001" or "1_2"; None for other texts.

    Parameters
    ----------
    texts : Series of str
        Empty ones do not count.
    """
    different = [text for text in pd.unique(texts) if text]
    if not different or any(len(text) > _LONGEST_NUMBER for text in different):
        return None
    kinds: tuple[tuple[type[int] | type[float], str], ...] = ((int, WHOLE), (float, NUMBER))
    return next((kind for kind, form in kinds if all(re.fullmatch(form, text) for text in different)), None)


def unreadable_words(error: BaseException) -> str:
    """Why a table cannot be read."""
    return f"cannot be read: {words_of(error)}"

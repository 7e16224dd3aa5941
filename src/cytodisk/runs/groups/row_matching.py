"""Which rows of a table of groups are about which cells, and what is wrong with those that are not."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import IntArray
from cytodisk.images.short_lists import shortened
from cytodisk.runs.given_tables.table_faults import Faults
from cytodisk.runs.groups.known_cells import CELL, FILE, FRAME, KEYS, KnownCells, numbers_words

_ANY = -1  # in the place of a key that is empty
_MOST_REMARKS = 5


class RowMatching:
    """The rows of a table of groups beside the cells that they may be about.

    Parameters
    ----------
    path : Path
        Of the table.
    keys : DataFrame
        As `Groups` has it.
    lines : ndarray of shape (rows,) and dtype int
        As `Groups` has it.
    known : KnownCells
    """

    def __init__(self, path: Path, keys: pd.DataFrame, lines: IntArray, known: KnownCells):
        self._name = path.name
        self._keys = keys
        self._lines = lines
        self._known = known
        self.remarks: list[str] = []
        """What a user should know of rows that count for nothing."""

    def files(self, faults: Faults) -> pd.DataFrame:
        """The rows with the number of the file; one that means all files of an input stands several times.

        Parameters
        ----------
        faults : Faults
            Gets names that mean no file, or several; a file that is there but not of the run is no fault.

        Returns
        -------
        DataFrame
            "file", "cell" and "frame", -1 for any, and "row".
        """
        rows = pd.DataFrame({"row": np.arange(len(self._keys))})
        for key in (CELL, FRAME):
            given = self._keys.get(key)
            rows[key] = _ANY if given is None else given.fillna(_ANY).to_numpy(dtype=np.int64)
        if FILE not in self._keys:
            return rows.assign(**{FILE: _ANY})
        rows["text"] = self._keys[FILE].fillna("")
        different = [text for text in pd.unique(rows["text"]) if text]
        pairs = [("", _ANY)]
        wrong: dict[str, list[int]] = {}
        elsewhere: list[str] = []
        for text in different:
            found = self._known.files.find(text)
            if self._known.files.is_clear(text, found):
                pairs += [(text, file) for file in found]
            elif not found and self._known.files.is_elsewhere(text):
                elsewhere.append(text)
            else:
                wrong[text] = found
        self._tell_of_others(rows["text"], elsewhere, faults)
        lost = np.flatnonzero(rows["text"].isin(wrong).to_numpy()).tolist()
        faults.add_rows(lost, lambda row: (self._place(row), self._file_words(rows["text"].iloc[row], wrong)))
        return rows.merge(pd.DataFrame(pairs, columns=["text", FILE]), on="text", how="inner")

    def cells(self, rows: pd.DataFrame, faults: Faults) -> pd.DataFrame:
        """Pairs of a row and a cell that it is about.

        Parameters
        ----------
        rows : DataFrame
            As `files` returns it.
        faults : Faults
            Gets rows that are about the same cells, and cells in two rows.

        Returns
        -------
        DataFrame
            "at" and "row".
        """
        parts = [pd.DataFrame({"at": [], "row": []}, dtype=np.int64)]
        for keys, some in _by_keys(rows):
            twice = some.duplicated(keys)
            if twice.any():
                first = some.loc[~twice, [*keys, "row"]].rename(columns={"row": "first"})
                pairs = some[twice].merge(first, on=keys)
                self._refuse_twice(pairs, faults)
                continue
            cells = self._known.table
            if CELL in keys:
                cells = cells[cells[CELL] != 0]
            parts.append(cells[[*keys, "at"]].merge(some[[*keys, "row"]], on=keys)[["at", "row"]])
        found = pd.concat(parts, ignore_index=True)
        self._refuse_two_rows(found, faults)
        return found

    def without_cells(self, rows: pd.DataFrame, found: pd.DataFrame, faults: Faults) -> None:
        """Rows that are about no cell: faults, but for files and images without usable masks.

        Parameters
        ----------
        rows : DataFrame
            As `files` returns it.
        found : DataFrame
            As `cells` returns it.
        faults : Faults
        """
        lost = rows[~rows["row"].isin(found["row"])].drop_duplicates("row")
        empty = self._known.table[self._known.table[CELL] == 0]
        frames = pd.MultiIndex.from_frame(empty[[FILE, FRAME]])
        of_frame = pd.MultiIndex.from_frame(lost[[FILE, FRAME]]).isin(frames)
        no_cells = ~lost[FILE].isin(
            [_ANY, *self._known.table.loc[self._known.table[CELL] != 0, FILE].unique()]
        )
        excused = of_frame | no_cells.to_numpy()
        wrong = lost[~excused].set_index("row")
        faults.add_rows(
            wrong.index.tolist(), lambda row: (self._place(row), self._no_cell_words(wrong.loc[row]))
        )
        remarks = [f"{self._place(row)}: the image has no usable masks" for row in lost.loc[excused, "row"]]
        more = len(remarks) - _MOST_REMARKS
        self.remarks += remarks[:_MOST_REMARKS]
        self.remarks += [f"{self._name}: … and {more} more such rows"] if more > 0 else []

    def _place(self, row: int) -> str:
        return f"{self._name} line {self._lines[row]}"

    def _tell_of_others(self, texts: Any, elsewhere: list[str], faults: Faults) -> None:
        """A remark on rows about files of other runs; a fault if all rows are."""
        number = int(texts.isin(elsewhere).sum())
        if not number:
            return
        names = shortened(elsewhere)
        if number == len(texts):
            faults.add(self._name, f"no row is about these masks, all are about other files: {names}")
        words = f"{number} rows are about files" if number > 1 else "1 row is about a file"
        self.remarks.append(f"{self._name}: {words} that are not of this run: {names}")

    def _file_words(self, text: str, wrong: dict[str, list[int]]) -> str:
        files, found = self._known.files, wrong[text]
        return files.several_words(text, found) if found else files.unknown_words(text)

    def _refuse_twice(self, pairs: pd.DataFrame, faults: Faults) -> None:
        """Faults for rows with the keys of an earlier one."""
        firsts = dict(zip(pairs["row"], pairs["first"], strict=True))

        def words(row: int) -> tuple[str, str]:
            return self._place(row), f"is about the same cells as line {self._lines[firsts[row]]}: keep one"

        faults.add_rows(sorted(firsts), words)

    def _refuse_two_rows(self, found: pd.DataFrame, faults: Faults) -> None:
        """Faults for cells in rows with different keys, once for each two rows."""
        again = found[found.duplicated("at")]
        if again.empty:
            return
        first = found.drop_duplicates("at").set_index("at")["row"]
        pairs = again.assign(first=first.loc[again["at"]].to_numpy()).drop_duplicates(["row", "first"])

        def words(place: int) -> tuple[str, str]:
            pair = pairs.iloc[place]
            cell, line = self._known.place(int(pair["at"])), self._lines[pair["first"]]
            return self._place(int(pair["row"])), f"{cell} is in line {line} too: a cell can be in one row"

        faults.add_rows(range(len(pairs)), words)

    def _no_cell_words(self, row: Any) -> str:
        """What to say of a row that is about no cell."""
        there, where = self._known.table, ""
        if row[FILE] != _ANY:
            there = there[there[FILE] == row[FILE]]
            where = f" of {self._known.files.names[int(row[FILE])]}"
        there = there[there[CELL] != 0]
        if row[FRAME] != _ANY and not (there[FRAME] == row[FRAME]).any():
            return f"there is no frame {row[FRAME]}{where}: frames are {numbers_words(there[FRAME].tolist())}"
        if row[FRAME] != _ANY:
            there, where = there[there[FRAME] == row[FRAME]], f" in frame {row[FRAME]}{where}"
        labels = numbers_words(there[CELL].tolist())
        return f"there is no cell {row[CELL]}{where}: labels of cells are {labels}"


def _by_keys(rows: pd.DataFrame) -> Iterator[tuple[list[str], pd.DataFrame]]:
    """Rows by the keys that they have; a row without any is about nothing."""
    given = rows[list(KEYS)] != _ANY
    for pattern, some in rows.groupby([given[key].rename(f"has {key}") for key in KEYS]):
        keys = [key for key, has in zip(KEYS, pattern, strict=True) if has]
        if keys:
            yield keys, some

"""Which file of a run a user means: by its name, its path, its name without ending, or the input's name."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property
from pathlib import Path
from unicodedata import normalize

import pandas as pd

from cytodisk.files import real_path
from cytodisk.images.mask_names import base_name, image_stem
from cytodisk.images.short_lists import shortened
from cytodisk.runs.groups.other_files import OtherFiles

_LIKE = 0.6  # from which likeness on a name is proposed
_MOST_COMPARED = 2000  # names, which takes milliseconds each


@dataclass(frozen=True, eq=False)
class NamedFiles:
    """The mask files of a run, or of a batch.

    Attributes
    ----------
    files : DataFrame
        A row a file, with those of the columns `input`, `source` and `path` that are known; no row twice.
    folder : Path
        What paths of a user are relative to.
    """

    files: pd.DataFrame
    folder: Path

    @property
    def names(self) -> list[str]:
        """What to call each file: its name, or that of its input."""
        sources, inputs = self._column("source"), self._column("input")
        return [source or given for source, given in zip(sources, inputs, strict=True)]

    def find(self, text: str) -> list[int]:
        """Rows of the files that a text means: one, or all of an input; none, or several, if it is not clear.

        Parameters
        ----------
        text : str
            A name, or a path with / or \\\\ between its parts.
        """
        text = normalize("NFC", text)
        if text in self._inputs:
            return self._inputs[text]
        *parents, name = re.sub(r"^(\./)+", "", text.replace("\\", "/")).split("/")
        for known in self._levels:
            found = [row for row in known.get(name, ()) if self._lies_in(row, parents, name)]
            if found:
                return found
        return []

    def is_elsewhere(self, text: str) -> bool:
        """Whether a text that means no file of the run names one that is there all the same."""
        return self._others.has(text)

    def is_clear(self, text: str, rows: Sequence[int]) -> bool:
        """Whether the rows that were found for a text are one file, or one input."""
        return len(rows) == 1 or self._inputs.get(text) == rows

    def unknown_words(self, text: str) -> str:
        """What to say of a text that means no file."""
        known = list(dict.fromkeys([*filter(None, self.names), *self._inputs]))
        name = text.replace("\\", "/").rsplit("/", 1)[-1]
        near = get_close_matches(name, known[:_MOST_COMPARED], 1, _LIKE)
        hint = f"did you mean {near[0]!r}?" if near and near[0] != text else f"there is {shortened(known, 8)}"
        return f"no file {text!r}: {hint}"

    def several_words(self, text: str, rows: Sequence[int]) -> str:
        """What to say of a text that means several files."""
        paths, inputs = self._column("path"), self._column("input")
        shown = [inputs[row] or paths[row] or self.names[row] for row in rows]
        return f"file {text!r} can be {shortened(shown)}: write {shown[0]!r} if that is meant"

    def _column(self, name: str) -> list[str]:
        if name not in self.files:
            return [""] * len(self.files)
        return [str(text) for text in self.files[name].fillna("")]

    @cached_property
    def _others(self) -> OtherFiles:
        return OtherFiles([self.folder, *(path.parent for path in self._paths if path is not None)])

    @cached_property
    def _inputs(self) -> dict[str, list[int]]:
        """Rows by the name of the input."""
        found: dict[str, list[int]] = {}
        for row, name in enumerate(self._column("input")):
            if name:
                found.setdefault(normalize("NFC", name), []).append(row)
        return found

    @cached_property
    def _levels(self) -> list[dict[str, list[int]]]:
        """Rows by the file's name, by that without its ending, and by the name of its image."""
        levels: list[dict[str, list[int]]] = [{}, {}, {}]
        for row, (source, path) in enumerate(zip(self._column("source"), self._column("path"), strict=True)):
            name = source or Path(path).name
            if name:
                for known, key in zip(levels, (name, image_stem(name), base_name(name)), strict=True):
                    known.setdefault(normalize("NFC", key), []).append(row)
        return levels

    def _lies_in(self, row: int, parents: Sequence[str], name: str) -> bool:
        """Whether a file lies in the folders that a path names, if its own is known."""
        path = self._paths[row]
        if not parents or path is None:
            return True
        given = "/".join(parents)
        if not given or os.path.isabs(given) or re.match(r"[A-Za-z]:", given):  # noqa: PTH117
            return real_path(Path(given or "/")) == real_path(path.parent)
        if real_path(self.folder / given) == real_path(path.parent):
            return True
        own = tuple(normalize("NFC", part) for part in path.parent.parts)
        return own[-len(parents) :] == tuple(parents)

    @cached_property
    def _paths(self) -> list[Path | None]:
        return [Path(path).absolute() if path else None for path in self._column("path")]

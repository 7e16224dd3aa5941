"""All that is wrong with a file that a user wrote, said at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from pathlib import Path

from cytodisk.errors import ParameterError

_MOST_SHOWN = 20


class Faults:
    """Collects faults of a file, each with its place."""

    def __init__(self) -> None:
        self._words: list[str] = []
        self._more = 0

    def __len__(self) -> int:
        return len(self._words) + self._more

    def add(self, place: str, words: str) -> None:
        """Note a fault."""
        self._words.append(f"{place}: {words}")

    def add_rows(self, rows: Sequence[int], words_of: Callable[[int], tuple[str, str]]) -> None:
        """Note a fault for each of some rows, of which there may be a million.

        Parameters
        ----------
        rows : sequence of int
        words_of : callable
            Gives (place, words) of a row; it is called for those that are shown.
        """
        shown = rows[: max(0, _MOST_SHOWN - len(self._words))]
        for row in shown:
            self.add(*words_of(row))
        self._more += len(rows) - len(shown)

    def add_unknown(self, place: str, what: str, found: Iterable[str], known: Iterable[str]) -> None:
        """Note names that are not known, each with the nearest one that is."""
        names = sorted(known)
        for name in found:
            if name not in names:
                near = get_close_matches(name, names, 1, 0.6)
                hint = f"did you mean {near[0]!r}?" if near else f"it can be {', '.join(names)}"
                self.add(place, f"unknown {what} {name!r}: {hint}")

    def raise_if_any(self, path: Path, what: str = "batch file") -> None:
        """Raise ParameterError with all faults, or the first twenty of many."""
        if not self._words:
            return
        lines = self._words[:_MOST_SHOWN]
        more = len(self) - len(lines)
        if more:
            lines = [*lines, f"… and {more} more"]
        raise ParameterError("\n  ".join([f"{what} {path} cannot be used:", *lines]))

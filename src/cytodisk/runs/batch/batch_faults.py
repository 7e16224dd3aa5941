"""All that is wrong with a batch file, said at once."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path

from cytodisk.errors import ParameterError

_MOST_SHOWN = 20


class Faults:
    """Collects faults of a file, each with its place."""

    def __init__(self) -> None:
        self._words: list[str] = []

    def add(self, place: str, words: str) -> None:
        """Note a fault."""
        self._words.append(f"{place}: {words}")

    def add_unknown(self, place: str, what: str, found: Iterable[str], known: Iterable[str]) -> None:
        """Note names that are not known, each with the nearest one that is."""
        names = sorted(known)
        for name in found:
            if name not in names:
                near = get_close_matches(name, names, 1, 0.6)
                hint = f"did you mean {near[0]!r}?" if near else f"it can be {', '.join(names)}"
                self.add(place, f"unknown {what} {name!r}: {hint}")

    def raise_if_any(self, path: Path) -> None:
        """Raise ParameterError with all faults, or the first twenty of many."""
        if not self._words:
            return
        lines = self._words[:_MOST_SHOWN]
        if len(self._words) > _MOST_SHOWN:
            lines = [*lines, f"… and {len(self._words) - _MOST_SHOWN} more"]
        raise ParameterError("\n  ".join([f"batch file {path} cannot be used:", *lines]))

"""Names of files that are frames of one movie: which belong together, in which order, and what is missing."""

from __future__ import annotations

import math
import re
from bisect import bisect
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

from cytodisk.errors import ReadError
from cytodisk.images.mask_names import natural_order
from cytodisk.images.short_lists import shortened

_TIMES = ("t", "tp", "time", "timepoint", "frame")
_NO_TIMES = {
    **dict.fromkeys(("c", "ch", "channel", "w", "wv", "wavelength"), "channels"),
    **dict.fromkeys(("z", "slice"), "slices of a z-stack"),
    **dict.fromkeys(("s", "p", "pos", "position", "xy", "site", "scene", "series", "well"), "positions"),
}
_UNSURE = ("c", "w", "s", "p", "slice")  # alone they may count anything
_MOST_MISSING = 0.5  # of the files: with more the numbers hardly count frames
_MOST_LISTED = 100  # places a file
_SHOWN = 3


@dataclass(frozen=True)
class FrameNames:
    """Files of one movie in the order of time, with a place for each that is missing.

    Attributes
    ----------
    files : tuple of Path
        By frame; also those that are not there.
    numbers : tuple of int, or None
        What counts the frames in the names; None where nothing does, or there is more than one.
    missing : frozenset of Path
        Those of the files that are not there, as the numbers go on without them.
    series : str
        What all names have in common, as "cell_t" of "cell_t001.tif".
    note : str
        What is odd about the numbers; empty if nothing is.
    """

    files: tuple[Path, ...]
    numbers: tuple[int, ...] | None
    missing: frozenset[Path]
    series: str
    note: str = ""

    @property
    def words(self) -> str:
        """As "40 files in natural order, t001.tif to t040.tif"."""
        there = [file for file in self.files if file not in self.missing]
        return f"{len(there)} files in natural order, {there[0].name} to {there[-1].name}"

    def taken(self, numbers: Sequence[int]) -> FrameNames:
        """Those with some numbers only, in their order; a number without a file is missing."""
        assert self.numbers is not None  # whoever asks for numbers knows that there are some
        by_number = dict(zip(self.numbers, self.files, strict=True))
        ordered = sorted(by_number)
        here = {number: by_number.get(number) or _file_of(number, ordered, by_number) for number in numbers}
        lost = {file for number, file in here.items() if number not in by_number or file in self.missing}
        return FrameNames(tuple(here.values()), tuple(here), frozenset(lost), self.series, self.note)


def by_series(names: Iterable[str]) -> dict[tuple[str, ...], list[str]]:
    """Names that differ in nothing but numbers, by what they have in common."""
    found: dict[tuple[str, ...], list[str]] = {}
    for name in names:
        found.setdefault(tuple(re.split(r"\d+", name)), []).append(name)
    return found


def series_of(names: Sequence[str]) -> str:
    """What names of one series have in common before the first number that differs.

    Without separators at its end, and what only says "time": "cell3" of "cell3_t001.tif" and its like.
    """
    columns = list(zip(*(re.findall(r"\d+", name) for name in names), strict=False))
    first = next((number for number, column in enumerate(columns) if len(set(column)) > 1), len(columns))
    before = "".join(re.split(r"(\d+)", names[0])[: 2 * first + 1])
    parts = [part for part in re.split(r"[ _.\-]+", before) if part]
    while parts and parts[-1].lower() in _TIMES:
        parts.pop()
    return "_".join(parts)


def frame_names(place: Path, named: Mapping[str, Path]) -> FrameNames:
    """Put the files of one series in the order of time.

    Parameters
    ----------
    place : Path
        The folder or pattern that they come from, for messages.
    named : mapping of str to Path
        Two files at least, by the names that count, which differ in nothing but numbers.

    Returns
    -------
    FrameNames

    Raises
    ------
    ReadError
        The names count channels, slices or positions as well, or two have one number.
    """
    names = sorted(named, key=natural_order)
    ordered = tuple(named[name] for name in names)
    columns = list(zip(*([int(part) for part in re.findall(r"\d+", name)] for name in names), strict=True))
    varying = [number for number, column in enumerate(columns) if len(set(column)) > 1]
    counting = _counting(place, names, columns, varying)
    found = FrameNames(ordered, None, frozenset(), series_of(names))
    if counting is None:
        words = f"more than one number differs from {names[0]} to {names[-1]}: files are in natural order"
        return replace(found, note=words)
    numbered = sorted(zip(columns[counting], names, strict=True))
    for (number, name), (following, other) in pairwise(numbered):
        if number == following:
            raise ReadError(f"{place} has two files with one number ({name}, {other}): take one away")
    numbers = tuple(number for number, _ in numbered)
    return _with_gaps(replace(found, numbers=numbers, files=tuple(named[name] for _, name in numbered)))


def _counting(
    place: Path,
    names: Sequence[str],
    columns: Sequence[tuple[int, ...]],
    varying: Sequence[int],
) -> int | None:
    """Which number counts the frames; None where natural order has to do."""
    texts = re.split(r"\d+", names[0])
    roles = {number: _role(texts[number]) for number in varying}
    if len(varying) < 2:
        sure = varying and place.is_dir() and _letters(texts[varying[0]]) not in _UNSURE
        what = roles[varying[0]] if sure else ""
        if what in _NO_TIMES.values():
            every = re.sub(r"\d+", "*", names[0])
            raise ReadError(
                f"{place} holds {what} by their names ({names[0]} to {names[-1]}), not frames: if they are "
                f"frames all the same, pass them as a pattern, in quotes, as '{place / every}'"
            )
        return varying[0] if varying else 0
    times = [number for number, role in roles.items() if role == "time"]
    if len(times) == 1 and len(set(columns[times[0]])) == len(names):
        return times[0]  # whatever else differs goes with time
    others = [number for number in varying if number not in times]
    mixed = [number for number in others if roles[number]] or (others if times else [])
    if mixed:
        what = roles[mixed[0]] or "more than one movie"
        raise ReadError(f"{place} holds {what}: {_patterns_words(place, names, mixed[0])}")
    apart = [number for number in varying if len(set(columns[number])) == len(names)]
    if apart and list(columns[apart[0]]) == sorted(columns[apart[0]]):
        return apart[0]
    return None


def _role(text: str) -> str:
    """What a number counts by the letters before it: "time", "channels", …; empty if they do not say."""
    letters = _letters(text)
    return "time" if letters in _TIMES else _NO_TIMES.get(letters, "")


def _letters(text: str) -> str:
    found = re.search(r"([A-Za-z]+)[^A-Za-z]*$", text)
    return found[1].lower() if found else ""


def _patterns_words(place: Path, names: Sequence[str], number: int) -> str:
    """The way to choose one value of a number in the names."""
    patterns: dict[str, None] = {}
    for name in names:
        parts = re.split(r"(\d+)", name)
        shown = [part if turn % 2 == 0 or turn == 2 * number + 1 else "*" for turn, part in enumerate(parts)]
        patterns["".join(shown)] = None
    folder = place if place.is_dir() else place.parent
    quoted = [f"'{folder / pattern}'" for pattern in list(patterns)[:_SHOWN]]
    return f"pass one of them as a pattern, in quotes, as {' or '.join(quoted)}"


def _with_gaps(found: FrameNames) -> FrameNames:
    """The same with places for the files whose numbers are left out."""
    assert found.numbers is not None  # they were found
    numbers, there = found.numbers, set(found.numbers)
    step = math.gcd(*(after - before for before, after in pairwise(numbers)))
    every = range(numbers[0], numbers[-1] + 1, step)
    n_lost = (numbers[-1] - numbers[0]) // step + 1 - len(numbers)  # len(every) knows no number of 20 digits
    if n_lost > _MOST_LISTED * len(numbers):
        return replace(found, note=_apart_words(numbers))
    lost = [number for number in every if number not in there]
    if all(number % 100 >= 60 for number in lost):
        return found  # none, or minutes and seconds of a clock
    if n_lost > _MOST_MISSING * len(numbers):
        return replace(found, note=_apart_words(numbers))
    filled = found.taken(every)
    names = [file.name for file in filled.files if file in filled.missing]
    return replace(filled, note=_missing_words(names))


def _apart_words(numbers: Sequence[int]) -> str:
    return (
        f"the numbers in the names go from {numbers[0]} to {numbers[-1]} with most left out: the "
        f"{len(numbers)} files are taken as frames one after the other, equally far apart in time"
    )


def _missing_words(names: Sequence[str]) -> str:
    if len(names) == 1:
        return (
            f"{names[0]} is not there: this frame counts as missing; "
            "number the files without a gap if there was none in time"
        )
    return (
        f"{shortened(names)} are not there: these frames count as missing; "
        "number the files without gaps if there were none in time"
    )


def _file_of(number: int, ordered: Sequence[int], by_number: Mapping[int, Path]) -> Path:
    """The name that a file with this number would have, after that of the nearest number and the least."""
    above = bisect(ordered, number)
    near, least = min(ordered[max(above - 1, 0) : above + 1], key=lambda one: abs(one - number)), ordered[0]
    place, width = _place_of(near, by_number[near].name), _place_of(least, by_number[least].name)
    name = by_number[near].name
    digits = f"{number:0{width.stop - width.start}d}"
    return by_number[near].with_name(f"{name[: place.start]}{digits}{name[place.stop :]}")


def _place_of(number: int, name: str) -> slice:
    found = [part for part in re.finditer(r"\d+", name) if int(part[0]) == number][-1]
    return slice(found.start(), found.end())

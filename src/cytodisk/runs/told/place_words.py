"""Numbers of frames or cells in few words."""

from collections.abc import Iterable
from itertools import pairwise

MOST_PLACES = 8
"""How many are listed."""


def ranges_words(numbers: Iterable[int]) -> str:
    """As "0–4, 7, … 3 more" for numbers in ascending order."""
    given = sorted(numbers)
    breaks = [0, *(k + 1 for k, (one, two) in enumerate(pairwise(given)) if two > one + 1), len(given)]
    runs = [(given[first], given[last - 1]) for first, last in pairwise(breaks)]
    words = [f"{first}" if first == last else f"{first}–{last}" for first, last in runs[:MOST_PLACES]]
    rest = sum(last - first + 1 for first, last in runs[MOST_PLACES:])
    return ", ".join([*words, f"… {rest} more"] if rest else words)

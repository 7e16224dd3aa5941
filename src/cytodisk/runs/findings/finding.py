"""`Finding`: what a study shows, in one to three sentences."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from cytodisk.number_words import rounded

_LARGE = 10.0


@dataclass(frozen=True)
class Finding:
    """What a study shows, in plain sentences with their numbers.

    Attributes
    ----------
    kind : {"found", "doubtful", "nothing", "measured"}
        A correlation that nothing known speaks against, one with a "but", none beyond chance, or what was
        measured where nothing was correlated.
    sentences : tuple of str
        One to three.
    command : str
        The command that asks the next question; empty if there is none.
    size : float
        Of a correlation, without its sign; 0 without one.
    """

    kind: Literal["found", "doubtful", "nothing", "measured"]
    sentences: tuple[str, ...]
    command: str = ""
    size: float = 0.0

    @property
    def words(self) -> str:
        """The sentences in one."""
        return " ".join(self.sentences)


def listed(words: list[str]) -> str:
    """Words as a list, as "a, b and c"."""
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def ratio_words(value: float) -> str:
    """A ratio with two decimals, or as many digits as count, as "1.05" and "18.9"."""
    return f"{value:.2f}" if abs(value) < _LARGE else rounded(value)


def signed_number(value: float) -> str:
    """A correlation with two digits and a true minus, as "−0.42"."""
    return f"{round(value, 2) + 0.0:.2f}".replace("-", "−")


def capital(words: str) -> str:
    """Words at the start of a sentence: with a capital, but for a name of a channel."""
    return words[0].upper() + words[1:] if words.startswith(("the ", "signal ", "channel ")) else words

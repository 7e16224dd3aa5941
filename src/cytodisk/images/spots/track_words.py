"""What is told of the tracks of other programs."""

from __future__ import annotations

from cytodisk.images.spots.spots import Branches

_SHOWN = 5


def branch_words(found: Branches) -> list[str]:
    """Divisions and merges, and links that cannot be used, in words."""
    daughters: dict[int, list[int]] = {}
    for daughter, mother in found.mothers.items():
        daughters.setdefault(mother, []).append(daughter)
    words = []
    if daughters:
        shown = [
            f"{mother} → {' and '.join(map(str, sorted(of)))}" for mother, of in sorted(daughters.items())
        ]
        words.append(
            f"{number_words(len(daughters), 'track')} divide: daughters are cells of their own "
            f"({first_words(shown)})"
        )
    if found.merged:
        shown = [f"{' and '.join(map(str, of))} → {track}" for track, of in sorted(found.merged.items())]
        words.append(
            f"{number_words(len(found.merged), 'track')} begin where others merge ({first_words(shown)})"
        )
    if found.ignored:
        words.append(f"{number_words(found.ignored, 'link')} within one frame left out")
    return words


def first_words(words: list[str]) -> str:
    """The first of some words, with commas between."""
    return ", ".join(words[:_SHOWN]) + (", …" if len(words) > _SHOWN else "")


def number_words(number: int, of: str) -> str:
    """A number of things, as "1 track" or "2 tracks"."""
    return f"{number} {of}" if number == 1 else f"{number} {of}s"

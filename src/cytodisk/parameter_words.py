"""What parameters may be, in words: for messages, help texts and docs."""

from __future__ import annotations

import re
import types
from collections.abc import Collection
from difflib import get_close_matches
from functools import cache
from typing import Any, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo

_WHOLE = r"[+-]?[0-9]+"
_NUMBER = r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?"
_LONGEST_VALUE = 60  # letters of a refused value that a message repeats


def kinds(annotation: Any) -> frozenset[Any]:
    """The types that an annotation admits; `str` for a `Literal` of texts, `tuple` for any tuple."""
    found: frozenset[Any] = _kinds(annotation)
    return found


@cache
def _kinds(annotation: Any) -> frozenset[Any]:
    if get_origin(annotation) in (Union, types.UnionType):
        return frozenset().union(*(_kinds(part) for part in get_args(annotation)))
    if get_origin(annotation) is Literal:
        return frozenset(type(choice) for choice in get_args(annotation))
    return frozenset({get_origin(annotation) or annotation})


def choices(annotation: Any) -> tuple[str, ...]:
    """The words that an annotation admits; none if it is no choice."""
    parts = get_args(annotation) if get_origin(annotation) in (Union, types.UnionType) else (annotation,)
    return tuple(str(word) for part in parts if get_origin(part) is Literal for word in get_args(part))


def unit_of(field: FieldInfo) -> str:
    """Unit of a parameter; empty if it has none."""
    return str(_extra(field, "unit"))


def range_words(field: FieldInfo) -> str:
    """What a parameter may be, as "a number above 0"."""
    if words := _extra(field, "words"):
        return words
    wanted = kinds(field.annotation)
    if words_of_choice := choices(field.annotation):
        return f"one of {', '.join(words_of_choice)}"
    if bool in wanted:
        return "True or False"
    if str in wanted:
        return "a text"
    kind = "a whole number" if int in wanted else "a number"
    return f"{kind}{limits(field)}"


def limits(field: FieldInfo) -> str:
    """The range of a number, as " above 0" or " from 0 to 1"; empty if there is none."""
    found = {name: getattr(part, name) for part in field.metadata for name in _LIMITS if hasattr(part, name)}
    if {"ge", "le"} <= found.keys():
        return f" from {number_words(found['ge'])} to {number_words(found['le'])}"
    words = [f"{word} {number_words(found[name])}" for name, word in _LIMITS.items() if name in found]
    return f" {' and '.join(words)}" if words else ""


_LIMITS = {"ge": "of at least", "gt": "above", "le": "at most", "lt": "below"}


def number_words(number: float) -> str:
    """A limit as one writes it: 1000000, not 1e+06."""
    return f"{number:.10f}".rstrip("0").rstrip(".")


def flag_of(name: str, field: FieldInfo) -> str:
    """The option of the command line for a parameter, as "--edge-length"."""
    return f"--{_extra(field, 'flag') or name.replace('_', '-')}"


def default_words(field: FieldInfo) -> str:
    """The default as one types it; empty if there is none."""
    if isinstance(field.default, bool):
        return "yes" if field.default else "no"
    if isinstance(field.default, tuple):
        return ",".join(str(item) for item in field.default)
    return "" if field.default is None else str(field.default)


def help_words(field: FieldInfo, more: str = "") -> str:
    """What a parameter does, then its unit, range, default and more, for the help of its option."""
    default = default_words(field)
    notes = [
        unit_of(field),
        _plain_limits(field),
        f"default {default}" if default else "",
    ]
    said = "; ".join(words for words in (", ".join(note for note in notes if note), more) if words)
    return f"{field.description} ({said})" if said else str(field.description)


_MOST_PLAIN = 1e5  # a limit from here on, or below its inverse, is there for mistakes: help leaves it out


def _plain_limits(field: FieldInfo) -> str:
    """The range of a number without what nobody would type, as "at least 1"; empty if nothing is left."""
    found = {name: getattr(part, name) for part in field.metadata for name in _LIMITS if hasattr(part, name)}
    shown = {name: limit for name, limit in found.items() if abs(limit) < _MOST_PLAIN}
    if 0 < shown.get("ge", 0) <= 1 / _MOST_PLAIN:
        del shown["ge"]
    if {"ge", "le"} <= shown.keys():
        return f"from {number_words(shown['ge'])} to {number_words(shown['le'])}"
    return " and ".join(f"{_LIMITS[name].removeprefix('of ')} {number_words(shown[name])}" for name in shown)


def value_of_text(field: FieldInfo, text: str) -> Any:
    """What was typed for a parameter, such as "10:80" or "30,40", as the value that is meant.

    Parts of a list have commas between, the first and the last of a range a colon. What is no such value
    stays a text, so that the model can say what is wrong with it.
    """
    wanted = kinds(field.annotation)
    if tuple not in wanted:
        return _number_of(text, wanted)
    item = tuple_items(field.annotation)
    parts = [part.strip() for part in text.split(":" if item == (int, int) else ",")]
    if item[0] not in (int, float):
        return tuple(parts)
    form = _NUMBER if item[0] is float else _WHOLE
    if (item == (int, int) and len(parts) != 2) or not all(re.fullmatch(form, part) for part in parts):
        return text
    values = tuple(item[0](part) for part in parts)
    return values[0] if len(values) == 1 and float in wanted else values


def _number_of(text: str, wanted: frozenset[Any]) -> Any:
    if int in wanted and re.fullmatch(_WHOLE, text):
        return int(text)
    return float(text) if float in wanted and re.fullmatch(_NUMBER, text) else text


def tuple_items(annotation: Any) -> tuple[Any, ...]:
    """The types of the items of the tuple that an annotation admits."""
    parts = get_args(annotation) if get_origin(annotation) in (Union, types.UnionType) else (annotation,)
    inside = next(get_args(part) for part in parts if get_origin(part) is tuple)
    return tuple(get_origin(one) or one for one in inside)


def value_words(value: Any) -> str:
    """A value as a user writes it in Python."""
    return f"{value:g}" if isinstance(value, float) else repr(value)


def short_words(value: Any) -> str:
    """A refused value, as far as a line has room for it."""
    words = repr(value)
    return words if len(words) <= _LONGEST_VALUE else f"{words[:_LONGEST_VALUE]}…"


def unknown_words(name: str, known: Collection[str]) -> str:
    """What is wrong with a name that is none."""
    near = get_close_matches(name, known, 1)
    hint = f"did you mean {near[0]}? " if near else ""
    return f"there is no parameter {name!r}: {hint}there are {', '.join(known)}"


def _extra(field: FieldInfo, name: str) -> str:
    extra = field.json_schema_extra
    return str(extra.get(name, "")) if isinstance(extra, dict) else ""

"""Read files that others may have edited or damaged: what stands in them is checked before it is used."""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from cytodisk.errors import CytodiskError, ReadError, words_of
from cytodisk.parameter_words import short_words

Content = TypeVar("Content")

_MOST_TEXT = 64_000_000  # bytes; files of text that a run writes are far smaller


@contextmanager
def reading_file(path: str | os.PathLike[str], what: str, remedy: str) -> Iterator[None]:
    """Turn whatever a library raises on a missing or damaged file into a `ReadError`.

    Parameters
    ----------
    path : path-like
    what : str
        What the file should be, as "a map that DiskMap.save wrote".
    remedy : str
        What to do, as "make it again, with cytodisk map".
    """
    try:
        yield
    except CytodiskError:
        raise
    except MemoryError as error:
        raise ReadError(f"{path} is not {what}: it asks for more memory than there is: {remedy}") from error
    except Exception as error:
        if isinstance(error, FileNotFoundError) and not os.path.lexists(path):
            raise ReadError(f"{path} does not exist: {remedy}") from error
        raise ReadError(f"{path} is not {what} ({words_of(error)}): {remedy}") from error


def text_of(path: str | os.PathLike[str]) -> str:
    """The text of a file in UTF-8, which is no pipe and no larger than any that a run writes."""
    with open(path, "rb", opener=_opened_at_once) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise ValueError("it is a pipe or a device, not a file")
        content = file.read(_MOST_TEXT + 1)
    if len(content) > _MOST_TEXT:
        raise ValueError(f"it is larger than {_MOST_TEXT // 10**6} MB")
    return content.decode("utf-8-sig")


def _opened_at_once(path: str, flags: int) -> int:
    """A pipe without a writer would keep whoever opens it waiting."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def json_of(text: str) -> Any:
    """The content of a JSON text.

    Raises
    ------
    ValueError
        It is none, is nested too deeply, or has a number that is too long.
    """
    try:
        return json.loads(text)
    except RecursionError as error:
        raise ValueError("it is nested too deeply") from error


def checked(content: Any, shape: Callable[[], TypeAdapter[Content]], place: str, remedy: str) -> Content:
    """Content of a file as the types say that it must be.

    Parameters
    ----------
    content : object
        As JSON or TOML give it.
    shape : callable
        Gives the types.
    place : str
        File and part, for the message.
    remedy : str

    Raises
    ------
    ReadError
        It is not; the message names the field, what stands there and what to do.
    """
    try:
        return shape().validate_python(content)
    except ValidationError as error:
        raise ReadError(f"{place}: {fault_words(error)}: {remedy}") from None


def fault_words(error: ValidationError) -> str:
    """The first fault of some content: its field, what it must be and what stands there."""
    fault = error.errors(include_url=False)[0]
    field = ".".join(str(part) for part in fault["loc"])
    said = str(fault["msg"]).removeprefix("Value error, ")
    must = said.replace("Input should be", "must be").replace("Field required", "is missing")
    got = "" if fault["type"] == "missing" else f", got {short_words(fault['input'])}"
    return f"{field} {must[:1].lower()}{must[1:]}{got}" if field else f"it {must[:1].lower()}{must[1:]}{got}"

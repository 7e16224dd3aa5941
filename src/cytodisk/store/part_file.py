"""The file that marks a part of a run as done: its rows, and the other files of the part with their marks."""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cytodisk.files import flushed_later, replacing
from cytodisk.store.provenance_file import json_bytes

_HEAD, _TAIL = b'{"crc32": "%08x",\n"part": ', b"}\n"


@dataclass(frozen=True)
class DonePart:
    """A part that was written whole.

    Attributes
    ----------
    rows : list of dict
        For the table of cells.
    files : dict of str to str
        Marks of its other files by name, relative to the study's folder; see `mark_of`.
    """

    rows: list[dict[str, Any]]
    files: dict[str, str]


def write_done(path: Path, rows: Sequence[Mapping[str, Any]], files: Mapping[str, str]) -> None:
    """Mark a part as done, with the checksum of what stands in the file."""
    content = json_bytes({"files": files, "rows": rows})
    with flushed_later(), replacing(path) as temporary:
        temporary.write_bytes(_HEAD % zlib.crc32(content) + content + _TAIL)


def read_done(path: Path) -> DonePart | None:
    """A part that is done; None if its file is not there, or is not whole."""
    try:
        found = path.read_bytes()
    except OSError:
        return None
    start = len(_HEAD % 0)
    content = found[start : -len(_TAIL)]
    if found != _HEAD % zlib.crc32(content) + content + _TAIL:
        return None
    part = json.loads(content)
    return DonePart(part["rows"], part["files"])

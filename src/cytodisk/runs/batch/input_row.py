"""The row of an input: how it went."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from cytodisk.errors import ReadError, StudyError
from cytodisk.images.image_paths import is_pattern, is_zarr, parts_of
from cytodisk.images.mask_names import files_of
from cytodisk.parameter_words import short_words
from cytodisk.reading_files import checked, json_of
from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.store.json_shapes import input_row
from cytodisk.store.targets import Store

ROWS, STUDIES = "rows", "inputs"


@dataclass(frozen=True)
class InputRow:
    """How an input went.

    Attributes
    ----------
    input : str
        Its name.
    kind : {"movie", "map"}
    status : str
        "ok"; "refused" (a user can mend it), "failed" (an error that nobody expected), "crashed" (its process
        died), "killed" (from outside), "timed out" or "out of memory".
    reason : str
        Why it has no result; empty if it has.
    settings, files : str
        Hashes of the parameters, and of sizes and times of the files: whether the result still fits.
    complete : bool
        Whether its study is there; so it may be for a refused input too, without any map.
    cells, frames, mapped : int
        Cells; for a movie frames of all cells, else the same; and how many of them have a map.
    qc_flags : int
        Cells (of a movie frames of all cells) that a QC flag names.
    flags : str
        Names of the study's QC flags, with semicolons between, the gravest first.
    pixel_size_um, frame_interval_s : float or None
    length_unit, velocity_unit : str
        Units of its tables.
    seconds : float
        Wall time.
    log : str
        The traceback, or what the process said last, where something went wrong unexpectedly.
    worker : dict
        Where it ran: host, and versions of what the results depend on.
    """

    input: str
    kind: str
    status: str
    reason: str
    settings: str
    files: str
    complete: bool = False
    cells: int = 0
    frames: int = 0
    mapped: int = 0
    qc_flags: int = 0
    flags: str = ""
    pixel_size_um: float | None = None
    frame_interval_s: float | None = None
    length_unit: str = ""
    velocity_unit: str = ""
    seconds: float = 0.0
    log: str = ""
    worker: dict[str, Any] | None = None


def study_key(name: str) -> str:
    """Where the study of an input stands."""
    return f"{STUDIES}/{name}"


def row_key(name: str) -> str:
    """Where the row of an input stands."""
    return f"{ROWS}/{name}.json"


def write_row(store: Store, row: InputRow) -> None:
    """Write the row of an input, which marks it as done."""
    store.write_text(row_key(row.input), json.dumps(asdict(row), indent=1, ensure_ascii=False) + "\n")


def read_row(store: Store, name: str) -> InputRow | None:
    """The row of an input; None if it was not done.

    Raises
    ------
    StudyError
        The row is damaged.
    """
    text = store.read_text(row_key(name))
    if text is None:
        return None
    place, remedy = f"row {row_key(name)}", "remove it, and its input is done anew"
    try:
        row = InputRow(**checked(json_of(text), input_row, place, remedy))
    except (ReadError, ValueError) as error:
        words = str(error) if isinstance(error, ReadError) else f"{place} is damaged ({error}): {remedy}"
        raise StudyError(words) from error
    if row.input != name:
        raise StudyError(f"{place} is that of input {short_words(row.input)}: {remedy}")
    return row


def files_mark(item: BatchInput) -> str:
    """A hash of sizes and times of an input's files; it changes when one of them does."""
    tracks = getattr(item.parameters, "tracks", None)  # which movies alone have
    paths = [*item.files.values(), *([] if tracks is None else [Path(tracks)])]
    marks = [_marks(path) for path in paths]
    return hashlib.sha256(json.dumps(marks).encode()).hexdigest()[:16]


def _marks(path: Path) -> list[Any]:
    try:
        if is_zarr(path):
            return [[str(part), *_marks(part)] for part in parts_of(path)]
        if path.is_dir() or is_pattern(path):
            return [[file.name, *_marks(file)] for file in files_of(path)]
        found = path.stat()
    except OSError:
        return []  # whoever opens it says what is wrong
    return [found.st_size, found.st_mtime_ns]

"""The file that says where a study comes from and what it wrote, and how two runs differ."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePath
from typing import Any

from cytodisk.disk.mapping_parameters import MAPS_VERSION
from cytodisk.errors import ReadError
from cytodisk.files import replacing

PROVENANCE = "provenance.json"
MAPS = "maps version"
_EARLIER_MAPS = "its maps are of an earlier version, with another mesh and relaxation"
FORMAT = 2
"""Of the tables and files of a study: 1 had no list of files, and other names of columns."""


def read_provenance(folder: Path) -> dict[str, Any] | None:
    """What a folder says of its run; None if it holds no study."""
    try:
        return parse_provenance((folder / PROVENANCE).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError):
        return None


def parse_provenance(text: str) -> dict[str, Any] | None:
    """The content of a provenance file; None if it is none."""
    try:
        found = json.loads(text)
    except json.JSONDecodeError:
        return None
    return found if isinstance(found, dict) and "fingerprint" in found else None


def read_complete(folder: Path, *runs: str) -> dict[str, Any]:
    """The provenance of a complete study.

    Parameters
    ----------
    folder : Path
    *runs : str
        Kinds of run that are wanted.

    Returns
    -------
    dict

    Raises
    ------
    ReadError
        The folder does not exist, holds no study or one of another kind or version, or it is not complete.
    """
    found = read_provenance(folder)
    if found is None and not folder.exists():
        raise ReadError(f"study {folder} does not exist: check the path")
    if found is None:
        raise ReadError(f"{folder} is no study: it has no readable {PROVENANCE}")
    if words := other_version(found):
        raise ReadError(f"study {folder} {words}: read it with that version, or run the command anew")
    if found.get("run") not in runs:
        raise ReadError(f"study {folder} holds a run of {command_of(found)}: {found.get('reader')}")
    if found.get("status") != "complete":
        raise ReadError(f"study {folder} is not complete: run the same command again with --resume")
    return found


def other_version(provenance: dict[str, Any]) -> str:
    """Words for a study that another version wrote in another way; empty for one of this version."""
    if provenance.get("format") == FORMAT:
        return ""
    version = provenance.get("versions", {}).get("cytodisk", "of unknown version")
    return f"was written by an earlier or later cytodisk ({version}), with other tables"


def maps_version(provenance: dict[str, Any]) -> int:
    """Version of the maps of a run, see `MAPS_VERSION`; version 1 did not write it down."""
    return int(provenance.get("fingerprint", {}).get(MAPS, 1))


def writer_of(provenance: dict[str, Any]) -> str:
    """Which cytodisk did a run, as "cytodisk 0.1.0"."""
    version = provenance.get("versions", {}).get("cytodisk")
    return f"cytodisk {version}" if version else "an earlier cytodisk"


def other_maps(provenance: dict[str, Any]) -> str:
    """Words for a study whose maps are of another version; empty for maps as they are made now."""
    if maps_version(provenance) == MAPS_VERSION:
        return ""
    return (
        f"Maps by {writer_of(provenance)}: their windows lie at other places than those of this version. "
        "Do not compare window by window with studies made now."
    )


def own_files(provenance: dict[str, Any]) -> list[str]:
    """Names, or patterns of names, of what a run wrote into its folder, beside the provenance.

    Names that lead out of the folder are left out: the file may come from elsewhere, and `--overwrite`
    removes what is named here.
    """
    names = [str(name) for name in provenance.get("files", []) if name and name != PROVENANCE]
    return [name for name in names if not PurePath(name).is_absolute() and ".." not in PurePath(name).parts]


def write_json(path: Path, content: Any) -> None:
    """Write a JSON file whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def record_files(folder: Path, names: Iterable[str]) -> None:
    """Note in the provenance of a study what else is written into its folder; nothing without a study.

    Parameters
    ----------
    folder : Path
    names : iterable of str
        Relative to the folder; `--overwrite` removes them.
    """
    if not (given := list(dict.fromkeys(names))):
        return
    with _held(folder):
        found = read_provenance(folder)
        known = [] if found is None else found.get("files", [])
        new = [name for name in given if name not in known]
        if found is not None and new:
            write_json(folder / PROVENANCE, found | {"files": [*known, *new]})


@contextmanager
def _held(folder: Path) -> Iterator[None]:
    """Let one process at a time change the provenance."""
    if sys.platform == "win32":
        yield
        return
    import fcntl

    held = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(held, fcntl.LOCK_EX)
        yield
    finally:
        os.close(held)


def command_of(provenance: dict[str, Any]) -> str:
    """The command that makes such a run."""
    return str(provenance.get("command") or f"cytodisk {provenance.get('run', 'map')}")


def differences(there: dict[str, Any], here: dict[str, Any]) -> str:
    """What two runs differ in, in words: the command, or else what their results depend on."""
    if command_of(there) != command_of(here):
        return f"that of {command_of(there)}, not of {command_of(here)}"
    changes = _changes(there.get("fingerprint", {}), here["fingerprint"])
    return "; ".join(changes) or "unknown"


def way_out(there: dict[str, Any], here: dict[str, Any]) -> str:
    """What to do where another run stands, in words."""
    then, now = there.get("fingerprint", {}), here["fingerprint"]
    anew = "--overwrite to replace it, or another folder"
    if "method" in then and then | {"method": now.get("method")} == now:
        return f"pass --method {then['method']} to go on with it, {anew}"
    return f"pass {anew}"


def _changes(old: dict[str, Any], new: dict[str, Any]) -> list[str]:
    changes = []
    for name in [*new, *(name for name in old if name not in new)]:
        then, now = old.get(name), new.get(name)
        if isinstance(then, dict) and isinstance(now, dict):
            changes += _changes(then, now)
        elif name == MAPS and then is None:
            changes.append(_EARLIER_MAPS)
        elif then != now:
            changes.append(f"{name}: {_short(then)} then, {_short(now)} now")
    return changes


def _short(value: Any) -> str:
    text = str(value)
    return text if len(text) <= 24 else f"{text[:8]}…"

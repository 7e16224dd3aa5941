"""The file that says where a study comes from and what it wrote, and how two runs differ."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from cytodisk.checks import is_path
from cytodisk.disk.mapping_parameters import MAPS_VERSION
from cytodisk.errors import ReadError
from cytodisk.files import replacing
from cytodisk.reading_files import checked, json_of, text_of
from cytodisk.store.json_shapes import provenance_fields

PROVENANCE = "provenance.json"
MAPS = "maps version"
_REMEDY = "take it from a copy of the study, or pass another folder and run the command again"
_GROUPS = "groups sha256"  # of the fingerprint
_EARLIER_MAPS = "its maps are of an earlier version, with another mesh and relaxation"
FORMAT = 3
"""Of the tables and files of a study: 1 had no list of files, and other names of columns; the list of 2 has
patterns of names, and no checksums."""
_READABLE = (2, FORMAT)


def read_provenance(folder: Path) -> dict[str, Any] | None:
    """What a folder says of its run; None if it holds no study."""
    path = folder / PROVENANCE
    try:
        return parse_provenance(text_of(path), str(path))
    except ReadError:
        raise
    except (OSError, ValueError):
        return None


def parse_provenance(text: str, place: str = PROVENANCE) -> dict[str, Any] | None:
    """The content of a provenance file; None if it is none.

    Parameters
    ----------
    text : str
    place : str
        Name of the file, for messages.

    Raises
    ------
    ReadError
        It is one of which a field is not as a run writes it.
    """
    try:
        found = json_of(text)
    except ValueError:
        return None
    if not isinstance(found, dict) or "fingerprint" not in found:
        return None
    checked(found, provenance_fields, place, _REMEDY)
    return found


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
    is_path("study", folder)
    found = read_provenance(folder)
    if found is None and not folder.exists():
        raise ReadError(f"study {folder} does not exist: check the path")
    if found is None:
        raise ReadError(f"{folder} is no study: it has no readable {PROVENANCE}")
    if words := other_version(found, to_read=True):
        raise ReadError(f"study {folder} {words}: read it with that version, or run the command anew")
    if found.get("run") not in runs:
        raise ReadError(f"study {folder} holds a run of {command_of(found)}: {found.get('reader')}")
    if found.get("status") != "complete":
        raise ReadError(f"study {folder} is not complete: run the same command again with --resume")
    return found


def other_version(provenance: dict[str, Any], *, to_read: bool = False) -> str:
    """Words for a study that another version wrote in another way; empty for one of this version.

    Parameters
    ----------
    provenance : dict
    to_read : bool
        It is only read: then an earlier one will do that has the same tables.
    """
    found = provenance.get("format")
    if found == FORMAT or (to_read and found in _READABLE):
        return ""
    version = provenance.get("versions", {}).get("cytodisk", "of unknown version")
    what = "which did not note all files that it wrote" if found in _READABLE else "with other tables"
    return f"was written by an earlier or later cytodisk ({version}), {what}"


def maps_version(provenance: dict[str, Any]) -> int:
    """Version of the maps of a run, see `MAPS_VERSION`; version 1 did not write it down."""
    found = provenance.get("fingerprint", {}).get(MAPS, 1)
    return found if isinstance(found, int) else 0


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


def write_json(path: Path, content: Any) -> None:
    """Write a JSON file whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_bytes(json_bytes(content, indent=2) + b"\n")


def json_bytes(content: Any, indent: int | None = None) -> bytes:
    """JSON in UTF-8; a name of a file that is not in UTF-8 comes back as it was, too."""
    return json.dumps(content, indent=indent, ensure_ascii=False).encode("utf-8", "backslashreplace")


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
    by_cells = command_of(there) != "cytodisk population"  # which can be grouped anew when they are done
    if by_cells and then | {_GROUPS: None} == now | {_GROUPS: None}:
        instead = "cytodisk population takes another table of groups for a study that is done"
        return f"{instead}, as --groups groups.csv; or pass {anew}"
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

"""The file that says where a study comes from, and how two runs differ."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from cytodisk.files import replacing

PROVENANCE = "provenance.json"


def read_provenance(folder: Path) -> dict[str, Any] | None:
    """What a folder says of its run; None if it holds no study."""
    try:
        found = json.loads((folder / PROVENANCE).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, json.JSONDecodeError):
        return None
    return found if isinstance(found, dict) and "fingerprint" in found else None


def write_json(path: Path, content: Any) -> None:
    """Write a JSON file whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(content, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


_COMMANDS = {
    None: "cytodisk map",
    "movie": "cytodisk movie",
    "shapes": "cytodisk shapes",
    "comparison": "cytodisk compare-windows",
    "movie comparison": "cytodisk compare-windows --movie",
}


def command_of(provenance: dict[str, Any]) -> str:
    """The command that makes such a run."""
    run = provenance.get("run")
    return _COMMANDS.get(run, f"cytodisk {run}")


def differences(there: dict[str, Any], here: dict[str, Any]) -> str:
    """What two runs differ in, in words: the command, or else what their results depend on."""
    if command_of(there) != command_of(here):
        return f"that of {command_of(there)}, not of {command_of(here)}"
    changes = _changes(there.get("fingerprint", {}), here["fingerprint"])
    return "; ".join(changes) or "unknown"


def _changes(old: dict[str, Any], new: dict[str, Any]) -> list[str]:
    changes = []
    for name in [*new, *(name for name in old if name not in new)]:
        then, now = old.get(name), new.get(name)
        if isinstance(then, dict) and isinstance(now, dict):
            changes += _changes(then, now)
        elif then != now:
            changes.append(f"{name}: {_short(then)} then, {_short(now)} now")
    return changes


def _short(value: Any) -> str:
    text = str(value)
    return text if len(text) <= 24 else f"{text[:8]}…"

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


def differences(there: dict[str, Any], here: dict[str, Any]) -> str:
    """What two runs' fingerprints differ in, in words."""
    old, new = there.get("fingerprint", {}), here["fingerprint"]
    names = [name for name in new if old.get(name) != new[name]]
    return (
        "; ".join(f"{name}: {_short(old.get(name))} then, {_short(new[name])} now" for name in names)
        or "unknown"
    )


def _short(value: Any) -> str:
    text = str(value)
    return text if len(text) <= 24 else f"{text[:8]}…"

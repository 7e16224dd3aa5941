"""What a page says of a run: its inputs, when it was made, with which versions."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

from cytodisk.files import file_name


def version_of(provenance: Mapping[str, Any]) -> str:
    """Version of the software that made the results."""
    return str(provenance.get("versions", {}).get("cytodisk", "unknown"))


def value_words(value: Any) -> str:
    """A parameter's value as a page shows it."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def input_words(provenance: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Inputs by role, with how they were read."""
    for role, told in provenance.get("inputs", {}).items():
        sha256 = f"(sha256 {told.get('sha256', '')[:16]}…)"
        yield role, f"{file_name(told['path'])} – {told.get('read as', '')} {sha256}"


def run_words(provenance: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """When the run was made, and with which versions."""
    for name in ("started", "finished", "python"):
        if name in provenance:
            yield name, str(provenance[name])
    versions = provenance.get("versions", {})
    yield "versions", ", ".join(f"{name} {version}" for name, version in versions.items())

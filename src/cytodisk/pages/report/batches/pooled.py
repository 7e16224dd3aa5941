"""Pooled correlations on the page of a batch."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

from cytodisk.errors import CytodiskError
from cytodisk.store.correlation_store import list_correlations, titled
from cytodisk.store.populations.pooled_correlation import PooledCorrelation, open_pooled_correlation
from cytodisk.store.study_kind import FIGURES

PICTURE = "curves.png"


def pooled_correlations(folder: Path) -> list[dict[str, Any]]:
    """What was correlated in all movies of a batch: title, sentences, and the picture as a data URL."""
    return [_of_names(folder, names) for names in list_correlations(folder)]


def _of_names(folder: Path, names: tuple[str, ...]) -> dict[str, Any]:
    try:
        found = open_pooled_correlation(folder, *names)
        sentences = [*found.sentences, *map(_warning_words, found.warnings)]
    except CytodiskError as error:
        return {"title": titled(*names), "sentences": [str(error)], "picture": ""}
    return {"title": titled(*names), "sentences": sentences, "picture": _picture(found)}


def _warning_words(one: dict[str, str]) -> str:
    return f"Warning: {one['name']}: {one['finding']} {one['consequence']} {one['remedy']}"


def _picture(found: PooledCorrelation) -> str:
    """Empty where it was not drawn as PNG."""
    path = found.path / FIGURES / PICTURE
    if not path.is_file():
        return ""
    return f"data:image/png;base64,{base64.b64encode(path.read_bytes()).decode('ascii')}"

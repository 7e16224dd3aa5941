"""Sphinx extension: write `changelog.rst` from the repository's CHANGELOG.md, which stays the only copy."""

import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

UNDERLINES = {1: "=", 2: "-", 3: "~"}


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("builder-inited", write_changelog)
    return {"parallel_read_safe": True}


def write_changelog(app: Sphinx) -> None:
    source = Path(app.srcdir)
    markdown = (source.parents[1] / "CHANGELOG.md").read_text(encoding="utf-8")
    lines = [".. currentmodule:: cytodisk", "", *(_as_rst(line) for line in markdown.splitlines())]
    (source / "changelog.rst").write_text("\n".join(lines) + "\n", encoding="utf-8")


def _as_rst(line: str) -> str:
    """Headings get underlines, links their targets; lists and code read the same in both languages."""
    heading = re.fullmatch(r"(#+) (.*)", line)
    if heading:
        text = heading[2]
        return f"{text}\n{UNDERLINES[len(heading[1])] * len(text)}"
    return re.sub(r"\[([^]]+)\]\(([^)]+)\)", r"`\1 <\2>`__", line)

"""Sphinx extension: write the pages of the Python reference from the package's stubs.

A stub lists the public names in groups, each under a comment. The comment becomes the heading of a table, so
the reference shows every name, in the order of the stub.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import cytodisk
from cytodisk import simulate

if TYPE_CHECKING:
    from sphinx.application import Sphinx

PACKAGE = Path(cytodisk.__file__).parent
NAMES_WORDS = "``import cytodisk as cd`` gives you all of these names, such as ``cd.map_to_disk``."
PLOT_WORDS = "These functions take Axes and return artists, so you can put your own figure together."
PAGES_WORDS = "These functions write whole figures to files."
SIMULATE_WORDS = "Cells, signals and movies with known answers, for the demo, these pages and tests."
ERRORS_WORDS = "A wrong input ends in one of these errors. Its message says what came and what to do."


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("config-inited", write_pages)
    return {"parallel_read_safe": True}


def write_pages(app: Sphinx, _config: Any) -> None:
    folder = Path(app.srcdir) / "reference" / "python"
    folder.mkdir(parents=True, exist_ok=True)
    pages = {
        "names": names_page("cytodisk", PACKAGE, "Functions and classes", NAMES_WORDS),
        "plot": names_page("cytodisk.plot", PACKAGE / "plot", "Pictures", PLOT_WORDS),
        "pages": names_page("cytodisk.pages", PACKAGE / "pages", "Figures in files", PAGES_WORDS),
        "simulate": simulate_page(),
        "errors": errors_page(),
    }
    for name, lines in pages.items():
        write(folder / f"{name}.rst", lines)


def names_page(module: str, folder: Path, title: str, words: str) -> list[str]:
    """A page with a table for each group of a stub."""
    lines = [*heading(title, "="), words, ""]
    for group, names in groups(folder / "__init__.pyi").items():
        lines += [*heading(group, "-"), *table(module, names)]
    return lines


def groups(stub: Path) -> dict[str, list[str]]:
    """Public names of a stub by the comment above them."""
    found: dict[str, list[str]] = {}
    title = ""
    for line in stub.read_text(encoding="utf-8").splitlines():
        if line.startswith("# ") and not line.startswith("# ruff"):
            title = line.removeprefix("# ")
        elif name := re.fullmatch(r"(?:from \.\S+ import |    )\w+ as (\w+),?", line):
            if not title:
                raise ValueError(f"{stub}: {name[1]} stands under no comment that names its group")
            found.setdefault(title, []).append(name[1])
    return found


def simulate_page() -> list[str]:
    """Functions and classes in a table, lists of kinds in words."""
    names = [name for name in simulate.__all__ if not isinstance(getattr(simulate, name), tuple)]
    kinds = [name for name in simulate.__all__ if isinstance(getattr(simulate, name), tuple)]
    lists = [f"``{name}``\n    {', '.join(getattr(simulate, name))}\n" for name in kinds]
    start = [*heading("Simulated cells and movies", "="), SIMULATE_WORDS, ""]
    return [*start, *table("cytodisk.simulate", sorted(names, key=str.lower)), *lists]


def errors_page() -> list[str]:
    """All errors on one page."""
    options = ["   :members:", "   :show-inheritance:", "   :member-order: bysource"]
    return [*heading("Errors", "="), ERRORS_WORDS, "", ".. automodule:: cytodisk.errors", *options]


def heading(text: str, underline: str) -> list[str]:
    return [text, underline * len(text), ""]


def table(module: str, names: list[str]) -> list[str]:
    """Table of names with their first sentences, and a page for each."""
    rows = [f"   {name}" for name in names]
    return [f".. currentmodule:: {module}", "", ".. autosummary::", "   :toctree: generated", "", *rows, ""]


def write(path: Path, lines: list[str]) -> None:
    """Write a page if it is another one than before, so that Sphinx reads again only what changed."""
    text = "\n".join(lines) + "\n"
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")

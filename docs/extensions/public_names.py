"""Sphinx extension: write the pages of the Python reference from the package's own lists of names.

A public name appears on the page of the folder of `src/cytodisk` that it comes from, so that the reference
cannot miss one.
"""

import inspect
import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

import cytodisk
from cytodisk import simulate

PAGES = {
    "geometry": ("Masks", "What a mask needs before it can be mapped, and what was changed."),
    "disk": ("Maps", "From a mask to the disk and back, with the proof that comes with every map."),
    "windows": ("Windows and sampling", "Divide a cell into windows, and measure a signal in each."),
    "motion": ("Movies", "Follow a cell through time: maps in correspondence, velocity of the edge."),
    "analysis": ("Analysis", "Signals through time, what they correlate with, episodes of the edge, shapes."),
    "study": ("Work on a whole study", "What the command line does, from Python."),
    "io": ("Files and studies", "Read images and masks, and the tables and maps of a run."),
    "report": ("Report", "One page with all views of a cell, red flags first."),
}
PLOT_WORDS = "Functions that draw take Axes and return artists: put a picture together as you need it."
SIMULATE_WORDS = "Cells, signals and movies with known answers, for the demo, these pages and tests."
ERRORS_WORDS = "Every fault of an input ends in one of these; the message says what came and what to do."


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("config-inited", write_pages)
    return {"parallel_read_safe": True}


def write_pages(app: Sphinx, _config: Any) -> None:
    folder = Path(app.srcdir) / "reference" / "python"
    folder.mkdir(parents=True, exist_ok=True)
    by_page: dict[str, list[str]] = {page: [] for page in PAGES}
    for name, home in cytodisk._HOME.items():
        page = home.split(".")[0]
        if page not in by_page:
            raise ExtensionError(f"cytodisk.{name} comes from {page}/: give that a page in {__file__}")
        by_page[page].append(name)
    for page, names in by_page.items():
        title, words = PAGES[page]
        write(folder / f"{page}.rst", [*heading(title, "="), words, "", *table("cytodisk", names)])
    write(folder / "plot.rst", plot_page())
    write(folder / "simulate.rst", simulate_page())
    write(folder / "errors.rst", errors_page())


def plot_page() -> list[str]:
    """A table for each paragraph of the module's docstring, "Windows: draw_windows, …", with its names."""
    left = set(cytodisk.plot.__all__)
    lines = [*heading("Pictures", "="), PLOT_WORDS, ""]
    for paragraph in inspect.cleandoc(cytodisk.plot.__doc__ or "").split("\n\n")[1:]:
        title, _, words = paragraph.replace("\n", " ").partition(":")
        names = sorted(left & set(re.findall(r"\w+", words)), key=str.lower)
        left -= set(names)
        lines += [*heading(title, "-"), *table("cytodisk.plot", names)]
    if left:
        raise ExtensionError(f"the docstring of cytodisk.plot does not name {', '.join(sorted(left))}")
    return lines


def simulate_page() -> list[str]:
    """Functions and classes in a table, lists of kinds in words."""
    names = [name for name in simulate.__all__ if not isinstance(getattr(simulate, name), tuple)]
    kinds = [name for name in simulate.__all__ if isinstance(getattr(simulate, name), tuple)]
    lists = [f"``{name}``\n    {', '.join(getattr(simulate, name))}\n" for name in kinds]
    start = [*heading("Simulated cells and movies", "="), SIMULATE_WORDS, ""]
    return [*start, *table("cytodisk.simulate", names), *lists]


def errors_page() -> list[str]:
    """All errors on one page."""
    options = ["   :members:", "   :show-inheritance:", "   :member-order: bysource"]
    return [*heading("Errors", "="), ERRORS_WORDS, "", ".. automodule:: cytodisk.errors", *options]


def heading(text: str, underline: str) -> list[str]:
    return [text, underline * len(text), ""]


def table(module: str, names: list[str]) -> list[str]:
    """Table of names with their first sentences, and a page for each."""
    rows = [f"   {name}" for name in sorted(names, key=str.lower)]
    return [f".. currentmodule:: {module}", "", ".. autosummary::", "   :toctree: generated", "", *rows, ""]


def write(path: Path, lines: list[str]) -> None:
    """Write a page if it is another one than before, so that Sphinx reads again only what changed."""
    text = "\n".join(lines) + "\n"
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")

"""What `cytodisk check` and `cytodisk map` say of nuclei: how many cells have how many, in a line."""

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

from cytodisk.number_words import counted

if TYPE_CHECKING:
    from cytodisk.runs.cells.cell_nuclei import CellNucleus

_WORDS = {
    "ok": "with one nucleus",
    "none": "without a nucleus",
    "several": "with several nuclei",
    "partly outside": "whose nucleus lies partly outside",
    "shared": "that share a nucleus",
    "unusable": "whose file of nuclei cannot be used",
}


def nuclei_words(statuses: Counter[str]) -> Iterator[str]:
    """A line on the nuclei of cells, and one on nuclei without a cell.

    Parameters
    ----------
    statuses : Counter of str
        Cells, and nuclei without a cell ("no cell"), by what their match says.
    """
    found = ", ".join(
        f"{counted(statuses[status], 'cell')} {words}" for status, words in _WORDS.items() if statuses[status]
    )
    if found:
        yield f"nuclei: {found}"
    if strays := statuses["no cell"]:
        yield "1 nucleus lies in no cell" if strays == 1 else f"{strays} nuclei lie in no cell"
    if statuses["none"] and not (statuses["ok"] or statuses["several"]):
        yield "no cell has a nucleus: are these the nuclei of the same image, with the same orientation?"


def statuses_of(nucleus: "CellNucleus") -> Iterator[str]:
    """The status of a cell's nuclei, and of nuclei without a cell that are told with it."""
    if nucleus.match is not None:
        yield nucleus.match.status
    elif nucleus.fault is not None:
        yield "unusable"
    yield from (stray.status for stray in nucleus.strays)

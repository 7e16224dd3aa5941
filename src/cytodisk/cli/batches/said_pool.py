"""What a command says of a batch that it pooled."""

import sys
from collections import Counter
from typing import TYPE_CHECKING, TypeAlias, Union

from cytodisk.cli.console import count

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.store.populations.pooled_correlation import PooledCorrelation
    from cytodisk.store.populations.pooled_prediction import PooledPrediction
    from cytodisk.store.populations.pooled_waves import PooledWaves

Found: TypeAlias = Union["PooledCorrelation", "PooledPrediction", "PooledWaves"]

_MOST_FAILED = 20


def say_inputs(console: "Console", found: Found, done: str) -> None:
    """How many movies are in, why others are not, and which cells are left out or flagged.

    Parameters
    ----------
    console : Console
    found : PooledCorrelation, PooledPrediction or PooledWaves
    done : str
        What was done with the inputs, as "correlated".
    """
    studies = found.studies
    console.print(_count_words(Counter(studies["status"]), len(studies), done))
    lost = [*studies[~studies["status"].isin(["ok", "kept"])].itertuples()]
    for row in lost[:_MOST_FAILED]:
        print(f"{row.input} {row.status}: {row.reason}", file=sys.stderr)
    if len(lost) > _MOST_FAILED:
        print(f"… and {len(lost) - _MOST_FAILED} more: studies.parquet in {found.path}", file=sys.stderr)
    cells = found.cells[found.cells["status"] != "ok"]
    if len(cells):
        console.print(f"{count(len(cells))} left out: column reason of cells.parquet says why")
    flagged = int((found.cells["qc_flags"].fillna("") != "").sum())
    if flagged:
        console.print(f"{count(flagged)} with QC flags are in: column qc_flags of cells.parquet names them")


def say_findings(console: "Console", found: Found) -> None:
    """What was found, and what speaks against it."""
    for words in found.sentences:
        console.print(words)
    said = [f"{one['name']}: {one['finding']} {one['consequence']} {one['remedy']}" for one in found.warnings]
    for words in dict.fromkeys(said):  # with and without geometry much is the same
        console.print(f"Warning: {words}")


def _count_words(statuses: Counter[str], whole: int, done_words: str) -> str:
    done = statuses.pop("ok", 0) + (kept := statuses.pop("kept", 0))
    words = f"{done} of {count(whole, 'input')} {done_words}" + (f", {kept} of them before" if kept else "")
    return "; ".join([words, *(f"{number} {status}" for status, number in sorted(statuses.items()))])

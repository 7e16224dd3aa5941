"""What `cytodisk map` says at its end."""

import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from cytodisk.cli.console import count, fail
from cytodisk.cli.flag_words import say_study_flags
from cytodisk.cli.nuclei_words import nuclei_words
from cytodisk.cli.nucleus_words import nucleus_ratio_words, nucleus_share_words
from cytodisk.cli.report.report_words import say_page
from cytodisk.images.mask_names import without_name
from cytodisk.store.nuclei.summary_columns import channels_among

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

    from cytodisk.store.study import Study

_MOST_LINES = 20
_LOST = {"refused": "refused", "no image": "without an image", "unreadable": "with a damaged image"}
_EMPTY = {"no cell": "empty", "no image": "without an image", "unreadable": "damaged", "refused": "no masks"}


def finish_map(
    console: "Console",
    study: "Study",
    figures: int,
    of_folder: bool,
    write_page: Callable[[], Path] | None = None,
) -> None:
    """Draw the overview, write the page and say what came out; exit code 2 if that is nothing, or an input
    is damaged.
    """
    from cytodisk.pages.overview import write_overview
    from cytodisk.store.figures_folder import drawing

    rows = study.cells
    if len(rows) > 1:
        with drawing(study.path, "overview.png") as folder:
            write_overview(folder / "overview.png", rows)
        _draw_nuclei(study)
    cells, without = rows[rows["label"] != 0], rows[rows["label"] == 0]
    mapped, lost = rows[rows["status"] == "ok"], rows[rows["status"] != "ok"]
    if of_folder:
        _say_totals(console, rows["source"].nunique(), cells, mapped)
    else:
        console.print(f"{len(mapped)} of {count(len(cells))} mapped{_one_to_one(mapped)}")
    for line in without_cell_words(Counter(without["status"]), of_folder):
        console.print(line)
    if "nucleus_status" in cells:
        for line in nuclei_words(Counter(cells["nucleus_status"].dropna())):
            console.print(line)
    if len(mapped):
        console.print(
            f"median {mapped['seconds'].median():.2f} s a cell; median area error of windows "
            f"{mapped['window_area_error'].median():.3f}; empty windows {int(mapped['empty_windows'].sum())}"
        )
    for words in (nucleus_ratio_words(mapped), nucleus_share_words(mapped)):
        if words:
            console.print(words)
    _say_remarks(console, mapped)
    if of_folder:
        numbers = [cell if label else None for cell, label in zip(lost["cell"], lost["label"], strict=True)]
        say_reasons(zip(numbers, lost["source"], lost["status"], lost["reason"], strict=True))
    else:
        _say_lost(lost)
    if 0 < figures < len(mapped):
        console.print(f"figures drawn for the first {count(figures)}: --figures -1 draws all")
    say_study_flags(console, study)
    console.print(f"results: {study.path}")
    if write_page is not None:
        say_page(console, write_page)
    unreadable = int((rows["status"] == "unreadable").sum())
    if not len(mapped):
        fail(f"no cell could be mapped: {lost['reason'].iloc[0] if len(lost) else 'the file holds no cell'}")
    if unreadable:
        what = "files or frames" if of_folder else "frames"
        fail(f"damaged {what} of the input: {unreadable}; all others are in {study.path}")


def _draw_nuclei(study: "Study") -> None:
    """The picture of nucleus and cytoplasm; lines by layer only of as many cells as can be told apart."""
    from cytodisk.pages.nuclei_page import MOST_CELLS, write_nuclei_figure
    from cytodisk.store.figures_folder import drawing

    if not channels_among(map(str, study.cells)):
        return
    few = (study.cells["status"] == "ok").sum() <= MOST_CELLS
    with drawing(study.path, "nuclei.png") as folder:
        write_nuclei_figure(folder / "nuclei.png", study.cells, study.nuclear_profile if few else None)


def without_cell_words(statuses: Counter[str], of_folder: bool) -> Iterator[str]:
    """A line on how many files, or images in them, hold no cell: they count as no cell in the totals."""
    if statuses:
        what = "files or images" if of_folder else "frames"
        yield f"{what} without a cell: {_counts(statuses, _EMPTY)}"


def _counts(statuses: Counter[str], words: dict[str, str]) -> str:
    return ", ".join(f"{statuses[name]} {said}" for name, said in words.items() if statuses[name])


def _say_totals(console: "Console", files: int, cells: "pd.DataFrame", mapped: "pd.DataFrame") -> None:
    """Totals with both denominators, so that cells that were lost cannot hide."""
    lost = _counts(Counter(cells["status"]), _LOST)
    words = f"{len(mapped)} mapped{_one_to_one(mapped)}" + (f"; {lost}" if lost else "")
    console.print(f"{count(files, 'file')}, {count(len(cells))}: {words}")
    border = int(mapped["touches_border"].astype(bool).sum())
    complete = int((mapped["empty_windows"] == 0).sum())
    console.print(f"on the image border: {_of(border, len(mapped))} mapped cells")
    of_all = _of(complete, len(cells))
    console.print(f"all windows complete: {_of(complete, len(mapped))} mapped cells, {of_all} all cells")


def _one_to_one(mapped: "pd.DataFrame") -> str:
    """What the certificates say."""
    valid = int(mapped["certificate_valid"].astype(bool).sum())
    if not len(mapped):
        return ""
    return ", one to one" if valid == len(mapped) else f", {valid} of them one to one"


def _of(part: int, whole: int) -> str:
    return f"{part} ({percent(part, whole)}) of {whole}" if whole else "0 of 0"


def percent(part: int, whole: int) -> str:
    """Without decimals; what is not none or not all is not rounded to it."""
    if 0 < part < whole:
        rounded = round(100 * part / whole)
        return "< 1 %" if rounded == 0 else "> 99 %" if rounded == 100 else f"{rounded} %"
    return f"{100 * part // whole} %"


def _say_remarks(console: "Console", mapped: "pd.DataFrame") -> None:
    remarks = mapped[mapped["notes"] != ""]
    if len(remarks):
        console.print(f"{count(len(remarks))} with remarks: column 'notes' of cells.parquet")


def _say_lost(lost: "pd.DataFrame") -> None:
    for _, row in lost.head(_MOST_LINES).iterrows():
        print(f"cell {row['cell']} (frame {row['frame']}) {row['status']}: {row['reason']}", file=sys.stderr)
    if len(lost) > _MOST_LINES:
        print(f"… and {len(lost) - _MOST_LINES} more: column 'reason' of cells.parquet", file=sys.stderr)


def say_reasons(lost: Iterable[tuple[int | None, str, str, str]]) -> None:
    """Print why cells were lost, one line for reasons that differ in numbers and names of files alone.

    Parameters
    ----------
    lost : iterable of (int or None, str, str, str)
        Cell (None for a file or an image without one), file, status and reason.
    """
    groups: dict[tuple[str, str], list[str]] = {}
    for cell, source, status, reason in lost:
        alike = re.sub(r"\S*" + re.escape(source), "FILE", reason) if source else reason
        key = status, re.sub(r"\d+", "N", alike)
        place = source if cell is None else f"cell {cell} of {source}"
        groups.setdefault(key, []).append(f"{place}: {without_name(reason, source)}")
    ordered = sorted(groups.items(), key=lambda item: -len(item[1]))
    for (status, _), found in ordered[:_MOST_LINES]:
        more = f" (and {len(found) - 1} more like it)" if len(found) > 1 else ""
        print(f"{len(found)} {status}: {found[0]}{more}", file=sys.stderr)
    if len(ordered) > _MOST_LINES:
        rest = sum(len(found) for _, found in ordered[_MOST_LINES:])
        print(f"… and {rest} for other reasons: column 'reason' of cells.parquet", file=sys.stderr)

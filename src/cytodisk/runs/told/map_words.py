"""What a run over single cells tells at its end: how many were mapped, and why others were not."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from cytodisk.images.mask_names import without_name
from cytodisk.number_words import counted
from cytodisk.runs.told.nuclei_words import nuclei_words
from cytodisk.runs.told.nucleus_words import nucleus_ratio_words, nucleus_share_words

if TYPE_CHECKING:
    import pandas as pd

    from cytodisk.store.study import Study

_MOST_LINES = 20
_LOST = {"refused": "refused", "no image": "without an image", "unreadable": "with a damaged image"}
_EMPTY = {"no cell": "empty", "no image": "without an image", "unreadable": "damaged", "refused": "no masks"}


def map_lines(study: "Study", of_folder: bool) -> Iterator[str]:
    """How many cells were mapped, and how well.

    Parameters
    ----------
    study : Study
    of_folder : bool
        Whether there were several files of masks.
    """
    rows = study.cells
    cells, without = rows[rows["label"] != 0], rows[rows["label"] == 0]
    mapped = rows[rows["status"] == "ok"]
    if of_folder:
        yield from _totals(rows["source"].nunique(), cells, mapped)
    else:
        yield f"{len(mapped)} of {counted(len(cells), 'cell')} mapped{_one_to_one(mapped)}"
    yield from without_cell_words(Counter(without["status"]), of_folder)
    if "nucleus_status" in cells:
        yield from nuclei_words(Counter(cells["nucleus_status"].dropna()))
    if len(mapped):
        yield (
            f"median {mapped['seconds'].median():.2f} s a cell; median area error of windows "
            f"{mapped['window_area_error'].median():.3f}; empty windows {int(mapped['empty_windows'].sum())}"
        )
    yield from filter(None, (nucleus_ratio_words(mapped), nucleus_share_words(mapped)))
    if remarks := int((mapped["notes"] != "").sum()):
        yield f"{counted(remarks, 'cell')} with remarks: column 'notes' of cells.parquet"


def signal_finding_lines(study: "Study") -> Iterator[str]:
    """Where the signals are, in the sentences of the report, and the command that compares conditions."""
    from cytodisk.runs.findings.cells_finding import cells_finding

    if not (study.cells["status"] == "ok").any():
        return
    _, *signals = (finding := cells_finding(study)).sentences  # the totals are told above
    if signals:
        yield f"Finding: {' '.join(signals)}"
    if finding.command:
        yield f"Do the conditions differ? {finding.command}"


def lost_cell_lines(study: "Study", of_folder: bool) -> Iterator[str]:
    """Why cells were not mapped."""
    lost = study.cells[study.cells["status"] != "ok"]
    if of_folder:
        numbers = [cell if label else None for cell, label in zip(lost["cell"], lost["label"], strict=True)]
        yield from reason_lines(zip(numbers, lost["source"], lost["status"], lost["reason"], strict=True))
        return
    for _, row in lost.head(_MOST_LINES).iterrows():
        yield f"cell {row['cell']} (frame {row['frame']}) {row['status']}: {row['reason']}"
    if len(lost) > _MOST_LINES:
        yield f"… and {len(lost) - _MOST_LINES} more: column 'reason' of cells.parquet"


def map_fault(study: "Study", of_folder: bool) -> str:
    """What went wrong with a run as a whole: nothing was mapped, or an input is damaged; else empty."""
    rows = study.cells
    lost = rows[rows["status"] != "ok"]
    if len(lost) == len(rows):
        return f"no cell could be mapped: {lost['reason'].iloc[0] if len(lost) else 'the file holds no cell'}"
    unreadable = int((rows["status"] == "unreadable").sum())
    what = "files or frames" if of_folder else "frames"
    return f"damaged {what} of the input: {unreadable}; all others are in {study.path}" if unreadable else ""


def without_cell_words(statuses: Counter[str], of_folder: bool) -> Iterator[str]:
    """A line on how many files, or images in them, hold no cell: they count as no cell in the totals."""
    if statuses:
        what = "files or images" if of_folder else "frames"
        yield f"{what} without a cell: {_counts(statuses, _EMPTY)}"


def _counts(statuses: Counter[str], words: dict[str, str]) -> str:
    return ", ".join(f"{statuses[name]} {said}" for name, said in words.items() if statuses[name])


def _totals(files: int, cells: "pd.DataFrame", mapped: "pd.DataFrame") -> Iterator[str]:
    """Totals with both denominators, so that cells that were lost cannot hide."""
    lost = _counts(Counter(cells["status"]), _LOST)
    words = f"{len(mapped)} mapped{_one_to_one(mapped)}" + (f"; {lost}" if lost else "")
    yield f"{counted(files, 'file')}, {counted(len(cells), 'cell')}: {words}"
    border = int(mapped["touches_border"].astype(bool).sum())
    complete = int((mapped["empty_windows"] == 0).sum())
    yield f"on the image border: {_of(border, len(mapped))} mapped cells"
    of_all = _of(complete, len(cells))
    yield f"all windows complete: {_of(complete, len(mapped))} mapped cells, {of_all} all cells"


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


def reason_lines(lost: Iterable[tuple[int | None, str, str, str]]) -> Iterator[str]:
    """Why cells were lost, one line for reasons that differ in numbers and names of files alone.

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
        yield f"{len(found)} {status}: {found[0]}{more}"
    if len(ordered) > _MOST_LINES:
        rest = sum(len(found) for _, found in ordered[_MOST_LINES:])
        yield f"… and {rest} for other reasons: column 'reason' of cells.parquet"

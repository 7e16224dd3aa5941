"""What `cytodisk map` and `cytodisk check` say at their end."""

import re
import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING

from cytodisk.cli.console import count, fail

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

    from cytodisk.io.study import Study
    from cytodisk.study.map_inputs import MapInputs
    from cytodisk.study.map_run import CheckedCell

_MOST_LINES = 20


def finish_map(console: "Console", study: "Study", figures: int, of_folder: bool) -> None:
    """Draw the overview and say what came out; exit code 2 if that is nothing, or an input is damaged."""
    from cytodisk.plot.study import draw_overview

    cells = study.cells
    if len(cells) > 1:
        draw_overview(study.path / "figures" / "overview.png", cells)
    mapped, lost = cells[cells["status"] == "ok"], cells[cells["status"] != "ok"]
    if of_folder:
        _say_totals(console, cells, mapped)
    else:
        console.print(f"{len(mapped)} of {count(len(cells))} mapped{_one_to_one(mapped)}")
    if len(mapped):
        console.print(
            f"median {mapped['seconds'].median():.2f} s a cell; median area distortion (mean |log λ|) "
            f"{mapped['area_distortion'].median():.3f}; empty windows {int(mapped['empty_windows'].sum())}"
        )
    _say_remarks(console, mapped, of_folder)
    if of_folder:
        say_reasons(zip(lost["cell"], lost["source"], lost["status"], lost["reason"], strict=True))
    else:
        _say_lost(lost)
    if 0 <= figures < len(mapped):
        console.print(f"figures drawn for the first {count(figures)}: --figures -1 draws all")
    console.print(f"results: {study.path}")
    unreadable = int((cells["status"] == "unreadable").sum())
    if not len(mapped):
        fail(f"no cell could be mapped: {lost['reason'].iloc[0] if len(lost) else 'the file holds no cell'}")
    if unreadable:
        what = "files or frames" if of_folder else "frames"
        fail(f"damaged {what} of the input: {unreadable}; all others are in {study.path}")


def _say_totals(console: "Console", cells: "pd.DataFrame", mapped: "pd.DataFrame") -> None:
    """Totals with both denominators, so that cells that were lost cannot hide."""
    status = cells["status"].value_counts()
    numbers = [f"{status.get(name, 0)} {name}" for name in ("refused", "unreadable") if status.get(name, 0)]
    console.print(
        f"{count(cells['source'].nunique(), 'file')}, {count(len(cells))}: "
        + "; ".join([f"{len(mapped)} mapped{_one_to_one(mapped)}", *numbers])
    )
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
    return f"{part} ({part / whole:.2%}) of {whole}" if whole else "0 of 0"


def _say_remarks(console: "Console", mapped: "pd.DataFrame", of_folder: bool) -> None:
    remarks = mapped[mapped["notes"] != ""]
    if len(remarks):
        console.print(f"{count(len(remarks))} with remarks: column 'notes' of cells.parquet")
    doubtful = mapped[mapped["doubts"] != ""]
    for _, row in doubtful.head(_MOST_LINES).iterrows():
        place = row["source"] if of_folder else f"frame {row['time']}"
        console.print(f"look at cell {row['cell']} ({place}): {row['doubts']}")
    if len(doubtful) > _MOST_LINES:
        console.print(f"… and at {len(doubtful) - _MOST_LINES} more: column 'doubts' of cells.parquet")


def _say_lost(lost: "pd.DataFrame") -> None:
    for _, row in lost.head(_MOST_LINES).iterrows():
        print(f"cell {row['cell']} (frame {row['time']}) {row['status']}: {row['reason']}", file=sys.stderr)
    if len(lost) > _MOST_LINES:
        print(f"… and {len(lost) - _MOST_LINES} more: column 'reason' of cells.parquet", file=sys.stderr)


def say_reasons(lost: Iterable[tuple[int, str, str, str]]) -> None:
    """Print why cells were lost, one line for reasons that differ in numbers and names of files alone.

    Parameters
    ----------
    lost : iterable of (int, str, str, str)
        Cell, file, status and reason.
    """
    groups: dict[tuple[str, str], list[str]] = {}
    for cell, source, status, reason in lost:
        alike = re.sub(r"\S*" + re.escape(source), "FILE", reason) if source else reason
        key = status, re.sub(r"\d+", "N", alike)
        groups.setdefault(key, []).append(f"cell {cell} of {source}: {reason}")
    ordered = sorted(groups.items(), key=lambda item: -len(item[1]))
    for (status, _), found in ordered[:_MOST_LINES]:
        more = f" (and {len(found) - 1} more like it)" if len(found) > 1 else ""
        print(f"{len(found)} {status}: {found[0]}{more}", file=sys.stderr)
    if len(ordered) > _MOST_LINES:
        rest = sum(len(found) for _, found in ordered[_MOST_LINES:])
        print(f"… and {rest} for other reasons: column 'reason' of cells.parquet", file=sys.stderr)


def say_checked(console: "Console", inputs: "MapInputs", cells: Iterable["CheckedCell"]) -> int:
    """Print a line a cell and the totals; give the number of cells that cannot be used."""
    unusable = doubtful = looked_at = on_border = 0
    lost: list[tuple[int, str, str, str]] = []
    print("cell\tfile\t" if inputs.is_folder else "cell\t", end="")
    print("frame\tlabel\tusable\tremarks")
    for checked in cells:
        found, report = checked.found, checked.report
        doubts, notes = (report.doubts, report.notes) if report is not None else ((), ())
        looked_at += 1
        unusable += bool(checked.reason)
        doubtful += bool(doubts)
        on_border += report is not None and report.touches_border
        remarks = checked.reason or "; ".join([*doubts, *notes])
        usable = "no" if checked.reason else "doubtful" if doubts else "yes"
        place = f"{found.cell}\t{found.source}" if inputs.is_folder else f"{found.cell}"
        print(f"{place}\t{found.frame}\t{found.label}\t{usable}\t{remarks}")
        if checked.reason:
            lost.append((found.cell, found.source, "not usable", checked.reason))
    what = count(looked_at, "cell" if inputs.sources[0].kind != "stack" or inputs.is_folder else "frame")
    words = f"{what}: {looked_at - unusable} usable ({doubtful} of them doubtful), {unusable} not usable"
    if inputs.is_folder:
        words = f"{count(len(inputs.sources), 'file')}, {words}, {on_border} on the image border"
        say_reasons(lost)
    console.print(words)
    return unusable

"""What `cytodisk compare-windows` prints: measures by method, what was lost, and which files say more."""

import sys
import textwrap
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from cytodisk.cli.console import count, say_losses
from cytodisk.runs.told.map_words import reason_lines

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.compare_windows.comparison import Comparison

_NAME, _VALUE = 26, 12  # characters of a column
_MOST_ROWS = 10


def _share(value: float) -> str:
    return f"{value:.1%}"


# Columns of comparison_methods.csv, how they are printed, and what they are.
_MEASURES: tuple[tuple[str, Callable[[Any], str], str], ...] = (
    ("invalid_maps", "{:.0f}".format, "maps (or rings) that are not one to one"),
    ("flipped", "{:.0f}".format, "triangles that they turned over"),
    ("area_error", "{:.3f}".format, "mean |log area ratio| of a map"),
    ("completeness", _share, "filled windows: with a part of the cell"),
    ("coverage", _share, "of the cells' area lies in windows"),
    ("folded", _share, "of the cells' area where a registration folds"),
    ("carried_outside", _share, "of windows' area that it carries out of the cell"),
    ("area_cv", "{:.3f}".format, "spread of window area within a layer"),
    ("eccentricity_cv", "{:.3f}".format, "spread of eccentricity within a layer"),
    ("outside", _share, "of ring points lie outside the cell"),
    ("overlap", _share, "of a cell lies in several windows"),
    ("area_error_cytoplasm", "{:.3f}".format, "mean |log area over mean| in the cytoplasm"),
    ("area_error_nucleus", "{:.3f}".format, "the same in the nucleus"),
    ("outer_fifth", _share, "of the cytoplasm in the outermost of 5 layers"),
    ("nearness", "{:.3f}".format, "rank correlation of layers with nearness to the nucleus"),
)


def say_comparison(console: "Console", found: "Comparison") -> None:
    """Print a line a measure, where the default is worse, and what was lost."""
    from cytodisk.runs.compare_windows.comparison_words import ring_faults, where_worse

    for line in table_lines(found):
        console.print(line)
    for words in (*where_worse(found), *ring_faults(found)):
        console.print(words)
    _say_lost(found)


def _say_lost(found: "Comparison") -> None:
    """Print what is wrong with masks once for all methods, and what a method could not do."""
    lost = found.cells[found.cells["reason"] != ""]
    at_fault = lost["status"].isin(("refused", "unreadable"))
    masks = lost[at_fault].drop_duplicates(["cell", "reason"])
    say_losses(
        reason_lines(zip(masks["cell"], masks["source"], masks["status"], masks["reason"], strict=True))
    )
    rows = lost[~at_fault].to_dict("records")
    for row in rows[:_MOST_ROWS]:
        print(f"cell {row['cell']}, {row['method']} ({row['status']}): {row['reason']}", file=sys.stderr)
    if len(rows) > _MOST_ROWS:
        more = count(len(rows) - _MOST_ROWS, "more row")
        print(f"… and {more}: column 'reason' of cells.parquet", file=sys.stderr)


def say_tables(console: "Console", found: "Comparison") -> None:
    """Print where the results are, and what is in which table."""
    through_time = ", comparison_movie.csv through time" if found.is_movie else ""
    console.print(
        f"results: {found.path} (comparison.csv by layer, comparison_methods.csv by method{through_time}; "
        "comparison_columns.csv says what their columns are)"
    )


def table_lines(found: "Comparison") -> Iterator[str]:
    """Lines of a table with a column a method, and rows named as the columns of the CSV files."""
    from cytodisk.runs.compare_windows.compare_parameters import TITLES

    width = _column(found)
    titles = [textwrap.wrap(TITLES[method], width - 1) for method in found.methods]
    for line in range(max(len(title) for title in titles)):
        heads = [title[line] if line < len(title) else "" for title in titles]
        yield _line("", heads, "", width)
    yield _line("method", found.methods, "its name in the tables", width)
    rows, each = found.by_method.to_dict("records"), "frame" if found.is_movie else "cell"
    mapped = [f"{row['mapped']}/{row['tried']}" for row in rows]
    yield _line("mapped", mapped, f"{each}s that got windows, of those tried", width)
    for name, form, words in _MEASURES:
        if name in rows[0]:
            yield _line(name, [_value(row[name], form) for row in rows], words, width)
    if found.is_movie:
        yield from _through_time(found)
    seconds = [_value(row["seconds"], "{:.2g}".format) for row in rows]
    yield _line("seconds", seconds, f"for a {each}", width)


def _through_time(found: "Comparison") -> Iterator[str]:
    """Medians over frames of the mean over layers."""
    from cytodisk.runs.channel_names import shown_name

    table, name = found.through_time, "centroid_displacement"
    if not len(table):
        return
    in_all = table[table["layer"].isna()]
    for channel in in_all["channel"].dropna().unique():
        values = in_all[in_all["channel"] == channel].set_index("method")["correlation"]
        shown = f"correlation, {shown_name(channel, _NAME - 13)}"
        cells = [_value(values.get(method), "{:.3f}".format) for method in found.methods]
        yield _line(shown, cells, "of a layer's windows with the next frame's", _column(found))
    moved = in_all.drop_duplicates("method").set_index("method")[name]
    unit = table.attrs["units"][name]
    cells = [_value(moved.get(method), "{:.3g}".format) for method in found.methods]
    yield _line(name, cells, f"{unit} that window centroids move a frame", _column(found))


def _value(value: Any, form: Callable[[Any], str]) -> str:
    return "" if value is None or value != value else form(value)


def _column(found: "Comparison") -> int:
    """Characters of a column: the names of methods fit."""
    return max(_VALUE, *(len(method) + 2 for method in found.methods))


def _line(name: str, values: Sequence[str], words: str, width: int) -> str:
    return (name.ljust(_NAME) + "".join(value.rjust(width) for value in values) + f"  {words}").rstrip()

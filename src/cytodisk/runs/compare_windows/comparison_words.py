"""What a comparison of windows says in words: where the default is worse than other methods."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.runs.channel_names import shown_name
from cytodisk.runs.compare_windows.compare_parameters import OURS, TITLES
from cytodisk.runs.compare_windows.comparison import Comparison

# Measures whose larger values are better; of all others smaller ones are.
_MORE_IS_BETTER = ("completeness", "correlation", "coverage", "nearness")
_BY_LAYER = ("completeness", "area_cv", "eccentricity_cv", "eccentricity")
_THROUGH_TIME = ("correlation", "centroid_displacement")
_BY_METHOD = ("area_error", "coverage", "area_error_cytoplasm", "area_error_nucleus", "nearness", "seconds")
_LEAST = 0.05  # relative difference that is worth a line
_MOST_RUNS = 5  # of layers that are named one by one


def where_worse(comparison: Comparison) -> list[str]:
    """A line for each measure in which another method does better than the default.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    list of str
        By method, then measure, with the names of the columns. Empty if the default was not compared, or is
        nowhere worse by more than 5 %.
    """
    if OURS not in comparison.methods or not len(comparison.by_layer):
        return []
    return [
        f"worse than {TITLES[method]}: {words}"
        for method in comparison.methods
        if method != OURS
        for words in _worse_than(comparison, method)
    ]


def _worse_than(comparison: Comparison, method: str) -> Iterator[str]:
    table = comparison.by_layer
    for name in _BY_LAYER:
        yield from _worse_by_layer(table, method, name, name, "")
    if comparison.is_movie:
        yield from _worse_through_time(comparison.through_time, method)
    rows = comparison.by_method.set_index("method")
    for name in (name for name in _BY_METHOD if name in rows):
        ours, theirs = rows[name].loc[[OURS]], rows[name].loc[[method]].set_axis([OURS])
        if _is_worse(ours, theirs, name).any():
            unit = "" if name != "seconds" else " s a frame" if comparison.is_movie else " s a cell"
            verb = "are" if name == "seconds" else "is"
            yield f"{name} {verb} {_than(name)} ({ours.iloc[0]:.3g} against {theirs.iloc[0]:.3g}{unit})"


def _worse_through_time(table: pd.DataFrame, method: str) -> Iterator[str]:
    if not len(table):
        return
    layers = table[table["layer"].notna()]
    for channel, rows in layers.groupby("channel", dropna=False, sort=False):
        shown = f"correlation of {shown_name(str(channel))}"
        yield from _worse_by_layer(rows, method, "correlation", shown, "")
    name = "centroid_displacement"  # windows are the same in all channels
    rows = layers.drop_duplicates(["method", "layer"])
    yield from _worse_by_layer(rows, method, name, name, f" {table.attrs['units'][name]} a frame")


def _worse_by_layer(table: pd.DataFrame, method: str, name: str, shown: str, unit: str) -> Iterator[str]:
    wide = table.pivot(index="layer", columns="method", values=name)
    if not {OURS, method} <= set(wide.columns):
        return
    ours, theirs = wide[OURS], wide[method]
    worse = _is_worse(ours, theirs, name)
    if worse.any():
        largest: Any = (ours - theirs).abs()[worse].idxmax()
        most = f"most in layer {largest}: " if worse.sum() > 1 else ""
        yield (
            f"{shown} is {_than(name)} in {_layer_words(wide.index[worse].tolist(), len(wide))} "
            f"({most}{ours[largest]:.3g} against {theirs[largest]:.3g}{unit})"
        )


def _than(name: str) -> str:
    return "smaller" if name in _MORE_IS_BETTER else "larger"


def _is_worse(ours: pd.Series[float], theirs: pd.Series[float], name: str) -> pd.Series[bool]:
    gap = (theirs - ours if name in _MORE_IS_BETTER else ours - theirs).astype(np.float64)
    return gap > _LEAST * theirs.astype(np.float64).abs()


def _layer_words(layers: Sequence[int], of: int) -> str:
    """Layers as 0–3, 7; their number alone if that becomes long."""
    runs: list[list[int]] = []
    for layer in layers:
        if runs and layer == runs[-1][-1] + 1:
            runs[-1].append(layer)
        else:
            runs.append([layer])
    if len(runs) > _MOST_RUNS:
        return f"{len(layers)} of {of} layers"
    spans = [f"{run[0]}–{run[-1]}" if len(run) > 1 else str(run[0]) for run in runs]
    return f"layer{'s' if len(layers) > 1 else ''} {', '.join(spans)}"


def ring_faults(comparison: Comparison) -> list[str]:
    """What is wrong with rings between nucleus and edge, a line a method.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    list of str
        Empty for comparisons without nuclei, and for methods without fault.
    """
    if not comparison.has_nuclei:
        return []
    rows = comparison.by_method.set_index("method")
    mapped = [method for method in comparison.methods if rows["mapped"][method]]
    found = {TITLES[method]: list(_ring_faults(rows.loc[method])) for method in mapped if method != OURS}
    return [f"{title}: {'; '.join(words)}" for title, words in found.items() if words]


def _ring_faults(row: Any) -> Iterator[str]:
    cells = int(row["mapped"])
    if row["invalid_maps"] > 0:
        yield f"rings cross each other in {row['invalid_maps']:.0f} of {cells} cells"
    if row["outside"] > 0:
        yield f"{row['outside']:.1%} of their points lie outside the cell"
    if row["empty_windows"] > 0:
        yield f"{row['empty_windows']:.0f} windows are empty"
    if abs(row["outer_fifth"] - 0.2) > _LEAST * 0.2:
        yield f"the outermost of five rings holds {row['outer_fifth']:.0%} of the cytoplasm"

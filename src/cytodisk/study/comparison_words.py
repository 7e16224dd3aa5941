"""What a comparison of windows says in words: where the default is worse than other methods."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from cytodisk.study.compare_parameters import OURS, TITLES
from cytodisk.study.comparison import Comparison

# Measure by layer, its name in words, and whether more of it is better.
_BY_LAYER = (
    ("completeness", "completeness is smaller", True),
    ("area_cv", "the spread of area (CV) is larger", False),
    ("eccentricity_cv", "the spread of eccentricity (CV) is larger", False),
    ("eccentricity", "windows are longer (mean eccentricity)", False),
)
_THROUGH_TIME = (
    ("correlation", "consecutive frames are less alike", True),
    ("centroid_displacement", "centroids move further", False),
)
_BY_METHOD = (
    ("area_error", "the area error is larger", False),
    ("coverage", "less of the cell lies in windows", True),
    ("seconds", "it takes longer", False),
)
_LEAST = 0.01  # relative difference that is worth a word


def where_worse(comparison: Comparison) -> list[str]:
    """Sentences on each method that does better than the default somewhere.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    list of str
        Empty if the default was not compared, or is nowhere worse by more than 1 %.
    """
    if OURS not in comparison.methods or not len(comparison.by_layer):
        return []
    words = []
    for method in comparison.methods:
        if method == OURS:
            continue
        found = [*_worse_by_layer(comparison.by_layer, method, _BY_LAYER)]
        if comparison.is_movie:
            found += _worse_through_time(comparison, method)
        found += _worse_over_all(comparison.by_method, method)
        if found:
            words.append(f"worse than {TITLES[method]}: {'; '.join(found)}")
    return words


def _worse_by_layer(
    table: pd.DataFrame, method: str, measures: Sequence[tuple[str, str, bool]]
) -> Iterator[str]:
    wide = table.pivot_table(index="layer", columns="method", dropna=False, sort=False)
    for name, words, more_is_better in measures:
        ours, theirs = (wide[name].get(which) for which in (OURS, method))
        if ours is None or theirs is None:
            continue
        worse = _is_worse(ours, theirs, more_is_better)
        if worse.any():
            largest = (ours - theirs).abs()[worse].idxmax()
            yield (
                f"{words} in {_layer_words(wide.index[worse].tolist())} "
                f"({ours[largest]:.3g} against {theirs[largest]:.3g} in layer {largest})"
            )


def _worse_through_time(comparison: Comparison, method: str) -> Iterator[str]:
    table = comparison.consistency
    for channel, rows in table.groupby("channel", dropna=False):
        middle = rows.groupby(["method", "layer"])[[name for name, _, _ in _THROUGH_TIME]].median()
        measures = _THROUGH_TIME if channel == table["channel"].iloc[0] else _THROUGH_TIME[:1]
        named = [
            (name, f"{words} ({channel})" if name == "correlation" else words, better)
            for name, words, better in measures
        ]
        yield from _worse_by_layer(middle.reset_index(), method, named)


def _worse_over_all(table: pd.DataFrame, method: str) -> Iterator[str]:
    rows = table.set_index("method")
    for name, words, more_is_better in _BY_METHOD:
        ours, theirs = rows[name].loc[[OURS]], rows[name].loc[[method]].set_axis([OURS])
        if _is_worse(ours, theirs, more_is_better).any():
            yield f"{words} ({ours.iloc[0]:.3g} against {theirs.iloc[0]:.3g})"


def _is_worse(ours: pd.Series[float], theirs: pd.Series[float], more_is_better: bool) -> pd.Series[bool]:
    gap = (theirs - ours if more_is_better else ours - theirs).astype(np.float64)
    return gap > _LEAST * theirs.astype(np.float64).abs()


def _layer_words(layers: Sequence[int]) -> str:
    """Layers as 0–3, 7."""
    runs: list[list[int]] = []
    for layer in layers:
        if runs and layer == runs[-1][-1] + 1:
            runs[-1].append(layer)
        else:
            runs.append([layer])
    spans = [f"{run[0]}–{run[-1]}" if len(run) > 1 else str(run[0]) for run in runs]
    return f"layer{'s' if len(layers) > 1 else ''} {', '.join(spans)}"

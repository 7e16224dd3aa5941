"""Where a signal is in a cell, or in many, in a sentence."""

from __future__ import annotations

from typing import Any

import pandas as pd

from cytodisk.runs.findings.finding import capital, ratio_words
from cytodisk.runs.findings.layer_levels import LayerLevels
from cytodisk.runs.findings.layer_names import channel_words, layer_name
from cytodisk.store.nuclei.summary_columns import RATIO, column_of
from cytodisk.store.study import Study

_MOST_CHANNELS = 2
_EVEN = 1.1
"""Times the cell's mean: a brightest layer that does not reach it is none."""
_FEWEST_FOR_QUARTILES = 4


def signal_sentences(study: Study, levels: LayerLevels, cell: int | None = None) -> list[str]:
    """Where the first channels are brightest, edge to centre and nucleus to cytoplasm.

    Parameters
    ----------
    study : Study
    levels : LayerLevels
    cell : int, optional
        Of a movie, the cell that is told of; of single cells the median over all.

    Returns
    -------
    list of str
        One a channel; the last says that no background was subtracted.
    """
    told = [_of_channel(study, levels, channel, cell) for channel in levels.channels[:_MOST_CHANNELS]]
    return [*told[:-1], f"{told[-1][:-1]}; background not subtracted."]


def _of_channel(study: Study, levels: LayerLevels, channel: str, cell: int | None) -> str:
    of_channel = levels.of(channel).dropna(how="all")
    name = capital(channel_words(channel))
    if of_channel.empty:
        return f"{name} has no mean above 0 in any cell."
    middle: Any = of_channel.median()
    brightest = int(middle.idxmax())
    level, layer = ratio_words(float(middle[brightest])), layer_name(study, brightest)
    many = cell is None and len(of_channel) > 1
    cells = f"{'the first ' * levels.cut}{len(of_channel)} cells"
    if middle[brightest] < _EVEN:
        where = f"{name} is even: no layer is more than {level} times the cell's mean"
        where += f" (in the median of {cells})" if many else ""
    else:
        where = f"{name} is brightest in {layer}, {level} times the cell's mean"
        most = int((of_channel.idxmax(axis=1) == brightest).sum())
        where += f" (in the median; this layer is the brightest in {most} of {cells})" if many else ""
    parts = [where, *_ratios(study, levels, channel, cell)]
    return f"{'; '.join(parts)}."


def _ratios(study: Study, levels: LayerLevels, channel: str, cell: int | None) -> list[str]:
    words = []
    if levels.inner > 0:
        inner = f"layer {levels.inner} (next to the nucleus)" if levels.has_nucleus else "centre"
        words.append(_told(f"edge to {inner}", levels.edge_to_centre(channel), cell))
    column = column_of(RATIO, channel)
    if column in study.cells:
        rows = study.cells if cell is None else study.cells[study.cells["cell"] == cell]
        words.append(_told("nucleus to cytoplasm", rows[column], cell))
    return [one for one in words if one]


def _told(name: str, values: pd.Series[float], cell: int | None) -> str:
    """The median, over cells with the quartiles."""
    known = values.dropna()
    if known.empty:
        return ""
    low, middle, high = (ratio_words(float(known.quantile(share))) for share in (0.25, 0.5, 0.75))
    spread = f" (quartiles {low}–{high})" if cell is None and len(known) >= _FEWEST_FOR_QUARTILES else ""
    return f"{name} {middle}{spread}"

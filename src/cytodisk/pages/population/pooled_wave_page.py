"""The figure of pooled waves: order, speed, period and persistence, cell by cell."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.pages.drawn_correlation import VELOCITY_NAMES
from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.population.drawn_population import in_two_lines
from cytodisk.pages.population.pooled_figure import save_pooled
from cytodisk.pages.population.pooled_heading import pooled_heading
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.population.condition_looks import are_shared
from cytodisk.plot.population.experiment_key import experiment_key
from cytodisk.plot.population.super_plot import draw_super_plot
from cytodisk.plot.style import SINGLE_COLUMN_MM, WIDE_MM
from cytodisk.plot.units import with_unit
from cytodisk.runs.channel_names import shown_name
from cytodisk.runs.population.movies.wave_summaries import WAVE_UNITS
from cytodisk.runs.population.wave_numbers.pooled_wave_numbers import ORDER
from cytodisk.store.populations.pooled_waves import PooledWaves

FIGURE = "waves"

_LABELS = {
    "wave_order": "order (0: none)",
    "wave_speed_um_s": "speed along the edge",
    "wave_period_s": "period",
    "wave_persistence_s": "persistence",
}
_LEFT, _TALL, _ABOVE, _BELOW, _LINE = 12.5, 27.0, 5.0, 9.0, 3.6  # mm
_MOST_ON_NARROW = 3  # conditions
_LONGEST = 24


def write_pooled_waves(pooled: PooledWaves, *, formats: Sequence[str] = ("png",)) -> list[Path]:
    """Draw the pooled waves into the folder `figures` of the waves.

    Parameters
    ----------
    pooled : PooledWaves
        As of `run_batch_waves`.
    formats : sequence of {"png", "pdf", "svg"}

    Returns
    -------
    list of Path

    Raises
    ------
    ParameterError
        A format is unknown.
    StudyError
        The folder cannot be written.

    See Also
    --------
    write_pooled_gains : Predictions of a batch.

    Examples
    --------
    >>> import cytodisk as cd
    >>> pooled = cd.open_pooled_waves("all")  # doctest: +SKIP
    >>> cd.pages.write_pooled_waves(pooled)  # doctest: +SKIP
    """
    return save_pooled(pooled.path, FIGURE, lambda: wave_page(pooled), formats)


def wave_page(pooled: PooledWaves) -> Sheet:
    """A SuperPlot of each number: cells small, experiments large, beside them mean and interval.

    Parameters
    ----------
    pooled : PooledWaves

    Returns
    -------
    Sheet
        85 mm wide, 119 mm with more than three conditions. Speed, period and persistence are of cells that
        have a wave; there is no panel where no cell has one.
    """
    conditions = list(pooled.conditions)
    width = SINGLE_COLUMN_MM if len(conditions) <= _MOST_ON_NARROW else WIDE_MM
    cells = pooled.cells[pooled.cells["status"] == "ok"]
    numbers = wide_numbers(pooled)
    shown = [name for name in _LABELS if name in numbers and numbers[name].notna().any()]
    table = cells.merge(numbers, on=["input", "cell"])
    table = table[table["condition"].isin(conditions)]
    heading = pooled_heading(_title(pooled), pooled.cells, conditions, width)
    key: list[Any] = experiment_key(table, conditions, paired=are_shared(table))
    means, last = key[:-2], key[-2:]
    below = heading.height_mm - 1.0 + _LINE * len(means)
    first = below + _LINE + 1.0
    rows = -(-len(shown) // 2)
    sheet = Sheet(first + rows * (_ABOVE + _TALL + _BELOW), width)
    heading.write(sheet)
    if means:
        sheet.key(LEFT_MM, heading.height_mm - 1.0, means, 1, borderaxespad=0.0, handlelength=1.4)
    sheet.key(LEFT_MM, below, last, 2, borderaxespad=0.0, handlelength=1.4)
    panel = width / 2.0 - _LEFT - 2.0
    for number, name in enumerate(shown):
        row, column = divmod(number, 2)
        top = first + row * (_ABOVE + _TALL + _BELOW) + _ABOVE
        ax = sheet.axes(column * width / 2.0 + _LEFT, top, panel, _TALL)
        label = with_unit(_LABELS[name], WAVE_UNITS[name])
        draw_super_plot(ax, table, name, conditions=conditions, label=label)
        if name == ORDER:
            ax.axhline(0.0, color="0.6", linewidth=0.4, zorder=0.5)
        words = [in_two_lines(one, panel / len(conditions)) for one in conditions]
        ax.set_xticks(range(len(conditions)), words, parse_math=False)
    return sheet


def wide_numbers(pooled: PooledWaves) -> pd.DataFrame:
    """Numbers of each cell as columns; the order is that of the chosen layer."""
    layer = int(pooled.settings.get("layer") or 0) if pooled.signal not in VELOCITY_NAMES else 0
    rows = pooled.numbers[(pooled.numbers["number"] != ORDER) | (pooled.numbers["layer"] == layer)]
    wide = rows.pivot_table(index=["input", "cell"], columns="number", values="value")
    return wide.reset_index().rename_axis(columns=None)


def _title(pooled: PooledWaves) -> str:
    return f"Waves of {VELOCITY_NAMES.get(pooled.signal) or shown_name(pooled.signal, _LONGEST)}"

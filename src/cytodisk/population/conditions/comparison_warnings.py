"""Reasons to doubt a comparison of conditions, by name."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.population.cell_directions import SIGNAL
from cytodisk.population.conditions.experiment_units import Units
from cytodisk.population.group_columns import CONDITION, EXPERIMENT, names_in
from cytodisk.population.named_warning import NamedWarning
from cytodisk.population.population import Population
from cytodisk.population.significance import LEVEL

_UNEQUAL = 5.0  # cells of the largest experiment over those of the smallest
_MANY = 0.2  # share of cells without a direction
_BY_CELL = ("cell mean", "cell total", "z-score")
_TOGETHER = ("day", "date", "plate", "slide", "microscope", "operator", "animal", "batch")


def too_few(smallest_p: float, units: Units) -> Iterator[NamedWarning]:
    """The number of experiments cannot reach the level.

    Parameters
    ----------
    smallest_p : float
    units : Units

    Yields
    ------
    NamedWarning
    """
    if smallest_p > LEVEL:
        yield NamedWarning(
            "too few experiments",
            f"{sizes_words(units)} can give p = {smallest_p:.2g} at best.",
            f"No difference, however large, can reach p ≤ {LEVEL:g}.",
            "Repeat the experiment: 4 + 4 experiments can give 0.029, 6 pairs 0.031. Until then take the "
            "difference and its interval as a description.",
        )


def design_warnings(pop: Population, units: Units, unit: str) -> Iterator[NamedWarning]:
    """What the table of cells shows.

    Parameters
    ----------
    pop : Population
    units : Units
    unit : str

    Yields
    ------
    NamedWarning
    """
    if unit == "cell":
        yield NamedWarning(
            "cells as units",
            f"{units.count} cells were tested as if they were independent.",
            "Cells of one dish are alike: with a tenth of the variance between dishes more than half of such "
            "tests find a difference where there is none.",
            "Name the experiments in the table and use --unit experiment.",
        )
        return
    yield from _one_experiment(units)
    yield from _unequal(units.table)
    yield from _confounded(pop.cells, units)
    left = units.table[(units.table["used"] == 0) | (units.table["used"] < units.table["cells"])]
    alone = left[(left["used"] == 0) & (left["experiment"] != "")]
    if units.paired and len(alone):
        names = list(dict.fromkeys(alone["experiment"].astype(str)))
        verb = f"{', '.join(names)} {'hold' if len(names) > 1 else 'holds'}"
        yield NamedWarning(
            "incomplete pairs",
            f"{verb} only one of the conditions.",
            "Their cells are not in this test.",
            "Add the other half, or use --design unpaired if equal names are different experiments.",
        )
    nameless = units.table[units.table["experiment"] == ""]
    if len(nameless):
        yield NamedWarning(
            "experiments unknown",
            f"{int(nameless['cells'].sum())} cells have no name of their experiment.",
            "They are not in this test.",
            "Name the experiment of each cell in the table of groups.",
        )


def alignment_warnings(pop: Population, channels: Sequence[str], codes: np.ndarray) -> Iterator[NamedWarning]:
    """What the alignment does to the test.

    Parameters
    ----------
    pop : Population
    channels : sequence of str
        Those that are tested.
    codes : ndarray of shape (cells,)
        Unit of each cell, -1 for none.

    Yields
    ------
    NamedWarning
    """
    if pop.aligned_by == "none":
        return
    missing = int((pop.alignment["status"] != "ok")[codes >= 0].sum())
    used = int((codes >= 0).sum())
    if missing > _MANY * used:
        yield NamedWarning(
            "direction missing",
            f"{missing} of {used} cells have no clear direction by {pop.aligned_by}.",
            "They are in the test as they came, not turned, and make the pattern of the others weaker.",
            "Align by something else, or compare layers, which need no direction.",
        )
    if pop.aligned_by.startswith(SIGNAL) and pop.aligned_by.removeprefix(SIGNAL) in channels:
        name = pop.aligned_by.removeprefix(SIGNAL)
        yield NamedWarning(
            "double dipping",
            f"Cells are aligned by {name}, the signal that is tested.",
            "Such an atlas has a front even where there is only noise, and a difference in noise between the "
            "conditions looks like one in pattern. The level of the test holds.",
            "Align by the nucleus, the front or another channel before you speak of a pattern.",
        )


def of_shares(pop: Population, windows: xr.Dataset) -> Iterator[NamedWarning]:
    """Windows that rise and windows that fall, where each cell's level was taken out.

    Parameters
    ----------
    pop : Population
    windows : Dataset with dims (channel, layer, last)

    Yields
    ------
    NamedWarning
    """
    by = [name for name in pop.normalisation if name in _BY_CELL]
    for channel in windows["channel"].values if by else ():
        own = windows.sel(channel=channel)
        different = (own["p_fwer"] <= LEVEL).values
        raised = int((different & (own["difference"] > 0).values).sum())
        lowered = int((different & (own["difference"] < 0).values).sum())
        if raised and lowered:
            yield NamedWarning(
                "shares of a cell",
                f"{channel} rises in {raised} windows and falls in {lowered}, normalised by {by[-1]}.",
                "Each cell's own level is taken out, so a rise in one place makes all others fall: one of "
                "the two may have no cause of its own.",
                "Compare with --normalise none or background, too, where cells are equally bright.",
            )


def untested(status: np.ndarray) -> Iterator[NamedWarning]:
    """Windows that have no test.

    Parameters
    ----------
    status : ndarray of str
        Of all windows, ok or why not.

    Yields
    ------
    NamedWarning
    """
    missing = int((status != "ok").sum())
    if missing:
        yield NamedWarning(
            "windows not tested",
            f"{missing} of {status.size} windows have no value in too many experiments.",
            "Nothing is said about these places.",
            "See the column status; holes, depths that few cells reach, or NaN in the images make them.",
        )


def driven(left_out: pd.DataFrame, significant: Sequence[str]) -> Iterator[NamedWarning]:
    """One experiment alone makes a result.

    Parameters
    ----------
    left_out : DataFrame
        See `ConditionComparison.left_out`.
    significant : sequence of str
        Results that are called different.

    Yields
    ------
    NamedWarning
    """
    for result in significant:
        rows = left_out[left_out["result"] == result]
        kept = rows["difference"] / rows["difference_of_all"]
        weak = rows[kept < 0.5]
        for _, row in weak.iterrows():
            yield NamedWarning(
                "one experiment drives it",
                f"Without experiment {row['experiment']} the difference of {result} goes from "
                f"{row['difference_of_all']:.3g} to {row['difference']:.3g}.",
                "The result hangs on this experiment.",
                "Look at its cells, and repeat the experiment.",
            )


def sizes_words(units: Units) -> str:
    """As "4 + 4 experiments", "6 pairs", "40 + 38 cells"."""
    first, second = units.sizes
    if units.paired:
        return f"{first} pairs" if first != 1 else "1 pair"
    what = "cells" if units.found.startswith("Cells") else "experiments"
    return f"{first} + {second} {what}"


def _one_experiment(units: Units) -> Iterator[NamedWarning]:
    used = units.table[units.table["used"] > 0]
    if units.paired:
        return
    for name, count in used.groupby("condition", sort=False)["experiment"].nunique().items():
        if count == 1:
            yield NamedWarning(
                "conditions confounded",
                f"Condition {name} has one experiment.",
                "What was done cannot be told from all else that was special about that experiment.",
                "Repeat the condition on other days or dishes.",
            )


def _unequal(table: pd.DataFrame) -> Iterator[NamedWarning]:
    used = table.loc[table["used"] > 0, "used"]
    if len(used) and used.max() >= _UNEQUAL * used.min():
        yield NamedWarning(
            "cells per experiment unequal",
            f"Experiments have {used.min()} to {used.max()} cells.",
            "Each experiment counts the same, so one with few cells brings more noise.",
            "Add cells to the small experiments; do not pool cells over experiments.",
        )


def _confounded(cells: pd.DataFrame, units: Units) -> Iterator[NamedWarning]:
    """A column such as day that holds one condition alone in each of its few values."""
    if units.paired:
        return
    rows = units.codes >= 0
    condition, experiment = (names_in(cells, name)[rows] for name in (CONDITION, EXPERIMENT))
    for column in (str(name) for name in cells if str(name).lower() in _TOGETHER):
        table = pd.DataFrame(
            {"condition": condition, "experiment": experiment, "value": names_in(cells, column)[rows]}
        ).dropna()
        if table.empty or (table.groupby("value")["condition"].nunique() > 1).any():
            continue
        counts = table.groupby("condition")[["value", "experiment"]].nunique()
        if (counts["value"] < counts["experiment"]).any() or (counts["value"] == 1).any():
            yield NamedWarning(
                "conditions confounded",
                f"Each {column} holds one condition alone.",
                f"A difference between conditions cannot be told from one between {column}s.",
                f"Do both conditions within each {column}.",
            )

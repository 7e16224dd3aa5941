"""What is exchanged between two conditions: experiments, pairs of them, or cells."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
import pandas as pd

from cytodisk.arrays import BoolArray, IntArray
from cytodisk.errors import PopulationError
from cytodisk.images.short_lists import shortened
from cytodisk.population.comparison_parameters import Design, Unit
from cytodisk.population.group_columns import CONDITION, EXPERIMENT, codes_of, names_in

_FEWEST_SHARED = 0.5  # share of the experiments that hold both conditions, below which auto asks
_MOST_NAMED = 4

NO_VALUES = "no cell has values"
"""Reason of an experiment that is not used."""


@dataclass(frozen=True, eq=False)
class Units:
    """The units of a comparison: means of cells that are exchanged as wholes.

    Attributes
    ----------
    codes : ndarray of shape (cells,) and dtype int64
        Unit of each cell; -1 for a cell that is not used. Units of the control come first.
    treated : ndarray of shape (units,) and dtype bool
    names : tuple of str
        Of the units' experiments. In a paired design the second half names the same as the first.
    design : str
        paired or unpaired.
    found : str
        How the design was found, as a sentence.
    table : DataFrame
        A row for each experiment and condition: experiment, condition, cells, used, reason.
    """

    codes: IntArray
    treated: BoolArray
    names: tuple[str, ...]
    design: str
    found: str
    table: pd.DataFrame

    @property
    def count(self) -> int:
        """Number of units."""
        return len(self.treated)

    @property
    def sizes(self) -> tuple[int, int]:
        """Units of the control and of the other condition."""
        return int((~self.treated).sum()), int(self.treated.sum())

    @property
    def paired(self) -> bool:
        """Whether units are compared in pairs."""
        return self.design == "paired"


def units_of(
    cells: pd.DataFrame, usable: BoolArray, conditions: tuple[str, str], unit: Unit, design: Design
) -> Units:
    """The units of two conditions.

    Parameters
    ----------
    cells : DataFrame
        With columns condition and experiment.
    usable : ndarray of shape (cells,) and dtype bool
        Cells that have values.
    conditions : (str, str)
        Names of the control and of the other one.
    unit : str
    design : str

    Returns
    -------
    Units

    Raises
    ------
    PopulationError
        A condition is not there or has no usable cell, experiments are unknown, or the design does not fit.
    """
    condition = checked_conditions(cells, conditions)
    side = np.select([condition == conditions[0], condition == conditions[1]], [0, 1], -1)
    for k, name in enumerate(conditions):
        if not (usable & (side == k)).any():
            raise PopulationError(f"condition {name!r} has no cell with values: choose another one")
    experiment = names_in(cells, EXPERIMENT)
    if unit == "cell":
        if design == "paired":
            raise PopulationError(
                "unit='cell' has no pairs: leave design='paired' out, or use unit='experiment'"
            )
        use = usable & (side >= 0)
        order = np.flatnonzero(use)[np.argsort(side[use], kind="stable")]
        codes = np.full(len(cells), -1, dtype=np.int64)
        codes[order] = np.arange(len(order))
        found = "Cells are exchanged one by one, as if all were independent."
        table = _table(experiment, conditions, side, usable, use, "")
        return Units(codes, side[order] == 1, _cell_names(cells, order), "unpaired", found, table)
    number, names = codes_of(experiment)
    use = usable & (side >= 0) & (number >= 0)
    if not use.any():
        raise PopulationError(
            "experiments are unknown: cells have no name of the independent repetition (day, dish, animal) "
            "in a column experiment, without which a difference between conditions cannot be told from one "
            "between dishes: add it, as with --groups, or pass unit='cell' to treat cells as independent"
        )
    taken, found, shared = _chosen_design(design, number, side, use, names)
    if taken == "paired":
        use &= np.isin(number, shared)
    present, code = np.unique(side[use] * len(names) + number[use], return_inverse=True)
    codes = np.full(len(cells), -1, dtype=np.int64)
    codes[use] = code
    table = _table(experiment, conditions, side, usable, use, "holds only one of the two conditions")
    units = tuple(names[k % len(names)] for k in present)
    return Units(codes, present >= len(names), units, taken, found, table)


def checked_conditions(cells: pd.DataFrame, wanted: Collection[str]) -> pd.Series[str]:
    """The column of conditions, which holds those that are wanted.

    Raises
    ------
    PopulationError
        There is none, a condition is not in it, or one is wanted twice.
    """
    names = names_in(cells, CONDITION)
    found = [str(name) for name in names.dropna().unique()]
    if not found:
        raise PopulationError(
            "cells have no condition: add a column condition that says what was done to each cell, as with "
            "--groups"
        )
    for name in wanted:
        if name not in found:
            raise PopulationError(
                f"condition {name!r} is not there: conditions are {', '.join(map(repr, found))}"
            )
    if len(set(wanted)) < len(wanted):
        raise PopulationError(f"a condition is compared with itself: {', '.join(wanted)}")
    return names


def _chosen_design(
    design: Design, number: IntArray, side: IntArray, use: BoolArray, names: tuple[str, ...]
) -> tuple[str, str, IntArray]:
    """The design, the sentence that says how it was found, and the experiments with both conditions."""
    first, second = (np.unique(number[use & (side == k)]) for k in (0, 1))
    shared = np.intersect1d(first, second)
    single = np.setxor1d(first, second)
    alone = shortened([names[k] for k in single], _MOST_NAMED)
    words = shortened([names[k] for k in shared], _MOST_NAMED)
    if design == "paired" and len(shared) < 2:
        raise PopulationError(
            f"design='paired' needs experiments that hold both conditions, {len(shared)} does: give both "
            "halves of an experiment one name in the column experiment, or pass design='unpaired'"
        )
    if design == "auto" and len(shared) and len(shared) < _FEWEST_SHARED * (len(shared) + len(single)):
        raise PopulationError(
            f"experiments {words} hold both conditions, but {alone} hold only "
            "one: pass design='paired' to use the former alone, or design='unpaired' if equal names are "
            "different experiments"
        )
    if design == "unpaired" or (design == "auto" and not len(shared)):
        if not len(shared):
            return "unpaired", "Each experiment holds one condition: the design is unpaired.", shared
        return (
            "unpaired",
            f"{_verb(words, shared, 'stand')} in both conditions, taken as different ones.",
            shared,
        )
    verbs = "holds only one and is" if len(single) == 1 else "hold only one and are"
    left = f"; {alone} {verbs} left out" if len(single) else ""
    found = f"{_verb(words, shared, 'hold')} both conditions{left}: the design is paired."
    return "paired", found, shared


def _table(
    experiment: pd.Series[str],
    conditions: tuple[str, str],
    side: IntArray,
    usable: BoolArray,
    use: BoolArray,
    unpaired_words: str,
) -> pd.DataFrame:
    """A row for each experiment and condition."""
    chosen = side >= 0
    cells = pd.DataFrame(
        {
            "experiment": experiment[chosen].fillna(""),
            "condition": np.array(conditions)[side[chosen]],
            "usable": usable[chosen],
            "used": use[chosen],
        }
    )
    groups = cells.groupby(["condition", "experiment"], sort=False)
    table = groups.agg(cells=("used", "size"), usable=("usable", "sum"), used=("used", "sum")).reset_index()
    reason = np.select(
        [table["used"] > 0, table["usable"] == 0, table["experiment"] == ""],
        [_without_values(table), NO_VALUES, "no experiment is named"],
        unpaired_words,
    )
    table = table.drop(columns="usable").assign(reason=reason)
    return table[["experiment", "condition", "cells", "used", "reason"]]


def _without_values(table: pd.DataFrame) -> list[str]:
    """Cells of an experiment that are not used, in words; empty for none."""
    missing = table["cells"] - table["used"]
    return [f"{number} of its cells have no values" if number else "" for number in missing]


def _cell_names(cells: pd.DataFrame, order: IntArray) -> tuple[str, ...]:
    names = cells["cell"] if "cell" in cells else cells.index.to_series()
    return tuple(names.iloc[order].astype(str))


def _verb(words: str, experiments: IntArray, verb: str) -> str:
    """As "Experiments day1, day2 hold", "Experiment day1 holds"."""
    return f"Experiment {words} {verb}s" if len(experiments) == 1 else f"Experiments {words} {verb}"

"""Which conditions of a population are shown, and which of them is the control."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from cytodisk.errors import PopulationError
from cytodisk.population.group_columns import CONDITION, EXPERIMENT, names_in
from cytodisk.population.population import Population

CONTROL_NAMES = ("control", "ctrl", "untreated", "wt", "dmso")
"""Names by which a condition is taken for the control."""

ALL_CELLS = "all cells"
"""Name of the one condition of cells whose conditions are not known."""


@dataclass(frozen=True)
class ComparedConditions:
    """The conditions that are shown.

    Attributes
    ----------
    names : tuple of str
        The control first.
    control : str
        Empty where nothing is compared.
    sentence : str
        Which one was taken as the control and why, or why nothing is compared; empty if the user named them.
    """

    names: tuple[str, ...]
    control: str
    sentence: str = ""

    @property
    def treated(self) -> tuple[str, ...]:
        """The conditions that are compared with the control."""
        return self.names[1:] if self.control else ()


def compared_conditions(
    population: Population, compare: Sequence[str], dose: str | None = None
) -> ComparedConditions:
    """The conditions to show, and the control.

    Parameters
    ----------
    population : Population
    compare : sequence of str
        As they were asked for, the control first; none for all.
    dose : str, optional
        Column of cells with their dose: conditions that were not asked for by name are in its order.

    Returns
    -------
    ComparedConditions

    Raises
    ------
    PopulationError
        A condition is not there, or there are several and none is known as the control.
    """
    there = population.conditions
    if compare:
        compare = _with_commas(there, compare)
        _refuse_missing(there, compare)
        return ComparedConditions(tuple(compare), compare[0])
    if not there:
        words = (
            "No cell has a condition, so that all cells are shown together and nothing is compared: pass "
            "--groups table.csv with a column condition."
        )
        return ComparedConditions((ALL_CELLS,), "", words)
    if len(there) == 1:
        words = (
            f"There is one condition, {there[0]!r}, so that it is shown and nothing is compared: add cells "
            "of another one, such as a control."
        )
        return ComparedConditions(there, "", words)
    control, why = _control_among(there)
    others = _by_dose([name for name in there if name != control], population.cells, dose)
    words = f"{control!r} is taken as the control, {why}: pass {_flag((control, *others))} to name it."
    return ComparedConditions((control, *others), control, words)


def _by_dose(names: Sequence[str], cells: pd.DataFrame, dose: str | None) -> tuple[str, ...]:
    """Conditions from the lowest dose to the highest; those without a dose last, equal ones as they came."""
    if dose is None or dose not in cells:
        return tuple(names)
    doses = (
        pd.to_numeric(cells[dose].astype(object), errors="coerce").groupby(names_in(cells, CONDITION)).mean()
    )
    return tuple(sorted(names, key=lambda name: float(doses.fillna(np.inf).get(name, np.inf))))


def _with_commas(there: Sequence[str], compare: Sequence[str]) -> tuple[str, ...]:
    """Names put together again that have commas themselves, as of "10 nM, fresh" beside "control"."""
    if all(name in there for name in compare):
        return tuple(compare)
    by_pieces = {tuple(piece.strip() for piece in name.split(",")): name for name in there}
    found, at = [], 0
    while at < len(compare):
        ends = range(len(compare), at, -1)
        end = next((end for end in ends if tuple(compare[at:end]) in by_pieces), at + 1)
        found.append(by_pieces.get(tuple(compare[at:end]), compare[at]))
        at = end
    return tuple(found)


def _refuse_missing(there: Sequence[str], compare: Sequence[str]) -> None:
    missing = [name for name in compare if name not in there]
    if missing:
        listed = ", ".join(map(repr, there)) or "none: pass --groups table.csv with a column condition"
        raise PopulationError(f"compare: no cell has the condition {missing[0]!r}; there is {listed}")


def _control_among(there: Sequence[str]) -> tuple[str, str]:
    """The control, and why it is taken for it."""
    known = [name for name in there if name.casefold().strip() in CONTROL_NAMES]
    if len(known) == 1:
        return known[0], "by its name"
    if len(there) == 2 and not known:
        return there[0], "as the first of two in the table"
    what = f"several are names of a control ({', '.join(known)})" if known else "none is called control"
    raise PopulationError(
        f"compare: {len(there)} conditions are there ({', '.join(there)}) and {what}: name the control "
        f"first, such as {_flag(there)}"
    )


def _flag(names: Sequence[str]) -> str:
    """The flag that names them in this order, as one types it."""
    return f"--compare {shlex.quote(','.join(names))}"


def chosen_cells(population: Population, chosen: ComparedConditions) -> pd.Series[str]:
    """Why each cell is left out; empty for those that are used.

    Parameters
    ----------
    population : Population
        Normalised.
    chosen : ComparedConditions

    Returns
    -------
    Series of str
    """
    names = names_in(population.cells, CONDITION)
    if chosen.names == (ALL_CELLS,):
        names = names.astype(object).fillna(ALL_CELLS)
    words = names.map(lambda name: "" if name in chosen.names else "its condition is not compared")
    words = words.where(names.notna(), "it has no condition")
    status = pd.Series(population.level_status, index=words.index)
    words = words.where((words != "") | (status == ""), "it cannot be normalised: " + status)
    return words.astype(object)


def with_conditions(population: Population, chosen: ComparedConditions) -> Population:
    """The population with conditions and experiments as names, and one condition where none is known."""
    cells = population.cells.copy(deep=False)
    for column in (CONDITION, EXPERIMENT):
        cells[column] = names_in(cells, column)
    if chosen.names == (ALL_CELLS,):
        cells[CONDITION] = ALL_CELLS
    return population.with_cells(cells)


def knows_experiments(population: Population) -> bool:
    """Whether any cell has an experiment."""
    return bool(population.experiments)

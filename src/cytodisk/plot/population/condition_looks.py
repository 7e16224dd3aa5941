"""Colours of conditions, and colours and marks of experiments."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.colors import to_hex

from cytodisk.errors import ParameterError

CONTROL_COLOUR = "#4D4D4D"
TREATED_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
"""Of Okabe and Ito, told apart by people with any colour blindness."""

EXPERIMENT_COLOURS = (*TREATED_COLOURS, "#000000", "#F0E442")
EXPERIMENT_MARKS = ("o", "s", "^", "D", "v", "P", "X", "p", "<", ">", "h", "*")


@dataclass(frozen=True)
class Look:
    """How an experiment is drawn."""

    colour: str
    mark: str


def condition_colours(conditions: Sequence[str]) -> dict[str, str]:
    """A colour for each condition; the first, the control, is grey.

    Parameters
    ----------
    conditions : sequence of str

    Returns
    -------
    dict of str to str
    """
    treated = _enough(TREATED_COLOURS, len(conditions) - 1)
    return dict(zip(conditions, [CONTROL_COLOUR, *treated], strict=False))


def are_shared(units: pd.DataFrame) -> bool:
    """Whether an experiment has cells of several conditions, as in a paired design."""
    pairs = units.loc[units["experiment"] != "", ["condition", "experiment"]].drop_duplicates()
    return bool(pairs["experiment"].duplicated().any())


def experiment_looks(units: pd.DataFrame, *, shared: bool) -> dict[tuple[str, str], Look]:
    """How each experiment is drawn, by (condition, experiment).

    A shared experiment has one colour and one mark in all conditions. Others have the colour of their
    condition, and marks begin anew.

    Parameters
    ----------
    units : DataFrame
        With the columns condition and experiment; rows may repeat.
    shared : bool
        Whether equal names in several conditions are one experiment.

    Returns
    -------
    dict of (str, str) to Look
    """
    pairs = units[["condition", "experiment"]].drop_duplicates()
    conditions, experiments = (list(dict.fromkeys(pairs[name])) for name in ("condition", "experiment"))
    of_condition, looks = condition_colours(conditions), {}
    colours = dict(zip(experiments, _enough(EXPERIMENT_COLOURS, len(experiments)), strict=False))
    seen: dict[str, int] = dict.fromkeys(conditions, 0)
    for condition, experiment in pairs.itertuples(index=False):
        number = experiments.index(experiment) if shared else seen[condition]
        seen[condition] += 1
        colour = colours[experiment] if shared else of_condition[condition]
        looks[condition, experiment] = Look(colour, EXPERIMENT_MARKS[number % len(EXPERIMENT_MARKS)])
    return looks


def checked_units(table: Any, name: str, columns: Iterable[str] = ()) -> pd.DataFrame:
    """A table with the columns condition and experiment, and others that are needed.

    An experiment that is not known becomes an empty text.

    Raises
    ------
    ParameterError
        It is no table, has no row, or lacks a column.
    """
    if not isinstance(table, pd.DataFrame):
        raise ParameterError(f"{name} must be a table, got {type(table).__name__}: pass a DataFrame")
    missing = [column for column in ("condition", "experiment", *columns) if column not in table]
    if missing:
        raise ParameterError(
            f"{name} has no column {missing[0]!r}: pass a table with a row for each cell or experiment"
        )
    if table.empty:
        raise ParameterError(f"{name} has no rows: pass a table of at least one cell")
    known = {column: table[column].astype(object) for column in ("condition", "experiment")}
    return table.assign(
        **{name: column.where(column.notna(), "").astype(str) for name, column in known.items()}
    )


def _enough(colours: Sequence[str], count: int) -> list[str]:
    """As many colours as wanted: the given ones, or steps of viridis where they are too few."""
    if count <= len(colours):
        return list(colours[: max(count, 0)])
    return [to_hex(colour) for colour in mpl.colormaps["viridis"](np.linspace(0.0, 0.92, count))]

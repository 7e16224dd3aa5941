"""Lags in pictures of correlations: units, words, and the rows of a cell."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pandas as pd

from cytodisk.errors import ParameterError
from cytodisk.scale import suited_lag


@dataclass(frozen=True)
class LagUnit:
    """How lags are shown: the column of a table that holds them, and words for its unit.

    Attributes
    ----------
    column : str
        "lag_s", or "lag" where seconds are not known.
    unit : str
        "s", "min", "h" or "frames".
    factor : float
        How many of the unit are one of the column.
    """

    column: str
    unit: str
    factor: float = 1.0

    @classmethod
    def of(cls, table: pd.DataFrame) -> LagUnit:
        """Seconds, minutes or hours where the table has seconds, else frames."""
        if "lag_s" not in table:
            return cls("lag", "frames")
        moved = table[(table["lag"] != 0) & table["lag_s"].notna()]
        if moved.empty:
            known = bool(table["lag_s"].notna().any())
            return cls("lag_s", "s") if known else cls("lag", "frames")
        first = moved.iloc[0]
        unit = suited_lag(abs(float(first["lag_s"]) / float(first["lag"])))
        return cls("lag_s", unit.name, unit.factor)

    def shown(self, table: pd.DataFrame) -> pd.DataFrame:
        """The table with its column of lags in this unit."""
        if self.factor == 1.0 or self.column not in table:
            return table
        return table.assign(**{self.column: table[self.column] * self.factor})

    @property
    def label(self) -> str:
        """For an axis."""
        return f"lag ({self.unit})"

    def write(self, lag: float) -> str:
        """A lag with its unit, as in "−20 s" or "1 frame"."""
        unit = "frame" if self.unit == "frames" and abs(lag) == 1 else self.unit
        return f"{signed(lag, 'g')} {unit}"


def rows_of_cell(table: Any, cell: int, columns: set[str], name: str) -> pd.DataFrame:
    """Rows of one cell in a table of a correlation.

    Parameters
    ----------
    table : DataFrame
    cell : int
    columns : set of str
        That it must have.
    name : str
        Name of the argument, for the error.

    Returns
    -------
    DataFrame

    Raises
    ------
    ParameterError
        It is no table, lacks a column, or has no row of the cell.
    """
    if not isinstance(table, pd.DataFrame):
        raise ParameterError(f"{name} must be a table of a study's correlation, got {type(table).__name__}")
    missing = sorted(columns - set(table.columns))
    if missing:
        raise ParameterError(f"{name} lacks the columns {', '.join(missing)}: pass a table of a correlation")
    rows = table[table["cell"] == cell]
    if rows.empty:
        raise ParameterError(f"{name} has no cell {cell}: it has {sorted(set(table['cell']))}")
    return rows


_PARTS = ("edge", "cell", "membrane", "nucleus", "cytoplasm")


def sides(signal: str, with_: str, *, upright: bool = False) -> str:
    """What the sides of a lag axis mean: `with_` comes first at negative lags, `signal` at positive ones.

    A channel that is called as a part of the cell is named as a channel: "edge first" would mean the edge.
    """
    signal, with_ = (f"channel {name}" if name.lower() in _PARTS else name for name in (signal, with_))
    if upright:
        return f"↓ {with_} first  ·  ↑ {signal} first"
    return f"← {with_} first  ·  {signal} first →"


def signed(number: float, form: str) -> str:
    """A number in a format, with a true minus."""
    return format(number, form).replace("-", "−")

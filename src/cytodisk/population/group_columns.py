"""The columns that say what was done to a cell, and in which repetition."""

from __future__ import annotations

import numpy as np
import pandas as pd

CONDITION, EXPERIMENT = "condition", "experiment"


def names_in(table: pd.DataFrame, column: str) -> pd.Series[str]:
    """A column as names: numbers as they are written, NaN where it is empty or is not there.

    Parameters
    ----------
    table : DataFrame
    column : str

    Returns
    -------
    Series of object
    """
    if column not in table:
        return pd.Series(np.nan, index=table.index, dtype=object)
    given = table[column]
    if pd.api.types.is_float_dtype(given) and (given.dropna() % 1 == 0).all():
        given = given.astype("Int64")  # a whole number beside an empty field came as 1.0
    texts = given.astype(object).where(given.notna(), np.nan)
    texts = texts.map(lambda value: str(value).strip(), na_action="ignore")
    return texts.where(texts != "", np.nan).astype(object)  # also where none is given


def codes_of(names: pd.Series[str]) -> tuple[np.ndarray, tuple[str, ...]]:
    """Number of each name in order of appearance, -1 for none, and the names.

    Parameters
    ----------
    names : Series of object

    Returns
    -------
    codes : ndarray of int64
    names : tuple of str
    """
    codes, found = pd.factorize(names)
    return codes.astype(np.int64), tuple(str(name) for name in found)

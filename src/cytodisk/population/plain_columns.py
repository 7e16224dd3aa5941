"""Columns of a table in the types that every version of AnnData writes to a file, whatever pandas has.

pandas 3 keeps text as `str`, in Arrow's memory, which AnnData 0.12 cannot write: here text is objects.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pandas as pd

_TAKEN = "_index"  # a name that AnnData keeps for itself


def plain_column(values: pd.Series[Any]) -> Any:
    """Numbers as they are, what repeats as categories, all else as text."""
    kind = values.dtype
    if isinstance(kind, pd.CategoricalDtype):
        return categories(values, kind.categories)
    if pd.api.types.is_bool_dtype(kind) and not values.isna().any():
        return values.to_numpy(dtype=bool)
    if pd.api.types.is_numeric_dtype(kind) and not pd.api.types.is_complex_dtype(kind):
        return (
            values.to_numpy(dtype=np.float64, na_value=np.nan) if values.isna().any() else values.to_numpy()
        )
    texts = values.astype(object).map(str, na_action="ignore").astype(object).reset_index(drop=True)
    found = texts.dropna().unique()
    return categories(texts, found) if len(found) < len(texts) else texts.astype(object)


def categories(values: Iterable[Any], known: Iterable[Any]) -> pd.Categorical:
    """Values as text out of known ones, in their order; what is missing stays so."""
    texts = [str(value) if value is not None and value == value else None for value in values]
    order = pd.Index(list(dict.fromkeys(str(value) for value in known)), dtype=object)
    return pd.Categorical(texts, categories=order)


def with_plain_names(table: pd.DataFrame, index: Iterable[str]) -> pd.DataFrame:
    """A table whose names of rows and columns are unique text, as objects: AnnData 0.12 writes no others."""
    table.index = pd.Index(_unique(index), dtype=object)
    table.columns = pd.Index(_unique(file_key(str(name)) for name in table.columns), dtype=object)
    return table


def file_key(name: str) -> str:
    """A name of a column that a file may have: HDF5 takes a slash for a folder."""
    return "index" if name == _TAKEN else name.replace("/", "_")


def _unique(names: Iterable[str]) -> list[str]:
    """Names, with a number behind those that were there before."""
    taken: set[str] = set()
    found = []
    for name in names:
        number, new = 1, name
        while new in taken:
            new, number = f"{name}-{number}", number + 1
        taken.add(new)
        found.append(new)
    return found

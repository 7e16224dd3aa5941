"""Tables as a page's list takes them, to be sorted and filtered."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

MOST_ROWS = 20_000
"""Of a table on a page; the file that it comes from has all."""
_DIGITS = 6


def listed(
    table: pd.DataFrame,
    *,
    main: Iterable[str],
    labels: Mapping[str, str] | None = None,
    meanings: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    """A table for `page.list`.

    Parameters
    ----------
    table : DataFrame
        Units in `attrs["units"]`. Columns without any value are left out.
    main : iterable of str
        Columns that are shown first, in this order; the others on demand.
    labels, meanings : dict of str to str, optional
        Headings where they are not the columns' names, and what stands in a column, as a sentence.

    Returns
    -------
    dict
        "columns", and "rows" with the first `MOST_ROWS`.
    """
    units, first = table.attrs.get("units", {}), list(dict.fromkeys(main))
    told = [str(name) for name in table if table[name].notna().any() and not (table[name] == "").all()]
    shown = [name for name in first if name in told]
    names = [*shown, *(name for name in told if name not in shown)]
    columns = [
        {
            "name": name,
            "label": (labels or {}).get(name, name.replace("_", " ")),
            "unit": units.get(name, "") if units.get(name, "") not in ("1", "frame") else "",
            "title": (meanings or {}).get(name, ""),
            "number": _is_number(table[name]),
            "whole": _is_whole(table[name]),
            "main": name in shown,
        }
        for name in names
    ]
    values = [_values(table[name].iloc[:MOST_ROWS]) for name in names]
    return {"columns": columns, "rows": [list(row) for row in zip(*values, strict=True)] if values else []}


def rows_words(table: pd.DataFrame, file: str) -> str:
    """What a page says where it shows less of a table than there is; empty if it shows all."""
    if len(table) <= MOST_ROWS:
        return ""
    return f"The list holds the first {MOST_ROWS} of {len(table)} rows: all are in {file}."


def _is_number(column: Any) -> bool:
    return bool(pd.api.types.is_numeric_dtype(column) and not pd.api.types.is_bool_dtype(column))


def _is_whole(column: Any) -> bool:
    """Whether all numbers of a column are whole, as counts are."""
    if not _is_number(column):
        return False
    values = column.to_numpy(dtype=np.float64, na_value=np.nan)
    return bool((values[np.isfinite(values)] % 1 == 0).all())


def _values(column: Any) -> list[Any]:
    """Numbers to six digits, text and truth as they are; None for nothing."""
    if not _is_number(column):
        return [None if pd.isna(value) else _plain(value) for value in column.tolist()]
    values = column.to_numpy(dtype=np.float64, na_value=np.nan)
    if _is_whole(column):
        return [int(value) if np.isfinite(value) else None for value in values]
    return [float(f"{value:.{_DIGITS}g}") if np.isfinite(value) else None for value in values]


def _plain(value: Any) -> Any:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return value if isinstance(value, str) else str(value)

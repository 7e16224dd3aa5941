"""Cells of the studies that a population is made of, but that are not in it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

EXCLUDED = "excluded"
"""Where attrs of the table of cells have them."""

PLACE_AND_REASON = ("input", "source", "frame", "label", "reason")


def excluded_text(rows: Sequence[Mapping[str, Any]]) -> str:
    """As it stands in attrs: a text, which is cheap to copy along, and can be written to files.

    Parameters
    ----------
    rows : sequence of mapping
        By `PLACE_AND_REASON`.
    """
    return json.dumps(list(rows), ensure_ascii=False)


def excluded_cells(attrs: Mapping[Any, Any]) -> pd.DataFrame:
    """The table of these cells.

    Parameters
    ----------
    attrs : mapping
        Of a population's table of cells.

    Returns
    -------
    DataFrame
        Columns as in `Population.excluded`.
    """
    table = pd.DataFrame(json.loads(attrs.get(EXCLUDED, "[]")), columns=list(PLACE_AND_REASON))
    return table.astype({"frame": "Int64", "label": "Int64"})

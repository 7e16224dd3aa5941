"""Times on the page: measured by the run, or kept from the page that stands."""

from pathlib import Path
from typing import Any

import pandas as pd

COLUMNS: dict[str, tuple[tuple[str, ...], str]] = {
    "reference_masks.csv": (("mask", "map"), "seconds"),
    "by_method.csv": (("windows",), "seconds a cell"),
}
"""Tables with times: the columns that name a row, and the times."""

NOT_TIMED = "not timed"
MEASURED = "Times are those of the run that measured all else."
KEPT = (
    "Times are those of an earlier run with nothing beside it. Other work shared the machine when the rest "
    f"was measured, so what came new is *{NOT_TIMED}*."
)


def of_page(files: Path) -> dict[str, "pd.Series[str]"]:
    """The times on the page that stands, by table."""
    return {
        name: _read(files / name).set_index(list(keys))[column] for name, (keys, column) in COLUMNS.items()
    }


def put(files: Path, kept: dict[str, "pd.Series[str]"]) -> dict[str, Any]:
    """Put times of an earlier page into the tables; what the page's sentences quote of them."""
    for name, (keys, column) in COLUMNS.items():
        table = _read(files / name).set_index(list(keys))
        table[column] = kept[name].reindex(table.index).fillna(NOT_TIMED)
        table.reset_index()[list(_read(files / name))].to_csv(files / name, index=False)
    return {"times": KEPT}


def _read(path: Path) -> pd.DataFrame:
    return pd.read_csv(path, dtype=str, keep_default_na=False)

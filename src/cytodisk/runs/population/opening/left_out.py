"""Cells and files that are not in a population, each with the reason."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import pandas as pd

LEFT_OUT = "left_out"
COLUMNS = ("input", "source", "frame", "label", "reason")


@dataclass
class LeftOut:
    """A list that grows while studies are read.

    Attributes
    ----------
    rows : list of dict
        By `COLUMNS`; without frame and label for a file as a whole.
    """

    rows: list[dict[str, Any]] = field(default_factory=list)

    def add(
        self, study: str, reason: str, *, source: str = "", frame: int | None = None, label: int | None = None
    ) -> None:
        """Note a cell, or a file without a cell."""
        values = (study, source, frame, label, reason)
        self.rows.append(dict(zip(COLUMNS, values, strict=True)))

    def add_cells(self, cells: pd.DataFrame, reasons: pd.Series[str] | str) -> None:
        """Note rows of a table of cells.

        Parameters
        ----------
        cells : DataFrame
            With input, source, frame and label.
        reasons : Series or str
            By row, or for all.
        """
        words = [reasons] * len(cells) if isinstance(reasons, str) else list(reasons)
        places = zip(*(cells[name].tolist() for name in COLUMNS[:-1]), strict=True)
        for (study, source, frame, label), reason in zip(places, words, strict=True):
            self.add(study, reason, source=source, frame=int(frame), label=int(label))

    @property
    def text(self) -> str:
        """As it goes with a table: text is cheap to copy along, and can be written."""
        return json.dumps(self.rows, ensure_ascii=False)


def left_out_of(attrs: Mapping[Any, Any]) -> pd.DataFrame:
    """Cells and files that a population's studies have, but the population has not.

    Parameters
    ----------
    attrs : mapping
        `pop.cells.attrs`.

    Returns
    -------
    DataFrame
        Columns input (of the batch, or name of the study's folder), source (file of masks), frame, label and
        reason; frame and label are empty for a file as a whole.
    """
    rows = json.loads(attrs.get(LEFT_OUT, "[]"))
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    return table.astype({"frame": "Int64", "label": "Int64"})

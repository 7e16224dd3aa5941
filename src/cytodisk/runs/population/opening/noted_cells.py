"""Cells and files that are not in a population, each with the reason."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import pandas as pd

from cytodisk.population.excluded_cells import PLACE_AND_REASON


@dataclass
class LeftOut:
    """A list that grows while studies are read.

    Attributes
    ----------
    rows : list of dict
        By `PLACE_AND_REASON`; without frame and label for a file as a whole.
    """

    rows: list[dict[str, Any]] = field(default_factory=list)

    def add(
        self, study: str, reason: str, *, source: str = "", frame: int | None = None, label: int | None = None
    ) -> None:
        """Note a cell, or a file without a cell."""
        values = (study, source, frame, label, reason)
        self.rows.append(dict(zip(PLACE_AND_REASON, values, strict=True)))

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
        places = zip(*(cells[name].tolist() for name in PLACE_AND_REASON[:-1]), strict=True)
        for (study, source, frame, label), reason in zip(places, words, strict=True):
            self.add(study, reason, source=source, frame=int(frame), label=int(label))

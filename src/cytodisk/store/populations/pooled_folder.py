"""What pooled results of a batch have in common, whatever was pooled."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

import pandas as pd

from cytodisk.errors import ReadError
from cytodisk.store.derived.derived_folder import DerivedFolder
from cytodisk.store.provenance_file import read_complete

_POOLED = "pooled"


class PooledFolder(DerivedFolder):
    """Results of a batch's movies, pooled over cells and experiments; tables are read when asked for."""

    @property
    def conditions(self) -> tuple[str, ...]:
        """Conditions that have pooled values, the control first."""
        return tuple(self.pooled["condition"].drop_duplicates())

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was found, and what this number of experiments can reach at best."""
        return tuple(self.settings.get("sentences", ()))

    @property
    def warnings(self) -> tuple[dict[str, str], ...]:
        """Reasons to doubt a test: name, finding, consequence, remedy, and the condition that it is about."""
        return tuple(self.settings.get("warnings", ()))

    @cached_property
    def studies(self) -> pd.DataFrame:
        """One row an input of the batch: status, and the reason if it has no result."""
        return self._table("studies")

    @cached_property
    def cells(self) -> pd.DataFrame:
        """One row a cell: condition, experiment, status, and the reason if it is left out."""
        return self._table("cells")

    @cached_property
    def pooled(self) -> pd.DataFrame:
        """One row a condition and what is pooled in it: mean, interval and test over experiments."""
        return self._table(_POOLED)


def check_batch(folder: Path) -> None:
    """Raise ReadError if a folder is not that of a batch."""
    read_complete(folder, "batch")


def check_pooled(found: DerivedFolder, folder: Path, what: str) -> None:
    """Raise ReadError if what a batch folder holds is not pooled.

    Parameters
    ----------
    found : DerivedFolder
    folder : Path
        Of the batch.
    what : str
        As "prediction".
    """
    if not (found.path / f"{_POOLED}.parquet").exists():
        raise ReadError(f"{found.path} holds no pooled {what}: run {found.command} {folder} again")

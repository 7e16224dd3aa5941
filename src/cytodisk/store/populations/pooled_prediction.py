"""Pooled predictions of a batch, read back."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import pandas as pd

from cytodisk.errors import ReadError
from cytodisk.store.derived.derived_folder import DerivedFolder
from cytodisk.store.predictions.prediction_store import read_prediction, titled_prediction
from cytodisk.store.provenance_file import read_complete


@dataclass(frozen=True)
class PooledPrediction(DerivedFolder):
    """Predictions of a batch's movies, pooled over cells and experiments; tables are read when asked for.

    Attributes
    ----------
    path : Path
        Its folder, in that of the batch.
    source, target : str
        What was tested, in both directions; both empty for a network of all signals.
    name : str
        Name of a variant; empty for none.
    settings : dict
        What was asked for, and the version of cytodisk.

    See Also
    --------
    open_pooled_prediction : Opens one.
    """

    path: Path
    source: str
    target: str
    name: str
    settings: dict[str, Any]
    command: ClassVar[str] = "cytodisk predict"

    def __repr__(self) -> str:
        what = titled_prediction(self.source, self.target, self.name)
        return f"<PooledPrediction {self.path}: {what}, {len(self.cells)} cells>"

    @property
    def conditions(self) -> tuple[str, ...]:
        """Conditions that have a pooled gain, the control first."""
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
        """One row an input of the batch: status, and the reason if nothing could be tested."""
        return self._table("studies")

    @cached_property
    def cells(self) -> pd.DataFrame:
        """One row a cell: condition, experiment, status, and the reason if it is left out."""
        return self._table("cells")

    @cached_property
    def links(self) -> pd.DataFrame:
        """One row a cell, source, target and layer."""
        return self._table("links")

    @cached_property
    def experiments(self) -> pd.DataFrame:
        """One row a condition, experiment, kind, source, target and layer: mean over its cells."""
        return self._table("experiments")

    @cached_property
    def pooled(self) -> pd.DataFrame:
        """One row a condition, kind, source, target and layer: mean, interval and test over experiments."""
        return self._table("pooled")

    @cached_property
    def comparisons(self) -> pd.DataFrame | None:
        """One row a pair of conditions, kind, source, target and layer; None with one condition."""
        return self._optional("comparisons")


def open_pooled_prediction(
    path: str | os.PathLike[str], source: str = "", target: str = "", name: str = ""
) -> PooledPrediction:
    """Read what `cytodisk predict` wrote into the folder of a batch.

    Parameters
    ----------
    path : path-like
        Folder of the batch.
    source, target, name : str
        As they were given to `cytodisk predict`; the network of all signals without them.

    Returns
    -------
    PooledPrediction

    Raises
    ------
    ReadError
        The folder holds no batch, or no such prediction: the message lists those that are there.

    See Also
    --------
    run_batch_predict : Writes one.

    Examples
    --------
    >>> import cytodisk as cd
    >>> found = cd.open_pooled_prediction("all", "Rac1", "velocity")  # doctest: +SKIP
    >>> found.pooled.query("p_fwer <= 0.05 and score > 0")  # doctest: +SKIP
    """
    folder = Path(path)
    read_complete(folder, "batch")
    found = read_prediction(folder, source, target, name)
    if not (found.path / "pooled.parquet").exists():
        raise ReadError(f"{found.path} holds no pooled prediction: run cytodisk predict {folder} again")
    return PooledPrediction(found.path, found.source, found.target, found.name, found.settings)

"""Pooled predictions of a batch, read back."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import pandas as pd

from cytodisk.store.populations.pooled_folder import PooledFolder, check_batch, check_pooled
from cytodisk.store.predictions.prediction_store import read_prediction, titled_prediction


@dataclass(frozen=True)
class PooledPrediction(PooledFolder):
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
    needed: ClassVar[Mapping[str, tuple[str, ...]]] = {"pooled": ("weaker",)}

    def __repr__(self) -> str:
        what = titled_prediction(self.source, self.target, self.name)
        return f"<PooledPrediction {self.path}: {what}, {len(self.cells)} cells>"

    @cached_property
    def links(self) -> pd.DataFrame:
        """One row a cell, source, target and layer."""
        return self._table("links")

    @cached_property
    def experiments(self) -> pd.DataFrame:
        """One row a condition, experiment, kind, source, target and layer: mean over its cells."""
        return self._table("experiments")

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
    check_batch(folder)
    found = read_prediction(folder, source, target, name)
    check_pooled(found, folder, "prediction")
    return PooledPrediction(found.path, found.source, found.target, found.name, found.settings)

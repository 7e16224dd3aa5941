"""Pooled waves of a batch, read back."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import pandas as pd

from cytodisk.store.populations.pooled_folder import PooledFolder, check_batch, check_pooled
from cytodisk.store.waves.waves_store import read_waves, waves_title


@dataclass(frozen=True)
class PooledWaves(PooledFolder):
    """Waves of a batch's movies, pooled over cells and experiments; tables are read when asked for.

    Attributes
    ----------
    path : Path
        Its folder, in that of the batch.
    signal : str
        "velocity", "velocity_cell_frame" or a channel.
    name : str
        Name of a variant; empty for none.
    settings : dict
        What was asked for, and the version of cytodisk.

    See Also
    --------
    open_pooled_waves : Opens one.
    """

    path: Path
    signal: str
    name: str
    settings: dict[str, Any]
    command: ClassVar[str] = "cytodisk waves"
    may_be_empty: ClassVar[tuple[str, ...]] = ("layer",)

    def __repr__(self) -> str:
        return f"<PooledWaves {self.path}: {waves_title(self.signal, self.name)}, {len(self.cells)} cells>"

    @cached_property
    def numbers(self) -> pd.DataFrame:
        """One row a cell, number and layer."""
        return self._table("numbers")

    @cached_property
    def experiments(self) -> pd.DataFrame:
        """One row a condition, experiment, number and layer: mean over its cells."""
        return self._table("experiments")

    @cached_property
    def comparisons(self) -> pd.DataFrame | None:
        """One row a pair of conditions, number and layer; None with one condition."""
        return self._optional("comparisons")


def open_pooled_waves(path: str | os.PathLike[str], signal: str = "velocity", name: str = "") -> PooledWaves:
    """Read what `cytodisk waves` wrote into the folder of a batch.

    Parameters
    ----------
    path : path-like
        Folder of the batch.
    signal, name : str
        As they were given to `cytodisk waves`.

    Returns
    -------
    PooledWaves

    Raises
    ------
    ReadError
        The folder holds no batch, or no such waves: the message lists those that are there.

    See Also
    --------
    run_batch_waves : Writes them.

    Examples
    --------
    >>> import cytodisk as cd
    >>> found = cd.open_pooled_waves("all")  # doctest: +SKIP
    >>> found.pooled.query("number == 'wave_period_s'")  # doctest: +SKIP
    """
    folder = Path(path)
    check_batch(folder)
    found = read_waves(folder, signal, name)
    check_pooled(found, folder, "waves")
    return PooledWaves(found.path, found.signal, found.name, found.settings)

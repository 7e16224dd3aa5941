"""Pooled correlations of a batch, read back."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import pandas as pd

from cytodisk.store.correlation_store import CorrelationFolder, read_correlation
from cytodisk.store.populations.pooled_folder import PooledFolder, check_batch, check_pooled


@dataclass(frozen=True)
class PooledCorrelation(PooledFolder, CorrelationFolder):
    """Correlations of a batch's movies, pooled over cells and experiments; tables are read when asked for.

    Attributes
    ----------
    path : Path
        Its folder, in that of the batch.
    signal, with_ : str
        What was correlated. Positive lag: `with_` comes after `signal`.
    name : str
        Name of a variant; empty for none.
    settings : dict
        What was asked for, and the version of cytodisk.

    See Also
    --------
    open_pooled_correlation : Opens one.
    """

    def __repr__(self) -> str:
        return f"<PooledCorrelation {self.path}: {len(self.cells)} cells, {', '.join(self.conditions)}>"

    @cached_property
    def curves(self) -> pd.DataFrame:
        """One row a cell, layer and lag."""
        return self._table("curves")

    @cached_property
    def experiments(self) -> pd.DataFrame:
        """One row a condition, experiment, kind of curve, layer and lag: mean over the experiment's cells."""
        return self._table("experiments")

    @cached_property
    def peaks(self) -> pd.DataFrame:
        """One row a condition, kind of curve and layer: the lag of the peak, and its test."""
        return self._table("peaks")

    @cached_property
    def comparisons(self) -> pd.DataFrame | None:
        """One row a pair of conditions, kind of curve, layer and lag; None with one condition."""
        return self._optional("comparisons")


def open_pooled_correlation(
    path: str | os.PathLike[str], signal: str, with_: str = "velocity", name: str = ""
) -> PooledCorrelation:
    """Read what `cytodisk correlate` wrote into the folder of a batch.

    Parameters
    ----------
    path : path-like
        Folder of the batch.
    signal, with_, name : str
        As they were given to `cytodisk correlate`.

    Returns
    -------
    PooledCorrelation

    Raises
    ------
    ReadError
        The folder holds no batch, or no such correlation: the message lists those that are there.

    See Also
    --------
    run_batch_correlate : Writes one.

    Examples
    --------
    >>> import tifffile
    >>> from pathlib import Path
    >>> import cytodisk as cd
    >>> lines = ["[study]", "kind = 'movie'", "[parameters]", "layers = 2", "channels = ['Rac1', 'RhoA']"]
    >>> for day in range(1):
    ...     movie = cd.simulate.movie("fluctuating", frames=24, radius_px=14, seed=day)
    ...     tifffile.imwrite(f"masks{day}.tif", movie.masks.astype("uint8"), photometric="minisblack")
    ...     tifffile.imwrite(f"signal{day}.ome.tif", movie.signal.to_numpy(), metadata={"axes": "TCYX"})
    ...     lines += ["[[inputs]]", f"masks = 'masks{day}.tif'", f"signal = 'signal{day}.ome.tif'"]
    ...     lines += ["condition = 'control'", f"experiment = 'day {day}'"]
    >>> _ = Path("batch.toml").write_text("\\n".join(lines))
    >>> _ = cd.run_batch("batch.toml", "all")
    >>> found = cd.run_batch_correlate("all", "Rac1", max_lag=3, surrogates=0)
    >>> cd.open_pooled_correlation("all", "Rac1").peaks["layer"].tolist()
    [0, 1, 0, 1]
    """
    folder = Path(path)
    check_batch(folder)
    found = read_correlation(folder, signal, with_, name)
    check_pooled(found, folder, "correlation")
    return PooledCorrelation(found.path, found.signal, found.with_, found.name, found.settings)

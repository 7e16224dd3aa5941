"""`cytodisk batch` as a function."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from cytodisk.runs.batch.batch_file import read_batch
from cytodisk.runs.batch.batch_study import BatchSummary, Tell, batch_study
from cytodisk.runs.run_options import BatchOptions, Progress
from cytodisk.taking import takes


@takes(BatchOptions)
def run_batch(
    batch_file: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    groups: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    tell: Tell = print,
    **settings: Any,
) -> BatchSummary:
    """Run many movies and images, each in a process of its own, and merge their tables: `cytodisk batch`.

    Parameters
    ----------
    batch_file : path-like
        TOML file that names the inputs and their parameters.
    out : path-like
        Folder for the results, or a URL.
    groups : path-like, optional
        CSV table that says what was done to which cell, in the place of the one that the batch file names;
        see `run_map`.
    progress : callable, optional
        Called with (inputs done, inputs in all).
    tell : callable
        Called with sentences on workers of a cluster.
    **settings
        See `BatchOptions`.

    Returns
    -------
    BatchSummary
        How many inputs went well, and why others did not.

    Raises
    ------
    ParameterError
        The file cannot be read, or anything in it cannot be used; all faults are said at once.
    StudyError
        The folder cannot be used, or results cannot be written.

    See Also
    --------
    run_map, run_movie : One input.

    Examples
    --------
    >>> import tifffile
    >>> from pathlib import Path
    >>> from cytodisk import run_batch, simulate
    >>> tifffile.imwrite("mask.tif", simulate.disk(9).astype("uint8"))
    >>> lines = ["[study]", "kind = 'map'", "[parameters]", "layers = 2", "[[inputs]]", "masks = 'mask.tif'"]
    >>> _ = Path("batch.toml").write_text("\\n".join(lines))
    >>> run_batch("batch.toml", "all").statuses
    Counter({'ok': 1})
    """
    batch = read_batch(Path(batch_file), None if groups is None else Path(groups))
    return batch_study(batch, out, progress=progress, tell=tell, **settings)

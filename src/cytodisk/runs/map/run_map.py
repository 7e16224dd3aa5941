"""`cytodisk map` as a function."""

from __future__ import annotations

import os
from typing import Any

from cytodisk.runs.cells.cell_groups import with_groups
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.map.map_study import map_study
from cytodisk.runs.run_options import MapOptions, Progress
from cytodisk.store.study import Study
from cytodisk.taking import takes


@takes(MapParameters, MapOptions)
def run_map(
    masks: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    signal: str | os.PathLike[str] | None = None,
    nuclei: str | os.PathLike[str] | None = None,
    groups: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    parameters: MapParameters | None = None,
    **settings: Any,
) -> Study:
    """Map cells onto the disk, sample a signal in their windows, and write a study: `cytodisk map`.

    Parameters
    ----------
    masks : path-like
        One mask, a stack of masks or a label image, or a folder of those.
    out : path-like
        Folder for the results.
    signal : path-like, optional
        Image of the shape of the masks; for a folder of masks a folder, or an ending of names as "_img".
    nuclei : path-like, optional
        Label image, or 0/1 mask, of the nuclei, with the shape and the frames of the masks; each goes to the
        cell that holds most of it. For a folder of masks a folder, or an ending of names as "_nuclei".
    groups : path-like, optional
        CSV table that says what was done to which cell: columns `file`, `cell` (its label) or `frame`, and
        `condition`, `experiment` or your own, which become columns of the table of cells.
    progress : callable, optional
        Called with (cells done, cells in all).
    parameters : MapParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `MapParameters` and `MapOptions`.

    Returns
    -------
    Study
        A cell that could not be mapped has a row with the reason.

    Raises
    ------
    ReadError, MaskError, SignalError, NucleusError, ParameterError
        A file is missing, damaged, or does not fit, or a parameter is unknown or out of its range.
    StudyError
        The folder cannot be used.

    See Also
    --------
    map_to_disk : Maps one mask in memory.
    match_nuclei : The nuclei of cells, in memory.

    Examples
    --------
    >>> import tifffile
    >>> from cytodisk import run_map, simulate
    >>> tifffile.imwrite("mask.tif", simulate.disk(9).astype("uint8"))
    >>> study = run_map("mask.tif", "mapped", layers=2, sectors=4)
    >>> study.cells["status"].tolist(), len(study.windows)
    (['ok'], 8)
    """
    options, values = MapOptions.split(settings, MapParameters)
    inputs = open_inputs(masks, signal, MapParameters.chosen(parameters, values), nuclei=nuclei)
    return map_study(with_groups(inputs, groups), out, progress=progress, **dict(options))

"""`cytodisk shapes` as a function."""

from __future__ import annotations

import os
from typing import Any

import pandas as pd

from cytodisk.runs.run_options import Progress, RunOptions
from cytodisk.runs.shapes.shape_parameters import ShapeParameters
from cytodisk.runs.shapes.shape_study import open_shape_inputs, shape_study
from cytodisk.taking import takes


@takes(ShapeParameters, RunOptions)
def run_shapes(
    masks: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    groups: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    parameters: ShapeParameters | None = None,
    **settings: Any,
) -> pd.DataFrame:
    """Measure the shape of cells, score how complex it is, and write a table: `cytodisk shapes`.

    Parameters
    ----------
    masks : path-like
        One mask, a stack of masks or a label image, or a folder of those.
    out : path-like
        Folder for the results.
    groups : path-like, optional
        CSV table that says what was done to which cell; see `run_map`.
    progress : callable, optional
        Called with (cells done, cells in all).
    parameters : ShapeParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `ShapeParameters` and `RunOptions`.

    Returns
    -------
    DataFrame
        A row a cell, as in `shapes.parquet`. A cell that could not be measured has the reason.

    Raises
    ------
    ReadError, MaskError, ParameterError
        A file is missing or damaged, or a parameter is unknown or out of its range.
    StudyError
        The folder cannot be used.

    See Also
    --------
    shape_features : Measures masks in memory.

    Examples
    --------
    >>> import tifffile
    >>> from cytodisk import run_shapes, simulate
    >>> tifffile.imwrite("mask.tif", simulate.disk(40).astype("uint8"))
    >>> shapes = run_shapes("mask.tif", "shapes")
    >>> round(float(shapes["circularity"].iloc[0]), 1)
    1.0
    """
    options, values = RunOptions.split(settings, ShapeParameters)
    chosen = ShapeParameters.chosen(parameters, values)
    inputs = open_shape_inputs(masks, chosen, groups)
    return shape_study(inputs, out, chosen, progress=progress, **dict(options))

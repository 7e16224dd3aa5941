"""`cytodisk movie` as a function."""

from __future__ import annotations

import os
from typing import Any

from cytodisk.runs.movie.movie_groups import with_movie_groups
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.runs.run_options import Progress, RunOptions
from cytodisk.store.study import Study
from cytodisk.taking import takes


@takes(MovieParameters, RunOptions)
def run_movie(
    masks: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    signal: str | os.PathLike[str] | None = None,
    nuclei: str | os.PathLike[str] | None = None,
    groups: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    parameters: MovieParameters | None = None,
    **settings: Any,
) -> Study:
    """Follow cells through a movie and write a study: `cytodisk movie`.

    Parameters
    ----------
    masks : path-like
        Masks of one cell by frame, or label images by frame.
    out : path-like
        Folder for the results.
    signal : path-like, optional
        As many images, of the shape of the masks.
    nuclei : path-like, optional
        As many label images, or 0/1 masks, of the nuclei; in each frame a nucleus goes to the cell that holds
        most of it. It is followed as the cell's edge is.
    groups : path-like, optional
        CSV table that says what was done to which cell, or from which frame on; see `run_map`.
    progress : callable, optional
        Called with (frames done, frames in all), counted over all cells.
    parameters : MovieParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `MovieParameters` and `RunOptions`.

    Returns
    -------
    Study
        A frame that could not be mapped has a row with the reason.

    Raises
    ------
    ReadError, MaskError, SignalError, NucleusError, ParameterError
        A file is missing, damaged, or does not fit, or a parameter is unknown or out of its range.
    StudyError
        The folder cannot be used.

    See Also
    --------
    map_movie : Maps the masks of a movie in memory.

    Examples
    --------
    >>> import tifffile
    >>> from cytodisk import run_movie, simulate
    >>> movie = simulate.movie("growing", frames=3, radius_px=10, signals=False)
    >>> tifffile.imwrite("masks.tif", movie.masks.astype("uint8"), photometric="minisblack")
    >>> study = run_movie("masks.tif", "movie", layers=2, sectors=4)
    >>> study.cells["status"].tolist(), len(study.edge)
    (['ok', 'ok', 'ok'], 12)
    """
    options, values = RunOptions.split(settings, MovieParameters)
    inputs = open_movie(masks, signal, MovieParameters.chosen(parameters, values), nuclei=nuclei)
    inputs = with_movie_groups(inputs, masks, groups)
    return movie_study(inputs, out, progress=progress, **dict(options))

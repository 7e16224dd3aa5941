"""`cytodisk compare-windows` as a function."""

from __future__ import annotations

import os
from typing import Any, TypeAlias

from cytodisk.errors import ParameterError
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.cells.cell_parameters import CheckParameters, FileParameters
from cytodisk.runs.compare_windows.compare_cells import compare_opened_cells
from cytodisk.runs.compare_windows.compare_movie import compare_opened_movie
from cytodisk.runs.compare_windows.compare_nuclei import compare_opened_nuclei
from cytodisk.runs.compare_windows.compare_parameters import (
    CompareMovieParameters,
    CompareNucleiParameters,
    CompareWindowsParameters,
)
from cytodisk.runs.compare_windows.comparison import Comparison
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.run_options import Progress, RunOptions
from cytodisk.taking import takes

Compared: TypeAlias = CompareWindowsParameters | CompareMovieParameters | CompareNucleiParameters
"""Parameters of any comparison."""


@takes(CompareWindowsParameters, CompareMovieParameters, CompareNucleiParameters, RunOptions)
def run_compare_windows(
    masks: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    signal: str | os.PathLike[str] | None = None,
    nuclei: str | os.PathLike[str] | None = None,
    movie: bool = False,
    progress: Progress | None = None,
    parameters: Compared | None = None,
    **settings: Any,
) -> Comparison:
    """Lay windows of several kinds on cells and measure them: `cytodisk compare-windows`.

    Parameters
    ----------
    masks : path-like
        One mask, a stack of masks or a label image, or a folder of those.
    out : path-like
        Folder for the results.
    signal : path-like, optional
        Of a movie: what is sampled, to see how alike consecutive frames are.
    nuclei : path-like, optional
        Label image, or 0/1 mask, of the nuclei, with the shape and the frames of the masks. For a folder of
        masks a folder, or an ending of names as "_nuclei". Then windows on the map of cell and nucleus are
        compared with rings between nucleus and edge. Not in a movie.
    movie : bool
        The masks are the frames of a movie, whose cells are followed.
    progress : callable, optional
        Called with (cells or frames done, in all).
    parameters : CompareWindowsParameters, CompareMovieParameters or CompareNucleiParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `CompareWindowsParameters`, of a movie `CompareMovieParameters`, with nuclei
        `CompareNucleiParameters`, and `RunOptions`.

    Returns
    -------
    Comparison
        A cell that cannot be mapped has a row with the reason.

    Raises
    ------
    ReadError, MaskError, SignalError, ParameterError
        A file is missing, damaged, or does not fit, or a parameter is unknown or out of its range.
    StudyError
        The folder cannot be used.

    See Also
    --------
    measures_by_layer : Measures of windows that you have.
    open_comparison : Read the results later.

    References
    ----------
    u-Unwrap, sections 4.1 and 4.2, Figs. 3 and 4.

    Examples
    --------
    >>> import tifffile
    >>> from cytodisk import run_compare_windows, simulate
    >>> tifffile.imwrite("mask.tif", simulate.disk(9).astype("uint8"))
    >>> found = run_compare_windows("mask.tif", "compared", methods=("newton", "edge"), layers=2, sectors=4)
    >>> found.by_method["method"].tolist()
    ['newton', 'edge']
    """
    if nuclei is not None or isinstance(parameters, CompareNucleiParameters):
        return _compare_nuclei(masks, nuclei, out, (signal, movie, parameters), progress, settings)
    if movie or isinstance(parameters, CompareMovieParameters):
        options, values = RunOptions.split(settings, CompareMovieParameters)
        of_movie = CompareMovieParameters.chosen(parameters, values)
        frames = open_movie(masks, signal, of_movie)
        return compare_opened_movie(frames, out, of_movie, progress=progress, **dict(options))
    if signal is not None:
        raise ParameterError("signal is sampled in movies only: pass movie=True too, or leave signal out")
    for model, words in ((CompareMovieParameters, "movie=True"), (CompareNucleiParameters, "nuclei")):
        of_model = model.model_fields.keys() - CompareWindowsParameters.model_fields.keys()
        if beyond := [name for name in settings if name in of_model]:
            raise ParameterError(f"{', '.join(beyond)}: only with {words}; pass that too, or leave it out")
    options, values = RunOptions.split(settings, CompareWindowsParameters)
    of_cells = CompareWindowsParameters.chosen(parameters, values)
    cells = open_inputs(masks, None, of_cells.part(FileParameters))
    return compare_opened_cells(cells, out, of_cells, progress=progress, **dict(options))


def _compare_nuclei(
    masks: str | os.PathLike[str],
    nuclei: str | os.PathLike[str] | None,
    out: str | os.PathLike[str],
    others: tuple[str | os.PathLike[str] | None, bool, Compared | None],
    progress: Progress | None,
    settings: dict[str, Any],
) -> Comparison:
    """Compare windows that know the nucleus."""
    signal, movie, parameters = others
    if nuclei is None:
        raise ParameterError("parameters are those of cells with nuclei: pass nuclei, too")
    if movie or signal is not None:
        raise ParameterError("nuclei are compared in cells that are not followed: leave signal and movie out")
    options, values = RunOptions.split(settings, CompareNucleiParameters)
    of_nuclei = CompareNucleiParameters.chosen(parameters, values)
    cells = open_inputs(masks, None, of_nuclei.part(CheckParameters), nuclei=nuclei)
    return compare_opened_nuclei(cells, out, of_nuclei, progress=progress, **dict(options))

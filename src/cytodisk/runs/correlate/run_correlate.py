"""`cytodisk correlate` as a function."""

from __future__ import annotations

import os
from typing import Any

from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.correlate.correlate_study import correlate_study
from cytodisk.runs.run_options import Progress, TableOptions
from cytodisk.store.correlation_store import Correlation
from cytodisk.store.study import Study, open_study
from cytodisk.taking import takes


@takes(CorrelateParameters, TableOptions)
def run_correlate(
    study: str | os.PathLike[str] | Study,
    signal: str,
    with_: str = "velocity",
    *,
    cells: list[int] | None = None,
    progress: Progress | None = None,
    parameters: CorrelateParameters | None = None,
    **settings: Any,
) -> Correlation:
    """Correlate a signal of a movie's study with the velocity of the edge or with another signal.

    The tables go to STUDY/correlation/SIGNAL~WITH, as those of `cytodisk correlate`.

    Parameters
    ----------
    study : path-like or Study
        Of a movie.
    signal : str
        A channel of the study.
    with_ : str
        "velocity", "velocity_cell_frame" or a channel. Positive lag: it moves after the signal.
    cells : list of int, optional
        All by default.
    progress : callable, optional
        Called with (steps done, in all).
    parameters : CorrelateParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `CorrelateParameters` and `TableOptions`.

    Returns
    -------
    Correlation
        A cell that cannot be correlated has a row in `cells` that says why.

    Raises
    ------
    StudyError
        The study is not that of a movie, or has no signal.
    ParameterError
        There is no such signal or cell, a parameter is unknown or out of its range, or no cell could be
        correlated.

    See Also
    --------
    cross_correlate : Correlates arrays.

    Examples
    --------
    >>> import tifffile
    >>> from cytodisk import run_correlate, run_movie, simulate
    >>> movie = simulate.movie("fluctuating", frames=24, radius_px=14)
    >>> tifffile.imwrite("masks.tif", movie.masks.astype("uint8"), photometric="minisblack")
    >>> tifffile.imwrite("signal.ome.tif", movie.signal.to_numpy(), metadata={"axes": "TCYX"})
    >>> study = run_movie("masks.tif", "movie", signal="signal.ome.tif", layers=2, sectors=8)
    >>> found = run_correlate(study, "signal 1", max_lag=3, surrogates=19)
    >>> len(found.windows), found.settings["max_lag"]
    (16, 3)
    """
    there = study if isinstance(study, Study) else open_study(study)
    options, values = TableOptions.split(settings, CorrelateParameters)
    chosen = CorrelateParameters.chosen(parameters, values)
    return correlate_study(
        there, signal, with_, cells=cells, progress=progress, parameters=chosen, **dict(options)
    )

"""`cytodisk waves` as a function."""

from __future__ import annotations

import os
from typing import Any

from cytodisk.runs.run_options import Progress, TableOptions
from cytodisk.runs.waves.wave_run_parameters import WavesParameters
from cytodisk.runs.waves.waves_study import waves_study
from cytodisk.store.study import Study, open_study
from cytodisk.store.waves.waves_store import Waves
from cytodisk.taking import takes


@takes(WavesParameters, TableOptions)
def run_waves(
    study: str | os.PathLike[str] | Study,
    signal: str = "velocity",
    *,
    cells: list[int] | None = None,
    progress: Progress | None = None,
    parameters: WavesParameters | None = None,
    **settings: Any,
) -> Waves:
    """Look for waves that run along the edge of the cells of a movie's study, or through a signal.

    The tables go to STUDY/waves/SIGNAL, as those of `cytodisk waves`.

    Parameters
    ----------
    study : path-like or Study
        Of a movie.
    signal : str
        "velocity", "velocity_cell_frame" or a channel, of which waves are looked for in every layer.
    cells : list of int, optional
        All by default.
    progress : callable, optional
        Called with (steps done, in all).
    parameters : WavesParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `WavesParameters` and `TableOptions`.

    Returns
    -------
    Waves
        A cell in which waves cannot be looked for has a row in `cells` that says why. Speeds are positive
        towards higher sectors, which is clockwise in the cell's image.

    Raises
    ------
    StudyError
        The study is not that of a movie.
    ParameterError
        There is no such signal, layer or cell, a parameter is unknown or out of its range, or waves could be
        looked for in no cell.

    See Also
    --------
    edge_waves : Waves of an array.
    disk_waves : Waves of an array with layers.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("fluctuating", frames=40, radius_px=14)
    >>> tifffile.imwrite("masks.tif", truth.masks.astype("uint8"), photometric="minisblack")
    >>> study = cd.run_movie("masks.tif", "movie", layers=2, sectors=12, frame_interval_s=5.0)
    >>> found = cd.run_waves(study, surrogates=19)
    >>> found.cells["status"].tolist(), study.wave_signals
    (['ok'], [('velocity',)])
    """
    there = study if isinstance(study, Study) else open_study(study)
    options, values = TableOptions.split(settings, WavesParameters)
    chosen = WavesParameters.chosen(parameters, values)
    return waves_study(there, signal, cells=cells, progress=progress, parameters=chosen, **dict(options))

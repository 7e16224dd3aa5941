"""`cytodisk predict` as a function."""

from __future__ import annotations

import os
from typing import Any

from cytodisk.runs.predict.predict_parameters import PredictParameters
from cytodisk.runs.predict.predict_study import predict_study
from cytodisk.runs.run_options import Progress, TableOptions
from cytodisk.store.predictions.prediction_store import Prediction
from cytodisk.store.study import Study, open_study
from cytodisk.taking import takes


@takes(PredictParameters, TableOptions)
def run_predict(
    study: str | os.PathLike[str] | Study,
    source: str | None = None,
    target: str | None = None,
    *,
    cells: list[int] | None = None,
    progress: Progress | None = None,
    parameters: PredictParameters | None = None,
    **settings: Any,
) -> Prediction:
    """Test whether the past of a signal predicts another, in both directions, in a movie's study.

    The tables go to STUDY/prediction/SOURCE~TARGET, or STUDY/prediction/network, as those of
    `cytodisk predict`.

    Parameters
    ----------
    study : path-like or Study
        Of a movie.
    source, target : str, optional
        "velocity", "velocity_cell_frame" or a channel: both directions are tested. Without both, all channels
        and velocity are tested against each other, each pair with all others given.
    cells : list of int, optional
        All by default.
    progress : callable, optional
        Called with (steps done, in all).
    parameters : PredictParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `PredictParameters` and `TableOptions`.

    Returns
    -------
    Prediction
        A cell in which nothing can be tested has a row in `cells` that says why.

    Raises
    ------
    StudyError
        The study is not that of a movie, or has no signal.
    ParameterError
        There is no such signal or cell, a parameter is unknown or out of its range, or no cell could be
        tested.

    See Also
    --------
    predict : Tests arrays.
    run_correlate : Correlates signals.

    Notes
    -----
    A signal predicts another if its past makes the error of an autoregression smaller than the other's own
    past, its neighbours' and the signals given do. That is what a cause would do; it is no proof of one, as
    a common driver that was not imaged does it, too.

    References
    ----------
    Granger (1969), doi:10.2307/1912791; Noh et al. (2022), doi:10.1016/j.cels.2022.05.003.

    Examples
    --------
    >>> import tifffile
    >>> from cytodisk import run_movie, run_predict, simulate
    >>> movie = simulate.movie("fluctuating", frames=40, radius_px=14)
    >>> tifffile.imwrite("masks.tif", movie.masks.astype("uint8"), photometric="minisblack")
    >>> tifffile.imwrite("signal.ome.tif", movie.signal.to_numpy(), metadata={"axes": "TCYX"})
    >>> study = run_movie("masks.tif", "movie", signal="signal.ome.tif", layers=2, sectors=8)
    >>> found = run_predict(study, "signal 1", "velocity", max_order=3, surrogates=19, geometry=False)
    >>> len(found.links), sorted(set(found.links["target"]))  # both directions
    (4, ['signal 1', 'velocity'])
    """
    there = study if isinstance(study, Study) else open_study(study)
    options, values = TableOptions.split(settings, PredictParameters)
    chosen = PredictParameters.chosen(parameters, values)
    return predict_study(
        there, source, target, cells=cells, progress=progress, parameters=chosen, **dict(options)
    )

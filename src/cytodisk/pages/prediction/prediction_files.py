"""The pictures of a study's prediction, a set for each cell, at the width of a paper's column."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from cytodisk.pages.drawn_movie import DrawnMovie
from cytodisk.pages.figure_formats import check_cell, chosen_formats, save_pages
from cytodisk.pages.prediction.drawn_prediction import DrawnPrediction
from cytodisk.pages.prediction.prediction_pages import lags_page, network_page, profile_page
from cytodisk.pages.sheet import Sheet
from cytodisk.store.predictions.prediction_store import Prediction
from cytodisk.store.study import Study

_PAGES: dict[str, Callable[[DrawnPrediction], Sheet | None]] = {
    "network": network_page,
    "profile": profile_page,
    "lags": lags_page,
}


def write_prediction_figures(
    study: Study,
    prediction: Prediction,
    *,
    cell: int = 0,
    formats: Sequence[str] = ("png",),
    progress: Callable[[int, int], None] | None = None,
) -> list[Path]:
    """Write the pictures of one cell's prediction into the folder `figures` of the prediction.

    Parameters
    ----------
    study : Study
        Study of a movie.
    prediction : Prediction
        Of that study, as of `study.prediction`.
    cell : int
        Its number in the tables.
    formats : sequence of {"png", "pdf", "svg"}
        Text stays text in the last two.
    progress : callable, optional
        Called with (pages done, in all).

    Returns
    -------
    list of Path
        `cell_<number>_<what>.<format>`, each 85 mm wide: which signal predicts which, and in which layers
        (`network`); how much error is taken away by layer, in both directions, with what chance gives
        (`profile`); and the coefficients by lag (`lags`). What a cell has no numbers for is not drawn.

    Raises
    ------
    ParameterError
        A format is unknown, or the cell was not tested: the message says why.
    ReadError
        The study has no such cell, or a table or a map is damaged.
    StudyError
        The folder cannot be written.

    See Also
    --------
    write_correlation_figures : Pictures of a correlation.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("fluctuating", frames=40, radius_px=12.0)
    >>> tifffile.imwrite("masks.tif", truth.masks.astype("uint8"), metadata={"axes": "TYX"})
    >>> metadata = {"axes": "TCYX", "Channel": {"Name": ["edge", "material"]}}
    >>> tifffile.imwrite("signal.ome.tif", truth.signal.to_numpy(), metadata=metadata)
    >>> study = cd.run_movie("masks.tif", "out", signal="signal.ome.tif", layers=2, sectors=6)
    >>> found = cd.run_predict(study, "edge", "velocity", max_order=3, surrogates=19, geometry=False)
    >>> [path.name for path in cd.pages.write_prediction_figures(study, found)]
    ['cell_00000_network.png', 'cell_00000_profile.png', 'cell_00000_lags.png']
    """
    chosen = chosen_formats(formats)
    check_cell(prediction.cells, cell, prediction.path, "prediction")
    one = DrawnPrediction(DrawnMovie(study, cell), prediction)
    return save_pages(
        one, _PAGES, cell=cell, study=study.path, of=prediction.path, formats=chosen, progress=progress
    )

"""The pictures of a study's prediction, a set for each cell, at the width of a paper's column."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from cytodisk.errors import ParameterError
from cytodisk.pages.drawn_movie import DrawnMovie
from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.prediction.drawn_prediction import DrawnPrediction
from cytodisk.pages.prediction.prediction_pages import lags_page, network_page, profile_page
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.style import paper_style
from cytodisk.store.figures_folder import drawing
from cytodisk.store.predictions.prediction_store import Prediction
from cytodisk.store.study import Study
from cytodisk.store.study_folder import part_key

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
    _check_cell(prediction, cell)
    one = DrawnPrediction(DrawnMovie(study, cell), prediction)
    report = progress or (lambda done, whole: None)
    paths = []
    stems = {what: f"cell_{part_key(cell)}_{what}" for what in _PAGES}
    names = [f"{stem}.{kind}" for stem in stems.values() for kind in chosen]
    with drawing(study.path, *names, of=prediction.path) as folder:
        for done, (what, draw) in enumerate(_PAGES.items()):
            report(done, len(_PAGES))
            with paper_style():
                sheet = draw(one)
                if sheet is not None:
                    paths += save_in_formats(sheet, folder, stems[what], chosen)
    report(len(_PAGES), len(_PAGES))
    return paths


def _check_cell(prediction: Prediction, cell: int) -> None:
    rows = prediction.cells[prediction.cells["cell"] == cell]
    if rows.empty:
        there = sorted(int(number) for number in prediction.cells["cell"])
        raise ParameterError(f"cell {cell} is not in {prediction.path}: it has {there}")
    if rows["status"].iloc[0] != "ok":
        raise ParameterError(f"cell {cell} has no prediction to draw: {rows['reason'].iloc[0]}")

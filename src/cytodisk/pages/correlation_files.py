"""The pictures of a study's correlation, a set for each cell, at the widths of a paper's columns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from cytodisk.pages.correlation_pages import curves_page, events_page, maps_page, pairs_page, peaks_page
from cytodisk.pages.drawn_correlation import DrawnCorrelation
from cytodisk.pages.drawn_movie import DrawnMovie
from cytodisk.pages.figure_formats import check_cell, chosen_formats, save_pages
from cytodisk.pages.sheet import Sheet
from cytodisk.store.correlation_store import Correlation
from cytodisk.store.study import Study

_PAGES: dict[str, Callable[[DrawnCorrelation], Sheet | None]] = {
    "curves": curves_page,
    "maps": maps_page,
    "peaks": peaks_page,
    "pairs": pairs_page,
    "events": events_page,
}


def write_correlation_figures(
    study: Study,
    correlation: Correlation,
    *,
    cell: int = 0,
    formats: Sequence[str] = ("png",),
    progress: Callable[[int, int], None] | None = None,
) -> list[Path]:
    """Write the pictures of one cell's correlation into the folder `figures` of the correlation.

    Parameters
    ----------
    study : Study
        Study of a movie.
    correlation : Correlation
        Of that study, as of `study.correlation`.
    cell : int
        Its number in the tables.
    formats : sequence of {"png", "pdf", "svg"}
        Text stays text in the last two, and pictures of many pixels are pixels, at 200 dots per inch.
    progress : callable, optional
        Called with (pages done, in all).

    Returns
    -------
    list of Path
        `cell_<number>_<what>.<format>`: correlation against lag by layer (`curves`, 85 mm wide); the two
        quantities by time and sector (`maps`, 180 mm); peaks and their lags on disk and cell (`peaks`,
        85 mm); and where there are such tables, all pairs by distance and lag (`pairs`, up to 180 mm) and
        the signal around onsets of protrusion (`events`, 180 mm). What a cell has no numbers for is not
        drawn.

    Raises
    ------
    ParameterError
        A format is unknown, or the cell was not correlated: the message says why.
    ReadError
        The study has no such cell, or a table or a map is damaged.
    StudyError
        The folder cannot be written.

    See Also
    --------
    write_movie_figures : Pictures of the movie itself.

    References
    ----------
    u-Unwrap, Fig. 5 and S4.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("fluctuating", frames=24, radius_px=12.0)
    >>> tifffile.imwrite("masks.tif", truth.masks.astype("uint8"), metadata={"axes": "TYX"})
    >>> metadata = {"axes": "TCYX", "Channel": {"Name": ["edge", "material"]}}
    >>> tifffile.imwrite("signal.ome.tif", truth.signal.to_numpy(), metadata=metadata)
    >>> study = cd.run_movie("masks.tif", "out", signal="signal.ome.tif", layers=2, sectors=6)
    >>> correlation = cd.run_correlate(study, "edge", max_lag=4, surrogates=19)
    >>> [path.name for path in cd.pages.write_correlation_figures(study, correlation)]
    ['cell_00000_curves.png', 'cell_00000_maps.png', 'cell_00000_peaks.png', 'cell_00000_events.png']
    """
    chosen = chosen_formats(formats)
    check_cell(correlation.cells, cell, correlation.path, "correlation")
    one = DrawnCorrelation(DrawnMovie(study, cell), correlation)
    return save_pages(
        one, _PAGES, cell=cell, study=study.path, of=correlation.path, formats=chosen, progress=progress
    )

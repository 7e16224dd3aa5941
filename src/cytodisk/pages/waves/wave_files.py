"""The pictures of a cell's waves, at the widths of a paper's columns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from cytodisk.pages.drawn_movie import DrawnMovie
from cytodisk.pages.figure_formats import check_cell, chosen_formats, save_pages
from cytodisk.pages.sheet import Sheet
from cytodisk.pages.waves.drawn_waves import DrawnWaves
from cytodisk.pages.waves.wave_pages import depths_page, kymograph_page, phase_page, spectrum_page
from cytodisk.store.study import Study
from cytodisk.store.waves.waves_store import Waves

_PAGES: dict[str, Callable[[DrawnWaves], Sheet | None]] = {
    "kymograph": kymograph_page,
    "spectrum": spectrum_page,
    "phase": phase_page,
    "depths": depths_page,
}


def write_wave_figures(
    study: Study,
    waves: Waves,
    *,
    cell: int = 0,
    formats: Sequence[str] = ("png",),
    progress: Callable[[int, int], None] | None = None,
) -> list[Path]:
    """Write the pictures of one cell's waves into the folder `figures` of the waves.

    Parameters
    ----------
    study : Study
        Study of a movie.
    waves : Waves
        Of that study, as of `study.waves`.
    cell : int
        Its number in the tables.
    formats : sequence of {"png", "pdf", "svg"}
        Text stays text in the last two, and pictures of many pixels are pixels.
    progress : callable, optional
        Called with (pages done, in all).

    Returns
    -------
    list of Path
        `cell_<number>_<what>.<format>`: values by time and sector with the crests, and the phase
        (`kymograph`, 119 mm wide); power by number of waves around the cell, and by frequency (`spectrum`,
        119 mm); the phase on cell and disk at four times of a period (`phase`, 119 mm); of a signal the speed
        inwards and around by depth (`depths`, 85 mm). What a cell has no numbers for is not drawn.

    Raises
    ------
    ParameterError
        A format is unknown, or waves were not looked for in the cell: the message says why.
    ReadError
        The study has no such cell, or a table or a map is damaged.
    StudyError
        The folder cannot be written.

    See Also
    --------
    run_waves : Looks for waves.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("fluctuating", frames=40, radius_px=14)
    >>> tifffile.imwrite("masks.tif", truth.masks.astype("uint8"), photometric="minisblack")
    >>> study = cd.run_movie("masks.tif", "out", layers=2, sectors=12, frame_interval_s=5.0)
    >>> waves = cd.run_waves(study, surrogates=19)
    >>> [path.name for path in cd.pages.write_wave_figures(study, waves)][:2]
    ['cell_00000_kymograph.png', 'cell_00000_spectrum.png']
    """
    chosen = chosen_formats(formats)
    check_cell(waves.cells, cell, waves.path, "waves")
    one = DrawnWaves(DrawnMovie(study, cell), waves)
    return save_pages(
        one, _PAGES, cell=cell, study=study.path, of=waves.path, formats=chosen, progress=progress
    )

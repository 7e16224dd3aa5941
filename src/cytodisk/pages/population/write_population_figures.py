"""Write the pictures of a population's study."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeAlias

from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.population.curve_page import curves_page
from cytodisk.pages.population.direction_page import directions_page
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.population.gallery_page import gallery_page
from cytodisk.pages.population.map_pages import atlas_page, cell_atlas_page
from cytodisk.pages.population.profile_pages import profiles_page
from cytodisk.pages.population.scalar_pages import effects_page, scalars_page
from cytodisk.pages.population.trend_page import trend_maps_page, trends_page
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.style import paper_style
from cytodisk.runs.channel_names import file_names
from cytodisk.store.figures_folder import drawing
from cytodisk.store.populations.population_study import PopulationStudy

Page: TypeAlias = Callable[[], Sheet | None]


def write_population_figures(
    study: PopulationStudy,
    *,
    formats: Sequence[str] = ("png",),
    progress: Callable[[int, int], None] | None = None,
) -> list[Path]:
    """Write the pictures of a population into the folder `figures` of its study.

    Parameters
    ----------
    study : PopulationStudy
    formats : sequence of {"png", "pdf", "svg"}
        Text stays text in the last two.
    progress : callable, optional
        Called with (pages done, in all).

    Returns
    -------
    list of Path
        Of each of the first four channels `atlas_<channel>` (conditions and their difference on the disk),
        `atlas_on_cell_<channel>` (the same on the cell with the most usual shape) and `gallery_<channel>`
        (cells nearest to the mean and farthest from it); `profiles`, the signal by depth; `scalars`, the
        most important ones as SuperPlots; `effect_sizes` of all; `directions` in which channels are
        brightest; with a dose `dose_trends`, the scalars that follow it most closely, and
        `dose_trend_maps`, how each window of the disk follows it. Where curves are compared, such as the
        signal around events, `curves_<channel>` stands for the pictures of windows. What there are no numbers
        or maps for is not drawn: see `missing_figures`.

    Raises
    ------
    ParameterError
        A format is unknown.
    ReadError
        A table or a map is damaged.
    StudyError
        The folder cannot be written.

    See Also
    --------
    write_power_figure : How many experiments it takes.

    Examples
    --------
    >>> import cytodisk as cd
    >>> made = cd.simulate.population_images("made", experiments=2, cells=2, seed=0)
    >>> _ = cd.run_map(made.masks, "maps", signal=made.images, groups=made.groups, layers=3, sectors=6)
    >>> study = cd.run_population("maps", "atlas", channel=("Rac1",))
    >>> [path.name for path in cd.pages.write_population_figures(study)][:2]
    ['atlas_Rac1.png', 'atlas_on_cell_Rac1.png']
    """
    chosen = chosen_formats(formats)
    one = DrawnPopulation(study)
    pages = _pages(one)
    report = progress or (lambda done, whole: None)
    paths = []
    names = [f"{name}.{kind}" for name in pages for kind in chosen]
    with drawing(study.path, *names) as folder:
        for done, (name, draw) in enumerate(pages.items()):
            report(done, len(pages))
            with paper_style():
                sheet = draw()
                if sheet is not None:
                    paths += save_in_formats(sheet, folder, name, chosen)
    report(len(pages), len(pages))
    return paths


def missing_figures(study: PopulationStudy) -> list[str]:
    """Which pictures are not drawn and why, in sentences; empty if all are."""
    one = DrawnPopulation(study)
    told = [one.undrawn_words] if one.undrawn_words else []
    if study.is_curves or not one.channels:
        return told
    fault = one.sources.missing
    return [*told, f"No picture on a cell and no gallery: {fault}."] if fault else told


def _pages(one: DrawnPopulation) -> dict[str, Page]:
    pages: dict[str, Page] = {}
    channels = one.drawn_channels
    if one.study.is_curves:
        for channel, name in zip(channels, file_names(channels), strict=True):
            pages[f"curves_{name}"] = _of(curves_page, one, channel)
        channels = []
    for channel, name in zip(channels, file_names(channels), strict=True):
        pages[f"atlas_{name}"] = _of(atlas_page, one, channel)
        pages[f"atlas_on_cell_{name}"] = _of(cell_atlas_page, one, channel)
        pages[f"gallery_{name}"] = _of(gallery_page, one, channel)
    if channels:
        pages["profiles"] = lambda: profiles_page(one)
        pages["directions"] = lambda: directions_page(one)
    pages["scalars"] = lambda: scalars_page(one)
    pages["effect_sizes"] = lambda: effects_page(one)
    if one.study.parameters.get("dose") is not None:
        pages["dose_trends"] = lambda: trends_page(one)
        pages["dose_trend_maps"] = lambda: trend_maps_page(one)
    return pages


def _of(page: Callable[[DrawnPopulation, str], Sheet | None], one: DrawnPopulation, channel: str) -> Page:
    return lambda: page(one, channel)

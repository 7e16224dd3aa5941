"""Pages of a population: whole, readable, and with the numbers of its tables."""

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile
import xarray as xr
from drawn_study import study_of
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.errors import ParameterError, ReadError
from cytodisk.pages.population.cell_sources import CellSources
from cytodisk.pages.population.curve_page import curves_page
from cytodisk.pages.population.direction_page import directions_page
from cytodisk.pages.population.drawn_population import DrawnPopulation, in_two_lines
from cytodisk.pages.population.gallery_page import common_ending, gallery_page
from cytodisk.pages.population.map_pages import atlas_page, cell_atlas_page
from cytodisk.pages.population.power_page import write_power_figure
from cytodisk.pages.population.profile_pages import profiles_page
from cytodisk.pages.population.scalar_pages import chosen_scalars, effects_page, scalar_words, scalars_page
from cytodisk.pages.population.write_population_figures import missing_figures
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.style import DIVERGING_COLOURS, paper_style
from cytodisk.store.study import Study

ABSENT = Path("not there")


def population(conditions: int = 2, **settings: Any) -> cd.Population:
    names = ("control", "blebbistatin 25 µM", "Y-27632", "nocodazole", "latrunculin", "DMSO")[:conditions]
    given = {"experiments": 4, "cells": 3, "effect": 3.0, "layers": 3, "sectors": 8} | settings
    truth = cd.simulate.population(conditions=names, seed=0, **given)
    return cd.Population(truth.values + 10.0, truth.cells)


def drawn(pop: cd.Population, **parameters: Any) -> DrawnPopulation:
    return DrawnPopulation(study_of(pop, ABSENT, **parameters))


def words_of(figure: Figure) -> list[str]:
    texts = figure.findobj(lambda artist: hasattr(artist, "get_text"))
    return [text.get_text() for text in texts if text.get_text()]


@pytest.fixture
def page(tmp_path: Path, drawn_pages: Callable[[Sheet, Path], Figure]) -> Callable[..., Figure]:
    """Draw a page, check that it is whole, and give its figure."""

    def draw(make: Callable[..., Sheet | None], *arguments: Any) -> Figure:
        with paper_style():
            sheet = make(*arguments)
            assert sheet is not None
            return drawn_pages(sheet, tmp_path / "page.png")

    return draw


@pytest.fixture
def drawn_pages(drawn: list[Figure]) -> Callable[[Sheet, Path], Figure]:
    def save(sheet: Sheet, path: Path) -> Figure:
        sheet.save(path)
        return drawn[-1]

    return save


@pytest.fixture(scope="module")
def two() -> DrawnPopulation:
    return drawn(population())


@pytest.mark.slow
@pytest.mark.parametrize("conditions", [1, 2, 3, 6])
def test_an_atlas_shows_each_condition_and_each_difference(page: Any, conditions: int) -> None:
    one = drawn(population(conditions, experiments=2, cells=2))
    figure = page(atlas_page, one, "signal")
    titles = [ax.get_title() for ax in figure.axes if ax.get_title()]
    assert titles[:conditions] == one.conditions
    joined = [title.replace("\n", " ") for title in titles[conditions:]]
    assert joined == [f"{name} − control" for name in one.conditions[1:]]
    counts = [text for text in words_of(figure) if text == "4 cells\n2 experiments"]
    assert len(counts) == conditions
    assert figure.get_size_inches()[0] * 25.4 == pytest.approx(85.0 if conditions < 4 else 119.0)


def test_an_atlas_says_how_it_was_tested(page: Any, two: DrawnPopulation) -> None:
    told = " ".join(words_of(page(atlas_page, two, "signal")))
    assert "8 experiments" in told
    assert "4 + 4 experiments, unpaired, smallest p possible 0.029" in told
    assert "max-T" in told
    assert "mean signal (a.u.)" in told
    assert "equal areas" in told  # the studies of these cells are not there


def test_labels_tell_how_values_were_made(page: Any) -> None:
    one = drawn(population().normalise("cell mean").align("nucleus"), normalise="cell mean", align="nucleus")
    told = words_of(page(atlas_page, one, "signal"))
    assert "signal (a.u.)" in told  # the unit says what each cell was divided by
    assert any("sector 0: away from the nucleus" in words for words in told)
    assert drawn(population(), summary="peak_correlation").value_label("signal") == (
        "peak correlation of signal (a.u.)"
    )


@pytest.mark.parametrize(("summary", "is_signed"), [("mean", False), ("velocity", True)])
def test_what_has_a_sign_has_0_in_the_middle_of_its_colours(page: Any, summary: str, is_signed: bool) -> None:
    figure = page(atlas_page, drawn(population(), summary=summary), "signal")
    windows = figure.axes[0].collections[0]
    low, high = windows.get_clim()
    assert (low == -high) == is_signed
    assert (windows.get_cmap().name == DIVERGING_COLOURS) == is_signed


def test_long_names_have_two_lines() -> None:
    assert in_two_lines("control", 14.0) == "control"
    assert in_two_lines("blebbistatin 25 µM", 16.0) == "blebbistatin\n25 µM"
    assert max(map(len, in_two_lines("a_name_without_an_end and more of it", 14.0).split("\n"))) <= 10


def test_channels_without_figures_are_named() -> None:
    assert drawn(population()).undrawn_words == ""
    pop = population()
    names = ["DAPI", "b", "c", "d", "Rac 1", "f"]
    many = xr.concat([pop.values.isel(channel=0, drop=True)] * 6, pd.Index(names, name="channel"))
    one = drawn(cd.Population(many.transpose("cell", "channel", ...), pop.cells))
    assert one.drawn_channels == names[:4]
    assert "first 4 of 6 channels (DAPI, b, c, d)" in one.undrawn_words
    assert "--channel 'Rac 1,f'" in one.undrawn_words
    assert missing_figures(one.study)[0] == one.undrawn_words


@pytest.mark.slow
def test_several_conditions_are_corrected_together(page: Any) -> None:
    told = " ".join(words_of(page(effects_page, drawn(population(3)))))
    assert "corrected for all scalars (max-T, Holm)" in told


def test_without_experiments_nothing_is_tested(page: Any) -> None:
    pop = population()
    one = drawn(pop.with_cells(pop.cells.assign(experiment=None)))
    told = " ".join(words_of(page(atlas_page, one, "signal")))
    assert "experiments unknown" in told
    assert "not tested" in told
    scalars = words_of(page(scalars_page, one))
    assert not any("max-T" in words or words == "no p" for words in scalars)
    assert not two_marks(page(scalars_page, one))
    assert "mean of cells" in words_of(page(scalars_page, one))
    assert "one experiment" not in words_of(page(profiles_page, one))
    assert effects_page(one) is None


def two_marks(figure: Figure) -> list[Any]:
    return [line for ax in figure.axes for line in ax.lines if line.get_gid() == "experiment"]


def test_scalars_are_those_that_differ_most(page: Any, two: DrawnPopulation) -> None:
    figure = page(scalars_page, two)
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert labels == ["mean of signal (a.u.)", "edge to centre of signal", "polarity of signal"]
    assert chosen_scalars(two) == ["mean_signal", "edge_to_centre_signal", "polarity_signal"]
    assert len(two_marks(figure)) == 3 * 8
    assert any(words.startswith("p = ") for words in words_of(figure))
    assert scalar_words(two, "layer_2_signal") == "layer 2 of signal"
    assert scalar_words(two, "nucleus_area") == "nucleus area"


def test_paired_experiments_are_joined(page: Any) -> None:
    one = drawn(population(3, paired=True))
    figure = page(scalars_page, one)
    pairs = [line for ax in figure.axes for line in ax.lines if line.get_gid() == "pair"]
    assert len(pairs) == 3 * 4 * 2
    assert {"experiment 1", "experiment 4"} <= set(words_of(figure))


@pytest.mark.slow
def test_effect_sizes_have_a_row_a_scalar(page: Any, two: DrawnPopulation) -> None:
    figure = page(effects_page, two)
    (ax,) = figure.axes
    names = [label.get_text() for label in ax.get_yticklabels()]
    assert names == [scalar_words(two, name) for name in two.study.scalars["scalar"]]
    several = page(effects_page, drawn(population(4, experiments=3)))
    assert several.axes[0].get_title().replace("\n", " ") == "blebbistatin 25 µM − control"


def test_very_many_scalars_are_cut_to_the_largest(page: Any) -> None:
    one = drawn(population())
    row = one.study.scalars.iloc[[0]]
    many = [row.assign(scalar=f"feature_{k}", effect_size=k / 100.0) for k in range(100)]
    one.study.__dict__["scalars"] = pd.concat(many, ignore_index=True)
    figure = page(effects_page, one)
    assert "44 of 100, the largest effect sizes" in " ".join(words_of(figure))
    assert figure.axes[0].get_yticklabels()[0].get_text() == "feature 56"


def test_the_key_of_experiments_is_read_along_rows(page: Any) -> None:
    figure = page(scalars_page, drawn(population(2, experiments=17, cells=2, paired=True)))
    told = [text.get_text() for text in figure.legends[0].get_texts()]  # column by column
    step = int(told[1].split()[-1]) - 1
    assert step > 1
    along = [f"experiment {number}" for first in range(1, step + 1) for number in range(first, 18, step)]
    assert told == along


def test_profiles_have_a_line_an_experiment(page: Any, two: DrawnPopulation) -> None:
    figure = page(profiles_page, two)
    lines = [line.get_gid() for line in figure.axes[0].lines]
    assert (lines.count("experiment"), lines.count("mean")) == (8, 2)
    assert {"edge of the cell", "95 % interval over experiments"} <= set(words_of(figure))


@pytest.mark.slow
def test_directions_have_a_rose_a_condition(page: Any, two: DrawnPopulation) -> None:
    figure = page(directions_page, two)
    assert [ax.get_title() for ax in figure.axes] == two.conditions * 2
    assert {"nucleus", "front"} <= set(words_of(figure))
    cells = two.study.cells.assign(polarity_direction_signal=90.0)
    turned = DrawnPopulation(study_of(population(), ABSENT))
    turned.study.__dict__["cells"] = cells
    assert "brightest side of signal" in words_of(page(directions_page, turned))


def test_no_maps_no_pages_on_cells(two: DrawnPopulation) -> None:
    assert cell_atlas_page(two, "signal") is None
    assert gallery_page(two, "signal") is None
    assert "does not say which studies" in two.sources.missing
    gone = CellSources(two.study.cells.assign(study="no/such folder", number=0), np.arange(3))
    assert gone.missing == "no/such folder is not there any more"
    with pytest.raises(ReadError, match="not there any more"):
        gone.disk(0)


@pytest.fixture(scope="module")
def mapped(tmp_path_factory: pytest.TempPathFactory) -> Study:
    folder = tmp_path_factory.mktemp("mapped")
    masks = np.zeros((40, 130), dtype=np.uint8)
    for label, (radius, x) in enumerate([(9, 15), (12, 45), (11, 75), (15, 110)], 1):
        y, column = np.ogrid[:40, :130]
        masks[(y - 20) ** 2 + (column - x) ** 2 <= radius**2] = label
    tifffile.imwrite(folder / "masks.tif", masks)
    tifffile.imwrite(folder / "signal.tif", (masks * 10).astype(np.uint16))
    signal = {"signal": folder / "signal.tif", "channels": ("signal",)}
    return cd.run_map(folder / "masks.tif", folder / "out", layers=3, sectors=8, **signal)


def with_maps(study: Study, layers: int = 3, **columns: Any) -> DrawnPopulation:
    pop = population(cells=1, experiments=2, layers=layers)
    cells = pop.cells.assign(study=str(study.path), number=np.arange(len(pop)), **columns)
    cells["cell"] = [f"masks.tif, cell {number}" for number in range(1, 5)]
    return drawn(pop.with_cells(cells))


def test_the_atlas_is_carried_onto_the_most_usual_cell(page: Any, mapped: Study) -> None:
    one = with_maps(mapped)
    assert one.sources.representative in (1, 2)  # neither the smallest nor the largest
    figure = page(cell_atlas_page, one, "signal")
    told = " ".join(words_of(figure))
    assert f"most usual shape: {one.sources.name(one.sources.representative)}" in told
    assert one.grid.layers == 3
    assert one.sources.note == ""


def test_what_is_of_the_edge_lies_on_the_edge(page: Any, mapped: Study) -> None:
    """As the velocity of the edge: one layer of values, in a study whose grid has three."""
    one = with_maps(mapped, layers=1)
    for make in (atlas_page, cell_atlas_page):
        figure = page(make, one, "signal")
        shown = np.ma.asarray(figure.axes[0].collections[0].get_array()).reshape(3, 8)
        assert np.ma.getmaskarray(shown).all(axis=1).tolist() == [False, True, True]
        assert "no value" in words_of(figure)
    assert one.sources.note == ""


def test_a_gallery_names_its_cells(page: Any, mapped: Study) -> None:
    figure = page(gallery_page, with_maps(mapped), "signal")
    titles = [ax.get_title() for ax in figure.axes if ax.get_title()]
    assert set(titles) == {f"masks\ncell {number}" for number in range(1, 5)}
    assert {"nearest", "farthest", "control"} <= set(words_of(figure))


def test_names_are_told_without_what_all_end_with() -> None:
    assert common_ending(["control_1_cp_masks.tif", "drug_4_cp_masks.tif"]) == "_cp_masks.tif"
    assert common_ending(["a.tif", "a.tif"]) == ".tif"
    assert common_ending(["ab.tif", "cab.tif"]) == ".tif"
    assert common_ending(["", "x"]) == ""
    assert common_ending([]) == ""


def test_a_gallery_shows_the_images_that_were_measured(page: Any, mapped: Study) -> None:
    one = with_maps(mapped)
    one.study.__dict__["gallery"] = one.study.gallery.assign(channel="signal")
    figure = page(gallery_page, one, "signal")
    shown = [np.asarray(ax.images[0].get_array()) for ax in figure.axes if ax.images]
    usual = [int(np.bincount(image[image > 0].astype(int)).argmax()) for image in shown]
    assert set(usual) == {10, 20, 30, 40}  # each cell has its own grey
    assert not any("means of windows" in words for words in words_of(figure))
    bars = [words for words in words_of(figure) if words.endswith(" px")]
    assert len(bars) == 1


def test_cells_without_their_own_level_are_shown_alike(page: Any, mapped: Study) -> None:
    one = with_maps(mapped)
    one.study.__dict__["gallery"] = one.study.gallery.assign(channel="signal")
    one.study.provenance["parameters"] = {"normalise": "cell mean"}
    figure = page(gallery_page, one, "signal")
    shown = [np.asarray(ax.images[0].get_array()) for ax in figure.axes if ax.images]
    assert {round(float(np.nanmedian(image[image > 0])), 3) for image in shown} == {1.0}
    assert any("× cell mean" in words for words in words_of(figure))


@pytest.mark.slow
def test_a_full_gallery_has_room_on_its_page(page: Any, mapped: Study) -> None:
    one = with_maps(mapped)
    table = one.study.gallery
    ranks = [table.assign(rank=table["rank"] + 2 * k, row=table["row"] % 4) for k in range(2)]
    one.study.__dict__["gallery"] = pd.concat(ranks, ignore_index=True)
    figure = page(gallery_page, one, "signal")
    assert len([ax for ax in figure.axes if ax.images]) >= 8


def test_images_that_are_gone_are_told(page: Any, mapped: Study) -> None:
    signal = mapped.path.parent / "signal.tif"
    hidden = signal.rename(signal.with_suffix(".hidden"))
    try:
        figure = page(gallery_page, with_maps(mapped), "signal")
    finally:
        hidden.rename(signal)
    assert not any(ax.images for ax in figure.axes)
    assert any(words.startswith("means of windows: ") for words in words_of(figure))


def test_curves_have_a_panel_a_layer(page: Any) -> None:
    lag = np.arange(-4, 5) * 5.0
    cells = pd.DataFrame({"condition": np.repeat(["control", "drug"], 12), "experiment": list("abcdef") * 4})
    values = np.exp(-(lag**2) / 50) * np.ones((24, 1, 3, 1)) + np.random.default_rng(0).normal(
        0, 0.05, (24, 1, 3, 9)
    )
    values[12:, :, 0] += 1.0
    coords = {"channel": ["Rac1"], "lag": ("lag", lag, {"units": "s"})}
    pop = cd.Population(xr.DataArray(values, coords, ("cell", "channel", "layer", "lag")), cells)
    one = drawn(pop, summary="around_events")
    one.study.provenance.update({"curves": True, "lag_unit": "s"})
    figure = page(curves_page, one, "Rac1")
    assert [ax.get_title(loc="left") for ax in figure.axes] == [
        "layer 0 (edge)",
        "layer 1",
        "layer 2 (centre)",
    ]
    assert figure.axes[-1].get_xlabel() == "time after the onset (s)"
    dots = [[line for line in ax.lines if line.get_gid() == "differs"] for ax in figure.axes]
    assert [len(marks) for marks in dots] == [1, 0, 0]
    assert len(np.asarray(dots[0][0].get_xdata())) == 9


def test_power_is_written_in_the_formats_that_are_wanted(tmp_path: Path, drawn: list[Figure]) -> None:
    power = pd.DataFrame(itertools.product(["unpaired", "paired"], [4, 8], [0.5, 1.0, 3.0]))
    power.columns = pd.Index(["design", "experiments", "effect"])
    power = power.assign(window=0.9, scalar=np.linspace(0.0, 1.0, 12))
    notes = ["12 cells of each experiment", "10 % of the variance between experiments", "unpaired"]
    paths = write_power_figure(tmp_path, power, notes=notes, formats=("png", "svg"))
    assert [path.name for path in paths] == ["power.png", "power.svg"]
    figure = drawn[-1]
    assert any("10 % of the variance" in words for words in words_of(figure))
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["unpaired", "paired"] * 2
    assert [ax.get_xlabel() for ax in figure.axes[:2]] == [
        "experiments of each condition",
        "pairs of experiments",
    ]
    with pytest.raises(ParameterError, match="pass the table of population_power"):
        write_power_figure(tmp_path, power.drop(columns="design"))

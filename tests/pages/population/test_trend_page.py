"""Page of scalars over the dose."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from drawn_study import study_of
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.population.trend_page import chosen_trends, trend_maps_page, trends_page
from cytodisk.plot.population.dose_trends import BAND_NAME, TEST_NAME, TREND_NAME
from cytodisk.plot.style import paper_style
from cytodisk.runs.population.comparison_rows import trend_tables


def dosed(shared: bool, dose: str = "dose_nM", **parameters: Any) -> DrawnPopulation:
    names = ("control", "low", "high")
    truth = cd.simulate.population(
        conditions=names, experiments=4, cells=3, effect=3.0, layers=3, sectors=8, seed=0
    )
    cells = truth.cells.assign(**{dose: truth.cells["condition"].map({"control": 0, "low": 1, "high": 10})})
    if shared:
        cells["experiment"] = "day " + cells.groupby("condition").cumcount().mod(4).astype(str)
    pop = cd.Population(truth.values, cells)
    study = study_of(pop, Path("not there"), dose=dose, **parameters)
    trend = cd.dose_trend(pop, dose, permutations=99)
    study.__dict__.update(trend_tables(trend))
    return DrawnPopulation(study)


@pytest.mark.parametrize("shared", [True, False])
def test_scalars_stand_over_the_dose(drawn: list[Figure], tmp_path: Path, shared: bool) -> None:
    one = dosed(shared)
    with paper_style():
        sheet = trends_page(one)
        assert sheet is not None
        sheet.save(tmp_path / "page.png")
    (figure,) = drawn
    rows = chosen_trends(one)
    assert len(figure.axes) == len(rows)
    for ax, (_, row) in zip(figure.axes, rows.iterrows(), strict=True):
        assert ax.get_xlabel() == "dose_nM (even steps)"
        assert [text.get_text() for text in ax.get_xticklabels()] == ["0", "1", "10"]
        (line,) = [one for one in ax.lines if one.get_gid() == TREND_NAME]
        x, y = (np.asarray(values) for values in line.get_data())
        assert (y[-1] - y[0]) / (x[-1] - x[0]) == pytest.approx(row["slope"])
        assert any(one.get_gid() == BAND_NAME for one in ax.collections)
        assert [text.get_text()[:4] for text in ax.texts if text.get_gid() == TEST_NAME] == ["p = "]


def test_trends_of_windows_stand_on_the_disk(drawn: list[Figure], tmp_path: Path) -> None:
    one = dosed(True)
    with paper_style():
        sheet = trend_maps_page(one)
        assert sheet is not None
        sheet.save(tmp_path / "page.png")
    (figure,) = drawn
    disk, bar = figure.axes
    assert disk.get_title() == "signal"
    assert bar.get_xlabel() == "slope (a.u. per step)"
    slopes = one.study.trends.sort_values(["layer", "sector"])["slope"].to_numpy()
    assert np.sort(np.asarray(disk.collections[0].get_array())) == pytest.approx(np.sort(slopes))


def test_there_is_no_page_without_a_dose() -> None:
    one = dosed(True)
    del one.study.parameters["dose"]
    one.study.provenance["parameters"].pop("dose")
    assert trends_page(one) is None
    assert trend_maps_page(one) is None

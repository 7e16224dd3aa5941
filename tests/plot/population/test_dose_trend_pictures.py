"""A scalar over the dose: cells, experiments, the line of the trend and its band."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from scipy import stats

import cytodisk as cd
from cytodisk.errors import ParameterError
from cytodisk.plot.population.dose_trend_key import dose_trend_key
from cytodisk.plot.population.dose_trends import (
    BAND_NAME,
    EXPERIMENT_NAME,
    PAIR_NAME,
    TEST_NAME,
    TREND_NAME,
    draw_dose_trend,
)


def lines(ax: Axes, name: str) -> list[Line2D]:
    return [line for line in ax.lines if line.get_gid() == name]


@pytest.fixture
def cells() -> pd.DataFrame:
    """Eight experiments, each at one dose, with three cells each."""
    dose = np.repeat([0.0, 1.0, 10.0, 100.0], 6)
    noise = np.random.default_rng(0).normal(size=24)
    experiment = np.repeat([f"day {k}" for k in range(8)], 3)
    return pd.DataFrame({"experiment": experiment, "dose": dose, "size": noise}).assign(condition="all")


def test_line_and_band_are_those_of_least_squares(ax: Axes, cells: pd.DataFrame) -> None:
    units = cells.groupby("experiment").mean(numeric_only=True)
    x, y = units["dose"].rank(method="dense").to_numpy(), units["size"].to_numpy()
    fit = stats.linregress(x, y)
    wide = stats.t.ppf(0.975, len(x) - 2)
    slope = {"slope": fit.slope, "slope_low": fit.slope - wide * fit.stderr}
    slope["slope_high"] = fit.slope + wide * fit.stderr
    draw_dose_trend(ax, cells, "size", trend=slope | {"p": 0.5, "p_fwer": 0.031})
    (line,), at = lines(ax, TREND_NAME), np.array([1.0, 4.0])
    assert np.interp(at, *np.asarray(line.get_data())) == pytest.approx(fit.intercept + fit.slope * at)
    (band,) = [one for one in ax.collections if one.get_gid() == BAND_NAME]
    spread = np.sqrt(((y - fit.intercept - fit.slope * x) ** 2).sum() / (len(x) - 2))
    half = wide * spread * np.sqrt(1 / len(x) + (1.0 - x.mean()) ** 2 / ((x - x.mean()) ** 2).sum())
    ends = band.get_paths()[0].vertices
    first = ends[ends[:, 0] == 1.0, 1]
    assert (first.min(), first.max()) == pytest.approx(
        (line.get_ydata()[0] - half, line.get_ydata()[0] + half)
    )
    (words,) = [text.get_text() for text in ax.texts if text.get_gid() == TEST_NAME]
    assert words.startswith("p = 0.031\n")
    assert "per step" in words


@pytest.mark.parametrize(
    ("scale", "places", "label"),
    [
        ("rank", [1, 2, 3, 4], "dose (even steps)"),
        ("linear", [0, 1, 10, 100], "dose"),
        ("log", [0, 1, 2], "dose (logarithmic)"),
    ],
)
def test_doses_lie_as_the_trend_counts_them(
    ax: Axes, cells: pd.DataFrame, scale: str, places: list[float], label: str
) -> None:
    if scale == "log":
        with pytest.raises(ParameterError, match="a dose of 0 has no logarithm: pass scale='rank'"):
            draw_dose_trend(ax, cells, "size", scale="log")
        cells = cells[cells["dose"] > 0]
    dots = draw_dose_trend(ax, cells, "size", scale=scale)
    assert [float(np.median(np.asarray(one.get_offsets())[:, 0])) for one in dots] == pytest.approx(
        places, abs=0.1 * np.ptp(places)
    )
    marks = {float(x) for line in lines(ax, EXPERIMENT_NAME) for x in line.get_xdata()}
    assert sorted(marks) == pytest.approx(places)
    assert ax.get_xlabel() == label
    if scale != "linear":
        assert [text.get_text() for text in ax.get_xticklabels()] == [
            f"{d:g}" for d in np.unique(cells["dose"])
        ]


def test_experiments_of_several_doses_are_joined_and_named(ax: Axes, cells: pd.DataFrame) -> None:
    assert next(handle.get_label() for handle in dose_trend_key(cells)) == "mean of one experiment"
    shared = cells.assign(experiment=np.tile(["a", "b", ""], 8))
    draw_dose_trend(ax, shared, "size")
    assert [len(line.get_xdata()) for line in lines(ax, PAIR_NAME)] == [4, 4]
    assert [handle.get_label() for handle in dose_trend_key(shared)][:3] == ["a", "b", "cell"]


def test_cells_without_a_dose_are_not_drawn(ax: Axes, cells: pd.DataFrame) -> None:
    cells.loc[:2, "dose"] = np.nan
    dots = draw_dose_trend(ax, cells, "size")
    assert sum(len(one.get_offsets()) for one in dots) == 21
    with pytest.raises(ParameterError, match="no row with numbers in 'dose' and 'size'"):
        draw_dose_trend(ax, cells.assign(dose="much"), "size")


def test_a_trend_that_was_tested_fits_its_picture(ax: Axes) -> None:
    truth = cd.simulate.population(experiments=4, effect=3.0, seed=0)
    cells = truth.cells.assign(dose=np.where(truth.cells["condition"] == "drug", 2.0, 0.0))
    pop = cd.Population(truth.values, cells)
    scalars = pop.scalar_table()
    found = cd.dose_trend(pop).scalars.set_index("scalar").loc["mean_signal"]
    renamed = {"difference": "slope", "difference_low": "slope_low", "difference_high": "slope_high"}
    draw_dose_trend(ax, cells.assign(mean=scalars["mean_signal"]), "mean", trend=found.rename(renamed))
    (line,) = lines(ax, TREND_NAME)
    means = cells.assign(mean=scalars["mean_signal"]).groupby(["dose", "experiment"])["mean"].mean()
    expected = means.groupby("dose").mean().to_numpy()
    assert np.asarray(line.get_ydata())[[0, -1]] == pytest.approx(expected)

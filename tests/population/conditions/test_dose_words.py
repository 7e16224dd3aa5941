"""Trends over doses: what is refused, and what is said of cells that are in none."""

import pandas as pd
import pytest
import xarray as xr
from numpy.random import default_rng

import cytodisk as cd
from cytodisk.errors import PopulationError


def _population(doses: list[object], experiments: list[str | None] | None = None) -> cd.Population:
    values = xr.DataArray(default_rng(0).normal(size=(len(doses), 1, 2)), dims=("cell", "layer", "sector"))
    names = experiments or [f"day {k}" for k in range(len(doses))]
    return cd.Population(values, pd.DataFrame({"experiment": names, "dose": pd.Series(doses, dtype=object)}))


@pytest.mark.parametrize("dose", ["10 nM", "high", float("inf")])
def test_a_dose_that_is_no_number_is_refused(dose: object) -> None:
    with pytest.raises(PopulationError, match="2 of 6 cells have no finite number"):
        cd.dose_trend(_population([0, 1, dose, dose, 2.0, 3]))


def test_cells_without_a_dose_or_an_experiment_are_told() -> None:
    names = ["a", "b", "c", "d", None]
    found = cd.dose_trend(_population([0, "1.5", None, "", 3], names))
    assert found.doses.tolist() == [0.0, 1.5]
    assert "3 of 5 cells have no dose or no experiment: they are in no trend." in found.sentences


def test_what_no_trend_can_reach_is_said_first() -> None:
    few, many = (cd.dose_trend(_population(list(range(count)))) for count in (4, 5))
    assert few.sentences[0].endswith("can give p = 0.083 at best: no trend can reach 0.05.")
    assert many.sentences[0].endswith("can give p = 0.017 at best.")


def test_a_trend_says_where_and_by_how_much() -> None:
    truth = cd.simulate.population(experiments=4, effect=3.0, seed=0)
    cells = truth.cells.assign(dose=(truth.cells["condition"] == "drug") * 2.0)
    words = cd.dose_trend(cd.Population(truth.values, cells)).sentences
    assert words[1].startswith(
        "signal: 8 of 48 windows have a trend (max-T, p ≤ 0.05); cluster: layers 0–1, "
    )
    assert "sectors 2–5 (+3.03" in words[1]
    assert words[1].endswith(" by step of the dose, p = 0.029).")
    assert "mean_signal +0.581 (p = 0.029)" in words[2]

"""Benchmarks of populations go on where they were stopped, and test what `compare_conditions` tests."""

import sys
from argparse import Namespace
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def load() -> Iterator[Any]:
    sys.path.insert(0, str(BENCHMARKS))
    try:
        yield __import__
    finally:
        sys.path.remove(str(BENCHMARKS))


@pytest.mark.parametrize(
    ("experiments", "design", "level"),
    [
        (3, "unpaired", 0.0),
        (4, "unpaired", 2 / 70),
        (5, "unpaired", 12 / 252),
        (6, "unpaired", 46 / 924),
        (7, "unpaired", 0.05),  # 999 of 3432 are drawn
        (4, "paired", 0.0),
        (6, "paired", 2 / 64),
        (8, "paired", 12 / 256),
    ],
)
def test_what_few_experiments_can_attain(load: Any, experiments: int, design: str, level: float) -> None:
    cases = load("population_cases")
    assert cases.attainable(cases.Case(0.1, design, experiments), 999) == pytest.approx(level)


@pytest.mark.parametrize("design", ["unpaired", "paired"])
@pytest.mark.parametrize("unit", ["experiment", "cell"])
def test_the_fast_way_gives_the_p_values_of_the_comparison(
    load: Any, design: str, unit: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    cases = load("population_cases")
    monkeypatch.setattr(cases, "BLOCK", 3)
    case = cases.Case(0.1, design, 5, "signal", unit)
    studies = cases.Studies(case, 1, 199)
    for number in range(3):
        expected = cases.p_values_of_comparison(case, studies.alone(number), 7, 199)
        assert studies.p_values(number, 7) == pytest.approx(expected)


def test_a_stopped_run_goes_on_and_one_of_other_settings_is_refused(
    load: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    benchmark, path = load("population_null"), tmp_path / "results"
    case, settings = benchmark.Case(0.1, "paired", 4), {"studies": 3}
    chosen = Namespace(first_block=0, permutations=99)
    with ThreadPoolExecutor(1) as pool:
        rate = benchmark.rates(case, chosen, benchmark.BLOCK, pool, benchmark.Results(path, settings))
        with path.open("a", encoding="utf-8") as file:
            file.write('\n{"case": "0.1 pai')  # stopped in the middle of a line
        monkeypatch.setattr(benchmark, "count", None)  # nothing is left to do
        assert benchmark.rates(case, chosen, benchmark.BLOCK, pool, benchmark.Results(path, settings)) == rate
    with pytest.raises(SystemExit, match="other settings"):
        benchmark.Results(path, {"studies": 4})


def test_rates_above_or_below_the_level_are_not_met(load: Any) -> None:
    met = load("population_null").is_met
    right = dict.fromkeys(("windows", "clusters", "mean", "scalars"), 0.05)
    assert met(right, 0.05, 4000)
    assert met(right | {"clusters": 0.01}, 0.05, 4000)
    for wrong in ({"windows": 0.07}, {"mean": 0.03}, {"clusters": 0.07}, {"scalars": 0.07}):
        assert not met(right | wrong, 0.05, 4000)


def test_a_region_grows_and_shrinks_around_sector_0(load: Any) -> None:
    benchmark = load("population_region")
    region = benchmark.planted_region()
    assert region.sum() == 120
    assert benchmark.grown(region, 1).sum() == 7 * 22
    assert benchmark.grown(region, -1).sum() == 5 * 18  # layer 0 is the cell's edge, no border
    figures = benchmark.measure(0, 3.0, 1.0)
    assert np.shape(figures) == (3, len(benchmark.COLUMNS))
    assert figures[0, 0] > 0.9
    assert not figures[0, 2:].any()


@pytest.mark.parametrize(("experiments", "level"), [(3, 0.0), (5, 0.0), (6, 2 / 64), (8, 12 / 256)])
def test_turned_signs_attain_these_levels(load: Any, experiments: int, level: float) -> None:
    assert load("drawn_studies").attained(experiments) == pytest.approx(level)


def test_a_drawn_study_takes_each_stored_cell_once(load: Any) -> None:
    store = [pd.DataFrame({"value": [float(number)], "cell": 0}) for number in range(40)]
    conditions = {"control": (4, store)}
    rows, cells = load("drawn_studies").drawn_study(np.random.default_rng(0), conditions)
    assert cells["experiment"].nunique() == 4
    assert cells.groupby("experiment").size().between(1, 5).all()
    assert rows["value"].is_unique
    assert len(rows) == len(cells)


@pytest.mark.slow
def test_a_strong_prediction_is_found_over_experiments_and_none_without(load: Any) -> None:
    benchmark = load("prediction_over_experiments")
    none, one_way = (benchmark.store_of(0, 30, coupling) for coupling in ("none", "one way"))
    assert set(none[0]["channel"]) == {"signal → velocity", "velocity → signal"}
    assert benchmark.against_zero(0, 4, 6, none)["score above"] <= 1
    assert benchmark.against_zero(0, 4, 6, one_way)["score, true link"] >= 1

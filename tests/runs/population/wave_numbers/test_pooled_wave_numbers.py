import numpy as np
import pandas as pd
import pytest

from cytodisk.runs.population.pooling.pool_parameters import PoolParameters
from cytodisk.runs.population.pooling.pooled_population import Pooled
from cytodisk.runs.population.wave_numbers.pooled_wave_numbers import pool_waves, wave_numbers


def waves_of(p: float, period: float, rng: np.random.Generator) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Tables of waves of a study with two cells, of velocity."""
    cells = pd.DataFrame(
        {
            "cell": [0, 1],
            "status": "ok",
            "layer": [np.nan, np.nan],
        }
    )
    cells = cells.assign(
        kind="rotating" if p < 0.05 else "none",
        period_s=period + rng.normal(size=2),
        speed_um_s=[0.1, -0.1] + 0.01 * rng.normal(size=2),
        direction=[0.9, -0.9],  # the same size in all
        persistence_s=200.0 + rng.normal(size=2),
        order=(2.0 if p < 0.05 else 0.0) + 0.5 * rng.normal(size=2),
        p=np.clip(p + 0.2 * p * rng.normal(size=2), 0.001, 1.0),
    )
    return cells, cells[["cell", "layer", "order", "p"]]


def pooled(conditions: dict[str, tuple[float, float]], experiments: int = 6) -> Pooled:
    rng = np.random.default_rng(0)
    numbers, table = [], []
    for condition, (p, period) in conditions.items():
        for experiment in range(experiments):
            name = f"{condition} {experiment}"
            cells, layers = waves_of(p, period, rng)
            numbers.append(wave_numbers(cells, layers).assign(input=name))
            table.append(cells.assign(input=name, condition=condition, experiment=name))
    return pool_waves(pd.concat(numbers), pd.concat(table, ignore_index=True), PoolParameters())


def test_waves_are_found_and_their_numbers_are_means_over_experiments_without_sign() -> None:
    found = pooled({"cells": (0.01, 90.0)})
    means = found.tables["pooled"].set_index("number")
    assert means.loc["wave_order", "p_fwer"] == 2 / 2**6
    assert means.loc["wave_speed_um_s", "mean"] == pytest.approx(0.1, abs=0.01)
    assert means.loc["wave_direction", "mean"] == pytest.approx(0.9)
    assert means.loc["wave_period_s", "low"] < 90.0 < means.loc["wave_period_s", "high"]
    assert means.loc["wave_period_s", "unit"] == "s"
    assert means["p_fwer"].notna().sum() == 1  # a speed is never 0 by chance
    words = found.sentences[0]
    assert words.startswith("cells: There are waves beyond chance (mean order 2.")
    assert "12 of 12 cells have one by themselves: 12 rotating" in words
    assert "period 90 s (95 % interval" in words


def test_a_cell_whose_p_is_just_reached_has_a_wave_as_in_its_own_study() -> None:
    cells, layers = waves_of(0.01, 90.0, np.random.default_rng(0))
    found = wave_numbers(cells.assign(p=0.05, kind=["rotating", "none"]), layers)
    assert found.loc[found["channel"] == "wave_period_s", "cell"].tolist() == [0]


def test_without_waves_their_speed_does_not_count() -> None:
    found = pooled({"cells": (0.5, 90.0)})
    assert set(found.tables["pooled"]["number"]) == {"wave_order"}
    assert "There are no waves beyond chance" in found.sentences[0]
    assert "0 of 12 cells" in found.sentences[0]


def test_conditions_are_compared_by_all_numbers_and_a_constant_one_does_no_harm() -> None:
    found = pooled({"control": (0.01, 90.0), "drug": (0.001, 120.0)}, experiments=5)
    compared = found.tables["comparisons"].set_index("number")
    assert compared.loc["wave_period_s", "difference"] == pytest.approx(30.0, abs=2.0)
    assert compared.loc["wave_period_s", "p_holm"] <= 0.05
    (words,) = [one for one in found.sentences if one.startswith("drug differs from control")]
    assert "period, drug less control 30 s" in words


def test_numbers_that_one_condition_lacks_are_told_as_numbers_not_as_windows() -> None:
    found = pooled({"control": (0.5, 90.0), "drug": (0.01, 90.0)})
    (one,) = (one for one in found.warnings if one["name"] == "numbers not tested")
    assert one["finding"] == "4 of 5 numbers of waves have no value in too many experiments."
    assert "window" not in " ".join(map(str, one.values()))

"""Comparisons of conditions agree with hierarch's permutations of whole experiments."""

import numpy as np
import pandas as pd
import pytest
from plain_population import cell_scalars, compared

import cytodisk as cd

hierarch_stats = pytest.importorskip("hierarch.stats", reason="hierarch is not installed")


def rows_of(population: cd.Population, name: str) -> np.ndarray:
    """Condition, experiment, cell and value of each cell, as hierarch reads them."""
    cells = population.cells
    return np.column_stack(
        [
            (cells["condition"] == "drug").to_numpy(float),
            pd.factorize(cells["condition"] + cells["experiment"])[0],
            np.arange(len(cells)),
            population.scalar_table()[name].to_numpy(),
        ]
    )


def test_all_permutations_of_experiments_give_the_same_p() -> None:
    for seed in range(3):
        case = compared((5, 5), paired=False, seed=seed)
        table = case.found.scalars.set_index("scalar")
        for name in table.index:
            rows = rows_of(case.population, name)
            p = hierarch_stats.hypothesis_test(rows, 0, compare="means", bootstraps=1, permutations="all")
            assert table.loc[name, "p"] == pytest.approx(p, abs=1e-10)


def test_drawn_permutations_give_the_same_p_within_their_error() -> None:
    case = compared((8, 8), paired=False, effect=0.5)
    drawn = 1999
    found = cd.compare_conditions(case.population, "control", "drug", permutations=drawn, seed=4)
    table = found.scalars.set_index("scalar")
    for name in table.index:
        control, drug = cell_scalars(case.population, name)
        means = np.column_stack([np.repeat([0.0, 1.0], 8), np.arange(16), np.concatenate([control, drug])])
        p = hierarch_stats.hypothesis_test(means, 0, compare="means", bootstraps=1, permutations="all")
        assert table.loc[name, "p"] == pytest.approx(
            p, abs=4.0 * np.sqrt(p * (1.0 - p) / drawn) + 1.0 / drawn
        )

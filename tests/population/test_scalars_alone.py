"""Cells without windows, such as those of `shapes`: what is compared are their scalars."""

import numpy as np
import pandas as pd
import pytest

import cytodisk as cd


@pytest.mark.parametrize("unit", ["experiment", "cell"])
def test_scalars_are_compared_where_there_are_no_windows(unit: str) -> None:
    rng = np.random.default_rng(0)
    cells = pd.DataFrame(
        {
            "condition": np.repeat(["control", "drug"], 20),
            "experiment": np.repeat([f"dish {number}" for number in range(8)], 5),
            "area": rng.normal(10.0, 1.0, 40) + np.repeat([0.0, 5.0], 20),
            "solidity": rng.normal(0.5, 0.1, 40),
        }
    )
    pop = cd.Population(None, cells, scalars=["area", "solidity"])
    found = cd.compare_conditions(pop, "control", "drug", unit=unit, permutations=199)
    p = found.scalars.set_index("scalar")["p_fwer"]
    assert p["area"] < 0.05 < p["solidity"]
    assert found.windows["p"].size == 0
    assert found.clusters.empty

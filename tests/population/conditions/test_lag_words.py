import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.population.conditions.condition_comparison import compare_conditions
from cytodisk.population.conditions.window_words import lags_of
from cytodisk.population.population import Population


def test_places_along_a_curve_are_told_as_lags() -> None:
    lags = np.arange(-4, 5) * 2.5
    assert lags_of(np.array([0, 1, 2]), lags, "s") == "−10 to −5 s"
    assert lags_of(np.array([4, 6, 7]), lags, "s") == "0 s, 5 to 7.5 s"


def test_a_cluster_of_a_curve_says_its_lags() -> None:
    rng = np.random.default_rng(0)
    lags = xr.DataArray(5.0 * np.arange(-4, 5), dims="lag", attrs={"units": "s"})
    values = xr.DataArray(rng.normal(size=(12, 1, 9)), dims=("cell", "layer", "lag"), coords={"lag": lags})
    values[6:, 0, 5:8] += 6.0
    cells = pd.DataFrame({"condition": ["control"] * 6 + ["drug"] * 6, "experiment": [*"abcdefghijkl"]})
    found = compare_conditions(Population(values, cells), "control", "drug")
    assert found.clusters["sectors"].iloc[0] == "5 to 15 s"
    assert "lags 5 to 15 s" in " ".join(found.sentences)

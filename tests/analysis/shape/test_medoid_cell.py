import numpy as np
import pandas as pd
import pytest

from cytodisk.analysis.shape.medoid_cell import medoid_cell
from cytodisk.errors import ParameterError


def test_the_cell_in_the_middle_is_chosen_among_outliers() -> None:
    values = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 500.0])
    features = pd.DataFrame({"circularity": values, "solidity": values[::-1] * 0.0})
    assert medoid_cell(features) in (2, 3)
    order = np.random.default_rng(0).permutation(6)
    assert medoid_cell(features.iloc[order]) == medoid_cell(features.iloc[order].reset_index(drop=True))


def test_it_does_not_depend_on_units() -> None:
    rng = np.random.default_rng(1)
    features = pd.DataFrame(rng.normal(size=(50, 2)), columns=["circularity", "area"])
    assert medoid_cell(features) == medoid_cell(features * [1.0, 1e6])
    away = np.square(features - features.median()).sum(axis=1)
    assert away[medoid_cell(features)] < np.median(away)


def test_rows_without_numbers_are_left_out() -> None:
    features = pd.DataFrame({"area": [np.nan, 1.0, np.nan], "circularity": [np.nan, 1.0, np.nan]})
    assert medoid_cell(features) == 1
    with pytest.raises(ParameterError, match="no row with a number"):
        medoid_cell(features * np.nan)
    with pytest.raises(ParameterError, match="no column 'roundness'"):
        medoid_cell(features, columns=["roundness"])
    with pytest.raises(ParameterError, match="no feature of shape"):
        medoid_cell(features[[]])

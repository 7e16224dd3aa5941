"""Several conditions against a control: corrected for all of them."""

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.population.conditions.with_control import holm


def test_a_family_counts_until_all_of_its_members_are_rejected() -> None:
    found = holm({"a": np.array([[0.001, 0.02]]), "b": np.array([0.03, np.nan]), "c": np.array([0.5])})
    np.testing.assert_allclose(found["a"], [[0.003, 0.06]])
    np.testing.assert_allclose(found["b"], [0.06, np.nan])  # all of a are rejected before
    np.testing.assert_allclose(found["c"], [0.5])


def test_a_condition_without_clusters_counts_in_the_correction_of_clusters() -> None:
    truth = cd.simulate.population(
        0, conditions=("DMSO", "a", "b"), experiments=4, cells=3, effect=(0.0, 0.0, 3.0)
    )
    found = cd.compare_with_control(cd.Population(truth.values, truth.cells), "DMSO")
    assert found["a"].clusters.empty
    first = found["b"].clusters.iloc[0]
    assert (first["p"], first["p_holm"]) == pytest.approx((2 / 70, 4 / 70))

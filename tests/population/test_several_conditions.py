"""Several conditions against a control: corrected for all of them."""

import numpy as np

from cytodisk.population.conditions.with_control import holm


def test_a_family_counts_until_all_of_its_members_are_rejected() -> None:
    found = holm({"a": np.array([[0.001, 0.02]]), "b": np.array([0.03, np.nan]), "c": np.array([0.5])})
    np.testing.assert_allclose(found["a"], [[0.003, 0.06]])
    np.testing.assert_allclose(found["b"], [0.06, np.nan])  # all of a are rejected before
    np.testing.assert_allclose(found["c"], [0.5])

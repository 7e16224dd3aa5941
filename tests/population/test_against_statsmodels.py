"""Comparisons of conditions agree with statsmodels: Holm, false discovery rate, effect sizes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from plain_population import compared

from cytodisk.population.conditions.with_control import holm

multitest = pytest.importorskip("statsmodels.stats.multitest", reason="statsmodels is not installed")
meta_analysis = pytest.importorskip("statsmodels.stats.meta_analysis", reason="statsmodels is not installed")


def test_q_values_are_those_of_multipletests() -> None:
    windows = compared((5, 5), paired=False).found.windows
    expected = multitest.multipletests(windows["p"].to_numpy().ravel(), method="fdr_bh")[1]
    assert_allclose(windows["q"].to_numpy().ravel(), expected, rtol=0, atol=1e-12)


def test_effect_sizes_are_those_of_effectsize_smd() -> None:
    case = compared((4, 6), paired=False)
    drug, control = (
        (values.mean(axis=0), values.std(axis=0, ddof=1), len(values)) for values in (case.drug, case.control)
    )
    expected, variance = meta_analysis.effectsize_smd(*drug, *control)
    windows = case.found.windows
    assert_allclose(windows["effect_size"], expected, rtol=3e-3)  # it approximates Hedges' factor
    half = 0.5 * (windows["high"] - windows["low"]).to_numpy()
    assert_allclose(half, 1.96 * np.sqrt(variance), rtol=0.12)  # by a normal distribution


def test_families_of_one_are_corrected_by_holm() -> None:
    p = np.array([0.03, 0.001, 0.2, 0.013, 0.9])
    found = holm({str(k): one[None] for k, one in enumerate(p)})
    expected = multitest.multipletests(p, method="holm")[1]
    assert_allclose(np.concatenate(list(found.values())), expected, rtol=0, atol=1e-12)

"""Studentised differences against plain formulas, and where values are missing or do not vary."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import ttest_1samp, ttest_ind

from cytodisk.population.exchange.column_moments import column_moments
from cytodisk.population.exchange.dose_exchanges import DoseSlope
from cytodisk.population.exchange.exchange_test import exchange_test
from cytodisk.population.exchange.exchanges import LabelExchanges
from cytodisk.population.exchange.studentised import GroupDifference, PairDifference

TREATED = np.array([False, True, False, True, True, False, True])


@pytest.fixture
def values() -> np.ndarray:
    return np.random.default_rng(0).normal(5.0, 1.0, (7, 4))


def test_groups_have_the_score_of_welch(values: np.ndarray) -> None:
    expected = ttest_ind(values[TREATED], values[~TREATED], equal_var=False).statistic
    assert_allclose(GroupDifference(values, TREATED).scores(TREATED[None])[0], expected)


def test_a_missing_value_is_left_out(values: np.ndarray) -> None:
    values[1, 2] = np.nan
    expected = ttest_ind(values[TREATED], values[~TREATED], equal_var=False, nan_policy="omit").statistic
    statistic = GroupDifference(values, TREATED)
    assert statistic.testable.all()
    assert_allclose(statistic.scores(TREATED[None])[0], expected)


def test_windows_that_few_units_have_are_not_tested(values: np.ndarray) -> None:
    values[:2, 1] = np.nan
    statistic = GroupDifference(values, TREATED)
    assert statistic.testable.tolist() == [True, False, True, True]
    found = exchange_test(statistic, LabelExchanges(TREATED, 99, 0))
    assert np.isnan([found.p[1], found.p_fwer[1], found.q[1]]).all()
    assert np.isfinite(found.p_fwer[[0, 2, 3]]).all()


def test_pairs_have_the_score_of_a_paired_t_test(values: np.ndarray) -> None:
    assert_allclose(PairDifference(values).scores(np.ones((1, 7)))[0], ttest_1samp(values, 0.0).statistic)


def test_slopes_have_the_score_of_a_line(values: np.ndarray) -> None:
    doses = np.array([0.0, 1, 2, 3, 0, 1, 2])
    design = np.stack([np.ones(7), doses], axis=1)
    fit, rest, *_ = np.linalg.lstsq(design, values, rcond=None)
    error = np.sqrt(rest / 5 * np.linalg.inv(design.T @ design)[1, 1])
    found = DoseSlope(values, doses, np.zeros(7, dtype=np.int64)).scores(doses[None])[0]
    assert_allclose(found, fit[1] / error)


@pytest.mark.parametrize("level", [0.0, 1e6])
def test_values_that_do_not_vary_do_not_differ(level: float) -> None:
    values = np.full((7, 2), level)
    assert_allclose(GroupDifference(values, TREATED).scores(TREATED[None]), 0.0)
    found = exchange_test(GroupDifference(values, TREATED), LabelExchanges(TREATED, 99, 0))
    assert_allclose(found.p, 1.0)


def test_groups_that_differ_without_any_spread_have_the_smallest_p() -> None:
    values = np.where(TREATED, 2.0, 1.0)[:, None]
    exchanges = LabelExchanges(TREATED, 99, 0)
    assert exchange_test(GroupDifference(values, TREATED), exchanges).p[0] == exchanges.smallest_p


def test_moments_of_many_rows_are_those_of_all_at_once() -> None:
    values = np.random.default_rng(0).normal(1e3, 1.0, (9001, 3))
    values[::7, 1] = np.nan
    chosen = np.arange(9001) % 3 > 0
    found = column_moments(values, chosen)
    assert_allclose(found.mean, np.nanmean(values[chosen], axis=0))
    assert_allclose(found.variance, np.nanvar(values[chosen], axis=0, ddof=1))


def test_a_large_region_makes_nothing_of_windows_beside_it() -> None:
    """The shared error is one for all exchanges: windows beside keep their level, however many differ."""
    rng = np.random.default_rng(1)
    treated = np.repeat([False, True], 5)
    found = 0
    for _ in range(200):
        values = rng.normal(size=(10, 20))
        values[5:, :14] += 6.0
        statistic = GroupDifference(values, treated, np.zeros(20, dtype=np.int64))
        p = exchange_test(statistic, LabelExchanges(treated, 251, 0)).p_fwer
        assert (p[:14] <= 0.05).mean() > 0.9
        found += bool((p[14:] <= 0.05).any())
    assert found <= 200 * 0.05 + 3 * np.sqrt(200 * 0.05 * 0.95)


def test_windows_are_chosen_without_regard_to_labels() -> None:
    """A window that one condition alone has is not told, and yet it counts in the largest score of all."""
    rng = np.random.default_rng(4)
    treated = np.repeat([False, True], [3, 9])
    values = rng.normal(size=(12, 4))
    values[:2, 3] = np.nan  # one control is left: no score as labels are, but with most others
    statistic = GroupDifference(values, treated)
    assert statistic.testable.tolist() == [True] * 4
    found = exchange_test(statistic, LabelExchanges(treated, 999, 0))
    assert np.isnan([found.p[3], found.p_fwer[3], found.q[3], found.scores[3]]).all()
    ways = np.concatenate(list(LabelExchanges(treated, 999, 0).chunks(64)))
    scores = np.zeros((len(ways), 4))
    for way, labels in enumerate(ways):
        for window in range(4):
            groups = [values[chosen, window] for chosen in (labels, ~labels)]
            known = [group[np.isfinite(group)] for group in groups]
            if min(map(len, known)) > 1:
                error = sum(group.var(ddof=1) / len(group) for group in known)
                scores[way, window] = abs(known[0].mean() - known[1].mean()) / np.sqrt(error)
    reach = scores[0] * (1 - 1e-9)
    order = np.argsort(-scores[0])
    stepped = [(scores[:, order[k:]].max(axis=1) >= reach[order[k]]).mean() for k in range(3)]
    assert_allclose(found.p_fwer[order[:3]], np.maximum.accumulate(stepped), rtol=0, atol=1e-12)

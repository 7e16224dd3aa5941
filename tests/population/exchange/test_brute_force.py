"""p-values of paired windows and of trends within experiments, by plain loops over all ways."""

from itertools import permutations, product

import numpy as np
from numpy.testing import assert_allclose

from cytodisk.arrays import FloatArray
from cytodisk.population.exchange.dose_exchanges import DoseExchanges, DoseSlope
from cytodisk.population.exchange.effect_intervals import group_effects, pair_effects
from cytodisk.population.exchange.exchange_test import ExchangeTest, exchange_test
from cytodisk.population.exchange.exchanges import SignExchanges
from cytodisk.population.exchange.studentised import PairDifference


def step_down(scores: FloatArray) -> FloatArray:
    """Westfall and Young's p from scores (ways, windows), those as observed first."""
    order = np.argsort(-scores[0])
    reach = scores[0, order] * (1 - 1e-9)
    stepped = [(scores[:, order[k:]].max(axis=1) >= reach[k]).mean() for k in range(len(order))]
    found = np.empty(len(order))
    found[order] = np.maximum.accumulate(stepped)
    return found


def check(found: ExchangeTest, scores: FloatArray) -> None:
    assert_allclose(np.abs(found.scores), scores[0], rtol=1e-9)
    assert_allclose(found.p, (scores >= scores[0] * (1 - 1e-9)).mean(axis=0), rtol=0, atol=1e-12)
    assert_allclose(found.p_fwer, step_down(scores), rtol=0, atol=1e-12)


def test_pairs_some_of_which_lack_a_window() -> None:
    differences = np.random.default_rng(3).normal(0.8, 1.0, (7, 5))
    differences[2, 1] = differences[5, 4] = np.nan
    known = [column[np.isfinite(column)] for column in differences.T]
    shared = np.median([(column**2).sum() / len(column) ** 2 for column in known])
    scores = []
    for signs in product((1.0, -1.0), repeat=7):
        turned = differences * np.array(signs)[:, None]
        columns = [column[np.isfinite(column)] for column in turned.T]
        error = np.array([column.var(ddof=1) / len(column) for column in columns])
        means = np.abs([column.mean() for column in columns])
        scores.append(means / np.sqrt(0.5 * (error + shared)))
    statistic = PairDifference(differences, np.zeros(5, dtype=np.int64))
    check(exchange_test(statistic, SignExchanges(7, 999, 0)), np.array(scores))


def test_trends_within_experiments() -> None:
    rng = np.random.default_rng(5)
    doses, blocks = np.tile([0.0, 1.0, 10.0], 4), np.repeat(np.arange(4), 3)
    values = rng.normal(size=(12, 4)) + np.repeat(rng.normal(0.0, 9.0, 4), 3)[:, None]
    values[:, 0] += 0.2 * doses
    levels = np.eye(4)[blocks]  # each experiment has its own level
    left = values - levels @ np.linalg.lstsq(levels, values, rcond=None)[0]
    centred = np.array([0.0, 1.0, 10.0]) - 11.0 / 3.0
    spread = 4 * (centred**2).sum()
    shared = np.median((left**2).sum(axis=0) / (12 - 4)) / spread
    scores = []
    for orders in product(permutations([0.0, 1.0, 10.0]), repeat=4):
        design = np.column_stack([np.concatenate(orders), levels])
        fit, rest, *_ = np.linalg.lstsq(design, values, rcond=None)
        scores.append(np.abs(fit[0]) / np.sqrt(0.5 * (rest / (12 - 5) / spread + shared)))
    statistic = DoseSlope(values, doses, blocks, np.zeros(4, dtype=np.int64))
    found = exchange_test(statistic, DoseExchanges(doses, blocks, 1999, 0))
    check(found, np.array(scores))


def test_the_effect_size_of_pairs_is_over_the_spread_of_the_conditions() -> None:
    rng = np.random.default_rng(6)
    control = rng.normal(5.0, 2.0, (8, 1))
    treated = control + rng.normal(1.0, 0.5, (8, 1))
    found = pair_effects(control, treated)
    spread = np.sqrt((control.var(ddof=1) + treated.var(ddof=1)) / 2)
    difference = (treated - control).mean()
    bias = 1 - 3 / (4 * 7 - 1)  # Hedges' own approximation, within 1e-3 of the factor
    assert_allclose(found["effect_size"], difference / spread * bias, rtol=2e-3)
    assert found["low"][0] < found["effect_size"][0] < found["high"][0]


def test_groups_that_hardly_vary_have_an_interval_at_once() -> None:
    """Ends of the noncentral t go over into those of the chi distribution, for both signs."""
    treated = np.repeat([False, True], 4)
    values = np.tile(np.arange(4.0), 2)[:, None] * np.array([3.4e-3, 3.3e-3, 1e-9, 1e-11])
    values = values + 2.0 * treated[:, None]
    up, down = group_effects(values, treated), group_effects(-values, treated)
    for name, other in (("low", "high"), ("high", "low")):
        share = up[name] / up["effect_size"]
        assert_allclose(share, share[0], rtol=1e-3)
        assert_allclose(up[name], -down[other], rtol=1e-3)
    assert (up["low"] < up["effect_size"]).all()
    assert (up["effect_size"] < up["high"]).all()


def test_what_rounding_leaves_of_no_spread_gives_no_effect_size() -> None:
    treated = np.repeat([False, True], 5)
    values = np.where(treated, 0.7, 0.1)[:, None] + 1e-17 * np.arange(10.0)[:, None]
    values[0] = 0.1 * 3 - 0.2  # 0.1 but for rounding
    found = group_effects(values, treated)
    assert np.isnan(found["effect_size"][0])
    assert np.isnan(found["difference_low"][0])
    assert abs(found["difference"][0] - 0.6) < 1e-12

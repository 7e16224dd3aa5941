from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import pearsonr

from cytodisk.analysis.correlation.lagged import LaggedSeries
from cytodisk.analysis.correlation.prepared_series import standardised
from cytodisk.analysis.pairs.pair_blocks import (
    DistanceBins,
    Distribution,
    correlation_blocks,
    distributions,
    mean_by_bin,
)

NAN = np.nan


def noise(seed: int, *shape: int, missing: float = 0.0) -> Any:
    random = np.random.default_rng(seed)
    values = random.normal(size=shape)
    values[random.random(shape) < missing] = NAN
    return standardised(values)


def whole_table(a: Any, b: Any, lag: int, least: int = 4) -> Any:
    """Correlations of all blocks under each other."""
    table = np.full((a.shape[1], b.shape[1]), 99.0)
    for rows, found in correlation_blocks(a, b, lag, least):
        assert found.shape == (rows.stop - rows.start, b.shape[1])
        table[rows] = found
    return table


@pytest.mark.parametrize("lag", [-7, -1, 0, 3])
@pytest.mark.parametrize(("in_a", "in_b"), [(0.0, 0.0), (0.2, 0.0), (0.0, 0.2), (0.2, 0.2)])
def test_every_pair_is_scipys_correlation(lag: int, in_a: float, in_b: float) -> None:
    a, b = noise(0, 25, 4, missing=in_a), noise(1, 25, 3, missing=in_b)
    found = whole_table(a, b, lag)
    for i, k in np.ndindex(4, 3):
        x, y = a[max(0, -lag) : 25 - max(0, lag), i], b[max(0, lag) : 25 + min(0, lag), k]
        both = np.isfinite(x * y)
        assert found[i, k] == pytest.approx(pearsonr(x[both], y[both])[0], abs=1e-12)


@pytest.mark.parametrize("windows", [255, 256, 257, 600])
def test_blocks_cover_all_rows_once(windows: int) -> None:
    a, b = noise(2, 12, windows), noise(3, 12, 5)
    blocks = list(correlation_blocks(a, b, 1, 4))
    assert [rows.start for rows, _ in blocks] == list(range(0, windows, 256))
    assert blocks[-1][0].stop == windows
    expected = np.corrcoef(a[:-1].T, b[1:].T)[:windows, windows:]
    np.testing.assert_allclose(whole_table(a, b, 1), expected, atol=1e-12)


@given(st.integers(0, 1000), st.integers(-6, 6))
def test_gaps_of_one_series_change_nothing_for_others(seed: int, lag: int) -> None:
    a, b = noise(seed, 20, 4), noise(seed + 1, 20, 3)
    a[5], b[[0, 19]] = NAN, NAN  # the same gaps in all: products of unit columns
    alone = whole_table(a, b, lag)
    gap = np.concatenate([a, noise(seed + 2, 20, 1, missing=0.3)], axis=1)  # sums over pairs
    np.testing.assert_allclose(whole_table(gap, b, lag)[:-1], alone, atol=1e-12)
    np.testing.assert_allclose(alone, LaggedSeries(a, np.array([lag])).correlate(b, 4)[0][0], atol=1e-12)


@pytest.mark.parametrize("extra", [0.0, 0.3])
def test_constants_and_too_few_pairs(extra: float) -> None:
    a = np.concatenate([noise(4, 20, 2), np.zeros((20, 1)), noise(5, 20, 1, missing=extra)], axis=1)
    b = noise(6, 20, 2)
    found = whole_table(a, b, 0)
    assert np.isnan(found[2]).all()
    assert np.isfinite(found[[0, 1, 3]]).all()
    assert np.isnan(whole_table(a, b, 12, least=9)).all()
    assert np.isfinite(whole_table(a, b, 12, least=8)[:2]).all()
    assert np.isnan(whole_table(np.full((20, 2), NAN), b, 0)).all()


def test_bins_hold_their_upper_edge() -> None:
    edges = np.array([0.0, 1.0, 2.0, 3.0])
    distances = np.array([[0.0, 1e-9, 1.0], [1.0000001, 2.0, 3.0]])
    assert DistanceBins.of(distances, edges).number.tolist() == [[0, 1, 1], [2, 2, 3]]
    assert DistanceBins.of(distances, edges).count == 4


@pytest.mark.parametrize("missing", [0.0, 0.2])
def test_distribution_is_that_of_all_pairs(missing: float) -> None:
    random = np.random.default_rng(7)
    distances = random.uniform(0.0, 10.0, (300, 300)) * (random.random((300, 300)) < 0.9)
    bins = DistanceBins.of(distances, np.linspace(0.0, 10.0, 5))
    other = DistanceBins.of(10.0 - distances, np.linspace(0.0, 10.0, 5))
    a, b = noise(8, 18, 300, missing=missing), noise(9, 18, 300)
    lags = np.array([-2, 0, 5])
    steps: list[int] = []
    found = distributions(a, b, lags, 6, [bins, other], lambda: steps.append(1))
    means = mean_by_bin(a, b, lags, 6, [bins, other], lambda: steps.append(1))
    assert len(steps) == 6
    assert found["n"].shape == (2, 5, 3)
    for (i, kind), (k, lag) in ((x, y) for x in enumerate([bins, other]) for y in enumerate(lags.tolist())):
        table = whole_table(a, b, lag, 6)
        for number in range(5):
            values = table[(kind.number == number) & np.isfinite(table)]
            at = {name: found[name][i, number, k] for name in found}
            assert at["n"] == len(values)
            if not len(values):
                assert np.isnan(
                    [at["correlation"], at["sd"], at["lower_quartile"], means[i, number, k]]
                ).all()
                continue
            assert at["correlation"] == pytest.approx(values.mean(), abs=1e-12)
            assert means[i, number, k] == pytest.approx(values.mean(), abs=1e-12)
            assert at["sd"] == pytest.approx(values.std(), abs=1e-9)
            for name, share in (("lower_quartile", 0.25), ("upper_quartile", 0.75)):
                assert at[name] == pytest.approx(np.quantile(values, share, method="inverted_cdf"), abs=0.005)


def test_distribution_of_known_values() -> None:
    distribution = Distribution(
        DistanceBins.of(np.array([[0.0, 1.0, 1.0, 1.0, 1.0]]), np.array([0.0, 1.0, 2.0]))
    )
    distribution.add(slice(0, 1), np.array([[1.0000001, -0.5, 0.0, 0.5, NAN]]))
    found = distribution.summary()
    np.testing.assert_array_equal(found["n"], [1, 3, 0])
    np.testing.assert_allclose(found["correlation"], [1.0, 0.0, NAN], atol=1e-6)
    np.testing.assert_allclose(found["sd"], [0.0, np.sqrt(0.5 / 3.0), NAN], atol=1e-6)
    np.testing.assert_allclose(found["lower_quartile"], [1.0, -0.5, NAN])
    np.testing.assert_allclose(found["upper_quartile"], [1.0, 0.5, NAN])

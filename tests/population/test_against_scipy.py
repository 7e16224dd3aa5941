"""Comparisons of conditions agree with SciPy's permutations, intervals, corrections and labels."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from plain_population import LAYERS, SECTORS, Compared, cell_scalars, compared
from scipy import ndimage, stats

from cytodisk.arrays import FloatArray, IntArray

DESIGNS = [((5, 5), False), ((4, 6), False), (7, True)]
TAIL = 0.01  # beyond which scores join clusters


@pytest.fixture(scope="module", params=DESIGNS, ids=["5 + 5", "4 + 6", "7 pairs"])
def case(request: pytest.FixtureRequest) -> Compared:
    return compared(*request.param)


def welch(control: FloatArray, drug: FloatArray, axis: int, shared: FloatArray | float) -> FloatArray:
    """Size of the difference over its standard error, half of whose square may be shared by all windows."""
    own = sum(one.var(axis=axis, ddof=1) / one.shape[axis] for one in (control, drug))
    error = own if shared is None else 0.5 * (own + shared)
    return np.asarray(np.abs(drug.mean(axis=axis) - control.mean(axis=axis)) / np.sqrt(error))


def of_pairs(control: FloatArray, drug: FloatArray, axis: int, shared: FloatArray | float) -> FloatArray:
    difference = drug - control
    own = difference.var(axis=axis, ddof=1) / difference.shape[axis]
    error = own if shared is None else 0.5 * (own + shared)
    return np.asarray(np.abs(difference.mean(axis=axis)) / np.sqrt(error))


def permuted(control: FloatArray, drug: FloatArray, paired: bool, shared: float | None = None) -> FloatArray:
    """SciPy's p, the observed scores, and those of all exchanges, one after the other."""
    statistic: Callable[..., FloatArray] = of_pairs if paired else welch
    result = stats.permutation_test(
        (control, drug),
        lambda first, second, axis: statistic(first, second, axis, shared),
        permutation_type="samples" if paired else "independent",
        n_resamples=np.inf,
        alternative="greater",
        vectorized=True,
    )
    return np.concatenate([result.pvalue[None], result.statistic[None], result.null_distribution])


def shared_error(case: Compared, paired: bool) -> float:
    """Median over the windows of the squared error without regard to labels."""
    if paired:
        squares = ((case.drug - case.control) ** 2).mean(axis=0) / len(case.control)
        return float(np.median(squares))
    together = np.concatenate([case.control, case.drug]).var(axis=0, ddof=1)
    return float(np.median(together) * (1.0 / len(case.control) + 1.0 / len(case.drug)))


def is_paired(case: Compared) -> bool:
    return case.found.design == "paired"


def test_scalars_have_the_p_values_of_all_permutations(case: Compared) -> None:
    table = case.found.scalars.set_index("scalar")
    for name in table.index:
        control, drug = cell_scalars(case.population, name)
        p = permuted(control, drug, is_paired(case))[0]
        assert table.loc[name, "p"] == pytest.approx(float(p), abs=1e-10)


def test_windows_have_the_p_values_of_all_permutations_alone_and_together(case: Compared) -> None:
    paired = is_paired(case)
    p, observed, *ways = permuted(case.control, case.drug, paired, shared_error(case, paired))
    windows = case.found.windows
    assert_allclose(windows["p"], p, rtol=0, atol=1e-10)
    assert_allclose(np.abs(windows["score"]), observed, rtol=1e-10)
    order = np.argsort(-observed.ravel())
    null = np.stack(ways).reshape(len(ways), -1)[:, order]
    reach = observed.ravel()[order] * (1.0 - 1e-9)
    stepped = [(null[:, k:].max(axis=1) >= reach[k]).mean() for k in range(len(order))]
    expected = np.empty(len(order))
    expected[order] = np.maximum.accumulate(stepped)
    assert_allclose(windows["p_fwer"].to_numpy().ravel(), expected, rtol=0, atol=1e-10)


def test_q_values_are_those_of_benjamini_and_hochberg(case: Compared) -> None:
    for found in (case.found.windows, case.found.scalars.to_xarray()):
        expected = stats.false_discovery_control(found["p"].to_numpy().ravel())
        assert_allclose(found["q"].to_numpy().ravel(), expected, rtol=0, atol=1e-12)


def test_differences_have_the_intervals_of_t_tests(case: Compared) -> None:
    if is_paired(case):
        result = stats.ttest_rel(case.drug, case.control)
    else:
        result = stats.ttest_ind(case.drug, case.control, equal_var=False)
    interval, windows = result.confidence_interval(0.95), case.found.windows
    assert_allclose(windows["difference"], case.drug.mean(axis=0) - case.control.mean(axis=0), rtol=1e-10)
    assert_allclose(windows["difference_low"], interval.low, rtol=0, atol=1e-10)
    assert_allclose(windows["difference_high"], interval.high, rtol=0, atol=1e-10)
    name = "mean_" + case.population.channels[0]
    control, drug = cell_scalars(case.population, name)
    row = case.found.scalars.set_index("scalar").loc[name]
    test = (
        stats.ttest_rel(drug, control) if is_paired(case) else stats.ttest_ind(drug, control, equal_var=False)
    )
    assert_allclose(
        [row["difference_low"], row["difference_high"]], test.confidence_interval(0.95), atol=1e-10
    )


def test_ends_of_an_effect_size_have_the_tails_of_the_noncentral_t(case: Compared) -> None:
    paired, windows = is_paired(case), case.found.windows
    n = len(case.control)
    degrees = n - 1 if paired else len(case.control) + len(case.drug) - 2
    if paired:
        score = stats.ttest_rel(case.drug, case.control).statistic
        error = (case.drug - case.control).std(axis=0, ddof=1) / np.sqrt(n)
        spread = np.sqrt(0.5 * (case.control.var(axis=0, ddof=1) + case.drug.var(axis=0, ddof=1)))
        per_score = error / spread
    else:
        score = stats.ttest_ind(case.drug, case.control).statistic
        per_score = np.sqrt(1.0 / n + 1.0 / len(case.drug))
    factor = windows["effect_size"].to_numpy() / (score * per_score)  # Hedges', the same for all
    assert_allclose(factor, 1.0 - 3.0 / (4.0 * degrees - 1.0), rtol=3e-3)
    for end, tail in (("low", 0.975), ("high", 0.025)):
        noncentral = windows[end].to_numpy() / (factor * per_score)
        assert_allclose(stats.nct.cdf(score, degrees, noncentral), tail, atol=1e-5)


def labelled(beyond: np.ndarray) -> IntArray:
    """Clusters of windows that share a side, with the last sector beside the first."""
    twice = ndimage.label(np.concatenate([beyond, beyond], axis=-1))[0]
    labels = np.where(beyond, twice[:, : beyond.shape[1]], 0)
    for layer in range(len(beyond)):  # across sector 0
        if beyond[layer, 0] and beyond[layer, -1]:
            labels[labels == labels[layer, -1]] = labels[layer, 0]
    return np.asarray(labels)


def cluster_masses(scores: FloatArray, threshold: float) -> list[tuple[float, IntArray]]:
    """Sums of what lies beyond the threshold, and the windows, of each cluster of either sign."""
    found = []
    for sign in (1.0, -1.0):
        labels = labelled(sign * scores > threshold)
        for number in np.unique(labels[labels > 0]):
            inside = labels == number
            found.append((float((sign * scores - threshold)[inside].sum()), np.flatnonzero(inside)))
    return sorted(found, key=lambda one: -one[0])


def signed_ways(case: Compared, paired: bool) -> FloatArray:
    """Signed scores (ways, layers, sectors) for all exchanges."""
    shared = shared_error(case, paired)

    def statistic(first: FloatArray, second: FloatArray, axis: int) -> FloatArray:
        sizes = (of_pairs if paired else welch)(first, second, axis, shared)
        return sizes * np.sign(second.mean(axis=axis) - first.mean(axis=axis))

    result = stats.permutation_test(
        (case.control, case.drug),
        statistic,
        permutation_type="samples" if paired else "independent",
        n_resamples=np.inf,
        vectorized=True,
    )
    return np.concatenate([result.statistic[None], result.null_distribution])


def test_clusters_have_the_windows_masses_and_p_values_of_plain_ones() -> None:
    for experiments, paired in DESIGNS:
        case = compared(experiments, paired, seed=5, effect=2.0)
        own = len(case.control) - 1 if paired else len(case.control) + len(case.drug) - 2
        threshold = stats.t.isf(TAIL, 2 * own)
        observed, *ways = signed_ways(case, paired)
        expected = cluster_masses(observed, threshold)
        largest = [max([mass for mass, _ in cluster_masses(way, threshold)], default=0.0) for way in ways]
        found, labels = case.found.clusters, case.found.windows["cluster"].to_numpy()
        assert len(found) == len(expected) > 0
        for row, (mass, inside) in zip(found.itertuples(), expected, strict=True):
            assert row.mass == pytest.approx(mass, rel=1e-9)
            assert_array_equal(np.flatnonzero(labels == row.cluster), inside)
            assert row.p == pytest.approx(np.mean(np.array(largest) >= mass * (1.0 - 1e-9)), abs=1e-10)
        assert labels.shape == (LAYERS, SECTORS)

"""Means against 0 and trends over doses agree with SciPy's permutations."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import stats

import cytodisk as cd
from cytodisk.arrays import FloatArray

LAYERS, SECTORS = 2, 6


def means_by(truth: cd.simulate.SimulatedPopulation, column: str) -> tuple[FloatArray, FloatArray]:
    """Means (units, layers, sectors) of the cells of each experiment and condition, and their column."""
    groups = truth.cells.groupby(["condition", "experiment"], sort=False)
    values = truth.values.to_numpy()
    means = np.stack([values[rows.index].mean(axis=0) for _, rows in groups])
    return means, groups[column].first().to_numpy()


def test_means_against_zero_have_the_p_values_of_all_signs() -> None:
    truth = cd.simulate.population(
        1, conditions=("wild type",), mean=0.4, experiments=7, cells=5, layers=LAYERS, sectors=SECTORS
    )
    found = cd.compare_with_zero(cd.Population(truth.values, truth.cells), "wild type")
    means, _ = means_by(truth, "area")
    shared = float(np.median((means**2).mean(axis=0) / len(means)))

    def score(values: FloatArray, zeros: FloatArray, axis: int) -> FloatArray:
        mean = (values - zeros).mean(axis=axis)
        own = (values - zeros).var(axis=axis, ddof=1) / values.shape[axis]
        return np.asarray(np.abs(mean) / np.sqrt(0.5 * (own + shared)))

    result = stats.permutation_test(
        (means, np.zeros_like(means)),
        score,
        permutation_type="samples",
        n_resamples=np.inf,
        alternative="greater",
        vectorized=True,
    )
    assert_allclose(found.windows["p"], result.pvalue, rtol=0, atol=1e-10)
    interval = stats.ttest_1samp(means, 0.0).confidence_interval(0.95)
    assert_allclose(found.windows["difference_low"], interval.low, rtol=0, atol=1e-10)
    assert_allclose(found.windows["difference_high"], interval.high, rtol=0, atol=1e-10)


def test_trends_have_the_p_values_of_all_orders_and_the_slopes_of_a_line() -> None:
    truth = cd.simulate.population(
        2,
        conditions=("none", "low", "high"),
        effect=(0.0, 0.5, 1.0),
        doses=(0.0, 1.0, 3.0),
        experiments=(2, 2, 3),
        cells=5,
        layers=LAYERS,
        sectors=SECTORS,
    )
    found = cd.dose_trend(cd.Population(truth.values, truth.cells), scale="linear", permutations=5039)
    means, doses = means_by(truth, "dose")
    name = "mean_" + str(cd.Population(truth.values, truth.cells).channels[0])
    scalar = means.mean(axis=(1, 2))  # as many cells in each experiment
    row = found.scalars.set_index("scalar").loc[name]
    line = stats.linregress(doses, scalar)
    assert row["difference"] == pytest.approx(line.slope, rel=1e-9)
    half = stats.t.ppf(0.975, len(doses) - 2) * line.stderr
    assert row["difference_low"] == pytest.approx(line.slope - half)
    assert row["difference_high"] == pytest.approx(line.slope + half)
    away = scalar - scalar.mean()
    result = stats.permutation_test(
        (doses,),
        lambda order, axis: np.abs((order * away).sum(axis=axis)),  # which orders ways as the score does
        permutation_type="pairings",
        n_resamples=np.inf,
        alternative="greater",
        vectorized=True,
    )
    assert row["p"] == pytest.approx(result.pvalue, abs=1e-10)

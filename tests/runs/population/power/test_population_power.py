"""How often a difference is found: on plans whose answer is known."""

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.runs.population.power.population_power import plan_of
from cytodisk.runs.population.power.variance_shares import variance_shares


def test_too_few_experiments_find_nothing() -> None:
    table = cd.population_power(effects=(5.0,), experiments=(3,), studies=20)
    assert table["smallest_p"].tolist() == pytest.approx([0.1, 0.25])
    assert (table[["window", "windows", "cluster", "scalar"]] == 0).all(axis=None)


def test_larger_effects_are_found_more_often_and_a_seed_repeats() -> None:
    settings = {"effects": (0.3, 1.5, 6.0), "experiments": (4,), "studies": 20, "seed": 3}
    table = cd.population_power(**settings)
    own = table[table["design"] == "unpaired"]
    assert own["windows"].is_monotonic_increasing
    assert own["scalar"].is_monotonic_increasing
    assert own["window"].iloc[-1] == 1.0
    assert own["window"].iloc[0] < 0.5
    assert cd.population_power(**settings).equals(table)


def test_one_number_without_effect_keeps_its_level() -> None:
    table = cd.population_power(effects=(1e-9,), experiments=(6,), studies=100, permutations=99)
    assert (table["scalar"] <= 0.05 + 3 * np.sqrt(0.05 * 0.95 / 100)).all()


@pytest.mark.parametrize("paired", [False, True])
def test_shares_of_variance_come_back(paired: bool) -> None:
    truth = cd.simulate.population(
        1,
        experiments=40,
        cells=6,
        paired=paired,
        between_experiments=0.2,
        between_dishes=0.1 if paired else 0.0,
        layers=4,
        sectors=12,
    )
    shares = variance_shares(cd.Population(truth.values, truth.cells))
    assert shares.between_experiments == pytest.approx(0.2, abs=0.05)
    assert shares.between_dishes == pytest.approx(0.1 if paired else 0.0, abs=0.04)
    assert (shares.cells, shares.separate) == (6, paired)


def test_a_bright_channel_does_not_count_for_more() -> None:
    truth = cd.simulate.population(1, experiments=20, cells=4, channels=("a", "b"), between_experiments=0.2)
    plain = variance_shares(cd.Population(truth.values, truth.cells))
    scaled = truth.values * np.array([1.0, 1000.0])[:, None, None]
    bright = variance_shares(cd.Population(scaled, truth.cells))
    assert bright.between_experiments == pytest.approx(plain.between_experiments)


def test_shapes_alone_tell_their_shares() -> None:
    rng = np.random.default_rng(0)
    truth = cd.simulate.population(1, experiments=60, cells=5, layers=1, sectors=2)
    experiment = truth.cells["experiment"].astype("category").cat.codes
    area = rng.normal(size=experiment.max() + 1)[experiment] + rng.normal(size=len(experiment))
    cells = truth.cells.assign(area=1e4 * area, roundness=area)
    shares = variance_shares(cd.Population(None, cells, scalars=["area", "roundness"]))
    assert shares.between_experiments == pytest.approx(0.5, abs=0.08)


def test_a_plan_takes_what_is_given_before_what_is_measured() -> None:
    truth = cd.simulate.population(1, experiments=5, cells=7)
    population = cd.Population(truth.values, truth.cells)
    plan = plan_of(cd.PowerParameters(between_experiments=0.5), population)
    assert (plan.cells, plan.between_experiments) == (7, 0.5)
    assert plan.measured is not None
    assert plan_of(cd.PowerParameters()).cells == 12
    with pytest.raises(cd.errors.ParameterError, match=r"at most 1, got 0\.8 \+ 0\.4"):
        plan_of(cd.PowerParameters(between_experiments=0.8, between_dishes=0.4))


def test_one_experiment_tells_no_variance_between_experiments() -> None:
    truth = cd.simulate.population(1, experiments=1, cells=5)
    with pytest.raises(cd.errors.PopulationError, match="two experiments of one condition"):
        cd.population_power(cd.Population(truth.values, truth.cells))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"effects": (0.0,)}, "above 0"),
        ({"effects": ()}, "above 0"),
        ({"experiments": (1,)}, "from 2 to 100"),
    ],
)
def test_plans_are_refused_with_what_they_may_be(settings: dict[str, object], words: str) -> None:
    with pytest.raises(cd.errors.ParameterError, match=words):
        cd.PowerParameters(**settings)

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.simulate import SimulatedPopulation, population

NULL = {"effect": 0.0, "layers": 3, "sectors": 12, "correlation_length": 0.0}


def variances(truth: SimulatedPopulation) -> tuple[float, float]:
    """Between experiments and within them, by the analysis of variance of balanced groups."""
    groups = truth.cells.groupby(["condition", "experiment"]).indices
    values = np.stack([truth.values.to_numpy()[rows] for rows in groups.values()])
    within = values.var(axis=1, ddof=1).mean()
    return float(values.mean(axis=1).var(axis=0, ddof=1).mean() - within / values.shape[1]), float(within)


def along(values: FloatArray, steps: int) -> float:
    """Correlation of windows with those some sectors further."""
    return float(np.mean(values * np.roll(values, steps, axis=-1)) / np.mean(values**2))


@pytest.mark.parametrize("share", [0.0, 0.1, 0.3])
@pytest.mark.parametrize("length", [0.0, 1.5])
def test_variances_are_those_asked_for(share: float, length: float) -> None:
    how = NULL | {"between_experiments": share, "correlation_length": length, "deviation": 2.0}
    between, within = variances(population(1, conditions=("control",), experiments=200, cells=10, **how))
    assert between == pytest.approx(4.0 * share, abs=0.12)
    assert within == pytest.approx(4.0 * (1.0 - share), abs=0.12)


def test_experiments_are_shared_by_conditions_only_when_paired() -> None:
    for paired, expected in ((True, 0.3), (False, 0.0)):
        truth = population(2, experiments=150, cells=20, paired=paired, between_experiments=0.3, **NULL)
        means = truth.values.to_numpy().reshape(2, 150, 20, 3, 12).mean(axis=2) - 10.0
        assert np.mean(means[0] * means[1]) == pytest.approx(expected, abs=0.03)


def test_dishes_make_the_difference_vary_between_pairs() -> None:
    how = NULL | {"between_experiments": 0.3, "between_dishes": 0.2}
    truth = population(3, experiments=150, cells=20, paired=True, **how)
    means = truth.values.to_numpy().reshape(2, 150, 20, 3, 12).mean(axis=2)
    assert np.var(means[1] - means[0]) == pytest.approx(2.0 * (0.2 + 0.5 / 20.0), abs=0.03)


def test_windows_hang_together_as_asked() -> None:
    apart = population(4, effect=0.0, experiments=40, correlation_length=0.0).values.to_numpy() - 10.0
    assert along(apart, 1) == pytest.approx(0.0, abs=0.03)
    near = population(4, effect=0.0, experiments=40, correlation_length=2.0).values.to_numpy() - 10.0
    assert along(near, 2) == pytest.approx(np.exp(-0.5), abs=0.04)
    whole = population(4, effect=0.0, experiments=80, correlation_length=0.0, common=0.4).values.to_numpy()
    assert along(whole - 10.0, 5) == pytest.approx(0.4, abs=0.04)


def test_the_region_is_raised_and_nothing_else() -> None:
    truth = population(5, experiments=150, cells=10, doses=(0.0, 1.0), effect=1.5, deviation=2.0)
    drug = (truth.cells["condition"] == "drug").to_numpy()
    difference = truth.values[drug].mean("cell") - truth.values[~drug].mean("cell")
    assert_allclose(difference, 3.0 * truth.region, atol=0.35)
    assert_allclose(truth.expected.diff("condition")[0], 3.0 * truth.region)
    assert truth.cells["dose"].unique().tolist() == [0.0, 1.0]


def test_a_profile_and_a_front_are_in_all_conditions() -> None:
    truth = population(6, experiments=100, cells=10, effect=0.0, peripheral=2.0, polarity=1.0)
    assert_allclose(truth.values.mean("cell"), truth.expected[0], atol=0.2)
    profile = truth.expected[0].mean("sector").to_numpy()
    assert_allclose(profile - 10.0, 2.0 * np.exp(-np.arange(4) * 3.0 / 4.0))
    assert int(truth.expected[0, 0].to_numpy().argmax()) in (0, 11)


@pytest.mark.parametrize("turned", ["nucleus", "front"])
def test_cells_aligned_by_their_direction_lie_as_those_that_are_not_turned(turned: str) -> None:
    truth = population(7, turned=turned, channels=("Rac1", "RhoA"), polarity=3.0)
    direction = truth.cells[f"disk_direction_{turned}"].to_numpy()
    back = np.rint(direction / 30.0).astype(int) % 12
    assert_array_equal(back, truth.shifts)
    values = truth.values.to_numpy()
    aligned = np.stack([np.roll(one, -by, axis=-1) for one, by in zip(values, back, strict=True)])
    drug = (truth.cells["condition"] == "drug").to_numpy()
    difference = aligned[drug].mean(axis=0) - aligned[~drug].mean(axis=0)
    expected = truth.expected.sel(condition="drug") - truth.expected.sel(condition="control")
    assert_allclose(difference, expected, atol=0.9)
    assert not expected.sel(channel="RhoA").any()
    turned_mean = values[~drug].mean(axis=0)
    assert np.ptp(turned_mean, axis=-1).max() < 3.0 < np.ptp(aligned[~drug].mean(axis=0), axis=-1).min()
    other = "front" if turned == "nucleus" else "nucleus"
    angle = np.radians(truth.cells[f"disk_direction_{other}"].to_numpy() - direction)
    assert abs(np.exp(1j * angle).mean()) < 0.25  # nothing to do with it


def test_cells_without_a_direction_and_windows_without_a_value() -> None:
    truth = population(8, without_direction=0.25, missing=0.1, experiments=20)
    unknown = truth.cells["disk_direction_nucleus"].isna()
    assert unknown.mean() == pytest.approx(0.25, abs=0.06)
    assert_array_equal(truth.cells["direction_strength_nucleus"] == 0.0, unknown)
    assert truth.values.isnull().mean() == pytest.approx(0.1, abs=0.01)


def test_designs() -> None:
    paired = population(0, paired=True, conditions=("a", "b", "c"), experiments=3, cells=2, effect=(0, 1, 2))
    counts = paired.cells.groupby(["experiment", "condition"]).size()
    assert counts.tolist() == [2] * 9
    unequal = population(0, experiments=(2, 5), cells=10, cells_spread=0.8, days="by experiment").cells
    assert unequal.groupby("condition")["experiment"].nunique().tolist() == [2, 5]
    assert unequal.groupby("experiment")["condition"].nunique().max() == 1
    cells = unequal.groupby("experiment").size()
    assert cells.between(2, 18).all()
    assert cells.nunique() > 1
    assert unequal.groupby("condition")["day"].unique().map(list).tolist()[0] == ["day 1", "day 2"]
    by_condition = population(0, days="by condition").cells
    assert by_condition.groupby("day")["condition"].nunique().tolist() == [1, 1]


def test_type_compartments_and_seed() -> None:
    one = population(9, precision="float32", nucleus_layers=2)
    assert one.values.dtype == np.float32
    assert one.values["compartment"].to_numpy().tolist() == ["cytoplasm"] * 2 + ["nucleus"] * 2
    again = population(9, precision="float32", nucleus_layers=2)
    assert_array_equal(one.values, again.values)
    assert one.cells.equals(again.cells)
    assert not one.cells.equals(population(10).cells)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"conditions": ("a", "a")}, "different names"),
        ({"experiments": (3, 4, 5)}, "one for each of the 2 conditions"),
        ({"experiments": (3, 4), "paired": True}, "one number for paired"),
        ({"experiments": 0}, "at least 1"),
        ({"effect": (1.0,)}, "one for each of the 2"),
        ({"doses": (1.0,)}, "one number for each"),
        ({"between_experiments": 0.7, "between_dishes": 0.7}, "at most 1"),
        ({"nucleus_layers": 6}, "less than layers"),
        ({"channels": ("a", "a")}, "different names"),
        ({"region": np.ones((2, 2), dtype=bool)}, r"shape \(4, 12\)"),
        ({"seed": -1}, "seed"),
    ],
)
def test_what_cannot_be_simulated(settings: dict[str, object], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        population(**settings)  # type: ignore[arg-type]

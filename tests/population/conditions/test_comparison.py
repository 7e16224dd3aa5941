"""Comparisons of conditions: the design that is found, what is said, and what is warned of."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk.errors import ParameterError, PopulationError


def population(
    control: list[str], drug: list[str], *, cells: int = 3, effect: float = 0.0, seed: int = 0
) -> cd.Population:
    """Cells of experiments by name, with the first windows raised in those with the drug."""
    rng = np.random.default_rng(seed)
    rows = [("control", name) for name in control for _ in range(cells)]
    rows += [("drug", name) for name in drug for _ in range(cells)]
    table = pd.DataFrame(rows, columns=["condition", "experiment"])
    values = rng.normal(10.0, 1.0, (len(table), 2, 6))
    values[table["condition"] == "drug", 0, :3] += effect
    return cd.Population(xr.DataArray(values, dims=("cell", "layer", "sector"), name="Rac1"), table)


def names_of(found: cd.ConditionComparison) -> list[str]:
    return [one.name for one in found.warnings]


def test_what_can_be_reached_is_said_first() -> None:
    found = cd.compare_conditions(population(list("abc"), list("def")), "control", "drug")
    assert found.sentences[0] == (
        "3 + 3 experiments can give p = 0.1 at best (all 20 exchanges of labels): no difference can reach "
        "0.05."
    )
    assert found.sentences[1] == "Each experiment holds one condition: the design is unpaired."
    assert names_of(found) == ["too few experiments"]
    assert found.windows["p_fwer"].min() >= 0.1 - 1e-12


def test_equal_names_make_pairs_unless_they_are_said_to_differ() -> None:
    pop = population(list("abcdef"), list("fedcba"))
    found = cd.compare_conditions(pop, "control", "drug")
    assert (found.design, found.smallest_p) == ("paired", 1 / 32)
    assert (
        found.sentences[1] == "Experiments a, b, c, d and 2 more hold both conditions: the design is paired."
    )
    other = cd.compare_conditions(pop, "control", "drug", design="unpaired")
    assert other.design == "unpaired"
    assert "taken as different ones" in other.sentences[1]


def test_pairs_belong_together_whatever_the_order_of_cells() -> None:
    pop = population(list("abcdef"), list("fedcba"), effect=1.0)
    order = np.random.default_rng(0).permutation(len(pop))
    shuffled = cd.Population(pop.raw[order].squeeze("channel"), pop.cells.iloc[order])
    found, again = (cd.compare_conditions(one, "control", "drug") for one in (pop, shuffled))
    xr.testing.assert_allclose(found.windows, again.windows)


def test_incomplete_pairs_are_left_out_and_told() -> None:
    found = cd.compare_conditions(population(list("abcd"), list("abce")), "control", "drug")
    assert found.design == "paired"
    assert "incomplete pairs" in names_of(found)
    left = found.units[found.units["used"] == 0]
    assert left[["experiment", "cells"]].to_numpy().tolist() == [["d", 3], ["e", 3]]
    assert left["reason"].tolist() == ["holds only one of the two conditions"] * 2


def test_a_design_that_cannot_be_told_is_asked_for() -> None:
    pop = population(list("abcd"), list("aefg"))
    with pytest.raises(PopulationError, match="pass design='paired'"):
        cd.compare_conditions(pop, "control", "drug")
    assert cd.compare_conditions(pop, "control", "drug", design="unpaired").smallest_p == pytest.approx(
        2 / 70
    )
    with pytest.raises(PopulationError, match="1 does"):
        cd.compare_conditions(pop, "control", "drug", design="paired")


def test_a_region_is_found_as_windows_cluster_and_scalar() -> None:
    found = cd.compare_conditions(population(list("abcde"), list("fghij"), effect=6.0), "control", "drug")
    different = found.windows["p_fwer"] <= 0.05
    assert different.sum() == 3
    assert different[0, :3].all()
    row = found.clusters.iloc[0]
    assert (row["layers"], row["sectors"], row["n_windows"]) == ("0", "0–2", 3)
    assert row["p"] <= 0.05
    assert found.scalars.set_index("scalar").loc["layer_0_Rac1", "p_fwer"] <= 0.05
    assert "3 of 12 windows differ" in found.sentences[2]
    assert set(found.left_out["result"]) >= {"raised windows", "cluster 1"}
    assert (found.windows["low"] <= found.windows["effect_size"]).all()
    assert (found.windows["effect_size"] <= found.windows["high"]).all()


def test_experiments_that_are_unknown_cannot_be_tested() -> None:
    pop = population(list("abc"), list("def"))
    nameless = pop.with_cells(pop.cells.drop(columns="experiment"))
    with pytest.raises(PopulationError, match="experiments are unknown"):
        cd.compare_conditions(nameless, "control", "drug")
    found = cd.compare_conditions(nameless, "control", "drug", unit="cell")
    assert names_of(found) == ["cells as units"]
    some = pop.cells.assign(experiment=pop.cells["experiment"].where(pop.cells["experiment"] != "a"))
    found = cd.compare_conditions(pop.with_cells(some), "control", "drug")
    assert "experiments unknown" in names_of(found)
    assert found.units["used"].sum() == 15


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("control", "Drug"), "conditions are .control., .drug."),
        (("drug", "drug"), "compared with itself"),
    ],
)
def test_conditions_that_are_not_there_are_refused(arguments, words: str) -> None:
    with pytest.raises(PopulationError, match=words):
        cd.compare_conditions(population(list("abc"), list("def")), *arguments)


def test_parameters_are_checked() -> None:
    pop = population(list("abc"), list("def"))
    with pytest.raises(ParameterError, match="permutations"):
        cd.compare_conditions(pop, "control", "drug", permutations=0)
    with pytest.raises(PopulationError, match="no pairs"):
        cd.compare_conditions(pop, "control", "drug", unit="cell", design="paired")


def test_one_experiment_that_drives_a_result_is_named() -> None:
    pop = population(list("abcd"), list("efgh"))
    values = pop.raw.squeeze("channel").copy()
    values *= 0.01
    raised = pop.cells["experiment"].map({"e": 1.0, "f": 1.0, "g": 1.0, "h": 6.0}).fillna(0.0)
    values += raised.to_numpy()[:, None, None]
    found = cd.compare_conditions(cd.Population(values, pop.cells), "control", "drug")
    driven = [one for one in found.warnings if one.name == "one experiment drives it"]
    assert driven
    assert all("experiment h" in one.finding for one in driven)


@pytest.mark.parametrize(
    ("days", "warned"),
    [
        ({"a": 1, "b": 1, "c": 1, "d": 2, "e": 2, "f": 2}, True),
        ({"a": 1, "b": 2, "c": 3, "d": 1, "e": 2, "f": 3}, False),
        ({"a": 1, "b": 2, "c": 3, "d": 4, "e": 5, "f": 6}, False),
    ],
)
def test_days_that_hold_one_condition_are_warned_of(days: dict[str, int], warned: bool) -> None:
    pop = population(list("abc"), list("def"))
    pop = pop.with_cells(pop.cells.assign(day=pop.cells["experiment"].map(days)))
    found = cd.compare_conditions(pop, "control", "drug")
    assert ("conditions confounded" in names_of(found)) == warned


def test_a_condition_with_one_experiment_is_warned_of() -> None:
    found = cd.compare_conditions(population(["a"], list("bcdef")), "control", "drug")
    assert found.smallest_p == pytest.approx(1 / 6)
    assert names_of(found) == ["too few experiments", "conditions confounded"]


def test_unequal_numbers_of_cells_are_warned_of() -> None:
    pop = population(list("abc"), list("def"), cells=10)
    rows = (pop.cells["experiment"] != "a").to_numpy().copy()
    rows[:2] = True
    assert "cells per experiment unequal" in names_of(
        cd.compare_conditions(pop.select(rows), "control", "drug")
    )


def test_alignment_by_what_is_tested_is_warned_of() -> None:
    pop = population(list("abc"), list("def")).align("signal:Rac1", weakest=0.2)
    assert "double dipping" in names_of(cd.compare_conditions(pop, "control", "drug"))
    assert "direction missing" in names_of(cd.compare_conditions(pop, "control", "drug"))


@pytest.mark.parametrize(
    ("control", "drug", "spread", "warned"),
    [(8, 4, 3.0, True), (6, 6, 3.0, True), (6, 6, 1.0, False), (4, 8, 1.5, False)],
)
def test_a_spread_that_differs_is_warned_of(control: int, drug: int, spread: float, warned: bool) -> None:
    names = [f"e{k}" for k in range(control + drug)]
    pop = population(names[:control], names[control:], cells=30)
    values = pop.raw.squeeze("channel").copy()
    wide = (pop.cells["condition"] == "drug").to_numpy()
    codes = pop.cells["experiment"].str[1:].astype(int).to_numpy()
    dishes = np.random.default_rng(3).normal(size=(control + drug, *values.shape[1:]))
    values += dishes[codes] * np.where(wide, spread, 1.0)[:, None, None]
    found = cd.compare_conditions(cd.Population(values, pop.cells), "control", "drug")
    assert ("unequal spread" in names_of(found)) == warned


def test_a_rise_that_makes_others_fall_is_warned_of() -> None:
    pop = population(list("abcdef"), list("ghijkl"), cells=40, effect=8.0)
    found = cd.compare_conditions(pop.normalise("cell mean"), "control", "drug")
    assert "shares of a cell" in names_of(found)
    assert "shares of a cell" not in names_of(cd.compare_conditions(pop, "control", "drug"))


def test_windows_without_values_are_told() -> None:
    pop = population(list("abcd"), list("efgh"))
    values = pop.raw.squeeze("channel").copy()
    values[:15, 1, 4] = np.nan
    found = cd.compare_conditions(cd.Population(values, pop.cells), "control", "drug")
    assert "windows not tested" in names_of(found)
    assert found.windows["status"].values[1, 4] == "too few units have a value"
    assert np.isnan(found.windows["p"].values[1, 4])
    assert np.isfinite(found.windows["p"].values).sum() == 11


def test_cells_that_cannot_be_normalised_are_told() -> None:
    pop = population(list("abcd"), list("efgh"))
    values = pop.raw.squeeze("channel").copy()
    values[:2] = -1.0
    values[3:6] = np.nan
    found = cd.compare_conditions(cd.Population(values, pop.cells).normalise("cell mean"), "control", "drug")
    assert found.units["reason"].tolist()[:2] == ["2 of its cells have no values", "no cell has values"]
    assert found.sentences[2].startswith("5 of 24 cells have no values")
    whole = cd.compare_conditions(pop, "control", "drug")
    assert not any("no values" in sentence for sentence in whole.sentences)


def test_cells_without_an_experiment_are_told_where_a_mean_is_tested() -> None:
    pop = population(list("abcdef"), [])
    cells = pop.cells.copy()
    cells.loc[:1, "experiment"] = np.nan
    found = cd.compare_with_zero(pop.with_cells(cells))
    assert found.sentences[-1].startswith("2 of 18 cells have no name of their experiment")


def test_channels_are_corrected_together() -> None:
    pop = population(list("abcde"), list("fghij"), effect=4.0)
    values = pop.raw.squeeze("channel").expand_dims(channel=["Rac1", "RhoA"]).copy()
    both = cd.Population(values, pop.cells)
    found = cd.compare_conditions(both, "control", "drug")
    alone = cd.compare_conditions(both, "control", "drug", channel="RhoA")
    assert found.windows["p_fwer"].dims == ("channel", "layer", "sector")
    assert any("corrected together" in sentence for sentence in found.sentences)
    assert (found.windows["p_fwer"].sel(channel="RhoA") >= alone.windows["p_fwer"] - 1e-12).all()


def test_several_conditions_are_corrected_by_holm() -> None:
    pop = population(list("abcd"), list("efgh"), effect=5.0)
    other = population([], list("ijkl"), seed=1)
    table = pd.concat([pop.cells, other.cells.assign(condition="other")], ignore_index=True)
    values = xr.concat([pop.raw, other.raw], "cell").squeeze("channel")
    three = cd.Population(values, table)
    found = cd.compare_with_control(three, "control")
    assert list(found) == ["drug", "other"]
    alone = cd.compare_conditions(three, "control", "drug")
    assert float(found["drug"].windows["p_holm"].min()) == pytest.approx(
        2 * float(alone.windows["p_fwer"].min())
    )
    assert (found["other"].windows["p_holm"] >= found["other"].windows["p_fwer"]).all()
    assert (
        found["drug"]
        .sentences[0]
        .endswith(
            "Corrected for 2 comparisons (Holm) it is 0.057 at best: no difference can then reach 0.05."
        )
    )
    assert names_of(found["drug"])[0] == "too few experiments"
    alone_again = cd.compare_with_control(three, "control", ["drug", "drug"])["drug"]
    assert alone_again.sentences == alone.sentences
    assert "too few experiments" not in names_of(alone_again)
    with pytest.raises(PopulationError, match="no condition beside"):
        cd.compare_with_control(population(list("abc"), []), "control")


def test_curves_do_not_close() -> None:
    pop = population(list("abcde"), list("fghij"))
    values = pop.raw.squeeze("channel").copy()
    raised = (pop.cells["condition"] == "drug").to_numpy()
    values[raised, 0, 0] += 8.0
    values[raised, 0, 5] += 8.0
    closed = cd.compare_conditions(cd.Population(values, pop.cells), "control", "drug")
    curves = cd.compare_conditions(cd.Population(values.rename(sector="lag"), pop.cells), "control", "drug")
    assert closed.clusters.iloc[0]["sectors"] == "5–0"
    assert sorted(curves.clusters["sectors"].head(2)) == ["0", "5"]
    with pytest.raises(PopulationError, match="run along lag"):
        cd.Population(values.rename(sector="lag"), pop.cells).align("nucleus")


def test_a_mean_that_is_not_zero_is_found_over_experiments() -> None:
    pop = population(list("abcdef"), [])
    values = pop.raw.squeeze("channel") - 10.0
    values[:, 1, 2:4] += 3.0
    found = cd.compare_with_zero(cd.Population(values, pop.cells))
    assert found.smallest_p == 1 / 32
    assert ((found.windows["p_fwer"] <= 0.05).values.nonzero()[1] == [2, 3]).all()


def test_a_trend_over_doses_is_found_between_and_within_experiments() -> None:
    for names in (["a", "b", "c", "d", "e", "f", "g", "h", "i"], ["a", "b", "c"] * 3):
        pop = population(names, [])
        dose = np.repeat([0.0, 1.0, 10.0], 9)
        values = pop.raw.squeeze("channel").copy()
        values[:, 0, :3] += 3.0 * np.repeat([0, 1, 2], 9)[:, None]
        dosed = cd.Population(values, pop.cells.assign(dose=dose))
        found = cd.dose_trend(dosed)
        assert found.design == ("between experiments" if len(set(names)) == 9 else "within experiments")
        assert (found.windows["p_fwer"][0, :3] <= 0.05).all()
        assert (found.windows["p_fwer"][1] > 0.05).all()
        assert float(found.windows["difference"][0, :3].mean()) == pytest.approx(3.0, abs=0.5)
    with pytest.raises(PopulationError, match="no column 'dose'"):
        cd.dose_trend(population(list("abc"), []))


def test_a_pattern_by_direction_is_found_and_none_by_itself() -> None:
    truth = cd.simulate.population(effect=0.0, turned="nucleus", seed=0)
    angle = 2 * np.pi * (np.arange(12) + 0.5) / 12
    towards = np.radians(truth.cells["disk_direction_nucleus"].to_numpy())
    values = truth.values + xr.DataArray(
        np.cos(angle - towards[:, None])[:, None] * np.ones((1, 4, 1)), dims=("cell", "layer", "sector")
    )
    pop = cd.Population(values, truth.cells)
    with pytest.raises(PopulationError, match="not aligned"):
        cd.pattern_test(pop)
    found = cd.pattern_test(pop.align("nucleus"), permutations=199)
    assert float(found.windows["p_fwer"].min()) == 1 / 200
    with pytest.raises(PopulationError, match="cannot be tested"):
        cd.pattern_test(pop.align(f"signal:{pop.channels[0]}"))

"""What a run computes of a population, on simulated cells whose answer is known."""

import numpy as np
import pandas as pd
import pytest

import cytodisk as cd
from cytodisk.runs.population.population_work import PopulationResult, population_result


def _result(truth: cd.simulate.SimulatedPopulation, **settings: object) -> PopulationResult:
    settings = {"permutations": 199} | settings
    population = cd.Population(truth.values, truth.cells, scalars=["area"])
    return population_result(population, cd.PopulationParameters(**settings), lambda share: None)


def test_several_conditions_are_each_compared_with_the_control() -> None:
    truth = cd.simulate.population(
        0, conditions=("a", "DMSO", "b"), experiments=4, cells=3, effect=(0.0, 0.0, 3.0)
    )
    found = _result(truth)
    comparisons = found.tables["comparisons"]
    assert comparisons["control"].unique().tolist() == ["DMSO"]
    assert comparisons["condition"].tolist() == ["a", "b"]
    assert (comparisons["p_holm"] >= comparisons["smallest_found"]).all()
    assert found.notes["conditions"] == ["DMSO", "a", "b"]
    windows = found.tables["windows"]
    hits = windows[windows["p_fwer"] <= 0.05]
    assert set(hits["condition"]) <= {"b"}
    assert found.tables["atlas"]["condition"].unique().tolist() == ["DMSO", "a", "b"]
    sentences = found.notes["sentences"]
    for name in ("a", "b"):
        pair = f"{name} against DMSO"
        assert sum(words.startswith(f"{pair}: 4 + 4 experiments") for words in sentences) == 1
        assert sum(words.startswith(f"Scalars, {pair}: 0 of ") for words in sentences) == 1
    corrected = "2 conditions were compared with the control, and each p is corrected for that (Holm)."
    assert sentences.count(corrected) == 1
    assert comparisons["smallest_p_holm"].tolist() == pytest.approx([4 / 70, 4 / 70])
    assert (comparisons[["windows_found", "clusters_found", "scalars_found"]] == 0).all(axis=None)


def test_the_first_named_condition_is_the_control() -> None:
    truth = cd.simulate.population(0, conditions=("a", "b", "c"), experiments=2, cells=2)
    found = _result(truth, compare=("b", "a"))
    assert found.notes["control"] == "b"
    left_out = found.tables["cells"]["left_out"]
    assert (left_out[truth.cells["condition"] == "c"] == "its condition is not compared").all()
    assert set(found.tables["gallery"]["condition"]) == {"a", "b"}


def test_a_dose_has_a_trend_beside() -> None:
    truth = cd.simulate.population(
        0,
        conditions=("control", "low", "high"),
        experiments=3,
        cells=4,
        doses=(0.0, 1.0, 10.0),
        effect=(0.0, 2.0, 4.0),
    )
    found = _result(truth, dose="dose")
    trends = found.tables["trends"]
    region = truth.region.to_numpy()[trends["layer"], trends["sector"]]
    assert (trends.loc[region, "slope"] > 0).mean() > 0.9
    assert (trends.loc[region, "p_fwer"] <= 0.05).mean() > 0.5
    assert "area" in found.tables["scalar_trends"]["scalar"].tolist()
    assert found.notes["sentences"][2].startswith("9 units at 3 doses")


def test_a_dose_that_is_not_there_is_refused() -> None:
    truth = cd.simulate.population(0, experiments=2, cells=2)
    with pytest.raises(cd.errors.PopulationError, match="no column 'µM': give each cell its dose, a number"):
        _result(truth, dose="µM")


def test_pairs_that_are_not_whole_are_named_without_cells_of_unknown_experiments() -> None:
    truth = cd.simulate.population(0, experiments=3, cells=2, paired=True)
    truth.cells.loc[:1, "experiment"] = None
    warnings = _result(truth).tables["warnings"].set_index("name")["finding"]
    assert warnings["incomplete pairs"] == "experiment 1 holds only one of the conditions."
    assert warnings["experiments unknown"] == "2 cells have no name of their experiment."


def test_a_channel_can_align_cells_without_being_compared() -> None:
    truth = cd.simulate.population(0, channels=("Rac1", "RhoA"), experiments=2, cells=3, polarity=3.0)
    found = _result(truth, channel=("Rac1",), align="signal:RhoA")
    assert found.tables["windows"]["channel"].unique().tolist() == ["Rac1"]
    assert found.tables["cells"]["alignment"].unique().tolist() == ["ok"]
    assert found.tables["cells"]["strength"].min() > 0


def test_the_bright_side_is_told_as_aligned() -> None:
    truth = cd.simulate.population(0, experiments=2, cells=3, polarity=8.0, effect=0.0, turned="nucleus")
    cells = _result(truth, align="nucleus").tables["cells"]
    away = np.radians(cells["polarity_direction_signal"].to_numpy())
    assert np.abs(np.angle(np.exp(1j * away))).max() < 0.3  # polarity is highest at sector 0


def test_distances_find_the_odd_cell() -> None:
    truth = cd.simulate.population(0, experiments=3, cells=5, effect=0.0)
    truth.values[7] += 5.0
    found = _result(truth)
    cells, gallery = found.tables["cells"], found.tables["gallery"]
    assert cells["distance_to_mean"].idxmax() == 7
    far = gallery[(gallery["place"] == "farthest") & (gallery["rank"] == 1)]
    assert 7 in far["row"].tolist()
    shown = gallery[gallery["row"] == 7].set_index(["layer", "sector"])["value"]
    assert shown.loc[1, 2] == pytest.approx(float(truth.values[7, 1, 2]))


def test_profiles_are_means_of_layers_by_experiment() -> None:
    truth = cd.simulate.population(0, experiments=2, cells=3)
    profiles = _result(truth).tables["profiles"]
    first = truth.cells["experiment"] == truth.cells["experiment"].iloc[0]
    mine = truth.values[first.to_numpy()].mean(("cell", "sector")).to_numpy()
    assert profiles[profiles["experiment"] == "experiment 1"]["mean"].to_numpy() == pytest.approx(mine)


def test_shapes_alone_are_compared_without_windows() -> None:
    truth = cd.simulate.population(0, experiments=4, cells=3)
    population = cd.Population(None, truth.cells, scalars=["area"])
    found = population_result(population, cd.PopulationParameters(), lambda share: None)
    assert found.tables["scalars"]["scalar"].tolist() == ["area"]
    assert not len(found.tables["windows"])
    assert not len(found.tables["atlas"])


def test_cells_that_cannot_be_normalised_are_left_out() -> None:
    truth = cd.simulate.population(0, experiments=3, cells=3, mean=10.0)
    truth.values[0] = -1.0
    cells = _result(truth, normalise="cell mean").tables["cells"]
    assert cells["left_out"].iloc[0].startswith("it cannot be normalised: ")
    assert np.isnan(cells["distance_to_mean"].iloc[0])
    assert (cells["left_out"].iloc[1:] == "").all()


def test_some_cells_without_a_condition_are_told() -> None:
    truth = cd.simulate.population(0, experiments=3, cells=3)
    truth.cells.loc[2, "condition"] = None
    found = _result(truth)
    assert found.tables["cells"]["left_out"].iloc[2] == "it has no condition"
    assert found.tables["experiments"]["cells"].sum() == len(truth.cells) - 1


def test_a_column_of_the_user_may_not_hide_one_of_the_run() -> None:
    truth = cd.simulate.population(0, experiments=3, cells=2)
    population = cd.Population(truth.values, truth.cells.assign(strength=1.0))
    with pytest.raises(cd.errors.PopulationError, match=r"column 'strength' .* rename yours"):
        population_result(population, cd.PopulationParameters(), lambda share: None)


def test_progress_goes_from_0_to_1() -> None:
    truth = cd.simulate.population(0, experiments=3, cells=2)
    shares: list[float] = []
    population_result(cd.Population(truth.values, truth.cells), cd.PopulationParameters(), shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_warnings_that_several_comparisons_share_are_told_once() -> None:
    truth = cd.simulate.population(0, conditions=("control", "a", "b"), experiments=2, cells=2)
    warnings: pd.DataFrame = _result(truth).tables["warnings"]
    few = warnings[warnings["name"] == "too few experiments"]
    assert few["condition"].tolist() == [""]


def test_curves_have_lags_and_a_compartment() -> None:
    truth = cd.simulate.population(0, experiments=3, cells=2, layers=2, sectors=9)
    lags = truth.values.rename(sector="lag").assign_coords(lag=np.arange(-4.0, 5.0))
    lags["lag"].attrs["units"] = "s"
    population = cd.Population(lags, truth.cells)
    found = population_result(population, cd.PopulationParameters(), lambda share: None)
    assert found.notes["curves"]
    assert found.notes["lag_unit"] == "s"
    windows = found.tables["windows"]
    assert sorted(windows["lag"].unique()) == [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0]
    assert windows["compartment"].unique().tolist() == ["cell"]
    assert "polarity_signal" not in found.tables["cells"]

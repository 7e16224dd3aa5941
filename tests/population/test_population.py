"""Populations: what they accept, and how they normalise, align and average."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from numpy.testing import assert_allclose

import cytodisk as cd
from cytodisk.errors import PopulationError

DIMS = ("cell", "channel", "layer", "sector")


@pytest.fixture
def values() -> xr.DataArray:
    numbers = np.random.default_rng(0).uniform(1.0, 3.0, (6, 2, 3, 8))
    return xr.DataArray(numbers, dims=DIMS, coords={"channel": ["Rac1", "RhoA"]})


@pytest.fixture
def cells() -> pd.DataFrame:
    table = pd.DataFrame({"condition": ["control", "drug"] * 3, "experiment": [1, 1, 2, 2, 3, 3]})
    return table.assign(area=np.arange(6.0), background_Rac1=0.5, background_RhoA=0.25)


def test_rows_belong_to_cells_whatever_their_index(values: xr.DataArray, cells: pd.DataFrame) -> None:
    pop = cd.Population(values, cells.set_index(np.arange(6)[::-1]), scalars=["area"])
    assert pop.cells["area"].tolist() == cells["area"].tolist()
    assert pop.conditions == ("control", "drug")
    assert pop.experiments == ("1", "2", "3")
    assert pop.select(cells["condition"] == "drug").cells["area"].tolist() == [1.0, 3.0, 5.0]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda v, c: (v.isel(cell=slice(4)), c), "4 cells and the table 6 rows"),
        (lambda v, c: (v.rename(sector="angle"), c), "it needs cell, layer and sector"),
        (lambda v, c: (v.where(v < 2.9, np.inf), c), "infinite in"),
        (lambda v, c: (v.where(v < 2.9, np.inf).astype("float32"), c), "infinite in"),
        (lambda v, c: (v * 1e160, c), "beyond 1e\\+150"),
        (lambda v, c: (v[..., :0], c), "values has no sector"),
        (lambda v, c: (v.astype(str), c), "must be numbers"),
        (lambda v, c: (v.assign_coords(channel=["a", "a"]), c), "channels with one name"),
    ],
)
def test_values_that_do_not_fit_are_refused(change, words: str, values, cells) -> None:
    with pytest.raises(PopulationError, match=words):
        cd.Population(*change(values, cells))


@pytest.mark.parametrize(("name", "words"), [("volume", "no column 'volume'"), ("condition", "no numbers")])
def test_scalars_are_columns_of_numbers(name: str, words: str, values, cells) -> None:
    with pytest.raises(PopulationError, match=words):
        cd.Population(values, cells, scalars=[name])


@pytest.mark.parametrize("rows", [[0, 1, 2], np.ones(3, bool), np.arange(6), np.ones((6, 1), bool)])
def test_cells_are_selected_by_one_truth_each(rows: object, values, cells) -> None:
    with pytest.raises(PopulationError, match="rows must be 6 values of True and False"):
        cd.Population(values, cells).select(rows)


def test_a_table_has_no_column_twice(values: xr.DataArray, cells: pd.DataFrame) -> None:
    twice = pd.concat([cells, cells[["experiment"]]], axis=1)
    for made in (
        lambda: cd.Population(values, twice),
        lambda: cd.Population(values, cells).with_cells(twice),
    ):
        with pytest.raises(PopulationError, match="two columns 'experiment'"):
            made()


@pytest.mark.parametrize("test", [cd.dose_trend, cd.compare_with_zero, cd.pattern_test])
def test_what_is_no_population_is_refused(test, values: xr.DataArray) -> None:
    with pytest.raises(cd.errors.ParameterError, match="pop must be a Population, got DataArray"):
        test(values)
    with pytest.raises(cd.errors.ParameterError, match="pop must be a Population, got DataArray"):
        cd.compare_with_control(values, "control")


def test_normalising_takes_out_the_level_of_each_cell(values: xr.DataArray, cells: pd.DataFrame) -> None:
    raw = values.to_numpy()
    pop = cd.Population(values, cells)
    mean, sd = (np.asarray(f(raw, axis=(2, 3), keepdims=True)) for f in (np.mean, np.std))
    assert_allclose(pop.normalise("cell mean").values, raw / mean)
    assert_allclose(pop.normalise("cell total").values.sum(("layer", "sector")), 1.0)
    assert_allclose(pop.normalise("z-score").values, (raw - mean) / sd, atol=1e-12)
    background = np.array([0.5, 0.25])[:, None, None]
    without = raw - background
    assert_allclose(pop.normalise("background").values, without)
    both = pop.normalise("background").normalise("cell mean")
    assert_allclose(both.values, without / without.mean(axis=(2, 3), keepdims=True))
    assert both.units == "× cell mean"
    assert_allclose(pop.values, raw)


@pytest.mark.parametrize(
    ("method", "units"),
    [("none", "a.u."), ("cell mean", "× cell mean"), ("cell total", "share of cell"), ("z-score", "sd")],
)
def test_units_are_those_after_normalising(method: str, units: str, values, cells) -> None:
    pop = cd.Population(values, cells).normalise(method)
    assert pop.units == pop.values.attrs["units"] == units
    assert {pop.atlas()[name].attrs["units"] for name in ("mean", "sd", "sem")} == {units}


def test_windows_count_by_area(values: xr.DataArray, cells: pd.DataFrame) -> None:
    weights = np.random.default_rng(1).uniform(1, 5, (6, 3, 8))
    areas = xr.DataArray(weights, dims=("cell", "layer", "sector"))
    pop = cd.Population(values, cells, areas=areas).normalise("cell mean")
    means = (pop.values.to_numpy() * weights[:, None]).sum(axis=(2, 3)) / weights.sum(axis=(1, 2))[:, None]
    assert_allclose(means, 1.0)


@pytest.mark.parametrize("method", ["cell mean", "cell total", "z-score"])
def test_areas_turn_with_their_windows(method: str, values: xr.DataArray, cells: pd.DataFrame) -> None:
    areas = xr.DataArray(np.random.default_rng(1).uniform(1, 5, (6, 3, 8)), dims=("cell", "layer", "sector"))
    turned = cells.assign(disk_direction_nucleus=np.arange(6) * 90.0, direction_strength_nucleus=1.0)
    pop = cd.Population(values, turned, areas=areas)
    first, last = pop.normalise(method).align("nucleus"), pop.align("nucleus").normalise(method)
    assert_allclose(last.values, first.values, rtol=1e-12)


def test_a_cell_that_cannot_be_normalised_has_no_values_and_says_why(values, cells) -> None:
    values[2, 0] = 0.0
    pop = cd.Population(values, cells).normalise("cell mean")
    assert np.isnan(pop.values[2, 0]).all()
    assert pop.level_status.tolist() == ["", "", "its mean is not above 0", "", "", ""]


def test_a_background_that_is_not_there_is_asked_for(values, cells) -> None:
    with pytest.raises(PopulationError, match="no column background_RhoA"):
        cd.Population(values, cells.drop(columns="background_RhoA")).normalise("background")
    with pytest.raises(PopulationError, match="background away first"):
        cd.Population(values, cells).normalise("cell mean").normalise("background")


def test_cells_turn_to_their_direction(values: xr.DataArray, cells: pd.DataFrame) -> None:
    degrees = [0.0, 45.0, 90.0, 359.0, 180.0, np.nan]
    strengths = [1.0, 1.0, 1.0, 1.0, 0.01, 1.0]
    table = cells.assign(disk_direction_nucleus=degrees, direction_strength_nucleus=strengths)
    pop = cd.Population(values, table).align("nucleus")
    assert pop.alignment["shift"].tolist() == [0, 1, 2, 0, 0, 0]
    assert pop.alignment["status"].tolist()[3:] == [
        "ok",
        "its direction is weaker than 0.05",
        "it has no direction",
    ]
    assert_allclose(pop.values[1], np.roll(values[1], -1, axis=-1))
    assert_allclose(pop.align("none").values, values)


def test_a_signal_gives_the_direction_of_its_first_harmonic(cells: pd.DataFrame) -> None:
    angle = 2 * np.pi * (np.arange(24) + 0.5) / 24
    towards = np.radians([10.0, 100.0, 200.0, 300.0, 40.0, 350.0])
    numbers = 2.0 + np.cos(angle - towards[:, None, None]) * np.ones((6, 3, 1))
    pop = cd.Population(xr.DataArray(numbers, dims=("cell", "layer", "sector"), name="Rac1"), cells)
    aligned = pop.align("signal:Rac1")
    assert_allclose(aligned.alignment["direction"], np.degrees(towards))
    assert_allclose(aligned.alignment["strength"], 0.25)
    around = aligned.values.to_numpy()[:, 0, 0]
    assert (np.abs((around.argmax(axis=1) + 0.5 + 12) % 24 - 12) <= 1.0).all()


@pytest.mark.parametrize(
    ("by", "words"),
    [("front", "no column disk_direction_front"), ("left", "none of"), ("signal:X", "channel 'X'")],
)
def test_a_direction_that_is_not_there_is_refused(by: str, words: str, values, cells) -> None:
    with pytest.raises(PopulationError, match=words):
        cd.Population(values, cells).align(by)


def test_an_atlas_averages_experiments_not_cells(values: xr.DataArray, cells: pd.DataFrame) -> None:
    table = cells.assign(condition="control", experiment=["a", "a", "a", "a", "b", "b"])
    atlas = cd.Population(values, table).atlas()
    raw = values.to_numpy()
    means = np.stack([raw[:4].mean(axis=0), raw[4:].mean(axis=0)])
    assert_allclose(atlas["mean"][0], means.mean(axis=0))
    assert_allclose(atlas["sem"][0], means.std(axis=0, ddof=1) / np.sqrt(2))
    assert_allclose(atlas["sd"][0], raw.std(axis=0, ddof=1))
    assert (atlas["n_cells"] == 6).all()
    assert (atlas["n_experiments"] == 2).all()


def test_without_experiments_an_atlas_averages_cells(values, cells) -> None:
    atlas = cd.Population(values, cells.drop(columns="experiment")).atlas()
    assert_allclose(atlas["mean"].sel(condition="drug"), values.to_numpy()[1::2].mean(axis=0))
    assert (atlas["n_experiments"] == 0).all()
    assert np.isnan(atlas["sem"]).all()


def test_scalars_follow_from_the_windows(values: xr.DataArray, cells: pd.DataFrame) -> None:
    values = values.assign_coords(compartment=("layer", ["cytoplasm", "cytoplasm", "nucleus"]))
    table = cd.Population(values, cells, scalars=["area"]).normalise("cell mean").scalar_table()
    raw = values.to_numpy()[:, 1]
    assert_allclose(table["mean_RhoA"], raw.mean(axis=(1, 2)))
    assert_allclose(table["layer_1_RhoA"], raw[:, 1].mean(axis=1) / raw.mean(axis=(1, 2)))
    assert_allclose(table["edge_to_centre_RhoA"], raw[:, 0].mean(axis=1) / raw[:, 1].mean(axis=1))
    expected = raw[:, 2].mean(axis=1) / raw[:, :2].mean(axis=(1, 2))
    assert_allclose(table["nucleus_to_cytoplasm_RhoA"], expected)
    assert_allclose(table["area"], cells["area"])


def test_values_are_read_block_by_block(values, cells, monkeypatch: pytest.MonkeyPatch) -> None:
    table = cells.assign(disk_direction_nucleus=np.arange(6) * 45.0, direction_strength_nucleus=1.0)
    pop = cd.Population(values, table).normalise("z-score").align("nucleus")
    whole, atlas, scalars = pop.values, pop.atlas(), pop.scalar_table()
    monkeypatch.setattr("cytodisk.population.cell_values.BLOCK_VALUES", 50)
    assert len(list(pop.blocks())) == 6
    xr.testing.assert_allclose(pop.values, whole)
    xr.testing.assert_allclose(pop.atlas(), atlas)
    pd.testing.assert_frame_equal(pop.scalar_table(), scalars)

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cytodisk.errors import PopulationError, PopulationWarning, ReadError
from cytodisk.runs.population.opening import map_values
from cytodisk.runs.population.opening.open_population import open_population


def test_a_study_is_a_population_of_its_cells(day1) -> None:
    population = open_population(day1)
    assert population.channels == ("Rac1", "RhoA")
    assert population.raw.shape == (4, 2, 2, 6)
    wanted = np.array([1, 2, 3, 4])[:, None] * [10.0, 100.0]
    np.testing.assert_allclose(population.values, np.broadcast_to(wanted[:, :, None, None], (4, 2, 2, 6)))
    cells = population.cells
    np.testing.assert_allclose(population.areas.sum(("layer", "sector")), cells["area"], rtol=1e-6)
    assert cells["cell"].tolist() == [f"cells.tif, label {label}" for label in (1, 2, 3, 4)]
    assert cells["number"].tolist() == [0, 1, 2, 3]
    assert population.scalars == ("area",)
    assert cells.attrs["units"]["area"] == "px²"
    assert population.raw["depth"].attrs["units"] == "px"
    assert population.raw["depth"][0] < population.raw["depth"][1]
    assert population.values.dtype == np.float64
    assert population.excluded.empty


def test_rows_may_be_in_any_order(day1, changed) -> None:
    shuffled = changed("shuffled", windows=lambda table: table.sample(frac=1.0, random_state=0))
    np.testing.assert_array_equal(open_population(shuffled).values, open_population(day1).values)


def test_channels_are_chosen_and_kept_in_order(day1) -> None:
    assert open_population(day1, channels=["RhoA", "Rac1"]).channels == ("RhoA", "Rac1")
    assert open_population(day1, channels=["RhoA"]).raw.shape == (4, 1, 2, 6)
    with pytest.raises(PopulationError, match=r"channel 'Cdc42' is in no study: they have Rac1, RhoA"):
        open_population(day1, channels=["Cdc42"])
    with pytest.raises(PopulationError, match=r"write \['Rac1'\]"):
        open_population(day1, channels="Rac1")
    with pytest.raises(PopulationError, match=r"empty list"):
        open_population(day1, channels=[])


def test_studies_of_a_list_or_a_folder_are_joined(day1, changed, tmp_path: Path) -> None:
    day2 = changed("day2")
    population = open_population([day1, day2])
    assert population.cells["input"].tolist() == ["day1"] * 4 + ["day2"] * 4
    assert population.cells["cell"].iloc[5] == "day2, label 2"
    assert population.cells["cell"].is_unique
    changed("day10")
    assert open_population(tmp_path).cells["input"].unique().tolist() == ["day2", "day10"]


def test_large_populations_are_in_single_precision_and_say_so(day1, monkeypatch) -> None:
    monkeypatch.setattr(map_values, "MOST_DOUBLE", 1000)
    population = open_population(day1)
    assert population.raw.dtype == population.areas.dtype == np.float32
    assert population.raw.attrs["precision"].startswith("single: in double they would take")
    np.testing.assert_allclose(population.values, open_population(day1).values)


def test_cells_that_are_not_in_it_are_told_with_the_reason(changed) -> None:
    def no_map(cells: pd.DataFrame) -> pd.DataFrame:
        cells.loc[0, ["status", "reason"]] = "refused", "several cells in one mask"
        return cells.assign(condition=["a", "a", None, "a"])

    def no_signal(windows: pd.DataFrame) -> pd.DataFrame:
        return windows.assign(mean=windows["mean"].where(windows["cell"] != 1))

    study = changed("day2", cells=no_map, windows=no_signal)
    more = changed("day3", cells=lambda cells: cells.assign(condition="b"))
    population = open_population([study, more])
    assert population.cells["cell"].tolist() == ["day2, label 4", *(f"day3, label {k}" for k in (1, 2, 3, 4))]
    assert population.conditions == ("a", "b")
    told = population.excluded
    assert told[["input", "label", "reason"]].values.tolist() == [
        ["day2", 1, "refused: several cells in one mask"],
        ["day2", 3, "its condition is empty"],
        ["day2", 2, "all windows of Rac1 are NaN"],
    ]
    json.dumps(population.cells.attrs)


def test_a_cell_without_one_of_the_channels_is_left_out(changed) -> None:
    def without(windows: pd.DataFrame) -> pd.DataFrame:
        return windows[(windows["cell"] != 2) | (windows["channel"] == "Rac1")]

    population = open_population(changed("day2", windows=without))
    assert population.excluded["reason"].tolist() == ["it has no channel RhoA"]


def test_windows_without_a_value_stay_nan(changed) -> None:
    def hole(windows: pd.DataFrame) -> pd.DataFrame:
        return windows.assign(mean=windows["mean"].where((windows["cell"] != 1) | (windows["sector"] > 0)))

    population = open_population(changed("day2", windows=hole))
    assert len(population) == 4
    assert np.isnan(population.values[1]).sum() == 4
    assert np.isnan(population.values).sum() == 4


@pytest.mark.parametrize("extra", [slice(0, 1), slice(5, 6)])
def test_a_window_that_stands_twice_or_not_at_all_is_refused(changed, extra: slice) -> None:
    twice = changed("twice", windows=lambda table: pd.concat([table, table.iloc[extra]]))
    with pytest.raises(ReadError, match=r"stands twice"):
        open_population(twice)
    short = changed("short", windows=lambda table: table.iloc[1:])
    with pytest.raises(ReadError, match=r"cell 0 has rows for 23 of 24 windows"):
        open_population(short)
    absent = changed("absent", windows=lambda table: table[table["cell"] != 3])
    with pytest.raises(ReadError, match=r"cell 3 has rows for 0 of 24 windows"):
        open_population(absent)


def test_a_window_that_the_grid_does_not_have_is_refused(changed) -> None:
    wrong = changed("wrong", windows=lambda table: table.assign(sector=table["sector"] + 1))
    with pytest.raises(ReadError, match=r"sector 6 is none of the 6"):
        open_population(wrong)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("layers", 3, "studies differ in layers: 2 in day1; 3 in other: windows .* same --layers"),
        ("sectors", 8, "differ in sectors"),
        ("spacing", "radius", "differ in spacing: 'area' in day1; 'radius' in other"),
        ("depth_um", [1.0, 2.0], "differ in depth_um"),
        ("method", "harmonic", "differ in method: .* values mean something else.* same --method"),
        ("holes", "exclude", "differ in holes"),
        ("nan", "omit", "differ in nan"),
        ("shape_weight", 0.1, "differ in shape_weight"),
    ],
)
def test_studies_that_differ_in_what_windows_mean_are_refused(day1, changed, name, value, words) -> None:
    with pytest.raises(PopulationError, match=words):
        open_population([day1, changed("other", parameters={name: value})])


def test_studies_that_differ_in_more_are_refused(day1, changed) -> None:
    fingerprint = {"maps version": 1}
    with pytest.raises(PopulationError, match=r"the version of their maps: 2 in day1; 1 in old"):
        open_population([day1, changed("old", fingerprint=fingerprint)])
    with pytest.raises(PopulationError, match=r"the unit of lengths: px in day1; µm in fine.*--pixel-size"):
        open_population([day1, changed("fine", length_unit="µm")])
    nuclei = {"masks": {"path": "a", "sha256": "b"}, "nuclei": {"path": "c", "sha256": "d"}}
    with pytest.raises(PopulationError, match=r"differ in nuclei: without in day1; with nuclei in nucleated"):
        open_population([day1, changed("nucleated", inputs=nuclei)])
    with pytest.raises(PopulationError, match=r"kind of run: cytodisk map in day1; cytodisk movie in film"):
        open_population([day1, changed("film", run="movie", command="cytodisk movie")])


def test_another_align_is_warned_of(day1, changed) -> None:
    turned = changed("turned", parameters={"align": 90.0})
    with pytest.warns(PopulationWarning, match=r"differ in align \('upright', 90\): sector 0"):
        population = open_population([day1, turned])
    assert len(population.cells.attrs["notes"]) == 1


def test_a_channel_that_not_all_have_is_named(day1, changed) -> None:
    def renamed(windows: pd.DataFrame) -> pd.DataFrame:
        return windows.assign(channel=windows["channel"].replace({"RhoA": "Cdc42"}))

    other = changed("day2", windows=renamed)
    with pytest.raises(
        PopulationError,
        match=r"'RhoA' is missing in day2 \(day2 has Rac1, Cdc42\); all have Rac1: pass --channel Rac1",
    ):
        open_population([day1, other])
    assert open_population([day1, other], channels=["Rac1"]).raw.shape == (8, 1, 2, 6)
    none = changed("day3", windows=lambda table: table.assign(channel=table["channel"] + "x"))
    with pytest.raises(PopulationError, match=r"no channel is in all: name them alike with --channels"):
        open_population([day1, none])


def test_a_cell_twice_is_refused(day1, changed) -> None:
    with pytest.raises(PopulationError, match=r"day1 is given twice: each cell counts once"):
        open_population([day1, str(day1)])
    with pytest.raises(PopulationError, match=r"cell 1 of cells.tif is in day1 and in again"):
        open_population([day1, changed("again", same_cells=True)])


def test_equal_masks_with_other_signals_are_other_cells(day1, changed) -> None:
    """As those of cells on one adhesive pattern."""
    found = json.loads((day1 / "provenance.json").read_text())["inputs"]
    found["masks"]["path"], found["signal"]["sha256"] = "elsewhere/cells.tif", "another"
    assert len(open_population([day1, changed("day2", same_cells=True, inputs=found)])) == 8


def test_what_holds_no_cells_says_what_to_do(day1, changed, tmp_path: Path) -> None:
    with pytest.raises(PopulationError, match=r"nowhere does not exist: check the path"):
        open_population(tmp_path / "nowhere")
    with pytest.raises(PopulationError, match=r"is a file: pass the folder"):
        open_population(day1 / "cells.parquet")
    (tmp_path / "empty").mkdir()
    with pytest.raises(PopulationError, match=r"empty is empty: it is no study; pass what cytodisk map"):
        open_population(tmp_path / "empty")
    with pytest.raises(PopulationError, match=r"empty list"):
        open_population([])
    with pytest.raises(PopulationError, match=r"not complete: run the same command again with --resume"):
        open_population(changed("half", status="running"))
    bare = changed("bare", windows=lambda table: table.assign(channel=pd.Series(np.nan, table.index, object)))
    with pytest.raises(PopulationError, match=r"no signal in bare: run cytodisk map with --signal"):
        open_population(bare)


def test_one_cell_is_no_population(changed) -> None:
    def one(cells: pd.DataFrame) -> pd.DataFrame:
        cells.loc[1:, ["status", "reason"]] = "refused", "too small"
        return cells

    with pytest.raises(PopulationError, match=r"one cell can be used \(3 left out: refused: too small\)"):
        open_population(changed("one", cells=one))


def test_scalars_are_columns_of_numbers(day1) -> None:
    assert open_population(day1, scalars=["perimeter"]).scalars == ("perimeter",)
    assert open_population(day1, scalars=[]).scalars == ()
    with pytest.raises(
        PopulationError, match=r"'perimetre' is no column of the cells: did you mean 'perimeter'"
    ):
        open_population(day1, scalars=["perimetre"])
    with pytest.raises(PopulationError, match=r"'qc_flags' is no number that can be compared"):
        open_population(day1, scalars=["qc_flags"])
    with pytest.raises(PopulationError, match=r"write \['area'\]"):
        open_population(day1, scalars="area")


def test_a_summary_of_movies_is_refused_for_images(day1) -> None:
    with pytest.raises(PopulationError, match=r"'velocity' is one of movies, and day1 is of images"):
        open_population(day1, summary="velocity")
    with pytest.raises(PopulationError, match=r"summary must be one of mean, sd"):
        open_population(day1, summary="median")


def test_cells_mapped_without_a_nucleus_are_left_out(changed) -> None:
    inputs = {"masks": {"path": "a", "sha256": "b"}, "nuclei": {"path": "c", "sha256": "d"}}

    def plain(cells: pd.DataFrame) -> pd.DataFrame:
        return cells.assign(nucleus_status=["ok", "ok", "none", "ok"])

    parameters = {"nucleus_layers": 1, "layers": 1, "missing": "plain"}
    population = open_population(changed("nucleated", inputs=inputs, cells=plain, parameters=parameters))
    assert population.compartments == ("cytoplasm", "nucleus")
    assert population.excluded["reason"].item().startswith("it was mapped without a nucleus")


def test_what_does_not_fit_into_memory_is_refused(day1, monkeypatch) -> None:
    monkeypatch.setattr(map_values, "free_bytes", lambda: 1000)
    with pytest.raises(PopulationError, match=r"need 0.0 GB of memory, .*: name some channels"):
        open_population(day1)


def test_damaged_studies_say_which_file_and_what_to_do(changed) -> None:
    odd = changed("odd", parameters={"layers": "many"})
    with pytest.raises(ReadError, match=r"provenance.json: parameters: layers must be .* --overwrite"):
        open_population(odd)
    cut = changed("cut")
    content = (cut / "windows.parquet").read_bytes()
    (cut / "windows.parquet").write_bytes(content[:-100])
    with pytest.raises(ReadError, match=r"windows.parquet is not a table of windows"):
        open_population(cut)
    (cut / "windows.parquet").unlink()
    with pytest.raises(ReadError, match=r"windows.parquet does not exist"):
        open_population(cut)
    (cut / "cells.parquet").write_bytes(b"no table")
    with pytest.raises(ReadError, match=r"cells.parquet is not a table that cytodisk wrote"):
        open_population(cut)

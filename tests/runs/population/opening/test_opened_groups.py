from pathlib import Path

import pytest

import cytodisk as cd
from cytodisk.errors import ParameterError, PopulationError, PopulationWarning
from cytodisk.runs.population.opening.open_population import open_population


def written(folder: Path, text: str) -> Path:
    (folder / "groups.csv").write_text(text)
    return folder / "groups.csv"


def test_groups_by_file_and_cell_come_from_a_table(day1, tmp_path: Path) -> None:
    table = "file,cell,condition,experiment,dose\ncells.tif,1,control,a,0\ncells.tif,2,control,b,0\n"
    table += "cells.tif,3,drug,a,2.5\ncells.tif,4,drug,b,2.5\n"
    population = open_population(day1, groups=written(tmp_path, table))
    assert population.cells["condition"].tolist() == ["control", "control", "drug", "drug"]
    assert population.cells["experiment"].tolist() == ["a", "b"] * 2
    assert population.cells["dose"].tolist() == [0.0, 0.0, 2.5, 2.5]


def test_a_table_takes_the_place_of_what_the_study_says(changed, tmp_path: Path) -> None:
    study = changed("day2", cells=lambda cells: cells.assign(condition="before", plate=7))
    groups = written(tmp_path, "file,condition\ncells,after\n")
    population = open_population(study, groups=groups)
    assert population.conditions == ("after",)
    assert population.cells["plate"].tolist() == [7] * 4


def test_cells_that_no_row_is_about_are_left_out(day1, tmp_path: Path) -> None:
    groups = written(tmp_path, "cell,condition\n1,control\n2,drug\n")
    with pytest.warns(PopulationWarning, match="2 of 4 cells are in no row"):
        population = open_population(day1, groups=groups)
    assert len(population) == 2
    told = population.excluded
    assert told["label"].tolist() == [3, 4]
    assert set(told["reason"]) == {"its condition is empty"}


def test_studies_are_told_apart_by_their_names(day1, changed, tmp_path: Path) -> None:
    groups = written(tmp_path, "file,experiment\nday1,a\nday2,b\n")
    population = open_population([day1, changed("day2")], groups=groups)
    assert population.cells["experiment"].tolist() == ["a"] * 4 + ["b"] * 4


def test_the_path_of_masks_is_known_from_the_study(day1, tmp_path: Path) -> None:
    masks = Path(cd.open_study(day1).provenance["inputs"]["masks"]["path"])
    groups = written(tmp_path, f"file,condition\n{masks.parent.name}/cells.tif,a\n")
    assert open_population(day1, groups=groups).conditions == ("a",)
    with pytest.raises(ParameterError, match=r"no file 'another/cells\.tif'"):
        open_population(day1, groups=written(tmp_path, "file,condition\nanother/cells.tif,a\n"))


def test_a_row_about_no_cell_is_refused(day1, tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"other\.tif"):
        open_population(day1, groups=written(tmp_path, "file,condition\ncells.tif,a\nother.tif,b\n"))


def test_files_of_one_name_are_told_apart_by_their_paths(day1, changed, tmp_path: Path) -> None:
    inputs = {"masks": {"path": "/data/day 2/cells.tif", "sha256": "other"}}
    groups = written(tmp_path, "file,experiment\nday 2/cells.tif,b\nday1,a\n")
    population = open_population([day1, changed("second", inputs=inputs)], groups=groups)
    assert population.cells["experiment"].tolist() == ["a"] * 4 + ["b"] * 4


def test_inputs_of_several_folders_are_named_with_them(day1, changed, tmp_path: Path) -> None:
    other = tmp_path / "other" / "day1"
    other.parent.mkdir()
    changed("copy").rename(other)
    names = open_population([day1, other]).cells["input"].unique().tolist()
    assert names[1] == "other/day1"
    groups = written(tmp_path, f"file,condition\n{names[0]},a\n{names[1]},b\n")
    assert open_population([day1, other], groups=groups).cells["condition"].tolist() == ["a"] * 4 + ["b"] * 4


def test_columns_of_a_user_do_not_replace_those_of_a_population(day1, changed, tmp_path: Path) -> None:
    study = changed("day2", cells=lambda cells: cells.assign(number=5))
    with pytest.raises(PopulationError, match=r"day2: column 'number' is one that .* rename yours"):
        open_population(study)
    groups = written(tmp_path, "cell,study\n1,x\n2,x\n3,x\n4,x\n")
    with pytest.raises(PopulationError, match=r"groups.csv: column 'study' is one that"):
        open_population(day1, groups=groups)
    measured = changed("day3", cells=lambda cells: cells.assign(disk_direction_axis=5.0))
    with pytest.raises(
        PopulationError, match=r"column 'disk_direction_axis' of the cells is one that is measured"
    ):
        open_population(measured)
    given = changed(
        "day4", cells=lambda cells: cells.assign(disk_direction_front=90.0, direction_strength_front=1.0)
    )
    assert open_population(given).align("front").alignment["status"].tolist() == ["ok"] * 4

"""`--groups` on the command line."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile
from command_line import Run, assert_refused, write

from cytodisk.runs.groups.known_cells import numbers_words


@pytest.fixture
def labels(tmp_path: Path) -> Path:
    image = np.zeros((20, 40), dtype=np.uint8)
    image[4:16, 4:15], image[4:16, 24:35] = 1, 3
    return write(tmp_path / "labels.tif", image)


def table(folder: Path, *lines: str) -> Path:
    (folder / "groups.csv").write_text("\n".join(lines), encoding="utf-8")
    return folder / "groups.csv"


def test_check_says_which_cells_have_which_condition(run: Run, labels: Path, tmp_path: Path) -> None:
    groups = table(tmp_path, "cell,condition,experiment,dose", "1,control,day 1,0.5", "3,drug,day 1,2")
    code, said, _ = run("check", labels, "--groups", groups, "--all")
    assert code == 0
    lines = said.splitlines()
    assert (
        "groups: by cell; conditions: control (1 cell of 1 experiment), drug (1 cell of 1 experiment); "
        "columns dose"
    ) in lines
    assert "cell\tframe\tlabel\tcondition\texperiment\tdose\tusable\tremarks" in lines
    assert any(line.startswith("0\t0\t1\tcontrol\tday 1\t0.5\tyes") for line in lines)
    assert any(line.startswith("1\t0\t3\tdrug\tday 1\t2\tyes") for line in lines)


def test_check_says_what_is_wrong_with_a_table_of_groups(run: Run, labels: Path, tmp_path: Path) -> None:
    groups = table(tmp_path, "file,cell,condition", "labels,2,control", "label,1,drug")
    assert_refused(run("check", labels, "--groups", groups), "did you mean 'labels.tif'?")
    groups = table(tmp_path, "file,cell,condition", "labels,2,control")
    assert_refused(run("check", labels, "--groups", groups), "there is no cell 2 of labels.tif", "1, 3")
    assert_refused(run("check", labels, "--groups", tmp_path / "none.csv"), "none.csv cannot be read")


@pytest.mark.parametrize(("command", "name"), [("map", "cells"), ("movie", "cells"), ("shapes", "shapes")])
def test_commands_write_the_columns_and_say_which_cells_have_none(
    run: Run, labels: Path, tmp_path: Path, command: str, name: str
) -> None:
    small = () if command == "shapes" else ("--layers", 1, "--sectors", 4, "--figures", 0)
    if command == "movie":
        write(labels, np.stack([tifffile.imread(labels)] * 2), metadata={"axes": "TYX"})
    groups = table(tmp_path, "cell,condition", "1,control")
    out = tmp_path / "out"
    code, said, error = run(command, labels, "-o", out, "--groups", groups, *small)
    assert code == 0, error
    assert "groups: by cell; conditions: control (1 cell)" in said
    words = "groups.csv: 1 of 2 cells are in no row, so they have no condition: label 3 of labels.tif"
    assert words in said + error
    assert pd.read_parquet(out / f"{name}.parquet")["condition"].fillna("").unique().tolist() == [
        "control",
        "",
    ]
    same = run(command, labels, "-o", out, "--groups", groups, "--resume", *small)
    assert same[0] == 0
    table(tmp_path, "cell,condition", "1,control", "3,drug")
    other = run(command, labels, "-o", out, "--groups", groups, "--resume", *small)
    assert_refused(other, "groups")


def test_long_lists_of_labels_are_cut_off() -> None:
    assert numbers_words(range(0, 40, 2)).endswith("12, 14, …")

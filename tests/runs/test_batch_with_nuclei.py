"""Batches of cells with nuclei: the batch file, the inputs and the merged tables."""

from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import ParameterError, StudyError
from cytodisk.runs.batch.batch_file import read_batch
from cytodisk.runs.batch.batch_task import BatchTask
from cytodisk.runs.batch.cluster_tasks import as_seen_by_all
from cytodisk.runs.batch.dry_run import understand
from cytodisk.runs.batch.input_row import files_mark

STUDY = """
[study]
kind = "map"

[parameters]
layers = 2
sectors = 4
several = "largest"

[[inputs]]
masks = "?_masks.tif"
nuclei = "{image}_nuclei.tif"
name = "{image}"
parameters = {nucleus_layers = 1}

[[inputs]]
masks = "plain.tif"
name = "plain"
"""


@pytest.fixture
def study(tmp_path: Path) -> Path:
    for k, name in enumerate("ab"):
        cells, nuclei = np.zeros((2, 60, 120), dtype=np.uint8)
        cells[5:55, 5:55], cells[5:55, 60:110] = 1, 2
        nuclei[20:35, 20 : 35 + k], nuclei[20:40, 70:90] = 5, 6 * (k == 0)
        tifffile.imwrite(tmp_path / f"{name}_masks.tif", cells)
        tifffile.imwrite(tmp_path / f"{name}_nuclei.tif", nuclei)
    tifffile.imwrite(tmp_path / "plain.tif", (cells == 1).astype(np.uint8))
    (tmp_path / "study.toml").write_text(STUDY)
    return tmp_path / "study.toml"


def test_templates_follow_each_mask_file(study: Path) -> None:
    items = read_batch(study).inputs
    assert [item.nuclei and item.nuclei.name for item in items] == ["a_nuclei.tif", "b_nuclei.tif", None]
    assert [understand(item).fault for item in items] == ["", "", ""]


def test_tables_are_merged_with_those_of_cells_without_nuclei(study: Path) -> None:
    out = study.parent / "out"
    cd.run_batch(study, out)
    inputs = pd.read_csv(out / "inputs.csv").set_index("input")
    assert inputs["nuclei"].fillna("").tolist() == ["a_nuclei.tif", "b_nuclei.tif", ""]
    cells = pd.read_parquet(out / "cells.parquet")
    assert cells["nucleus_status"].fillna("").tolist() == ["ok", "ok", "ok", "none", ""]
    assert cells["status"].tolist() == ["ok", "ok", "ok", "refused", "ok"]
    nuclei = pd.read_parquet(out / "nuclei.parquet")
    assert nuclei[["input", "nuclei"]].to_numpy().tolist() == [["a", "5"], ["a", "6"], ["b", "5"], ["b", ""]]
    windows = pd.read_parquet(out / "windows.parquet")
    assert windows.groupby("input")["layer"].nunique().tolist() == [3, 3, 2]
    assert windows.groupby("input")["compartment"].last().fillna("").tolist() == ["nucleus", "nucleus", ""]
    assert "nuclei.parquet" in pd.read_csv(out / "columns.csv")["table"].tolist()


@pytest.mark.slow
def test_other_nuclei_are_done_again_and_nothing_else(study: Path) -> None:
    out = study.parent / "out"
    cd.run_batch(study, out)
    before = {name: (out / f"inputs/{name}/provenance.json").stat().st_mtime_ns for name in ("a", "b")}
    nuclei = tifffile.imread(study.parent / "b_nuclei.tif")
    nuclei[30, 80] = 9
    tifffile.imwrite(study.parent / "b_nuclei.tif", nuclei)
    cd.run_batch(study, out, resume=True)
    after = {name: (out / f"inputs/{name}/provenance.json").stat().st_mtime_ns for name in ("a", "b")}
    assert after["a"] == before["a"]
    assert after["b"] > before["b"]
    cells = pd.read_parquet(out / "cells.parquet")
    assert cells.loc[cells["input"] == "b", "nucleus_status"].tolist() == ["ok", "ok"]


def test_nuclei_count_for_the_mark_of_the_files(study: Path) -> None:
    item = read_batch(study).inputs[0]
    assert files_mark(item) != files_mark(replace(item, nuclei=None))


@pytest.mark.slow
def test_nuclei_among_the_results_are_never_removed(study: Path) -> None:
    out = study.parent / "out"
    cd.run_batch(study, out)
    inside = out / "inputs/a/nuclei.tif"
    (study.parent / "a_nuclei.tif").rename(inside)
    marked = out / "inputs/a/nuclei.parquet"
    marked.unlink()
    marked.symlink_to(inside)
    study.write_text(STUDY.replace("{image}_nuclei.tif", "out/inputs/a/nuclei.parquet"))
    with pytest.raises(StudyError, match="is among the results"):
        cd.run_batch(study, out, overwrite=True)
    assert inside.exists()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("{image}_nuclei.tif", "gone.tif"), r"nuclei \S+gone\.tif does not exist"),
        (("{image}_nuclei.tif", "{name}"), r"is the mask file itself: name the masks of its nuclei"),
        (("{image}_nuclei.tif", "{well}.tif"), "field in nuclei"),
        (('"{image}_nuclei.tif"', "5"), "nuclei must be a path, got 5"),
        (('kind = "map"', 'kind = "map"\ncolumns = ["n_nuclei"]'), "one that the tables have anyway"),
    ],
)
def test_faults_of_the_file_are_said_before_the_run(study: Path, change: tuple[str, str], words: str) -> None:
    study.write_text(STUDY.replace(*change))
    with pytest.raises(ParameterError, match=words):
        read_batch(study)


def test_what_is_said_of_nuclei_without_any_is_a_fault_of_the_input(study: Path) -> None:
    study.write_text(STUDY.replace('nuclei = "{image}_nuclei.tif"\n', ""))
    assert [understand(item).fault != "" for item in read_batch(study).inputs] == [True, True, False]
    assert "nucleus_layers is given, but there are no nuclei" in understand(read_batch(study).inputs[0]).fault


def test_paths_are_full_for_workers_elsewhere(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(study.parent)
    (item,) = (one for one in read_batch(Path("study.toml")).inputs if one.name == "a")
    near = replace(item, masks=Path("a_masks.tif"), nuclei=Path("a_nuclei.tif"))
    folder = replace(item, masks=Path(), nuclei=Path("_nuclei"))
    task = as_seen_by_all(BatchTask(version("cytodisk"), (near, folder), "out"), "out", "")
    assert [one.nuclei for one in task.inputs] == [study.parent / "a_nuclei.tif", Path("_nuclei")]


def test_cells_have_the_numbers_of_the_channels_of_all_inputs(study: Path) -> None:
    for name, signal in (("a", "DAPI"), ("b", "GFP")):
        nuclei = tifffile.imread(study.parent / f"{name}_nuclei.tif") > 0
        tifffile.imwrite(study.parent / f"{name}_{signal}.tif", np.where(nuclei, 6.0, 2.0).astype(np.float32))
    inputs = STUDY[STUDY.index("[[inputs]]") : STUDY.rindex("[[inputs]]")].replace("?_masks", "a_masks")
    first = inputs.replace("name =", 'signal = "a_DAPI.tif"\nname =').replace(
        "= 1}", '= 1, channels = ["DAPI"]}'
    )
    second = first.replace("a_masks", "b_masks").replace("a_DAPI", "b_GFP").replace("DAPI", "GFP")
    study.write_text(STUDY[: STUDY.index("[[inputs]]")] + first + second)
    out = study.parent / "out"
    cd.run_batch(study, out)
    cells = pd.read_parquet(out / "cells.parquet")
    assert cells["nucleus_to_cytoplasm_DAPI"].round(6).fillna(0).tolist() == [3, 3, 0, 0]
    assert cells["nucleus_to_cytoplasm_GFP"].round(6).fillna(0).tolist() == [0, 0, 3, 0]
    assert cells["nucleus_offset"].notna().tolist() == [True, True, True, False]
    assert "nucleus_to_cytoplasm_GFP" in pd.read_csv(out / "columns.csv")["column"].tolist()

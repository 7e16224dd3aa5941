"""Groups of a batch: columns by cell in all merged tables, and faults before anything runs."""

import json
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import ParameterError
from cytodisk.runs.batch.batch_file import read_batch
from cytodisk.runs.batch.batch_study import BatchSummary
from cytodisk.runs.batch.dry_run import refuse_groups

STUDY = """
[study]
kind = "map"
groups = "groups.csv"
[parameters]
layers = 1
sectors = 4
edge_length = 2.0
[[inputs]]
masks = "labels.tif"
experiment = "day 1"
[[inputs]]
masks = "folder"
name = "more"
[[inputs]]
masks = "movie.tif"
kind = "movie"
[[inputs]]
masks = "damaged.tif"
"""
TABLE = (
    "file,cell,frame,condition,dose",
    "labels,1,,control,0",
    "labels,3,,drug,2.5",
    "folder/b_masks.tif,,,drug,5",
    "a,2,,control,0",
    "movie,,0,control,0",
    "movie,,1,drug,1",
    "damaged,7,,drug,1",
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_files(tmp_path)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A batch that is done."""
    folder = write_files(tmp_path_factory.mktemp("batch"))
    cd.run_batch(folder / "study.toml", folder / "out", tell=lambda _: None)
    return folder


@pytest.fixture
def done(run: Path, tmp_path: Path) -> Path:
    """A copy to go on with, in which nothing is left to do."""
    shutil.copytree(run, tmp_path / "batch")
    (tmp_path / "batch" / "study.toml").write_text(STUDY.rpartition("[[inputs]]")[0])
    return tmp_path / "batch"


def write_files(folder: Path) -> Path:
    """Batch of label images, one file and a folder, a movie, and a damaged file."""
    image = np.zeros((20, 40), dtype=np.uint8)
    image[4:16, 4:15], image[4:16, 24:35] = 1, 3
    (folder / "folder").mkdir()
    for name, values in (("labels", image), ("folder/a_masks", image % 3 * 2), ("folder/b_masks", image)):
        tifffile.imwrite(folder / f"{name}.tif", values, photometric="minisblack")
    movie = np.stack([image[:, :20] == 1] * 2).astype(np.uint8)
    tifffile.imwrite(folder / "movie.tif", movie, photometric="minisblack", metadata={"axes": "TYX"})
    (folder / "damaged.tif").write_bytes(b"no image")
    (folder / "study.toml").write_text(STUDY)
    write_table(folder, *TABLE)
    return folder


def resume(folder: Path, **options: Path) -> BatchSummary:
    return cd.run_batch(folder / "study.toml", folder / "out", resume=True, tell=lambda _: None, **options)


def write_table(folder: Path, *lines: str) -> None:
    (folder / "groups.csv").write_text("\n".join(lines), encoding="utf-8")


@pytest.mark.slow
def test_columns_by_cell_and_frame_are_in_all_merged_tables(run: Path) -> None:
    tables = {path.stem: pd.read_parquet(path) for path in (run / "out").glob("*.parquet")}
    cells = tables["cells"]
    assert cells.columns[:5].tolist() == ["input", "condition", "experiment", "dose", "length_unit"]
    keys = cells[["input", "cell", "frame", "condition", "experiment", "dose"]].fillna("")
    assert keys.to_numpy().tolist() == [
        ["labels", 0, 0, "control", "day 1", 0.0],
        ["labels", 1, 0, "drug", "day 1", 2.5],
        ["more", 0, 0, "control", "", 0.0],
        ["more", 1, 0, "drug", "", 5.0],
        ["more", 2, 0, "drug", "", 5.0],
        ["movie", 0, 0, "control", "", 0.0],
        ["movie", 0, 1, "drug", "", 1.0],
    ]
    by_cell = cells.set_index(["input", "cell", "frame"])["condition"]
    for name in ("windows", "edge", "consistency"):
        found = tables[name].set_index(["input", "cell", "frame"])["condition"]
        assert len(found)
        assert (found == by_cell.loc[found.index]).all()
    assert tables["inputs"].set_index("input")["condition"].isna().all()  # cells of no input are alike
    told = pd.read_csv(run / "out" / "columns.csv").set_index(["table", "column"])["meaning"]
    assert told["windows.parquet", "dose"] == "your own, from the table of groups"
    provenance = json.loads((run / "out" / "provenance.json").read_text())
    assert provenance["warnings"] == ["groups.csv line 8: the image has no usable masks"]
    assert provenance["columns"] == ["condition", "experiment", "dose"]
    assert provenance["inputs"]["groups"]["path"] == str(run / "groups.csv")


@pytest.mark.slow
def test_a_table_that_changed_changes_the_merged_tables_alone(done: Path) -> None:
    study = done / "out" / "inputs" / "labels" / "cells.parquet"
    before = study.stat().st_mtime_ns
    write_table(done, "file,condition", "labels,treated", "more,control", "movie,control")
    assert not [words for words in resume(done).remarks if "groups.csv" in words]
    assert study.stat().st_mtime_ns == before
    inputs = pd.read_parquet(done / "out" / "inputs.parquet").set_index("input")
    assert inputs["condition"].to_dict() == {"labels": "treated", "more": "control", "movie": "control"}
    assert "dose" not in inputs
    (done / "other.csv").write_text("file,condition\nlabels,other\n")
    *_, words = resume(done, groups=done / "other.csv").remarks
    assert words.startswith(
        "other.csv: 4 of 6 cells are in no row, so they have no condition: a_masks.tif, b_"
    )
    cells = pd.read_parquet(done / "out" / "cells.parquet")
    assert cells["condition"].fillna("").tolist() == ["other"] * 2 + [""] * 5


@pytest.mark.slow
def test_a_row_of_no_cell_is_said_and_nothing_is_lost(done: Path) -> None:
    write_table(done, "file,cell,condition", "labels,2,control")
    with pytest.raises(ParameterError, match=r"(?s)no cell 2 of labels\.tif.*all inputs are done.*--resume"):
        resume(done)
    write_table(done, "file,cell,condition", "labels,1,control")
    assert resume(done).statuses == {"ok": 3}


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (("file,condition", "label,x"), "no file 'label': did you mean 'labels"),
        (
            ("file,experiment", "labels,x"),
            "column 'experiment' is in the batch file, too, as for input labels",
        ),
        (("file,mapped", "labels,x"), "column 'mapped' is one that the tables have anyway"),
        (("file,condition", "folder/c_masks.tif,x"), "no file 'folder/c_masks.tif'"),
    ],
)
def test_a_table_that_does_not_fit_is_refused_before_anything_runs(
    folder: Path, lines: tuple[str, ...], words: str
) -> None:
    write_table(folder, *lines)
    with pytest.raises(ParameterError, match=words):
        cd.run_batch(folder / "study.toml", folder / "out", tell=lambda _: None)
    assert not (folder / "out").exists()


def test_a_dry_run_compares_labels_of_images(folder: Path) -> None:
    assert refuse_groups(read_batch(folder / "study.toml")) == ()
    write_table(folder, "file,cell,condition", "labels,2,control", "movie,7,drug")
    with pytest.raises(ParameterError, match=r"there is no cell 2 of labels\.tif: labels of cells are 1, 3$"):
        refuse_groups(read_batch(folder / "study.toml"))
    (folder / "study.toml").write_text(STUDY.partition('[[inputs]]\nmasks = "movie')[0])
    write_table(
        folder, "file,cell,condition", "labels,1,control", "more,1,drug", "folder/a_masks.tif,2,control"
    )
    (words,) = refuse_groups(read_batch(folder / "study.toml"))
    assert words.endswith(
        "2 of 5 cells are in no row, so they have no condition: label 3 of labels.tif, label 3 of b_masks.tif"
    )


def test_groups_of_one_input_are_refused_by_name(folder: Path) -> None:
    (folder / "study.toml").write_text('[[inputs]]\nmasks = "movie.tif"\ngroups = "groups.csv"\n')
    with pytest.raises(ParameterError, match=r"groups stands in \[study\]: one table for all inputs"):
        cd.run_batch(folder / "study.toml", folder / "out")

"""Groups in runs over masks: their columns in the tables, and what is said of a table that does not fit."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import OtherRunError, ParameterError

SMALL: dict[str, Any] = {"layers": 1, "sectors": 4, "edge_length": 2.0}


def write_table(folder: Path, *lines: str) -> Path:
    (folder / "groups.csv").write_text("\n".join(lines), encoding="utf-8")
    return folder / "groups.csv"


def write_labels(path: Path, labels: Sequence[int], shift: int = 0) -> Path:
    image = np.zeros((20, 20 * len(labels)), dtype=np.uint8)
    for place, label in enumerate(labels):
        image[4:16, 20 * place + 4 + shift : 20 * place + 15 + shift] = label
    tifffile.imwrite(path, image, photometric="minisblack")
    return path


@pytest.fixture
def masks(tmp_path: Path) -> Path:
    """Folder of two label images and a damaged one."""
    folder = tmp_path / "masks"
    folder.mkdir()
    write_labels(folder / "a_cp_masks.tif", (1, 3))
    write_labels(folder / "b_cp_masks.tif", (2,))
    (folder / "c_cp_masks.tif").write_bytes(b"no image")
    return folder


def test_the_columns_stand_behind_the_label_in_all_tables_of_cells(masks: Path, tmp_path: Path) -> None:
    table = write_table(
        tmp_path, "file;cell;condition;experiment;dose", "a;1;control;7;0", "a;3;drug;7;2.5", "b;;drug;8;5"
    )
    study = cd.run_map(masks, tmp_path / "out", groups=table, csv=True, **SMALL)
    assert study.cells.columns[:8].tolist() == [
        "cell",
        "source",
        "frame",
        "time_s",
        "label",
        "condition",
        "experiment",
        "dose",
    ]
    held = study.cells[study.cells["label"] != 0]
    assert held["condition"].tolist() == ["control", "drug", "drug"]
    assert held["experiment"].tolist() == ["7", "7", "8"]
    assert held["dose"].tolist() == [0.0, 2.5, 5.0]
    assert study.cells["condition"].isna().sum() == 1  # the damaged file
    written = pd.read_csv(tmp_path / "out" / "cells.csv", dtype=str)
    assert written["experiment"].tolist()[:3] == ["7", "7", "8"]
    told = pd.read_csv(tmp_path / "out" / "columns.csv").set_index(["table", "column"])["meaning"]
    assert told["cells.parquet", "condition"] == "what was done to the cell"
    assert told["cells.parquet", "dose"] == "your own, from the table of groups"
    given = cd.open_study(tmp_path / "out").provenance["inputs"]["groups"]
    assert given["path"] == str(table)
    assert len(given["sha256"]) == 64
    assert given["read as"] == (
        "by file and cell; conditions: control (1 cell of 1 experiment), drug (2 cells of 2 experiments); "
        "columns dose"
    )


def test_a_table_that_changed_is_another_input(masks: Path, tmp_path: Path) -> None:
    table = write_table(tmp_path, "file,condition", "a,control", "b,drug")
    first = cd.run_map(masks, tmp_path / "out", groups=table, **SMALL)
    again = cd.run_map(masks, tmp_path / "out", groups=table, resume=True, **SMALL)
    pd.testing.assert_frame_equal(first.cells, again.cells)
    write_table(tmp_path, "file,condition", "a,drug", "b,drug")
    with pytest.raises(OtherRunError, match=r"groups sha256: .*: cytodisk population takes another table of"):
        cd.run_map(masks, tmp_path / "out", groups=table, resume=True, **SMALL)
    with pytest.raises(OtherRunError, match="groups"):
        cd.run_map(masks, tmp_path / "out", resume=True, **SMALL)


def test_a_study_whose_derived_tables_are_gone_gets_its_groups_again(masks: Path, tmp_path: Path) -> None:
    table = write_table(tmp_path, "file,condition", "a,control", "b,drug")
    first = cd.run_map(masks, tmp_path / "out", groups=table, csv=True, **SMALL)
    before = (tmp_path / "out" / "cells.csv").read_bytes()
    (tmp_path / "out" / "cells.csv").unlink()
    with pytest.warns(cd.errors.DamagedPartWarning):
        again = cd.run_map(masks, tmp_path / "out", groups=table, csv=True, resume=True, **SMALL)
    pd.testing.assert_frame_equal(first.cells, again.cells)
    assert (tmp_path / "out" / "cells.csv").read_bytes() == before


def test_cells_without_a_row_are_among_the_warnings(masks: Path, tmp_path: Path) -> None:
    table = write_table(tmp_path, "file,condition", "a,control")
    study = cd.run_map(masks, tmp_path / "out", groups=table, **SMALL)
    assert study.cells["condition"].notna().tolist() == [True, True, False, False]
    [words] = [words for words in study.provenance["warnings"] if words.startswith("groups.csv")]
    assert words.endswith("1 of 3 cells are in no row, so they have no condition: b_cp_masks.tif")


def test_a_row_of_no_cell_stops_the_run_before_it_begins(masks: Path, tmp_path: Path) -> None:
    table = write_table(tmp_path, "file,cell,condition", "a,2,control", "b,2,drug")
    with pytest.raises(ParameterError, match=r"no cell 2 of a_cp_masks\.tif: labels of cells are 1, 3"):
        cd.run_map(masks, tmp_path / "out", groups=table, **SMALL)
    assert not (tmp_path / "out").exists()


def test_masks_of_a_stack_have_the_condition_of_their_position(tmp_path: Path) -> None:
    stack = np.zeros((3, 20, 20), dtype=np.uint8)
    stack[:, 4:16, 5:15] = 255
    tifffile.imwrite(tmp_path / "stack.tif", stack, photometric="minisblack", metadata={"axes": "TYX"})
    table = write_table(tmp_path, "frame,cell,condition", "2,1,drug", "0,,control", "1,,control")
    study = cd.run_map(tmp_path / "stack.tif", tmp_path / "out", groups=table, **SMALL)
    assert study.cells["condition"].tolist() == ["control", "control", "drug"]


def test_shapes_have_groups_in_both_tables(masks: Path, tmp_path: Path) -> None:
    table = write_table(tmp_path, "file,condition,day", "a,control,1", "b,drug,2")
    shapes = cd.run_shapes(masks, tmp_path / "out", groups=table)
    cells = pd.read_parquet(tmp_path / "out" / "cells.parquet")
    for found in (shapes, cells, cd.open_shapes(tmp_path / "out")):
        assert found["condition"].tolist()[:3] == ["control", "control", "drug"]
        assert found["day"].tolist()[:3] == [1, 1, 2]
    told = pd.read_csv(tmp_path / "out" / "columns.csv").set_index(["table", "column"])["meaning"]
    assert told["shapes.parquet", "condition"] == told["cells.parquet", "condition"]
    with pytest.raises(ParameterError, match="column 'circularity' is one that the tables of this run have"):
        cd.run_shapes(masks, tmp_path / "b", groups=write_table(tmp_path, "file,circularity", "a,1", "b,1"))


def test_a_movie_has_groups_by_cell_or_by_frame(tmp_path: Path) -> None:
    frames = np.stack([tifffile.imread(write_labels(tmp_path / "f.tif", (4, 9), k)) for k in range(3)])
    tifffile.imwrite(tmp_path / "labels.tif", frames, photometric="minisblack", metadata={"axes": "TYX"})
    table = write_table(tmp_path, "cell,condition,experiment", "4,control,d1", "9,drug,d1")
    study = cd.run_movie(tmp_path / "labels.tif", tmp_path / "out", groups=table, **SMALL)
    assert study.cells["condition"].tolist() == ["control"] * 3 + ["drug"] * 3
    assert "groups" in study.provenance["inputs"]
    table = write_table(tmp_path, "file,frame,condition", "labels,0,before", "labels,2,after")
    study = cd.run_movie(tmp_path / "labels.tif", tmp_path / "by_frame", groups=table, **SMALL)
    assert study.cells["condition"].fillna("").tolist() == ["before", "", "after"] * 2
    assert any("2 of 2 cells are in no row" in words for words in study.provenance["warnings"])


def test_a_column_of_a_channel_is_not_taken_from_the_user(tmp_path: Path) -> None:
    masks = write_labels(tmp_path / "cells.tif", (1, 2))
    nuclei = tifffile.imread(masks)
    nuclei[:, :] = np.where(
        np.roll(nuclei, 3, 1) * np.roll(nuclei, -3, 1) * np.roll(nuclei, 3, 0) > 0, nuclei, 0
    )
    tifffile.imwrite(tmp_path / "nuclei.tif", nuclei, photometric="minisblack")
    tifffile.imwrite(tmp_path / "GFP.tif", nuclei, photometric="minisblack")
    table = write_table(tmp_path, "cell,nucleus_mean_GFP", "1,1", "2,2")
    with pytest.raises(
        ParameterError, match="column 'nucleus_mean_GFP' is one that the tables of this run have"
    ):
        cd.run_map(
            masks, tmp_path / "out", signal=tmp_path / "GFP.tif", nuclei=tmp_path / "nuclei.tif", groups=table
        )

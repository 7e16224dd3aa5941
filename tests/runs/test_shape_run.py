"""A run over the shapes of many cells: what it writes, and that nothing that was measured is lost."""

import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
import tifffile

import cytodisk as cd
from cytodisk.analysis.shape import complexity
from cytodisk.analysis.shape.features import FEATURES
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError, ReadError, StudyError
from cytodisk.runs.shapes import shape_study as module
from cytodisk.runs.shapes.shape_parameters import ShapeParameters
from cytodisk.runs.shapes.shape_study import (
    cleaned_masks,
    open_shape_inputs,
    shape_study,
)

NAMES = [feature.name for feature in FEATURES]


@pytest.fixture(autouse=True)
def plane(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two features instead of UMAP, which takes seconds to be compiled and has tests of its own."""

    def two_features(values: FloatArray, *_: object) -> FloatArray:
        return np.asarray(values[:, :2] - values[:, :2].mean(axis=0))

    monkeypatch.setattr(complexity, "umap_plane", two_features)
    monkeypatch.setattr(module, "CELLS_AT_ONCE", 3)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two label images with 7 and 5 cells, and a file that is no image."""
    place = tmp_path / "masks"
    place.mkdir()
    for name, seeds in (("a_masks.tif", range(7)), ("b_masks.tif", range(7, 12))):
        image = np.zeros((50, 420), dtype=np.uint16)
        for column, seed in enumerate(seeds):
            cell = cd.simulate.random_smooth(seed, radius=10 + seed, margin=0)[:50, :58]
            left = 60 * column
            image[: cell.shape[0], left : left + cell.shape[1]][cell] = 10 + seed
        tifffile.imwrite(place / name, image, photometric="minisblack", resolution=(4, 4), metadata=None)
    (place / "c_masks.tif").write_bytes(b"no image")
    return place


def run(masks: Path, out: Path, parameters: ShapeParameters | None = None, **options: object) -> pd.DataFrame:
    given = ShapeParameters() if parameters is None else parameters
    return shape_study(open_shape_inputs(masks, given), out, given, **options)  # type: ignore[arg-type]


def test_a_folder_gives_a_row_a_cell_and_a_bad_file_one_row(folder: Path, tmp_path: Path) -> None:
    table = run(folder, tmp_path / "out")
    assert table["cell"].tolist() == list(range(13))
    assert table["source"].tolist() == ["a_masks.tif"] * 7 + ["b_masks.tif"] * 5 + ["c_masks.tif"]
    assert table["label"].tolist()[:12] == list(range(10, 22))
    assert table["status"].tolist() == ["ok"] * 12 + ["unreadable"]
    assert "c_masks.tif" in table["reason"][12]
    assert table.loc[:11, ["complexity", *NAMES]].notna().all(axis=None)
    assert table.loc[12, ["complexity", *NAMES]].isna().all()
    assert table.loc[:11, "touches_border"].any()  # cells begin in the first row


def test_features_are_those_of_shape_features(folder: Path, tmp_path: Path) -> None:
    table = run(folder, tmp_path / "out", ShapeParameters(pixel_size_um=0.25))
    expected = cd.shape_features(tifffile.imread(folder / "a_masks.tif"), pixel_size_um=0.25)
    pd.testing.assert_frame_equal(table.loc[:6, ["label", *NAMES]], expected[["label", *NAMES]])
    assert table.attrs["units"]["area"] == "µm²"


def test_the_files_of_a_study_say_what_their_columns_mean(folder: Path, tmp_path: Path) -> None:
    table = run(folder, tmp_path / "out", ShapeParameters(pixel_size_um=0.25, seed=4))
    out = tmp_path / "out"
    schema = pq.read_schema(out / "shapes.parquet")
    assert schema.field("feret_max").metadata == {b"unit": "µm".encode()}
    assert schema.field("complexity").metadata == {b"unit": b"1"}
    read = cd.open_shapes(out)
    pd.testing.assert_frame_equal(read, table, check_dtype=False)
    assert read.attrs["units"]["area"] == "µm²"
    csv = pd.read_csv(out / "shapes.csv")
    np.testing.assert_allclose(csv[NAMES], table[NAMES])
    features = pd.read_csv(out / "features.csv")
    assert features["name"].tolist() == NAMES
    assert features.set_index("name").loc["area", ["unit", "scale_free"]].tolist() == ["µm²", False]
    provenance = json.loads((out / "provenance.json").read_text())
    assert (provenance["run"], provenance["status"], provenance["seed"]) == ("shapes", "complete", 4)
    assert "umap-learn" in provenance["versions"]
    assert any("c_masks.tif" in warning for warning in provenance["warnings"])
    assert "seed = 4" in (out / "parameters.toml").read_text()
    assert pd.read_parquet(out / "cells.parquet")["status"].tolist() == table["status"].tolist()
    assert {path.name for path in out.iterdir()} == {
        "cells.parquet", "columns.csv", "features.csv", "parameters.toml", "provenance.json",
        "shapes.csv", "shapes.parquet",
    }  # fmt: skip


@pytest.mark.slow
def test_results_do_not_depend_on_workers(folder: Path, tmp_path: Path) -> None:
    masks = folder / "b_masks.tif"  # two parts, so that there is work for two
    one, two = run(masks, tmp_path / "one"), run(masks, tmp_path / "two", workers=2)
    pd.testing.assert_frame_equal(one, two, check_exact=True)
    assert (tmp_path / "one/shapes.csv").read_bytes() == (tmp_path / "two/shapes.csv").read_bytes()


def test_a_stopped_run_does_the_rest_to_the_same_results(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = run(folder, tmp_path / "whole")
    done: list[int] = []

    def stop(so_far: int, total: int) -> None:
        if so_far >= 6:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(folder, tmp_path / "out", progress=stop)
    with pytest.raises(StudyError, match="--resume"):
        run(folder, tmp_path / "out")
    table = run(folder, tmp_path / "out", resume=True, progress=lambda so_far, total: done.append(so_far))
    assert done == [6, 7, 10, 12, 13]
    pd.testing.assert_frame_equal(table, whole, check_exact=True)
    assert (tmp_path / "out/shapes.csv").read_bytes() == (tmp_path / "whole/shapes.csv").read_bytes()


def test_nothing_is_measured_again_where_the_score_failed(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("out of memory")

    with monkeypatch.context() as broken:
        broken.setattr(module, "shape_table", fail)
        with pytest.raises(RuntimeError):
            run(folder, tmp_path / "out")
    monkeypatch.setattr(module, "measure_shape", fail)
    table = run(folder, tmp_path / "out", resume=True)
    assert (table["status"] == "ok").sum() == 12


def test_a_complete_study_is_returned_and_another_seed_is_another_run(folder: Path, tmp_path: Path) -> None:
    first = run(folder, tmp_path / "out")
    pd.testing.assert_frame_equal(run(folder, tmp_path / "out", resume=True), first, check_dtype=False)
    with pytest.raises(StudyError, match="seed: 0 then, 1 now"):
        run(folder, tmp_path / "out", ShapeParameters(seed=1), resume=True)
    (tmp_path / "out/shapes.csv").write_text("old")
    run(folder, tmp_path / "out", ShapeParameters(seed=1), overwrite=True)
    assert (tmp_path / "out/shapes.csv").read_text() != "old"


def test_too_few_cells_have_features_and_no_complexity(folder: Path, tmp_path: Path) -> None:
    table = run(folder / "b_masks.tif", tmp_path / "out")
    assert table[NAMES].notna().all(axis=None)
    assert table[["complexity", "umap_1", "umap_2"]].isna().all(axis=None)
    warnings = json.loads((tmp_path / "out/provenance.json").read_text())["warnings"]
    assert "5 of 5 cells are too small for curvature" in warnings[-2]
    assert "at least 10" in warnings[-1]


def test_cells_that_are_all_alike_have_features_and_no_complexity(tmp_path: Path) -> None:
    stack = np.repeat(cd.simulate.random_smooth(0, radius=12)[None], 10, axis=0)
    tifffile.imwrite(tmp_path / "same.tif", stack.astype(np.uint8), photometric="minisblack")
    table = run(tmp_path / "same.tif", tmp_path / "out", ShapeParameters(kind="stack"))
    assert table[NAMES].notna().all(axis=None)
    assert table["complexity"].isna().all()
    assert "all alike" in json.loads((tmp_path / "out/provenance.json").read_text())["warnings"][-1]


def test_only_a_complete_run_of_shapes_is_read(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="is no study"):
        cd.open_shapes(tmp_path)
    run(folder / "b_masks.tif", tmp_path / "out")
    with pytest.raises(ReadError, match="open_shapes"):
        cd.open_study(tmp_path / "out")
    told = tmp_path / "out/provenance.json"
    told.write_text(told.read_text().replace('"complete"', '"running"'))
    with pytest.raises(ReadError, match="--resume"):
        cd.open_shapes(tmp_path / "out")


def test_masks_for_pictures_are_those_of_the_cells(folder: Path, tmp_path: Path) -> None:
    inputs = open_shape_inputs(folder, ShapeParameters())
    table = shape_study(inputs, tmp_path / "out")
    masks = cleaned_masks(inputs, [2, 8])
    assert {cell: mask.sum() for cell, mask in masks.items()} == {
        cell: table.loc[cell, "area"] for cell in (2, 8)
    }


def test_workers_must_be_positive(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="workers"):
        run(folder, tmp_path / "out", workers=0)


def test_without_umap_there_are_features_and_words_on_the_score(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "umap", None)
    table = run(folder, tmp_path / "out")
    assert table["complexity"].isna().all()
    measured = table["status"] == "ok"
    assert table.loc[measured, "circularity"].notna().all()
    provenance = json.loads((tmp_path / "out" / "provenance.json").read_text(encoding="utf-8"))
    assert any("pip install" in words for words in provenance["warnings"])

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import DamagedPartWarning, MapError, ParameterError, ReadError, StudyError
from cytodisk.runs.compare_windows import compare_cells as module
from cytodisk.runs.compare_windows import compared_cells
from cytodisk.runs.compare_windows.compare_summaries import layer_summary, method_summary
from cytodisk.runs.compare_windows.comparison_words import where_worse
from cytodisk.runs.parameters_file import parameters_from

METHODS = ("newton", "harmonic", "edge", "rings")
GRID = cd.CompareWindowsParameters(methods=METHODS, layers=4, sectors=12)


@pytest.fixture(scope="module")
def masks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three cells and an empty frame."""
    stack = np.zeros((4, 96, 128), dtype=np.uint8)
    shapes = {
        0: cd.simulate.disk(14),
        1: cd.simulate.dumbbell(14, neck_width=3),
        3: np.ones((20, 30), dtype=bool),
    }
    for frame, shape in shapes.items():
        stack[frame, : shape.shape[0], : shape.shape[1]] = shape
    path = tmp_path_factory.mktemp("masks") / "masks.tif"
    tifffile.imwrite(path, stack, photometric="minisblack", metadata={"axes": "TYX"})
    return path


@pytest.fixture(scope="module")
def comparison(masks: Path, tmp_path_factory: pytest.TempPathFactory) -> cd.Comparison:
    return cd.run_compare_windows(masks, tmp_path_factory.mktemp("comparison") / "out", parameters=GRID)


def row_of(comparison: cd.Comparison, cell: int, method: str) -> dict[str, Any]:
    cells = comparison.cells
    (row,) = cells[(cells["cell"] == cell) & (cells["method"] == method)].to_dict("records")
    return row


def test_every_cell_and_method_has_a_row(comparison: cd.Comparison) -> None:
    assert list(comparison.cells["cell"]) == [cell for cell in range(4) for _ in METHODS]
    assert list(comparison.cells["method"]) == list(METHODS) * 4
    assert (comparison.cells["source"] == "masks.tif").all()
    assert len(comparison.layers) == 3 * len(METHODS) * 4


def test_an_empty_mask_is_refused_and_no_cell(comparison: cd.Comparison) -> None:
    for method in METHODS:
        row = row_of(comparison, 2, method)
        assert row["status"] == "refused"
        assert "empty" in row["reason"]
    assert (comparison.by_method["tried"] == 3).all()
    assert (comparison.by_method["mapped"] == 3).all()


def test_numbers_are_those_of_the_windows(comparison: cd.Comparison, masks: Path) -> None:
    mask = tifffile.imread(masks)[1]
    edge = cd.edge_windows(mask, 4, 12)
    row = row_of(comparison, 1, "edge")
    assert row["empty_windows"] == edge.n_empty
    assert row["depth_px"] == pytest.approx(edge.depth_px)
    assert (row["coverage"], row["lost_px"]) == (1.0, 0.0)
    assert row["certificate_valid"] is None
    disk = cd.map_to_disk(mask)
    row = row_of(comparison, 1, "newton")
    assert row["certificate_valid"] is True
    assert (row["flipped"], row["lost_px"], row["empty_windows"]) == (0, 0.0, 0)
    assert row["area_distortion"] == pytest.approx(disk.distortion.area)
    for method, windows in (("edge", edge), ("newton", cd.polar_windows(4, 12).on(disk))):
        layers = comparison.layers
        found = layers[(layers["cell"] == 1) & (layers["method"] == method)]
        expected = cd.measures_by_layer(windows)
        for name in ("completeness", "area_cv", "eccentricity_cv", "pieces", "layer_pieces"):
            np.testing.assert_allclose(found[name], expected[name], rtol=1e-6, err_msg=name)


def test_labels_are_parts_of_small_cells(comparison: cd.Comparison, masks: Path) -> None:
    labels = comparison.labels(1)
    assert set(labels) == {"mask", *METHODS}
    assert labels["mask"].sum() == 16 * tifffile.imread(masks)[1].sum()
    for method in METHODS:
        assert (labels[method][~labels["mask"]] == -1).all()
        windows = np.unique(labels[method][labels["mask"]])
        assert 48 - len(windows) <= row_of(comparison, 1, method)["empty_windows"]
    with pytest.raises(ReadError, match="cell 2 has no windows"):
        comparison.labels(2)


def test_summaries_stand_in_files(comparison: cd.Comparison) -> None:
    tables = {"comparison.csv": comparison.by_layer, "comparison_methods.csv": comparison.by_method}
    for name, table in tables.items():
        found = pd.read_csv(comparison.path / name)
        pd.testing.assert_frame_equal(found, table, check_dtype=False, rtol=1e-4)
    told = pd.read_csv(comparison.path / "comparison_columns.csv").set_index(["table", "name"])
    for name, table in tables.items():
        assert list(told.loc[name].index) == list(table.columns)
        assert list(table.attrs["units"]) == list(table.columns)
    assert told["description"].str.len().min() > 3
    assert comparison.by_method.attrs["units"]["lost_px"] == "px²"
    assert comparison.by_layer.attrs["units"]["area_cv_q25"] == "1"
    assert comparison.provenance["parameters"]["methods"] == list(METHODS)
    assert "method" not in comparison.provenance["parameters"]


def test_a_stopped_run_goes_on(
    masks: Path, comparison: cd.Comparison, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patched:
        measure, calls = module.compare_cell, []

        def stop_at_the_third(task: Any, **settings: Any) -> Any:
            calls.append(task.found.cell)
            if len(calls) == 3:
                raise KeyboardInterrupt
            return measure(task, **settings)

        patched.setattr(module, "compare_cell", stop_at_the_third)
        with pytest.raises(KeyboardInterrupt):
            cd.run_compare_windows(masks, tmp_path / "out", parameters=GRID)
    with pytest.raises(ReadError, match=r"not complete.*--resume"):
        cd.open_comparison(tmp_path / "out")
    done: list[tuple[int, int]] = []
    resumed = cd.run_compare_windows(
        masks, tmp_path / "out", parameters=GRID, resume=True, progress=lambda *counts: done.append(counts)
    )
    assert done == [(2, 4), (3, 4), (4, 4)]
    for here, there in ((resumed.cells, comparison.cells), (resumed.layers, comparison.layers)):
        pd.testing.assert_frame_equal(
            here.drop(columns="seconds", errors="ignore"), there.drop(columns="seconds", errors="ignore")
        )
    monkeypatch.setattr(compared_cells.CellRun, "fill", None)  # a complete comparison is not run again
    (tmp_path / "out" / "comparison.csv").unlink()
    with pytest.warns(DamagedPartWarning, match=r"comparison\.csv gone or damaged: these are made anew"):
        assert (
            cd.run_compare_windows(masks, tmp_path / "out", parameters=GRID, resume=True).methods == METHODS
        )
    assert (tmp_path / "out" / "comparison.csv").exists()


def test_a_cell_that_one_method_cannot_map_has_a_row_with_the_reason(
    masks: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail_on_dumbbells(mask: Any, **options: Any) -> cd.DiskMap:
        if options["method"] == "harmonic" and np.any(mask) and mask.shape[1] > 50:
            raise MapError("no valid map was found: for the test")
        return cd.map_to_disk(mask, **options)

    monkeypatch.setattr(module, "map_to_disk", fail_on_dumbbells)
    found = cd.run_compare_windows(masks, tmp_path / "out", parameters=GRID)
    lost = found.cells[found.cells["status"] == "no map"]
    assert list(zip(lost["cell"], lost["method"], strict=True)) == [(1, "harmonic")]
    assert lost["reason"].item() == "no valid map was found: for the test"
    layer = found.by_layer.set_index(["method", "layer"])
    for number in range(4):  # a cell without a map counts as empty, or not at all
        assert layer.loc[("harmonic", number), "completeness"] == pytest.approx(2 / 3)
        assert layer.loc[("harmonic", number), "completeness_mapped"] == 1.0
    method = found.by_method.set_index("method").loc["harmonic"]
    assert (method["tried"], method["mapped"]) == (3, 2)
    assert f"cell 1, harmonic: {lost['reason'].item()}" in found.provenance["warnings"]
    assert "harmonic" not in found.labels(1)


def test_another_grid_is_another_run(comparison: cd.Comparison, masks: Path) -> None:
    other = GRID.model_copy(update={"layers": 5})
    with pytest.raises(StudyError, match="layers: 4 then, 5 now"):
        cd.run_compare_windows(masks, comparison.path, parameters=other, resume=True)


def test_folders_and_label_images_are_compared_too(tmp_path: Path) -> None:
    cell = cd.simulate.disk(10)
    height, width = cell.shape
    labels = np.zeros((height, 2 * width), dtype=np.uint16)
    labels[:, :width][cell], labels[:, width:][cell] = 4, 5
    folder = tmp_path / "folder"
    folder.mkdir()
    tifffile.imwrite(folder / "a_masks.tif", labels)
    (folder / "b_masks.tif").write_bytes(b"no image")
    grid = cd.CompareWindowsParameters(methods=("edge",), layers=2, sectors=6, depth_px=3.0)
    found = cd.run_compare_windows(folder, tmp_path / "out", parameters=grid).cells
    assert list(found["label"]) == [4, 5, 0]
    assert list(found["status"]) == ["ok", "ok", "unreadable"]
    assert found["coverage"].iloc[0] == pytest.approx(1 - 0.4**2, abs=0.03)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"methods": ()}, "name at least one method"),
        ({"methods": ("edge", "edge")}, "each once"),
        ({"methods": ("voronoi",)}, "methods must be several of newton"),
        ({"method": "newton"}, "did you mean methods"),
        ({"depth_px": 0}, "depth_px must be a number above 0"),
    ],
)
def test_parameters_that_make_no_sense_are_refused(values: dict[str, Any], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        parameters_from(values, None, cd.CompareWindowsParameters)


def test_a_signal_needs_a_movie(masks: Path, tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"signal .* movie=True"):
        cd.run_compare_windows(masks, tmp_path / "out", signal=masks)


def test_the_parameters_of_a_comparison_can_be_fed_back(comparison: cd.Comparison) -> None:
    path = comparison.path / "parameters.toml"
    assert parameters_from({}, path, cd.CompareWindowsParameters) == GRID


def test_a_map_study_is_no_comparison(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="is no study"):
        cd.open_comparison(tmp_path)
    other = {
        "fingerprint": {},
        "status": "complete",
        "format": 2,
        "run": "map",
        "reader": "read otherwise",
    }
    (tmp_path / "provenance.json").write_text(json.dumps(other))
    with pytest.raises(ReadError, match="holds a run of cytodisk map: read otherwise"):
        cd.open_comparison(tmp_path)


def test_a_comparison_of_cells_has_no_consistency(comparison: cd.Comparison) -> None:
    with pytest.raises(ReadError, match="is not that of a movie"):
        _ = comparison.consistency


def made_up(**layers: list[float]) -> Callable[[str], pd.DataFrame]:
    """Tables of one cell by two methods whose area CV is given by layer."""
    cells = pd.DataFrame(
        [
            {"cell": 0, "method": name, "status": "ok", "frames": 1, "mapped": 1, "area_px": 10.0}
            | {"area_distortion": 0.1, "coverage": 1.0, "seconds": 1.0}
            | dict.fromkeys(("invalid_maps", "flipped", "lost_px", "empty_windows"), 0)
            for name in layers
        ]
    )
    rows = [
        {"cell": 0, "method": name, "layer": layer, "completeness": 1.0, "area_cv": value}
        | dict.fromkeys(("eccentricity", "eccentricity_cv", "pieces", "one_piece", "layer_pieces"), 1.0)
        for name, values in layers.items()
        for layer, value in enumerate(values)
    ]
    return lambda what: cells if what == "cells" else pd.DataFrame(rows)


def test_what_is_worse_is_said_by_layer() -> None:
    tables = made_up(newton=[0.1, 0.5, 0.6, 0.1, 0.4], edge=[0.2, 0.4, 0.3, 0.2, 0.3])
    provenance = {"run": "comparison", "parameters": {"methods": ["newton", "edge"]}}
    found = cd.Comparison(Path(), tables("cells"), tables("layers"), provenance)
    assert where_worse(found) == [
        "worse than edge-based: area_cv is larger in layers 1–2, 4 (most in layer 2: 0.6 against 0.3)"
    ]


def test_less_than_a_twentieth_is_not_worse_and_many_layers_are_counted() -> None:
    provenance = {"run": "comparison", "parameters": {"methods": ["newton", "edge"]}}
    tables = made_up(newton=[0.104, 0.104], edge=[0.1, 0.1])
    assert not where_worse(cd.Comparison(Path(), tables("cells"), tables("layers"), provenance))
    tables = made_up(newton=[0.2, 0.1] * 15, edge=[0.1, 0.1] * 15)
    (line,) = where_worse(cd.Comparison(Path(), tables("cells"), tables("layers"), provenance))
    assert "larger in 15 of 30 layers" in line
    assert len(line) < 160


def test_summaries_are_medians_and_quartiles_over_cells() -> None:
    cells = pd.concat([made_up(edge=[0.0])("cells").assign(cell=cell) for cell in range(5)])
    layers = pd.concat(
        [made_up(edge=[value])("layers").assign(cell=cell) for cell, value in enumerate((1.0, 2, 3, 4, 9))]
    )
    (row,) = layer_summary(cells, layers, ("edge",)).to_dict("records")
    assert (row["area_cv"], row["area_cv_q25"], row["area_cv_q75"]) == (3.0, 2.0, 4.0)
    (row,) = method_summary(cells, layers, ("edge",)).to_dict("records")
    assert (row["area_cv"], row["completeness"], row["tried"]) == (3.0, 1.0, 5)
    assert (row["area_error"], row["area_error_q25"], row["area_error_q75"]) == (0.1, 0.1, 0.1)
    (row,) = method_summary(cells.iloc[:1], layers.iloc[:1], ("edge",)).to_dict("records")
    assert row["area_error"] == 0.1
    assert np.isnan([row["area_error_q25"], row["area_error_q75"]]).all()  # one cell has no quartiles


def test_what_needs_a_movie_is_refused_without_one(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"^channels, tracker: only with movie=True"):
        cd.run_compare_windows("masks.tif", tmp_path / "out", channels=("VASP",), tracker="demons")

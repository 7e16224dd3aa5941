from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from command_line import Run, assert_refused, content, write

import cytodisk as cd
from cytodisk.analysis.shape import complexity
from cytodisk.arrays import FloatArray


@pytest.fixture(autouse=True)
def plane(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two features instead of UMAP, which takes seconds to be compiled and has tests of its own."""

    def two_features(values: FloatArray, *_: object) -> FloatArray:
        return np.asarray(values[:, :2] - values[:, :2].mean(axis=0))

    monkeypatch.setattr(complexity, "umap_plane", two_features)


@pytest.fixture
def labels(tmp_path: Path) -> Path:
    """A label image of 12 cells; the last is a crumb."""
    image = np.zeros((140, 420), dtype=np.uint8)
    for seed in range(11):
        cell = cd.simulate.random_smooth(seed, radius=12 + seed, margin=0)[:65, :65]
        row, column = divmod(seed, 6)
        part = image[2 + 70 * row :, 2 + 68 * column :][: cell.shape[0], : cell.shape[1]]
        part[cell] = seed + 1
    image[-3:-1, -3:-1] = 12
    return write(tmp_path / "labels.tif", image)


def test_shapes_of_a_label_image(run: Run, labels: Path, tmp_path: Path) -> None:
    code, said, error = run("shapes", labels, "-o", tmp_path / "out", "--pixel-size", 0.3)
    assert code == 0
    assert "1 file, 12 cells: 11 measured; 1 refused" in said
    assert "pixel size: 0.3 µm" in said
    assert "equivalent diameter below 75 px: 11 of 11 cells" in said
    assert "perhaps not one whole cell" not in said
    assert "of the plane's variance lies along its axis" in said
    assert "1 refused: cell 11 of labels.tif" in error
    assert {"complexity.png", "extremes.png"} == {path.name for path in (tmp_path / "out/figures").iterdir()}
    table = pd.read_parquet(tmp_path / "out/shapes.parquet")
    assert table["complexity"].notna().sum() == 11


def test_a_complete_run_is_not_run_again(run: Run, labels: Path, tmp_path: Path) -> None:
    run("shapes", labels, "-o", tmp_path / "out")
    before = content(tmp_path / "out")
    code, _, error = run("shapes", labels, "-o", tmp_path / "out", "--resume")
    assert code == 0
    assert "nothing was run again" in error
    after = content(tmp_path / "out")
    assert {name: after[name] for name in before if not name.endswith(".png")} == {
        name: before[name] for name in before if not name.endswith(".png")
    }
    assert_refused(run("shapes", labels, "-o", tmp_path / "out"), "--resume", "--overwrite")


def test_the_parameters_of_a_study_can_be_fed_back(run: Run, labels: Path, tmp_path: Path) -> None:
    run("shapes", labels, "-o", tmp_path / "one", "--seed", 3, "--neighbors", 4, "--pixel-size", 0.3)
    again = tmp_path / "one/parameters.toml"
    code, _, _ = run("shapes", labels, "-o", tmp_path / "two", "--parameters", again, "-q")
    assert code == 0
    assert (tmp_path / "two/parameters.toml").read_text() == again.read_text()
    assert (tmp_path / "two/shapes.csv").read_bytes() == (tmp_path / "one/shapes.csv").read_bytes()
    assert_refused(run("shapes", labels, "-o", tmp_path / "three", "--neighbors", 1), "--neighbors must be")


def test_few_cells_are_measured_without_a_score(run: Run, tmp_path: Path) -> None:
    mask = write(tmp_path / "mask.tif", cd.simulate.random_smooth(0).astype(np.uint8))
    code, said, _ = run("shapes", mask, "-o", tmp_path / "out")
    assert code == 0
    assert "no complexity" in said
    assert not (tmp_path / "out/figures").exists()


def test_a_damaged_file_of_a_folder_is_told_and_costs_one_row(run: Run, labels: Path, tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    labels.rename(tmp_path / "in/a_masks.tif")
    (tmp_path / "in/b_masks.tif").write_bytes(b"")
    result = run("shapes", tmp_path / "in", "-o", tmp_path / "out")
    assert "2 files, 12 cells: 11 measured; 1 refused\nfiles or images without a cell: 1\n" in result[1]
    assert_refused(result, "damaged files or frames", "b_masks.tif")


def test_what_holds_no_cell_is_refused(run: Run, tmp_path: Path) -> None:
    empty = write(tmp_path / "empty.tif", np.zeros((9, 9), np.uint8))
    assert_refused(run("shapes", empty, "-o", tmp_path / "out"), "no cell could be measured")
    assert_refused(run("shapes", tmp_path / "nothing.tif", "-o", tmp_path / "other"), "nothing.tif")
    assert not (tmp_path / "other").exists()

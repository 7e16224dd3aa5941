"""Benchmarks of real populations go the way of a user, and do not test what cannot be tested."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def load() -> Iterator[Any]:
    sys.path.insert(0, str(BENCHMARKS))
    try:
        yield __import__
    finally:
        sys.path.remove(str(BENCHMARKS))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """24 cells of two lines and three treatments, as the source has them."""
    words = {
        "cell_lines": ["dlm8"] * 12 + ["dunn"] * 12,
        "treatments": (["control"] * 4 + ["cytd"] * 4 + ["jasp"] * 4) * 2,
    }
    for name, lines in words.items():
        (tmp_path / f"{name}.txt").write_text("\n".join(lines), encoding="utf-8")
    return tmp_path


@pytest.fixture
def cells(load: Any, folder: Path) -> cd.Population:
    """A population of scalars: cytochalasin D raises the complexity, jasplakinolide nothing."""
    groups = load("population_osteosarcoma").write_groups(folder, folder / "groups.csv")
    rng = np.random.default_rng(0)
    shift = 3.0 * (groups["condition"] == "cytochalasin D")
    table = groups.assign(complexity=rng.normal(size=24) + shift, area=rng.normal(size=24), solidity=0.5)
    return cd.Population(None, table, scalars=["complexity", "area", "solidity"])


def test_groups_of_osteosarcoma_cells_are_by_place_in_the_stack(load: Any, folder: Path) -> None:
    load("population_osteosarcoma").write_groups(folder, folder / "groups.csv", every=5)
    groups = pd.read_csv(folder / "groups.csv")
    assert groups.columns.tolist() == ["frame", "condition", "line"]
    assert groups.iloc[1].tolist() == [5, "cytochalasin D", "DLM8"]


def test_unknown_experiments_are_refused_and_cells_described(load: Any, cells: cd.Population) -> None:
    benchmark = load("population_osteosarcoma")
    assert "experiments are unknown" in benchmark.refusal(cells)
    named = cells.with_cells(cells.cells.assign(experiment=np.arange(24) % 2 + 1))
    assert benchmark.refusal(named) == ""
    table = benchmark.effects(cells)
    assert len(table) == 3 * 4
    assert "p" not in table
    assert set(table["warning"]) == {"cells as units"}
    raised = table.query("scalar == 'complexity' and treatment == 'cytochalasin D'")
    assert raised["effect_size"].min() > 1.5
    assert benchmark.largest(table, 1) == ["complexity", "area"]


def test_the_picture_of_osteosarcoma_cells_says_that_nothing_was_tested(
    load: Any, cells: cd.Population, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    benchmark = load("population_osteosarcoma")
    table = benchmark.effects(cells)
    benchmark.print_effects(table, ["complexity", "area"])
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].startswith("complexity")
    assert lines[1].count("to") == 4
    benchmark.draw(cells, table, ["complexity", "area"], tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 10_000


def test_variance_between_wells(load: Any) -> None:
    share = load("population_schwann").between_share
    rng = np.random.default_rng(0)
    wells = pd.Series(np.repeat(np.arange(300), 20))
    values = pd.Series(rng.normal(scale=0.5, size=300)[wells] + rng.normal(size=len(wells)))
    assert share(values, wells) == pytest.approx(0.2, abs=0.03)  # 0.25 of 1.25
    assert share(pd.Series(rng.normal(size=len(wells))), wells) < 0.01
    unequal = wells < rng.integers(0, 600, len(wells))
    assert share(values[unequal], wells[unequal]) == pytest.approx(0.2, abs=0.05)


def test_wells_are_written_as_a_user_has_them(load: Any, tmp_path: Path) -> None:
    benchmark = load("population_schwann")
    source = tmp_path / "schwann_nuclei"
    source.mkdir()
    one, inner = cd.simulate.disk(25, margin=30), cd.simulate.disk(9, margin=46)
    for well in ("B7", "D6"):
        cells, nuclei = np.hstack([one, one]), np.hstack([inner, inner])
        cells[: len(one) // 2, len(one) // 2] |= well == "D6"  # the left one reaches the border
        tifffile.imwrite(source / f"{well}_cells.tif", cells.astype(np.uint8))
        tifffile.imwrite(source / f"{well}_nuclei.tif", nuclei.astype(np.uint8))
        signal = np.stack([7.0 + 10.0 * nuclei, 8.0 + cells, 9.0 + cells]).astype(np.uint16)
        tifffile.imwrite(source / f"{well}_signal.tif", signal, photometric="minisblack")
    groups = pd.read_csv(benchmark.write_inputs(tmp_path, tmp_path / "out"))
    assert groups["condition"].tolist() == ["row B", "row D"]
    assert groups["experiment"].tolist() == ["B7", "D6"]
    assert groups[[f"background_{name}" for name in benchmark.CHANNELS]].iloc[0].tolist() == [7, 8, 9]
    masks = [tifffile.imread(tmp_path / f"out/cells/{well}.tif") for well in ("B7", "D6")]
    counts = [len(np.unique(mask)) - 1 for mask in masks]
    assert counts == [2, 1]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_real_wells_cannot_show_a_difference(
    load: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    benchmark = load("population_schwann")
    if not (benchmark.DATA / "schwann_nuclei").is_dir():
        pytest.skip("the real data are not there: set CYTODISK_DATA")
    arguments = ["--quick", "--out", str(tmp_path), "--layers", "3", "--sectors", "6"]
    monkeypatch.setattr(sys, "argv", ["population_schwann.py", *arguments])
    monkeypatch.setattr(benchmark, "_QUICK", 16)  # fewer cells than --quick takes
    assert benchmark.main() == 0
    out = capsys.readouterr().out
    assert "1 + 2 experiments can give p = 0.33 at best" in out
    assert "WARNING too few experiments" in out
    assert (tmp_path / "schwann.png").exists()

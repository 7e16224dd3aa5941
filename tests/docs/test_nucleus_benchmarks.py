"""Benchmarks of cells with a nucleus go on where they were stopped, and say what fails."""

import json
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


def test_a_stopped_run_goes_on_and_another_version_is_refused(
    load: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    benchmark = load("random_nuclei")
    results = tmp_path / "results"
    list(benchmark.run(range(2), results, workers=1))
    first = results.read_text(encoding="utf-8")
    results.write_text(first + '{"seed": 2, "pix', encoding="utf-8")  # stopped in the middle of a line
    trials = list(benchmark.run(range(3), results, workers=1))
    assert [trial.seed for trial in trials] == [0, 1, 2]
    assert not any(trial.failed for trial in trials)
    monkeypatch.setattr(benchmark, "try_pair", None)  # nothing is left to do
    assert list(benchmark.run(range(3), results, workers=1)) == trials
    benchmark.print_table(trials)
    assert capsys.readouterr().out.splitlines()[-1].split()[:2] == ["all", "3"]
    results.write_text(json.dumps({"version": "another"}) + "\n", encoding="utf-8")
    with pytest.raises(SystemExit, match="another version"):
        list(benchmark.run(range(3), results, workers=1))


def test_what_fails_a_pair(load: Any) -> None:
    benchmark = load("random_nuclei")
    trial = benchmark.try_pair(0)
    assert not trial.failed
    assert trial.fine == (trial.pixels >= 500)
    for wrong in (
        {"refused": "no"},
        {"valid": False},
        {"flips": 1},
        {"lost": 1},
        {"astray": 1},
        {"round_trip": 1e-5},
        {"empty": 1},
        {"sum_error": 1e-8},
        {"sum_error": np.nan},
    ):
        assert benchmark.Trial(**(vars(trial) | wrong)).failed, wrong


def test_merged_cells_are_cut_around_their_nuclei(load: Any, tmp_path: Path) -> None:
    benchmark = load("schwann_nuclei")
    folder = tmp_path / "schwann_nuclei"
    folder.mkdir()
    left, right = cd.simulate.disk(25, margin=2), cd.simulate.disk(8, margin=19)
    cells, nuclei = np.hstack([left, left]), np.hstack([right, right])
    cells[27, 50:60] = True  # they touch
    nuclei[0, :5] = True  # a speck
    tifffile.imwrite(folder / "A1_cells.tif", cells.astype(np.uint8))
    tifffile.imwrite(folder / "A1_nuclei.tif", nuclei.astype(np.uint8))
    cases = list(benchmark.schwann_cases(tmp_path))
    assert len(cases) == 2
    assert sum(int(case.mask.sum()) for case in cases) == cells.sum()
    for case in cases:
        assert case.nucleus.sum() == right.sum()
        assert case.mask.sum() == pytest.approx(left.sum(), abs=10)
    found = benchmark.check(cases[0])
    assert not found.failed
    assert not found.refused
    assert benchmark.Check(**(vars(found) | {"astray": 1})).failed
    assert not benchmark.Check(**(vars(found) | {"refused": "no"})).failed


def test_drawn_nuclei_lie_where_the_cell_is_deepest(load: Any, tmp_path: Path) -> None:
    benchmark = load("schwann_nuclei")
    (tmp_path / "osteosarcoma").mkdir()
    mask = cd.simulate.disk(20)
    tifffile.imwrite(tmp_path / "osteosarcoma" / "masks.tif", np.stack([mask, mask]).astype(np.uint8))
    cases = list(benchmark.osteosarcoma_cases(tmp_path))
    assert [case.name for case in cases] == ["0", "1"]
    assert cases[0].nucleus.sum() == pytest.approx(np.pi * 9.75**2, rel=0.05)
    assert benchmark.Check("osteosarcoma", "0", 1, 1, refused="no").failed


def test_places_of_a_mirrored_cell_are_the_same_in_both_compartments(load: Any) -> None:
    benchmark = load("nucleus_places")
    outlines = load("cell_outlines")
    shape = outlines.Shape("egg", "round", outlines.polar(lambda t: 22.0 + 4.0 * np.cos(t)))
    rows = pd.DataFrame(benchmark.measure(shape, "aside", 0))
    assert rows["valid"].all()
    assert set(rows["part"]) == {"cytoplasm", "nucleus"}
    mirrored = rows[rows["change"] == "mirrored"]
    assert mirrored["same_with"].min() > 0.95
    table = list(benchmark.lines(rows.assign(same_with=rows["same_plain"] - 0.1), ["shape", "place"]))
    assert len(table) == 2
    assert all(line.startswith("egg aside") and "WORSE: mirrored, noise" in line for line in table)


def test_profiles_of_cells_cut_out_of_their_field(
    load: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two cells in a field, DAPI in the nucleus, GFP even, over a background of 50."""
    benchmark = load("nucleus_profiles")
    folder = tmp_path / "schwann_nuclei"
    folder.mkdir()
    one, inner = cd.simulate.disk(25, margin=60), cd.simulate.disk(9, margin=76)
    cells, nuclei = np.hstack([one, one]), np.hstack([inner, inner])
    image = np.stack([np.where(nuclei, 80.0, np.where(cells, 10.0, 0.0)), 20.0 * cells, 5.0 * cells]) + 50.0
    tifffile.imwrite(folder / "A1_cells.tif", cells.astype(np.uint8))
    tifffile.imwrite(folder / "A1_nuclei.tif", nuclei.astype(np.uint8))
    tifffile.imwrite(folder / "A1_signal.tif", image.astype(np.uint16), photometric="minisblack")
    found = benchmark.measure(next(benchmark.schwann_cells(tmp_path)), benchmark.Layers(3, 6, 1))
    np.testing.assert_allclose(found.profiles["map"], [[1, 1, 1, 8], [1] * 4, [1] * 4])
    np.testing.assert_allclose(found.shares["map"], [1 / 3, 1 / 3, 1 / 3, 1], atol=0.02)
    assert found.shares["by distance"][0] > 0.36
    assert float(found.raw["nucleus_to_cytoplasm"][0]) == pytest.approx(130 / 60)
    arguments = ["--data", str(tmp_path), "--layers", "3", "--sectors", "6", "--workers", "1"]
    monkeypatch.setattr(sys, "argv", ["nucleus_profiles.py", *arguments])
    assert benchmark.main() == 0
    out = capsys.readouterr().out
    assert "2 cells in 1 fields, 0 refused" in out
    assert "DAPI               2.17        8.00" in out

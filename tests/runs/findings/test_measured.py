"""What is told of a study without a correlation: the numbers are those of its tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from cytodisk.runs.findings import layer_levels
from cytodisk.runs.findings.cells_finding import cells_finding
from cytodisk.runs.findings.finding import Finding
from cytodisk.runs.findings.movie_finding import movie_finding, others_words, usual_cell
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag
from cytodisk.store.study import Study

LAYERS, SECTORS, FRAMES = 3, 4, 5


def table(levels: list[float], cells: int = 1, frames: int = 1) -> pd.DataFrame:
    """Windows of ten pixels with a level by layer."""
    axes = [range(cells), range(frames), range(LAYERS), range(SECTORS)]
    rows = pd.MultiIndex.from_product(axes, names=["cell", "frame", "layer", "sector"]).to_frame(index=False)
    return rows.assign(channel="Rac1", n_pixels=10, mean=np.array(levels)[rows["layer"]])


def study(path: Path, cells: pd.DataFrame, windows: pd.DataFrame, interval_s: float, **tables: Any) -> Study:
    provenance = {"pixel_size_um": 0.1, "frame_interval_s": interval_s, "inputs": {}}
    provenance |= {"parameters": {"layers": LAYERS, "sectors": SECTORS}, "velocity_unit": "µm/s"}
    cells.attrs["units"] = {"area": "µm²"}
    one = Study(path, cells, provenance)
    one.__dict__.update({"windows": windows} | tables)
    return one


def movie(path: Path, interval_s: float) -> Study:
    cells = pd.DataFrame(
        {"cell": 0, "frame": range(FRAMES), "status": "ok", "area": [100, 101, 98, 110, 125.0]}
    )
    edge = pd.DataFrame({"cell": 0, "velocity": [0.02, 0.04, -0.03, 0.01], "velocity_error": 0.005})
    return study(path, cells, table([3.0, 1.0, 2.0], frames=FRAMES), interval_s, edge=edge)


def test_a_movie_without_a_correlation(tmp_path: Path) -> None:
    found = movie_finding(movie(tmp_path, 10.0), 0, [])
    assert found.kind == "measured"
    assert found.sentences == (
        "In 40 s the edge moves at 25 nm/s in the median, and protrudes in 75 % of sectors and frames; the "
        "area goes from 100 to 125 µm² (+25 %).",
        "Rac1 is brightest in layer 0 (outermost), 1.50 times the cell's mean; edge to centre 1.50; "
        "background not subtracted.",
    )
    assert found.command.startswith("cytodisk correlate ")
    assert found.command.endswith(" --signal Rac1")


def test_a_slow_movie_is_told_in_minutes(tmp_path: Path) -> None:
    assert movie_finding(movie(tmp_path, 60.0), 0, []).words.startswith(
        "In 4 min the edge moves at 1.5 µm/min in"
    )


def test_flags_that_bear_on_it_stand_beside_it(tmp_path: Path) -> None:
    jumps, other = (QCFlag("area jumps", "", "", "", (Place(cell, 3),)) for cell in (0, 1))
    small = QCFlag("small windows", "", "", "")
    one = movie(tmp_path, 10.0)
    assert (
        "; but QC flags are raised that bear on this: area jumps."
        in movie_finding(one, 0, [jumps, small]).words
    )
    assert "QC flags" not in movie_finding(one, 0, [other, small]).words
    assert usual_cell(one) == 0


def test_single_cells(tmp_path: Path) -> None:
    cells = pd.DataFrame({"cell": range(5), "label": 1, "frame": 0, "status": "ok", "qc_flags": ""})
    cells = cells.assign(certificate_valid=True, nucleus_to_cytoplasm_Rac1=[0.5, 0.6, 0.7, 0.8, 0.9])
    cells["condition"] = ["control", "control", "drug", "drug", "drug"]
    found = cells_finding(study(tmp_path, cells, table([3.0, 1.0, 2.0], cells=5), 1.0), [])
    assert (
        found.sentences[0]
        == "5 of 5 cells in 1 file are mapped one to one; none of the mapped has a QC flag."
    )
    assert found.sentences[1] == (
        "Rac1 is brightest in layer 0 (outermost), 1.50 times the cell's mean (in the median; this layer is "
        "the brightest in 5 of 5 cells); edge to centre 1.50 (quartiles 1.50–1.50); nucleus to cytoplasm "
        "0.70 (quartiles 0.60–0.80); background not subtracted."
    )
    assert found.command.startswith("cytodisk population ")


def test_a_signal_that_is_even_has_no_brightest_layer(tmp_path: Path) -> None:
    cells = pd.DataFrame({"cell": [0], "label": 1, "frame": 0, "status": "ok", "qc_flags": "", "area": 9.0})
    even = study(tmp_path, cells.assign(certificate_valid=True), table([1.02, 1.0, 1.0]), 1.0)
    assert "Rac1 is even: no layer is more than 1.01 times the cell's mean" in cells_finding(even, []).words
    cells = pd.concat([cells] * 3).assign(cell=range(3), certificate_valid=True)
    said = cells_finding(study(tmp_path, cells, table([1.02, 1.0, 1.0], cells=3), 1.0), []).words
    assert "1.01 times the cell's mean (in the median of 3 cells); edge to centre" in said


def test_cells_beyond_the_first_are_not_told_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows of windows that are read: two cells whole, the third in part."""
    cells = pd.DataFrame({"cell": range(4), "label": 1, "frame": 0, "status": "ok", "qc_flags": ""})
    many = study(tmp_path, cells.assign(certificate_valid=True), pd.DataFrame(), 1.0)
    rows = table([3.0, 1.0, 2.0], cells=4)
    blocks = [rows[start : start + 7] for start in range(0, len(rows), 7)]
    monkeypatch.setattr(layer_levels, "MOST_ROWS", 30)
    monkeypatch.setattr(layer_levels, "has_signal", lambda _: True)
    monkeypatch.setattr(layer_levels, "window_blocks", lambda *_: iter(blocks))
    assert "is the brightest in 2 of the first 2 cells)" in cells_finding(many, []).words


def test_beside_a_nucleus_there_is_no_centre(tmp_path: Path) -> None:
    cells = pd.DataFrame({"cell": [0], "label": 1, "frame": 0, "status": "ok", "qc_flags": ""})
    one = study(tmp_path, cells.assign(certificate_valid=True), table([3.0, 1.0, 2.0]), 1.0)
    one.provenance["parameters"] |= {"nucleus_layers": 1}
    assert "edge to layer 2 (next to the nucleus) 1.50" in cells_finding(one, []).words


def test_a_signal_without_values_is_not_one_that_was_not_given(tmp_path: Path) -> None:
    one = movie(tmp_path, 10.0)
    one.windows["mean"] = np.nan
    assert movie_finding(one, 0, []).words.endswith("The signal has no value in any window.")
    one.windows["channel"] = None
    assert "No signal was given" in movie_finding(one, 0, []).words
    cells = pd.DataFrame({"cell": [0], "label": 1, "frame": 0, "status": "ok", "qc_flags": "holes"})
    some = study(tmp_path, cells.assign(certificate_valid=True), table([np.nan] * 3), 1.0)
    said = cells_finding(some, []).words
    assert said.endswith("1 of the mapped has QC flags. The signal has no value in any window.")


def test_an_edge_that_stands_still_has_no_velocity_of_rounding(tmp_path: Path) -> None:
    one = movie(tmp_path, 10.0)
    one.edge["velocity"] = 4e-17
    said = movie_finding(one, 0, []).words
    assert "moves at 0 µm/s in the median, no more than the error of one sector" in said
    assert "protrudes in 0 % of" in said


def test_other_correlations_are_counted() -> None:
    kinds = {"RhoA": "found", "Cdc42": "doubtful", "Ras": "nothing"}
    others = [((name, "velocity"), Finding(kind, ())) for name, kind in kinds.items()]
    assert others_words(others) == (
        "3 other correlations: 1 found (RhoA with velocity), 1 in doubt, 1 not beyond chance."
    )
    assert others_words(others[2:]) == "The other correlation, Ras with velocity: not beyond chance."

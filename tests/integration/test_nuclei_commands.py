"""`--nuclei` of the commands: what they print, and what they refuse."""

import shlex
from pathlib import Path

import numpy as np
import pytest
from command_line import Run, assert_refused, write

import cytodisk as cd

GRID = ("--layers", 3, "--sectors", 6, "--figures", 0)


def drawn(*boxes: tuple[int, int, int, int, int]) -> np.ndarray:
    labels = np.zeros((110, 260), dtype=np.uint16)
    for label, top, bottom, left, right in boxes:
        labels[top:bottom, left:right] = label
    return labels


CELLS = drawn((1, 10, 60, 10, 60), (2, 10, 60, 60, 120), (3, 10, 60, 130, 180), (4, 10, 60, 190, 250))
NUCLEI = drawn(
    (1, 10, 45, 25, 31), (2, 25, 45, 80, 95), (3, 20, 30, 140, 150), (4, 40, 50, 155, 165), (9, 90, 99, 9, 19)
)


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Path]:
    monkeypatch.chdir(tmp_path)
    return write(Path("cells.tif"), CELLS), write(Path("nuclei.tif"), NUCLEI)


def test_check_says_what_the_match_says(run: Run, files: tuple[Path, Path]) -> None:
    code, said, _ = run("check", files[0], "--nuclei", files[1])
    assert code == 1
    assert "nuclei: a label image, YX (110, 260) uint16\n" in said
    assert "nuclei: frame 0 holds 5 values beside 0\n" in said
    assert "not usable: cell 2: the cell has 2 nuclei, of 100 and 100 px: split it if" in said
    assert "not usable: cell 3: no nucleus lies in the cell: correct the masks, or map such cells" in said
    assert "QC flag: cell 0: nucleus clipped: 9.8% of its outline lay" in said
    assert "note: cell 0: 6 px of the nucleus at the cell's edge clipped" in said
    assert "4 cells: 2 usable (1 with QC flags), 2 not usable" in said
    assert "nuclei: 2 cells with one nucleus, 1 cell without a nucleus, 1 cell with several nuclei\n" in said
    assert "1 nucleus lies in no cell\n" in said


def test_check_all_has_a_line_for_each_cell(run: Run, files: tuple[Path, Path]) -> None:
    lines = run("check", files[0], "--nuclei", files[1], "--all")[1].splitlines()
    start = lines.index("cell\tframe\tlabel\tnuclei\tusable\tremarks")
    rows = [line.split("\t") for line in lines[start + 1 : start + 5]]
    assert [row[2:5] for row in rows] == [
        ["1", "1", "QC flag"],
        ["2", "2", "yes"],
        ["3", "3,4", "no"],
        ["4", "", "no"],
    ]


def test_check_asks_whether_nuclei_of_another_image_are_meant(run: Run, files: tuple[Path, Path]) -> None:
    elsewhere = write(Path("other.tif"), drawn((1, 70, 80, 20, 30), (2, 90, 99, 9, 19)))
    code, said, _ = run("check", files[0], "--nuclei", elsewhere)
    assert code == 1
    assert "no cell has a nucleus: are these the nuclei of the same image" in said


def test_map_says_how_many_have_which(run: Run, files: tuple[Path, Path]) -> None:
    options = ("--missing", "plain", "--several", "largest")
    code, said, error = run("map", files[0], "--nuclei", files[1], "-o", "out", *GRID, *options)
    assert code == 0, error
    assert "4 of 4 cells mapped, one to one" in said
    assert "nuclei: 2 cells with one nucleus, 1 cell without a nucleus, 1 cell with several nuclei" in said
    for flag in (
        "nucleus missing: there is no nucleus in 1 cell",
        "several nuclei: there are",
        "nucleus clipped",
    ):
        assert f"QC flag {flag}" in said
    settings = cd.open_study("out").provenance["parameters"]
    assert (settings["several"], settings["missing"], settings["nucleus_layers"]) == ("largest", "plain", 3)


def test_map_draws_nucleus_and_cytoplasm_of_all_cells(run: Run, files: tuple[Path, Path]) -> None:
    options = ("--nuclei", files[1], *GRID, "--several", "largest")
    assert run("map", files[0], "-o", "unmeasured", *options)[0] == 0
    assert not Path("unmeasured/figures/nuclei.png").exists()
    said = run("map", files[0], "--signal", files[0], "--channels", "GFP", "-o", "out", *options)[1]
    assert Path("out/figures/nuclei.png").exists()
    assert "at the nucleus and at the membrane: GFP 0.33 and 0.33 (an even one: 0.33)" in said


def test_the_parameters_of_a_run_can_be_fed_back(run: Run, files: tuple[Path, Path]) -> None:
    options = ("--several", "largest", "--nucleus-radius", "area", "--nucleus-layers", 2)
    assert run("map", files[0], "--nuclei", files[1], "-o", "out", *GRID, *options)[0] == 0
    again = ("--nuclei", files[1], "--parameters", "out/parameters.toml", "-o", "again", "--figures", 0)
    assert run("map", files[0], *again)[0] == 0
    first, second = (cd.open_study(name) for name in ("out", "again"))
    assert first.provenance["parameters"] == second.provenance["parameters"]
    missing = run("map", files[0], "--parameters", "out/parameters.toml", "-o", "third")
    assert_refused(missing, "nucleus_radius is given, but there are no nuclei: pass them as --nuclei")


def test_the_command_that_a_flag_prints_runs_as_it_stands(run: Run, files: tuple[Path, Path]) -> None:
    small = ("--layers", 20, "--sectors", 60, "--figures", 0, "--several", "join")
    assert run("map", files[0], "--nuclei", files[1], "-o", "out", *small)[0] == 0
    flags = {flag.name: flag.advice for flag in cd.qc_flags(cd.open_study("out"))}
    words = shlex.split(flags["small windows"].partition(": cytodisk ")[2])
    assert words[words.index("--nuclei") + 1] == "nuclei.tif"
    assert run(*words, "--figures", 0)[0] == 0


@pytest.mark.parametrize("command", [("map", "-o", "out"), ("check",)])
def test_faults_of_the_files_are_errors_with_a_remedy(
    run: Run, files: tuple[Path, Path], command: tuple[str, ...]
) -> None:
    name, *rest = command
    assert_refused(
        run(name, files[0], "--nuclei", files[0], *rest), "are these the masks of the cells twice?"
    )
    assert_refused(run(name, files[1], "--nuclei", files[0], *rest), "are the two swapped?")
    assert_refused(run(name, files[0], "--nuclei", "gone.tif", *rest), "gone.tif does not exist")
    inverted = write(Path("inverted.tif"), (NUCLEI == 0).astype(np.uint8))
    assert_refused(run(name, files[0], "--nuclei", inverted, *rest), "looks inverted", "--nuclei-kind mask")
    assert_refused(run(name, files[0], "--nuclei-channel", 1, *rest), "take --nuclei-channel out")


def test_a_dry_run_of_a_batch_lists_nuclei(run: Run, files: tuple[Path, Path]) -> None:
    text = '[study]\nkind = "map"\n[[inputs]]\nmasks = "cells.tif"\nnuclei = "nuclei.tif"\n'
    Path("study.toml").write_text(text)
    code, said, _ = run("batch", "study.toml", "-o", "out", "--dry-run", "-q")
    assert code == 0
    head, row = (line.split(",") for line in said.splitlines())
    assert Path(row[head.index("nuclei")]).name == "nuclei.tif"

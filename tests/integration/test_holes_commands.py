"""`--holes` on the command line."""

from pathlib import Path

import numpy as np
import pytest
import tifffile
from command_line import Run, assert_refused, write

import cytodisk as cd


@pytest.fixture
def mask(tmp_path: Path) -> Path:
    cell = cd.simulate.disk(20)
    middle = cell.shape[0] // 2
    cell[middle - 4 : middle + 4, middle - 4 : middle + 4] = False
    return write(tmp_path / "mask.tif", cell.astype(np.uint8))


def test_check_says_what_would_become_of_holes(run: Run, mask: Path) -> None:
    code, said, _ = run("check", mask, "--holes", "exclude")
    assert code == 0
    assert "note: cell 0: 1 hole excluded (64 px, 5.1%)" in said
    code, said, _ = run("check", mask, "--holes", "error")
    assert code == 1
    assert "not usable: cell 0: mask has 1 hole (64 px)" in said
    assert "QC flag: cell 0: perhaps several touching cells" in run("check", mask)[1]


def test_map_takes_the_flag_and_a_wrong_word_is_refused(run: Run, mask: Path, tmp_path: Path) -> None:
    small = ("--layers", 3, "--sectors", 8, "--figures", 0)
    code, said, _ = run("map", mask, "-o", tmp_path / "out", "--holes", "exclude", *small)
    assert code == 0
    assert "1 of 1 cell mapped" in said
    assert cd.open_study(tmp_path / "out").cells["excluded_px"].tolist() == [64]
    wrong = run("map", mask, "-o", tmp_path / "other", "--holes", "keep", *small)
    assert_refused(wrong, "--holes", "fill, exclude, error", "keep")


def test_every_command_on_masks_has_the_flag(run: Run) -> None:
    for command in ("map", "movie", "check", "shapes", "compare-windows"):
        said = run(command, "--help")[1]
        heading = said.split("What the files hold:")[1].split("\n\n")[0]
        assert "--holes" in heading, command


@pytest.mark.slow
def test_a_batch_takes_it_for_all_or_for_one_input(run: Run, mask: Path, tmp_path: Path) -> None:
    write(tmp_path / "other.tif", tifffile.imread(mask))
    (tmp_path / "study.toml").write_text(
        '[parameters]\nlayers = 3\nsectors = 8\nholes = "exclude"\n'
        '[[inputs]]\nname = "a"\nmasks = "mask.tif"\nkind = "map"\n'
        '[[inputs]]\nname = "b"\nmasks = "other.tif"\nkind = "map"\nparameters = {holes = "fill"}\n',
        encoding="utf-8",
    )
    code, _, error = run("batch", tmp_path / "study.toml", "-o", tmp_path / "all")
    assert code == 0, error
    studies = {name: cd.open_study(tmp_path / "all" / "inputs" / name) for name in ("a", "b")}
    cells = {name: study.cells.iloc[0] for name, study in studies.items()}
    assert cells["a"]["excluded_px"] == cells["b"]["filled_px"] == 64

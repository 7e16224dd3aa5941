import os
import re
import sys
from dataclasses import replace
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pandas as pd
import pytest
import tifffile
from command_line import Run, assert_refused

import cytodisk as cd
from cytodisk.cli.console import console_for
from cytodisk.cli.map_end import finish_map
from cytodisk.runs.told.map_words import percent
from deadlines import kill_after_parts

GRID = ("--layers", "3", "--sectors", "8", "--edge-length", "2", "--figures", "0")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """As Cellpose's own data set: 000_img.png and 000_masks.png; one file is cut short, one is empty."""
    (tmp_path / "cellpose").mkdir()
    for number in range(3):
        labels = cd.simulate.label_image(4, number)
        picture = np.random.default_rng(number).integers(0, 255, (*labels.shape, 3)).astype(np.uint8)
        imageio.imwrite(tmp_path / "cellpose" / f"{number:03d}_masks.png", labels)
        imageio.imwrite(tmp_path / "cellpose" / f"{number:03d}_img.png", picture)
    content = (tmp_path / "cellpose" / "001_masks.png").read_bytes()
    (tmp_path / "cellpose" / "001b_masks.png").write_bytes(content[: len(content) // 2])
    empty = np.zeros((40, 50, 3), dtype=np.uint8)
    for number in (3, 4):
        imageio.imwrite(tmp_path / "cellpose" / f"{number:03d}_masks.png", empty[..., 0])
        imageio.imwrite(tmp_path / "cellpose" / f"{number:03d}_img.png", empty)
    return tmp_path / "cellpose"


def test_a_folder_is_mapped_and_its_totals_are_given(run: Run, folder: Path, tmp_path: Path) -> None:
    result = run("map", folder, "--signal", "_img", "-o", tmp_path / "out", *GRID, "--format", "pdf")
    assert_refused(result, "damaged files or frames of the input: 1; all others are in")
    said, error = result[1:]
    assert "masks: 6 files: 3 label images, 2 single masks, 1 unusable file" in said
    assert "signal: 5 images with channels red, green, blue" in said
    assert "6 files, 12 cells: 12 mapped, one to one\n" in said
    assert "files or images without a cell: 2 empty, 1 damaged\n" in said
    assert "figures" not in said  # none were asked for
    assert [path.name for path in (tmp_path / "out" / "figures").iterdir()] == ["overview.pdf"]
    study = cd.open_study(tmp_path / "out")
    border = int(study.cells["touches_border"].fillna(False).sum())
    assert f"on the image border: {border} ({100 * border / 12:.0f} %) of 12 mapped cells" in said
    assert "all windows complete: 12 (100 %) of 12 mapped cells, 12 (100 %) of 12 all cells" in said
    assert "2 no cell: 003_masks.png: mask of shape (40, 50) is empty" in error
    assert "(and 1 more like it)" in error
    assert "1 unreadable: 001b_masks.png: frame 0 cannot be read" in error
    assert study.windows["channel"].unique().tolist() == ["red", "green", "blue"]


def test_a_folder_is_checked(run: Run, folder: Path) -> None:
    code, said, _ = run("check", folder)
    assert code == 1
    lines = said.splitlines()
    usable = r"6 files, 12 cells: 12 usable \((\d+) with QC flags\), 0 not usable, (\d+) on the image border"
    found = re.search(usable, said)
    assert found is not None
    assert found[1] == found[2]  # the flag of each is that it is on the border
    assert "files or images without a cell: 2 empty, 1 damaged" in said
    assert "without a cell: 2 (003_masks.png, 004_masks.png): mask of shape (40, 50) is empty" in said
    assert any(line.startswith("without a cell: 001b_masks.png: frame 0 cannot be read") for line in lines)
    (folder / "001b_masks.png").unlink()
    assert run("check", folder)[0] == 0  # an image without any cell is usual
    lines = run("check", folder, "--all")[1].splitlines()
    assert "cell\tfile\tframe\tlabel\tusable\tremarks" in lines
    assert any(line.startswith("4\t001_masks.png\t0\t1\tQC flag\ttouches the image border") for line in lines)


def test_a_folder_that_cannot_be_used(run: Run, folder: Path, tmp_path: Path) -> None:
    (tmp_path / "none").mkdir()
    assert_refused(run("map", tmp_path / "none", "-o", tmp_path / "out"), "holds no masks")
    assert_refused(
        run("map", folder, "--signal", folder / "000_img.png", "-o", tmp_path / "out"), "is one file"
    )
    assert_refused(run("check", folder, "--signal", "_gone"), "fits no mask file")
    assert not (tmp_path / "out").exists()


def test_maps_are_not_kept_when_so_wished(run: Run, folder: Path, tmp_path: Path) -> None:
    (folder / "001b_masks.png").unlink()
    assert run("map", folder, "-o", tmp_path / "out", *GRID, "--no-maps", "-q")[0] == 0
    assert not list((tmp_path / "out" / "maps").iterdir())
    assert cd.open_study(tmp_path / "out").cells["status"].tolist().count("ok") == 12


def test_maps_that_are_not_one_to_one_are_not_called_so(
    run: Run, folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "001b_masks.png").unlink()
    run("map", folder, "-o", tmp_path / "out", *GRID, "-q")
    study = cd.open_study(tmp_path / "out")
    flipped = study.cells.assign(certificate_valid=[False] * 2 + [True] * 10 + [None] * 2)
    finish_map(console_for(False), replace(study, cells=flipped), 0, of_folder=True)
    assert "12 mapped, 10 of them one to one\n" in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "killpg"), reason="process groups are POSIX")
def test_a_killed_run_over_a_folder_goes_on_to_the_same_tables(run: Run, tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    for number in range(4):
        tifffile.imwrite(tmp_path / "in" / f"{number}_masks.tif", cd.simulate.label_image(10, number))

    def command(out: Path, workers: int, *more: str) -> list[str]:
        return ["map", str(tmp_path / "in"), "-o", str(out), *GRID, "-q", "--workers", str(workers), *more]

    out = tmp_path / "out"
    killed = kill_after_parts([sys.executable, "-m", "cytodisk", *command(out, 2)], out, 2)
    assert 2 <= killed < 8  # of 8 and 2 cells an image
    assert run(*command(out, 2, "--resume"))[0] == 0
    assert run(*command(tmp_path / "whole", 1))[0] == 0
    resumed, whole = cd.open_study(out), cd.open_study(tmp_path / "whole")
    assert len(whole.cells) == 40
    pd.testing.assert_frame_equal(
        resumed.cells.drop(columns="seconds"), whole.cells.drop(columns="seconds"), check_exact=True
    )
    assert (out / "windows.parquet").read_bytes() == (tmp_path / "whole" / "windows.parquet").read_bytes()
    names = [
        {str(path.relative_to(study.path)) for path in study.path.rglob("*")} for study in (resumed, whole)
    ]
    assert names[0] == names[1]


def test_masks_without_an_image_are_not_called_bad(run: Run, folder: Path, tmp_path: Path) -> None:
    (folder / "001b_masks.png").unlink()
    (folder / "001_img.png").unlink()
    code, said, error = run("map", folder, "--signal", "_img", "-o", tmp_path / "out", *GRID)
    assert code == 0
    assert "5 files, 12 cells: 8 mapped, one to one; 4 without an image\n" in said
    assert "all windows complete: 8 (100 %) of 8 mapped cells, 8 (67 %) of 12 all cells" in said
    assert "4 no image: cell 4 of 001_masks.png: has no image in" in error


@pytest.mark.parametrize(("part", "words"), [(0, "0 %"), (1, "< 1 %"), (999, "> 99 %"), (1000, "100 %")])
def test_a_share_is_not_rounded_to_none_or_all(part: int, words: str) -> None:
    assert percent(part, 1000) == words

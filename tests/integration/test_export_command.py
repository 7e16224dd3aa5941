"""`cytodisk export`: what it writes and says."""

from pathlib import Path

import numpy as np
import pytest
import tifffile
from command_line import Run

import cytodisk as cd


def test_export_tells_its_files_and_the_cells_that_are_left_out(run: Run, tmp_path: Path) -> None:
    pytest.importorskip("roifile", reason="roifile is not installed")
    masks = np.zeros((3, 30, 30), dtype=np.uint8)
    masks[:, 2:27, 2:27] = cd.simulate.disk(10)[:25, :25]
    masks[1] = 0
    tifffile.imwrite(tmp_path / "masks.tif", masks, metadata={"axes": "TYX"}, photometric="minisblack")
    cd.run_movie(tmp_path / "masks.tif", tmp_path / "out", layers=2, sectors=4)
    code, said, error = run("export", tmp_path / "out", "--to", "roi, geojson", "-o", tmp_path / "fiji")
    assert code == 0, error
    assert "without a map, so left out: 1 cell; the first: cell 0, frame 1: " in said
    written = [Path(line.removeprefix("written: ")).name for line in said.splitlines() if "written" in line]
    assert written == ["outlines.zip", "windows.zip", "cells.geojson"]
    assert {file.name for file in (tmp_path / "fiji").iterdir()} == set(written)
    code, _, error = run("export", tmp_path / "out", "--to", "roi", "-o", tmp_path / "fiji")
    assert code == 2
    assert "pass --overwrite" in error
    few = ("--frames", "2:2", "--no-windows", "-q")
    code, said, _ = run("export", tmp_path / "out", "--to", "roi", "-o", tmp_path / "one", *few)
    assert code == 0
    assert said == ""
    assert [file.name for file in (tmp_path / "one").iterdir()] == ["outlines.zip"]

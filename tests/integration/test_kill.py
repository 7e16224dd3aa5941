"""Runs that are killed go on where they were."""

import os
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile
import xarray as xr
from command_line import Run

import cytodisk as cd
from deadlines import kill_after_parts

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not hasattr(os, "killpg"), reason="process groups are POSIX"),
]
PROGRAM = [sys.executable, "-m", "cytodisk"]
GRID = ("--layers", "4", "--sectors", "12")
N_CELLS = 10


def test_a_killed_run_is_resumed_to_the_same_results(run: Run, tmp_path: Path) -> None:
    cells = [cd.simulate.migrating(seed, size=0.7) for seed in range(N_CELLS)]
    shape = np.max([cell.shape for cell in cells], axis=0)
    masks = np.stack([np.pad(cell, [(0, n) for n in shape - cell.shape]) for cell in cells])
    counts = np.random.default_rng(0).poisson(100, masks.shape).astype(np.uint16)
    tifffile.imwrite(tmp_path / "masks.tif", masks.astype(np.uint8), photometric="minisblack")
    tifffile.imwrite(tmp_path / "signal.tif", counts, photometric="minisblack")

    def command(out: Path, workers: int, *options: str) -> list[str]:
        files = [str(tmp_path / "masks.tif"), "--signal", str(tmp_path / "signal.tif"), "-o", str(out)]
        flags = ["--figures", "0", *GRID, "--workers", str(workers), "-q", *options]
        return ["map", *files, *flags]

    out = tmp_path / "out"
    assert 3 <= kill_after_parts([*PROGRAM, *command(out, 2)], out, 3) < N_CELLS
    assert not (out / "windows.parquet").exists()

    assert run(*command(out, 2, "--resume"))[0] == 0
    assert run(*command(tmp_path / "whole", 1))[0] == 0
    resumed, whole = cd.open_study(out), cd.open_study(tmp_path / "whole")
    assert resumed.cells["status"].tolist() == ["ok"] * N_CELLS
    pd.testing.assert_frame_equal(
        resumed.cells.drop(columns="seconds"), whole.cells.drop(columns="seconds"), check_exact=True
    )
    assert (out / "windows.parquet").read_bytes() == (tmp_path / "whole" / "windows.parquet").read_bytes()
    names = [
        {str(path.relative_to(folder)) for path in folder.rglob("*")} for folder in (out, tmp_path / "whole")
    ]
    assert names[0] == names[1]


N_FRAMES = 20


def movie_command(files: Path, out: Path, workers: int, *options: str) -> list[str]:
    inputs = [str(files / "masks.tif"), "--signal", str(files / "signal.ome.tif"), "-o", str(out)]
    return ["movie", *inputs, "--figures", "0", *GRID, "-q", "--workers", str(workers), *options]


@pytest.fixture(scope="module")
def movie_files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of a movie that loses three frames."""
    folder = tmp_path_factory.mktemp("movie")
    truth = cd.simulate.movie("dropping", 0, frames=N_FRAMES, radius_px=25.0)
    assert truth.signal is not None
    tifffile.imwrite(folder / "masks.tif", truth.masks.astype(np.uint8), photometric="minisblack")
    metadata = {"axes": "TCYX", "PhysicalSizeX": 0.16, "PhysicalSizeY": 0.16}
    tifffile.imwrite(folder / "signal.ome.tif", truth.signal.to_numpy(), metadata=metadata)
    return folder


def test_a_killed_movie_is_resumed_to_the_same_results(run: Run, movie_files: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert 10 <= kill_after_parts([*PROGRAM, *movie_command(movie_files, out, 2)], out, 10) < N_FRAMES
    assert not (out / "windows.parquet").exists()

    assert run(*movie_command(movie_files, out, 1, "--resume"))[0] == 0
    assert run(*movie_command(movie_files, tmp_path / "whole", 1))[0] == 0
    resumed, whole = cd.open_study(out), cd.open_study(tmp_path / "whole")
    assert resumed.cells["status"].tolist().count("refused") == 3
    assert resumed.cells["status"].tolist().count("ok") == N_FRAMES - 3
    pd.testing.assert_frame_equal(
        resumed.cells.drop(columns="seconds"), whole.cells.drop(columns="seconds"), check_exact=True
    )
    for name in ("windows", "edge", "consistency"):
        pair = [(study.path / f"{name}.parquet").read_bytes() for study in (resumed, whole)]
        assert pair[0] == pair[1], name
    xr.testing.assert_identical(resumed.activity(0).load(), whole.activity(0).load())
    names = [
        {str(path.relative_to(study.path)) for path in study.path.rglob("*")} for study in (resumed, whole)
    ]
    assert names[0] == names[1]

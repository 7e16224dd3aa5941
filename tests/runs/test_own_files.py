"""`--overwrite` removes the files that a run wrote, and none with a name like theirs."""

from pathlib import Path

import numpy as np
import pytest
import tifffile

import cytodisk as cd

SMALL = {"layers": 2, "sectors": 6}
THEIRS = (
    "comparison_notes.csv",
    "comparison2.csv",
    "maps/cell_mine.npz",
    "maps/cell_00000_mine.npz",
    "maps/cell_0.npz",
    "maps/cell_00000_t00000_mine.npz",
    "maps/windows_mine.npz",
    "maps/windows_00000_mine.npz",
    "maps/activity_mine.npz",
    "maps/activity_00000_mine.npz",
    "figures/cell_mine.png",
    "figures/cell_00000_mine.png",
)


@pytest.fixture
def masks(tmp_path: Path) -> Path:
    stack = np.stack([cd.simulate.disk(9)] * 2).astype(np.uint8)
    tifffile.imwrite(tmp_path / "masks.tif", stack, photometric="minisblack", metadata={"axes": "TYX"})
    return tmp_path / "masks.tif"


@pytest.mark.parametrize("command", ["map", "movie", "comparison", "movie comparison"])
def test_overwrite_removes_what_the_run_wrote_and_nothing_else(
    command: str, masks: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    if command == "map":
        cd.run_map(masks, out, **SMALL, geojson=True)
    elif command == "movie":
        cd.run_movie(masks, out, **SMALL)
    else:
        methods = ("newton", "edge")
        cd.run_compare_windows(masks, out, **SMALL, movie=command.startswith("movie"), methods=methods)
    ours = [path for path in out.rglob("*") if path.is_file() and path.name != "provenance.json"]
    (out / "figures").mkdir(exist_ok=True)
    for name in THEIRS:
        (out / name).write_text("mine")
    cd.run_shapes(masks, out, overwrite=True)
    left = {str(path.relative_to(out)) for path in out.rglob("*") if path.is_file()}
    assert set(THEIRS) <= left
    assert [path.name for path in ours if path.exists()] == [
        path.name for path in ours if path.name in ("parameters.toml", "cells.parquet", "columns.csv")
    ]

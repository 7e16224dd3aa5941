"""`cytodisk map` with nuclei says the ratio of nucleus to cytoplasm."""

from pathlib import Path

import numpy as np
import tifffile
from command_line import Run

GRID = ("--layers", "3", "--sectors", "8", "--figures", "0")


def test_map_prints_the_ratio_of_each_channel(run: Run, tmp_path: Path) -> None:
    cells, nuclei = np.zeros((2, 60, 130), dtype=np.uint8)
    cells[8:50, 6:56], cells[8:50, 66:120] = 1, 2
    nuclei[20:34, 14:34], nuclei[16:36, 90:110] = 1, 2
    image = np.stack([np.where(nuclei, 80.0, 10.0), np.where(nuclei, 5.0, 20.0)]).astype(np.float32)
    tifffile.imwrite(tmp_path / "cells.tif", cells)
    tifffile.imwrite(tmp_path / "nuclei.tif", nuclei)
    tifffile.imwrite(tmp_path / "image.tif", image, metadata={"axes": "CYX"}, photometric="minisblack")
    files = (tmp_path / "cells.tif", "--nuclei", tmp_path / "nuclei.tif", "--signal", tmp_path / "image.tif")
    code, said, _ = run("map", *files, "--channels", "DAPI,GFP", "-o", tmp_path / "out", *GRID)
    assert code == 0
    one_line = "nucleus to cytoplasm: DAPI 8, GFP 0.25 (mean of 2 cells, background as in the image)"
    assert one_line in " ".join(said.split())

from __future__ import annotations

import numpy as np
import pytest
import tifffile
from placed_windows import GRID, SIZE_UM, two_cells

import cytodisk as cd


@pytest.fixture(scope="session")
def mapped(tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    """Two cells of a label image with two channels."""
    folder = tmp_path_factory.mktemp("mapped")
    tifffile.imwrite(folder / "cells.tif", two_cells())
    signal = np.random.default_rng(3).integers(0, 4000, (2, 40, 70)).astype(np.uint16)
    names = {"axes": "CYX", "Channel": {"Name": ["Rac1", "RhoA"]}}
    tifffile.imwrite(folder / "signal.ome.tif", signal, metadata=names, photometric="minisblack")
    given = {"signal": folder / "signal.ome.tif", "pixel_size_um": SIZE_UM, **GRID}
    return cd.run_map(folder / "cells.tif", folder / "out", **given)


@pytest.fixture(scope="session")
def followed(tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    """A cell in four frames, of which one is empty."""
    folder = tmp_path_factory.mktemp("followed")
    masks = cd.simulate.movie("growing", frames=4, radius_px=12.0).masks.astype(np.uint8)
    masks[2] = 0
    for name, frames in {"masks.tif": masks, "signal.tif": 100 * masks.astype(np.uint16)}.items():
        tifffile.imwrite(folder / name, frames, metadata={"axes": "TYX"}, photometric="minisblack")
    return cd.run_movie(folder / "masks.tif", folder / "out", signal=folder / "signal.tif", **GRID)

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import tifffile

import cytodisk as cd


@pytest.fixture
def write_stack(tmp_path: Path) -> Callable[[int], tuple[Path, Path]]:
    """Writes a stack of small cells and its two-channel movie; gives both paths."""

    def write(n_cells: int) -> tuple[Path, Path]:
        masks = np.zeros((n_cells, 50, 60), dtype=np.uint8)
        for seed, frame in enumerate(masks):
            cell = cd.simulate.random_smooth(seed, radius=12, margin=0)
            frame[3 : 3 + cell.shape[0], 3 : 3 + cell.shape[1]] = cell[:47, :57]
        signal = np.random.default_rng(0).integers(0, 4000, (n_cells, 2, 50, 60)).astype(np.uint16)
        options = {"compression": "zlib", "photometric": "minisblack"}
        tifffile.imwrite(tmp_path / "masks.tif", masks, **options)
        names = {"axes": "TCYX", "Channel": {"Name": ["Rac1", "RhoA"]}}
        tifffile.imwrite(tmp_path / "signal.ome.tif", signal, metadata=names, **options)
        return tmp_path / "masks.tif", tmp_path / "signal.ome.tif"

    return write

"""Two files of three cells with signals, one of which is refused, and names that break careless pages."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from cells_study import CHANNELS, FILES, LAYERS, SECTORS

import cytodisk as cd
from cytodisk.pages.report.page import write_report
from cytodisk.store.study import Study


@pytest.fixture(scope="session")
def cell_files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folders masks and images; label 3 of the second file has two pieces and is refused."""
    folder = tmp_path_factory.mktemp("cells")
    for name in ("masks", "images"):
        (folder / name).mkdir()
    for number, name in enumerate(FILES):
        labels = np.zeros((60, 120), dtype=np.uint16)
        for k in range(3):
            disk = cd.simulate.disk(12.0 + 2 * k + number, margin=2)
            labels[4 : 4 + disk.shape[0], 2 + 38 * k : 2 + 38 * k + disk.shape[1]][disk] = k + 1
        if number:
            labels[labels == 3] = 0
            labels[4:14, 80:90] = labels[40:52, 80:90] = 3
        x = np.indices(labels.shape)[1]
        signal = np.stack([100.0 + x, np.where(labels > 0, 500.0, 50.0)]).astype(np.uint16)
        tifffile.imwrite(folder / "masks" / name, labels, photometric="minisblack")
        options: Any = {"photometric": "minisblack", "metadata": {"axes": "CYX"}}
        tifffile.imwrite(folder / "images" / name, signal, **options)
    return folder


@pytest.fixture(scope="session")
def cells(cell_files: Path) -> Study:
    return cd.run_map(
        cell_files / "masks",
        cell_files / "study",
        signal=cell_files / "images",
        channels=CHANNELS,
        layers=LAYERS,
        sectors=SECTORS,
        kind="labels",
    )


@pytest.fixture(scope="session")
def cells_written(cells: Study, cell_files: Path) -> Path:
    return write_report(cells, cell_files / "report.html")

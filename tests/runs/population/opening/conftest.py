import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile

from cytodisk import simulate
from cytodisk.runs.map.run_map import run_map
from cytodisk.store.tables import read_table, write_table

Change = Callable[..., Path]


@pytest.fixture(scope="session")
def day1(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of four cells in two channels; the means are 10 and 100 times the label."""
    folder = tmp_path_factory.mktemp("population")
    labels = simulate.label_image(cells=4, seed=1)
    tifffile.imwrite(folder / "cells.tif", labels)
    signal = np.stack([labels * 10.0, labels * 100.0]).astype("float32")
    tifffile.imwrite(folder / "signal.tif", signal, metadata={"axes": "CYX"}, imagej=True)
    out = folder / "day1"
    run_map(
        folder / "cells.tif",
        out,
        signal=folder / "signal.tif",
        channels=("Rac1", "RhoA"),
        layers=2,
        sectors=6,
        maps=False,
    )
    return out


@pytest.fixture
def changed(day1: Path, tmp_path: Path) -> Change:
    """Copies of that study with other settings or tables, of other cells unless it is said."""

    def change(
        name: str,
        *,
        parameters: dict[str, Any] | None = None,
        same_cells: bool = False,
        windows: Callable[[pd.DataFrame], pd.DataFrame] | None = None,
        cells: Callable[[pd.DataFrame], pd.DataFrame] | None = None,
        **fields: Any,
    ) -> Path:
        folder = tmp_path / name
        shutil.copytree(day1, folder)
        provenance = json.loads((folder / "provenance.json").read_text())
        provenance["parameters"] |= parameters or {}
        provenance |= fields
        if not same_cells:
            for role in provenance["inputs"].values():
                role["sha256"] = f"{name} {role['sha256']}"
        (folder / "provenance.json").write_text(json.dumps(provenance))
        for table, edit in (("windows", windows), ("cells", cells)):
            path = folder / f"{table}.parquet"
            if edit is not None:
                before = read_table(path)
                after = edit(before)
                after.attrs = before.attrs
                write_table(after, path)
        return folder

    return change

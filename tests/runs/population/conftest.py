"""A small study of cells of two conditions, made once."""

from pathlib import Path

import pandas as pd
import pytest

import cytodisk as cd


@pytest.fixture(scope="session")
def cell_study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with `maps`, a study without groups, and `groups.csv`: 4 + 4 experiments of 2 cells."""
    folder = tmp_path_factory.mktemp("cells")
    made = cd.simulate.population_images(folder / "images", experiments=4, cells=2, seed=2)
    cd.run_map(made.masks, folder / "maps", signal=made.images, layers=3, sectors=8, maps=False)
    table = pd.read_csv(made.groups)
    table.to_csv(folder / "groups.csv", index=False)
    table.drop(columns="experiment").to_csv(folder / "no_experiments.csv", index=False)
    return folder

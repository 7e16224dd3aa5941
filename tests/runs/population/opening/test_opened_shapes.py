from pathlib import Path

import numpy as np
import pytest
import tifffile

from cytodisk import simulate
from cytodisk.analysis.shape.features import FEATURES
from cytodisk.errors import PopulationError
from cytodisk.runs.population.opening.open_population import open_population
from cytodisk.runs.shapes.run_shapes import run_shapes
from cytodisk.runs.shapes.shape_tables import open_shapes


@pytest.fixture(scope="module")
def shapes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("shapes")
    for day in (1, 2):
        tifffile.imwrite(folder / f"day{day}.tif", simulate.label_image(cells=3, seed=day))
        run_shapes(folder / f"day{day}.tif", folder / "out" / f"day{day}")
    return folder / "out"


def test_features_of_shapes_are_scalars_without_windows(shapes: Path) -> None:
    population = open_population(shapes)
    assert population.channels == ()
    assert population.areas is None
    assert len(population) == 6
    assert {*population.scalars} <= {feature.name for feature in FEATURES}
    assert "circularity" in population.scalars
    np.testing.assert_array_equal(
        population.cells["circularity"][3:], open_shapes(shapes / "day2")["circularity"]
    )
    assert population.cells.attrs["notes"][0].startswith("There is no complexity score")
    assert population.scalar_table()["area"].tolist() == population.cells["area"].tolist()


def test_some_features_can_be_chosen_and_windows_cannot(shapes: Path) -> None:
    assert open_population(shapes, scalars=["area", "solidity"]).scalars == ("area", "solidity")
    with pytest.raises(PopulationError, match=r"channels: day1 is of cytodisk shapes, without windows"):
        open_population(shapes, channels=["Rac1"])
    with pytest.raises(PopulationError, match=r"summary: day1 is of cytodisk shapes"):
        open_population(shapes, summary="sd")

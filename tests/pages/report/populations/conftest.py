"""A population of four experiments in each of two conditions, and its page."""

from pathlib import Path

import pytest

import cytodisk as cd
from cytodisk.pages.report.page import write_report
from cytodisk.store.populations.population_study import PopulationStudy


@pytest.fixture(scope="session")
def compared(tmp_path_factory: pytest.TempPathFactory) -> PopulationStudy:
    folder = tmp_path_factory.mktemp("population")
    made = cd.simulate.population_images(folder / "images", experiments=4, cells=2, effect=1.0)
    maps = cd.run_map(
        made.masks, folder / "maps", signal=made.images, groups=made.groups, layers=3, sectors=8
    )
    write_report(maps)
    return cd.run_population(folder / "maps", folder / "atlas", normalise="cell mean")


@pytest.fixture(scope="session")
def population_written(compared: PopulationStudy) -> Path:
    return write_report(compared)


@pytest.fixture(scope="session")
def shapes_written(compared: PopulationStudy) -> Path:
    folder, made = compared.path.parent, compared.path.parent / "images"
    cd.run_shapes(made / "masks", folder / "shapes", groups=made / "groups.csv")
    return write_report(
        cd.run_population(folder / "shapes", folder / "of_shapes", scalars=["area", "solidity"])
    )

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import PopulationError

pytestmark = pytest.mark.slow  # UMAP is compiled

EXPERIMENTS, CELLS, SIDE = 4, 3, 200


def framed(mask: np.ndarray) -> np.ndarray:
    """A mask in the middle of a frame that holds all."""
    room = [(SIDE - side) // 2 for side in mask.shape]
    return np.pad(
        mask, [(before, SIDE - side - before) for before, side in zip(room, mask.shape, strict=True)]
    )


@pytest.fixture(scope="module")
def population(tmp_path_factory: pytest.TempPathFactory) -> cd.Population:
    """Smooth cells, and spiky ones after a drug, by the way of a user."""
    folder = tmp_path_factory.mktemp("shapes")
    masks, rows = [], []
    for condition, draw in (("control", cd.simulate.random_smooth), ("drug", cd.simulate.random_spiky)):
        for experiment in range(EXPERIMENTS):
            for _ in range(CELLS):
                group = {"condition": condition, "experiment": f"{condition} {experiment}"}
                rows.append({"frame": len(masks)} | group)
                masks.append(framed(draw(len(masks), radius=40)))
    pd.DataFrame(rows).to_csv(folder / "groups.csv", index=False)
    tifffile.imwrite(folder / "masks.tif", np.stack(masks).astype(np.uint8), metadata={"axes": "IYX"})
    cd.run_shapes(folder / "masks.tif", folder / "out", groups=folder / "groups.csv")
    return cd.open_population(folder / "out")


def test_shapes_that_differ_are_found_and_the_score_is_among_them(population: cd.Population) -> None:
    found = cd.compare_conditions(population, "control", "drug")
    scalars = found.scalars.set_index("scalar")
    assert found.smallest_p == pytest.approx(2 / 70)
    assert scalars.loc["complexity", "p_fwer"] <= 0.05
    assert scalars.loc["complexity", "difference"] > 0.0  # spiky cells are higher, whatever UMAP's sign
    assert scalars.loc["circularity", "difference"] < 0.0
    assert scalars.loc["circularity", "p_fwer"] <= 0.05
    assert (scalars["p_fwer"].dropna() >= scalars["p"].dropna()).all()


def test_what_a_reader_must_know_goes_with_the_population(population: cd.Population) -> None:
    notes = " ".join(population.cells.attrs["notes"])
    assert "The complexity score was made of all 24 cells together" in notes
    assert population.cells.attrs["units"]["area"] == "px²"
    assert population.scalars[0] == "complexity"


def test_alike_shapes_do_not_differ_however_they_are_called(population: cd.Population) -> None:
    rounds = population.select((population.cells["condition"] == "control").to_numpy())
    renamed = rounds.cells.assign(condition=np.where(np.arange(len(rounds)) < 6, "a", "b"))
    found = cd.compare_conditions(rounds.with_cells(renamed), "a", "b")
    assert not (found.scalars["p_fwer"] <= 0.05).any()
    assert "too few experiments" in [one.name for one in found.warnings]


def test_osteosarcoma_cells_without_experiments_are_described_and_not_tested(
    data_dir: Path, tmp_path: Path
) -> None:
    folder = data_dir / "osteosarcoma"
    if not folder.is_dir():
        pytest.skip(f"real data is absent: no folder {folder}")
    every = slice(None, None, 9)
    treatments = (folder / "treatments.txt").read_text().split()[every]
    masks = tifffile.imread(folder / "masks.tif")[every]
    tifffile.imwrite(tmp_path / "masks.tif", masks, metadata={"axes": "IYX"})
    groups = pd.DataFrame({"frame": range(len(treatments)), "condition": treatments})
    groups.to_csv(tmp_path / "groups.csv", index=False)
    cd.run_shapes(tmp_path / "masks.tif", tmp_path / "out", groups=tmp_path / "groups.csv")
    pop = cd.open_population(tmp_path / "out")
    assert set(pop.conditions) == {"control", "cytd", "jasp"}
    assert "complexity" in pop.scalar_table()
    with pytest.raises(PopulationError, match="experiments are unknown"):
        cd.compare_conditions(pop, "control", "jasp")
    found = cd.compare_conditions(pop, "control", "jasp", unit="cell", permutations=199)
    assert "cells as units" in [one.name for one in found.warnings]

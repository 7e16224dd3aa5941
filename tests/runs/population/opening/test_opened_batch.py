import shutil
from pathlib import Path

import numpy as np
import pytest
import tifffile

from cytodisk import simulate
from cytodisk.errors import PopulationError
from cytodisk.runs.batch.run_batch import run_batch
from cytodisk.runs.population.opening.open_population import open_population

pytestmark = pytest.mark.slow  # a process for each input
_FILE = """
[study]
kind = "map"
columns = ["plate"]
groups = "groups.csv"
[parameters]
layers = 2
sectors = 6
channels = ["Rac1"]
[[inputs]]
masks = "a.tif"
signal = "a_signal.tif"
condition = "control"
experiment = "day 1"
plate = 1
[[inputs]]
masks = "b.tif"
signal = "b_signal.tif"
condition = "drug"
experiment = "day 1"
plate = 2
[[inputs]]
masks = "c.tif"
signal = "c_signal.tif"
condition = "drug"
experiment = "day 2"
plate = 3
"""


@pytest.fixture(scope="module")
def batch(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A batch of two files with three cells, and one of which the signal has another size."""
    folder = tmp_path_factory.mktemp("batch")
    for seed, name in enumerate("abc"):
        labels = simulate.label_image(cells=3, seed=seed)
        tifffile.imwrite(folder / f"{name}.tif", labels)
        signal = labels[: 10 if name == "c" else None] * (seed + 1.0)
        tifffile.imwrite(folder / f"{name}_signal.tif", signal.astype("float32"))
    (folder / "batch.toml").write_text(_FILE)
    (folder / "groups.csv").write_text("file,cell,dish\na,1,x\na,2,y\na,3,x\nb,,z\nc,,z\n")
    run_batch(folder / "batch.toml", folder / "out")
    return folder / "out"


def test_a_batch_is_a_population_of_all_its_cells(batch: Path) -> None:
    population = open_population(batch)
    cells = population.cells
    assert cells["cell"].tolist() == [f"{name}, label {k}" for name in "ab" for k in (1, 2, 3)]
    assert cells["condition"].tolist() == ["control"] * 3 + ["drug"] * 3
    assert cells["experiment"].tolist() == ["day 1"] * 6
    assert cells["plate"].tolist() == [1] * 3 + [2] * 3
    assert cells["dish"].tolist() == ["x", "y", "x", "z", "z", "z"]
    np.testing.assert_allclose(population.values[:, 0, 0, 0], [1, 2, 3, 2, 4, 6])
    assert Path(cells["study"].iloc[4]) == batch / "inputs" / "b"
    found = open_population(batch / "inputs" / "b")  # one of its studies alone
    np.testing.assert_array_equal(found.values, population.values[3:])


def test_an_input_without_results_is_told_with_the_reason(batch: Path) -> None:
    told = open_population(batch).excluded
    assert told["input"].unique().tolist() == ["c"]
    assert told["source"].unique().tolist() == ["c.tif"]
    assert told["reason"].str.startswith("refused: ").all()


def test_a_batch_of_which_a_study_is_gone_is_refused(batch: Path, tmp_path: Path) -> None:
    copy = tmp_path / "out"
    shutil.copytree(batch, copy)
    shutil.rmtree(copy / "inputs" / "b")
    with pytest.raises(PopulationError, match=r"input b of batch .* is done, but .* is gone"):
        open_population(copy)
    shutil.copytree(batch / "inputs" / "b", copy / "inputs" / "b")
    with pytest.raises(PopulationError, match=r"cell 1 of a.tif is in out/a and in a"):
        open_population([copy, batch / "inputs" / "a"])

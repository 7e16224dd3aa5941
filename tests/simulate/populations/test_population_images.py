from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile
from numpy.testing import assert_array_equal
from scipy import ndimage

import cytodisk as cd
from cytodisk.errors import ParameterError
from cytodisk.simulate import PopulationImages, population_images


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> PopulationImages:
    folder = tmp_path_factory.mktemp("images")
    return population_images(
        folder, 1, nuclei=True, cells=6, effect=1.0, between_experiments=0.5, deviation=0.3
    )


def inside(files: PopulationImages, name: str, label: int) -> tuple[float, float]:
    """Mean of the first channel over the second one, towards the region and away from it."""
    labels = tifffile.imread(files.masks / f"{name}_cp_masks.tif")
    counts = tifffile.imread(files.images / f"{name}.ome.tif").astype(float) - 20.0
    row = files.cells.query("file == @name and label == @label").iloc[0]
    places = np.argwhere(labels == label)
    angle = np.degrees(np.arctan2(*(places - places.mean(axis=0)).T)) - row["region_direction"]
    beside = np.abs((angle + 180.0) % 360.0 - 180.0)
    outer = ndimage.distance_transform_edt(labels == label)[labels == label] <= 2.0
    means = [counts[:, labels == label][:, outer & part].mean(axis=1) for part in (beside < 50, beside > 70)]
    return means[0][0] / means[0][1], means[1][0] / means[1][1]


def test_files_and_table_name_the_same_images(files: PopulationImages) -> None:
    groups = pd.read_csv(files.groups)
    assert list(groups.columns) == ["file", "condition", "experiment"]
    names = set(groups["file"])
    assert (
        names == {f"{one}_{n}" for one in ("control", "drug") for n in (1, 2, 3)} == set(files.cells["file"])
    )
    assert {path.name for path in files.masks.iterdir()} == {f"{name}_cp_masks.tif" for name in names}
    assert files.nuclei is not None
    assert {path.name for path in files.nuclei.iterdir()} == {f"{name}.tif" for name in names}
    signal = cd.read_image(files.images / "drug_2.ome.tif")
    assert signal["channel"].to_numpy().tolist() == ["Rac1", "RhoA"]
    assert signal.attrs["pixel_size_um"] == pytest.approx(0.3)


def test_cells_are_apart_and_whole_with_their_nucleus_inside(files: PopulationImages) -> None:
    labels = tifffile.imread(files.masks / "drug_1_cp_masks.tif")
    assert files.nuclei is not None
    nuclei = tifffile.imread(files.nuclei / "drug_1.tif")
    assert np.unique(labels).tolist() == np.unique(nuclei).tolist() == list(range(7))
    assert_array_equal(labels[nuclei > 0], nuclei[nuclei > 0])
    assert not any(edge.any() for edge in (labels[0], labels[-1], labels[:, 0], labels[:, -1]))
    assert {True, False} == set(files.cells["arms"])


def test_the_region_is_brighter_away_from_the_nucleus_under_the_drug(files: PopulationImages) -> None:
    found = {
        one: np.array([inside(files, f"{one}_1", label) for label in range(1, 7)])
        for one in ("control", "drug")
    }
    assert np.median(found["drug"][:, 0]) == pytest.approx(1.9, abs=0.25)
    for means in (found["drug"][:, 1], *found["control"].T):
        assert np.median(means) == pytest.approx(1.0, abs=0.12)


def test_brightness_hangs_together_in_an_experiment(tmp_path: Path) -> None:
    files = population_images(
        tmp_path, 2, experiments=8, cells=4, paired=True, arms=0.0, radius_px=12.0, between_experiments=1.0
    )
    brightness = files.cells.groupby("experiment")["brightness"]
    assert brightness.nunique().tolist() == [1] * 8
    assert np.log(brightness.first()).std() == pytest.approx(0.15, abs=0.1)
    assert files.nuclei is None
    assert set(files.cells["region_direction"]) == {0.0}


def test_the_same_seed_gives_the_same_files(tmp_path: Path) -> None:
    one, again = (population_images(tmp_path / name, 3, experiments=1, cells=2) for name in "ab")
    assert one.cells.equals(again.cells)
    name = "control_1.ome.tif"
    assert_array_equal(tifffile.imread(one.images / name), tifffile.imread(again.images / name))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"conditions": ("a/b",)}, "files can have"),
        ({"channels": ()}, "one or more"),
        ({"effect": -2.0}, "at least -1"),
        ({"effect": (0.0, 1.0, 2.0)}, "one for each of the 2"),
        ({"seed": -1}, "seed"),
    ],
)
def test_what_cannot_be_drawn(tmp_path: Path, settings: dict[str, object], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        population_images(tmp_path, **settings)  # type: ignore[arg-type]

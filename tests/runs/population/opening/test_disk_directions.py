from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile

from cytodisk.analysis.compartments.nucleus_place import direction_in_disk, turn_of_disk
from cytodisk.population.population import Population
from cytodisk.runs.map.run_map import run_map
from cytodisk.runs.population.opening.disk_directions import movie_directions
from cytodisk.runs.population.opening.open_population import open_population
from cytodisk.runs.population.opening.row_moments import RowMoments
from cytodisk.runs.population.opening.streamed_windows import WindowBlock
from cytodisk.store.study import Study

ANGLES = (0.0, 50.0, 140.0, 265.0)


def drop(angle: float, size: int = 80) -> tuple[Any, Any, Any]:
    """A cell with its thin end at an angle, an eccentric nucleus, and a signal that grows along it."""
    y, x = np.mgrid[:size, :size] - size / 2 + 0.5
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    along, across = c * x + s * y, c * y - s * x
    cell = (along / 27) ** 2 + (across / (17 - 0.25 * along)) ** 2 <= 1
    nucleus = ((along + 8) / 7) ** 2 + ((across - 2) / 6) ** 2 <= 1
    return cell, nucleus, 100.0 + along


@pytest.fixture(scope="module", params=["upright", 90.0, "nucleus", (10.0, 20.0)], ids=str)
def turned(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Study, Population]:
    """One cell at several angles in the image, mapped with an `align`."""
    folder = tmp_path_factory.mktemp("turned")
    stacks = zip(*(drop(angle) for angle in ANGLES), strict=True)
    for name, stack in zip(("cells", "nuclei", "signal"), stacks, strict=True):
        kind = {"photometric": "minisblack", "metadata": {"axes": "TYX"}}
        tifffile.imwrite(folder / f"{name}.tif", np.stack(stack).astype("float32"), **kind)
    study = run_map(
        folder / "cells.tif",
        folder / "out",
        nuclei=folder / "nuclei.tif",
        signal=folder / "signal.tif",
        kind="stack",
        layers=3,
        sectors=24,
        align=request.param,
    )
    return study, open_population(folder / "out")


def off(found: Any, wanted: Any) -> float:
    """Largest difference of angles, in degrees."""
    return float(np.abs((np.asarray(found) - np.asarray(wanted) + 180.0) % 360.0 - 180.0).max())


@pytest.mark.slow
def test_directions_are_those_of_the_map_whatever_its_align(turned: tuple[Study, Population]) -> None:
    study, population = turned
    cells = population.cells
    maps = [study.map(number) for number in cells["number"]]
    assert off(cells["disk_turn"], [turn_of_disk(disk) for disk in maps]) < 0.5
    assert off(cells["disk_direction_nucleus"], [direction_in_disk(disk) for disk in maps]) < 0.5
    assert off(cells["disk_direction_axis"], np.array(ANGLES) - cells["disk_turn"]) < 3.0
    spread = np.sqrt(np.linalg.eigvalsh(np.cov(np.nonzero(drop(0.0)[0]))))
    longer = (spread[1] - spread[0]) / spread.sum()
    np.testing.assert_allclose(cells["direction_strength_axis"], longer, atol=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("by", ["nucleus", "axis"])
def test_one_cell_that_is_turned_in_the_image_aligns(turned: tuple[Study, Population], by: str) -> None:
    values = turned[1].align(by).values[:, 0, 0]
    step = 55.0 * 2.0 * np.pi / 24  # of the signal from one sector to the next, at most, at the edge
    assert float((values.max("cell") - values.min("cell")).max()) < step


def test_a_long_axis_has_the_end_that_reaches_further_out() -> None:
    x = np.array([-2.0, -1.0, 0.0, 3.0, 0.0, 0.0])
    y = np.array([0.0, 0.0, 0.0, 0.0, 1.0, -1.0])
    found = []
    for angle in (0.0, 70.0, 200.0):
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        moments = RowMoments(np.array([[5.0, 7.0]]), sectors=6)  # not the mean: moments are taken about that
        places = {"centroid_y": 20.0 + s * x + c * y, "centroid_x": 30.0 + c * x - s * y}
        sectors = np.arange(6)
        moments.add(
            WindowBlock(0 * sectors, 0 * sectors, 0 * sectors, sectors, places | {"area": np.ones(6)})
        )
        direction, strength = moments.long_axis()
        found.append(float(strength[0]))
        assert off(direction, [angle]) < 1e-6
    np.testing.assert_allclose(found, found[0])
    assert (np.sqrt(7) - 1) / (np.sqrt(7) + 1) == pytest.approx(found[0])


def test_windows_without_a_centroid_give_no_direction() -> None:
    moments = RowMoments(np.zeros((2, 2)), sectors=4)
    nothing = np.full(1, np.nan)
    block = WindowBlock(
        *np.zeros((4, 1), dtype=int), {"centroid_y": nothing, "centroid_x": nothing, "area": nothing}
    )
    moments.add(block)
    assert np.isnan(moments.turn).all()
    assert np.isnan(moments.long_axis()[1]).all()


def frames(turn: Any, **columns: Any) -> pd.DataFrame:
    """A cell that goes two pixels along +x a frame."""
    number = len(turn)
    place = {"centroid_x": 2.0 * np.arange(number), "centroid_y": np.zeros(number)}
    return pd.DataFrame({"turn": turn, "axis": 90.0, "long": 0.5} | place | columns)


def edge(means: Any) -> pd.DataFrame:
    return pd.DataFrame({"sector": range(len(means)), "velocity": means})


def test_motion_is_a_direction_in_the_disk_and_how_straight_the_path_is() -> None:
    found = movie_directions(frames([30.0] * 5), edge([0.0] * 4), 4)
    assert off(found["disk_direction_motion"], 330.0) < 1e-9
    assert found["direction_strength_motion"] == pytest.approx(1.0)
    assert off(found["disk_turn"], 30.0) < 1e-9
    assert np.isnan(found["disk_direction_front"])
    back = frames([0.0] * 5, centroid_x=[0.0, 3.0, 0.0, 3.0, 2.0])
    found = movie_directions(back, edge([0.0] * 4), 4)
    assert found["direction_strength_motion"] == pytest.approx(2.0 / 10.0)


def test_front_is_where_the_edge_goes_forward() -> None:
    found = movie_directions(frames([10.0] * 3), edge([1.0, 0.0, -1.0, 0.0]), 4)
    assert off(found["disk_direction_front"], 45.0) < 1e-9  # the middle of sector 0
    assert found["direction_strength_front"] == pytest.approx(1.0)
    even = movie_directions(frames([10.0] * 3), edge([1.0] * 4), 4)
    assert even["direction_strength_front"] == pytest.approx(0.0, abs=1e-12)


def test_axes_of_frames_are_averaged_without_their_ends() -> None:
    found = movie_directions(frames([0.0] * 3, axis=[10.0, 190.0, 10.0]), edge([0.0] * 4), 4)
    assert off(found["disk_direction_axis"], 10.0) < 1e-9
    assert found["direction_strength_axis"] == pytest.approx(0.5)


def test_a_nucleus_that_moves_about_has_a_weak_direction() -> None:
    away = {"nucleus_direction": [0.0, 90.0, 180.0, 270.0], "nucleus_polarity": 0.3}
    found = movie_directions(frames([0.0] * 4, **away), edge([0.0] * 4), 4)
    assert found["direction_strength_nucleus"] == pytest.approx(0.0, abs=1e-12)
    still = {"nucleus_direction": [np.nan, 90.0, 90.0, 90.0], "nucleus_polarity": 0.3}
    found = movie_directions(frames([0.0] * 4, **still), edge([0.0] * 4), 4)
    assert off(found["disk_direction_nucleus"], 90.0) < 1e-9
    assert found["direction_strength_nucleus"] == pytest.approx(0.3)

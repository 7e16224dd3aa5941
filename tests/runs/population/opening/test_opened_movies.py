from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile

from cytodisk import simulate
from cytodisk.errors import PopulationError
from cytodisk.runs.movie.run_movie import run_movie
from cytodisk.runs.population.movie_values import movie_values
from cytodisk.runs.population.opening.movie_cells import rows_by_cell
from cytodisk.runs.population.opening.open_population import open_population
from cytodisk.store.study import open_study


def test_numbers_of_a_cell_are_means_over_its_frames_with_a_map() -> None:
    frames = pd.DataFrame(
        {
            "input": "a",
            "number": [1, 1, 1, 0],
            "frame": [2, 3, 4, 0],
            "label": [7, 7, 7, 3],
            "status": ["missing", "ok", "ok", "refused"],
            "reason": ["gone", "", "", "too small"],
            "area": [np.nan, 10.0, 30.0, np.nan],
            "qc_flags": ["", "area jumps", "area jumps; image border", None],
        }
    )
    frames.attrs = {"units": {"area": "px²"}}
    found = rows_by_cell(frames)
    assert found["number"].tolist() == [1, 0]
    assert found["area"].iloc[0] == 20.0
    assert found["frames"].tolist() == [2, 0]
    assert found["frame"].tolist() == [2, 0]
    assert found["qc_flags"].tolist() == ["area jumps; image border", ""]
    assert found[["status", "reason"]].values.tolist() == [["ok", ""], ["refused", "too small"]]
    assert found.attrs == frames.attrs


@pytest.fixture(scope="module")
def movies(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of three studies, of cells that go somewhere; one has too few frames."""
    folder = tmp_path_factory.mktemp("movies")
    for number, frames in enumerate((12, 10, 4)):
        truth = simulate.movie("migrating", frames=frames, radius_px=12, seed=number)
        stack = truth.masks.astype("uint8")
        tifffile.imwrite(folder / f"m{number}.tif", stack, photometric="minisblack")
        tifffile.imwrite(folder / f"s{number}.ome.tif", truth.signal.to_numpy(), metadata={"axes": "TCYX"})
        run_movie(
            folder / f"m{number}.tif",
            folder / "out" / f"movie{number}",
            signal=folder / f"s{number}.ome.tif",
            channels=("A", "B"),
            layers=2,
            sectors=8,
            frame_interval_s=2.0,
        )
    return folder / "out"


@pytest.mark.slow
def test_each_movie_contributes_its_summary(movies: Path) -> None:
    population = open_population(movies)
    assert population.channels == ("A", "B")
    study = open_study(movies / "movie1")
    np.testing.assert_array_equal(population.values[1], movie_values(study, 0, "mean"))
    areas = study.windows[study.windows["channel"] == "A"].groupby(["layer", "sector"])["area"].mean()
    np.testing.assert_allclose(population.areas[1].values.ravel(), areas)
    assert population.cells["frames"].tolist() == [12, 10]
    assert population.raw.attrs["frame_interval_s"] == 2.0
    assert 0.0 < population.raw["depth"][0] < population.raw["depth"][1]
    assert open_population(movies, channels=["B"]).channels == ("B",)


@pytest.mark.slow
def test_a_movie_that_gives_nothing_is_told_with_the_reason(movies: Path) -> None:
    told = open_population(movies).excluded
    assert told["input"].tolist() == ["movie2"]
    assert told["reason"].item().startswith("4 of 4 frames have values, the mean over time needs at least 5")
    with pytest.raises(PopulationError, match=r"'peak_correlation'|cytodisk correlate"):
        open_population(movies, summary="peak_correlation")


@pytest.mark.slow
def test_velocity_has_no_channels_of_the_signal_and_aligns_by_front(movies: Path) -> None:
    population = open_population(movies, summary="velocity")
    assert population.channels == ("velocity",)
    assert population.raw.attrs["units"] == "px/s"
    front = population.align("front").values[:, 0, 0]
    assert (front.sel(sector=[7, 0]).mean("sector") > front.sel(sector=[3, 4]).mean("sector")).all()


@pytest.mark.slow
def test_the_front_is_where_cells_go(movies: Path) -> None:
    cells = open_population(movies).cells
    between = (cells["disk_direction_front"] - cells["disk_direction_motion"] + 180.0) % 360.0 - 180.0
    assert (between.abs() < 30.0).all()
    assert (cells["direction_strength_motion"] > 0.8).all()

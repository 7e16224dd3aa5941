from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
import xarray as xr
from movie_files import LAYERS, SECTORS, SMALL, assert_same_movie, write_movie
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.analysis.activity import STATISTICS, sample_movie
from cytodisk.analysis.consistency import centroid_displacement, consecutive_correlation
from cytodisk.errors import ParameterError
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.simulate.moving_cells import SimulatedMovie
from cytodisk.store.tables import (
    CELL_COLUMNS,
    CONSISTENCY_COLUMNS,
    EDGE_COLUMNS,
    TRACK_COLUMNS,
)
from cytodisk.store.window_columns import WINDOW_COLUMNS, WINDOW_SIZE_COLUMNS
from cytodisk.windows.study_grid import polar_grid_of

FRAMES, GAP = 8, 6
PIXEL_UM, INTERVAL_S = 0.16, 5.0
CHANNELS = ["material", "edge"]
MAPPED = [0, 1, 2, 3, 4, 5, 7]
MEASURES = ["velocity", "velocity_cell_frame", "velocity_error", "protruded_area", "retracted_area"]


@pytest.fixture(scope="module")
def truth() -> SimulatedMovie:
    """Five bulges come and go; frame 6 is lost."""
    made = cd.simulate.movie("dropping", 0, frames=FRAMES, radius_px=20.0)
    assert np.flatnonzero(~made.present).tolist() == [GAP]
    return made


@pytest.fixture(scope="module")
def files(truth: SimulatedMovie, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    return write_movie(tmp_path_factory.mktemp("movie"), truth)


@pytest.fixture(scope="module")
def study(files: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    return movie_study(open_movie(*files, SMALL), tmp_path_factory.mktemp("study") / "out")


@pytest.fixture(scope="module")
def sampled(study: cd.Study, truth: SimulatedMovie) -> xr.Dataset:
    return sample_movie(study.movie(0), cd.polar_windows(LAYERS, SECTORS), truth.signal)


def table(frame: pd.DataFrame, name: str, time: int) -> np.ndarray:
    return frame.loc[frame["frame"] == time, name].to_numpy()


def test_every_frame_has_a_row(study: cd.Study, truth: SimulatedMovie) -> None:
    cells = study.cells
    assert cells["frame"].tolist() == list(range(FRAMES))
    assert_array_equal(cells["time_s"], INTERVAL_S * np.arange(FRAMES))
    assert_array_equal(cells["status"] == "ok", truth.present)
    assert "is empty: no pixel belongs to the cell" in cells["reason"][GAP]
    assert set(cells["reason"][MAPPED]) == {""}
    assert cells["certificate_valid"][MAPPED].all()
    assert (cells["empty_windows"][MAPPED] == 0).all()
    assert_array_equal(cells["area_px"][MAPPED], truth.masks.sum(axis=(1, 2))[MAPPED])
    assert_allclose(cells["area"][MAPPED], PIXEL_UM**2 * cells["area_px"][MAPPED])
    assert np.isnan(cells["area"][GAP])


def test_tables_have_a_row_for_all_there_is(study: cd.Study) -> None:
    sizes = {
        "windows": (study.windows, 2 * LAYERS * SECTORS),
        "edge": (study.edge, SECTORS),
        "consistency": (study.consistency, 2 * LAYERS),
    }
    for name, (rows, per_frame) in sizes.items():
        assert rows["frame"].tolist() == np.repeat(MAPPED, per_frame).tolist(), name
        assert_array_equal(rows["time_s"], INTERVAL_S * rows["frame"])
        assert (rows["cell"] == 0).all()
    assert study.windows["channel"].unique().tolist() == CHANNELS
    assert set(study.windows["status"]) == {"ok"}


def test_columns_and_units_are_those_of_the_tables(study: cd.Study) -> None:
    wanted = {
        "cells": (*CELL_COLUMNS, *WINDOW_SIZE_COLUMNS, *TRACK_COLUMNS),
        "windows": WINDOW_COLUMNS,
        "edge": EDGE_COLUMNS,
        "consistency": CONSISTENCY_COLUMNS,
    }
    units = {}
    for name, columns in wanted.items():
        schema = pq.read_schema(study.path / f"{name}.parquet")
        assert schema.names == [column.name for column in columns]
        found = {field.name: field.metadata[b"unit"].decode() for field in schema}
        assert getattr(study, name).attrs["units"] == found
        units |= {f"{name}.{column}": unit for column, unit in found.items()}
    assert units["edge.velocity"] == units["edge.velocity_error"] == "µm/s"
    assert units["edge.protruded_area"] == units["windows.area"] == units["cells.area"] == "µm²"
    assert units["edge.edge_length"] == units["cells.tracking_residual"] == "µm"
    assert units["consistency.centroid_displacement"] == "µm"
    assert units["cells.registration_angle"] == "°"
    assert (units["cells.frame"], units["cells.time_s"], units["windows.n_pixels"]) == ("frame", "s", "px²")


def test_windows_hold_the_whole_intensity_of_every_frame(study: cd.Study, truth: SimulatedMovie) -> None:
    windows = study.windows
    sums = (windows["mean"] * windows["n_pixels"]).groupby([windows["frame"], windows["channel"]]).sum()
    areas = windows["area"].groupby([windows["frame"], windows["channel"]]).sum()
    for time in MAPPED:
        mask = truth.masks[time]
        for channel in CHANNELS:
            counts = truth.signal.sel(channel=channel).to_numpy()[time][mask]
            assert sums[time, channel] == pytest.approx(counts.sum(dtype=float), rel=1e-10)
            assert areas[time, channel] == pytest.approx(PIXEL_UM**2 * mask.sum(), rel=1e-10)


def test_frames_without_a_next_one_have_no_velocity_and_say_why(study: cd.Study) -> None:
    edge = study.edge
    reason = study.cells["reason"][GAP]
    for time, status in ((FRAMES - 1, "last frame"), (GAP - 1, f"the next frame has no map: {reason}")):
        rows = edge[edge["frame"] == time]
        assert set(rows["status"]) == {status}
        assert rows[[*MEASURES, "edge_length"]].isna().all(axis=None)
    others = edge[~edge["frame"].isin([GAP - 1, FRAMES - 1])]
    assert set(others["status"]) == {"ok"}
    assert others[[*MEASURES, "edge_length"]].notna().all(axis=None)
    assert (others["velocity_error"] > 0).all()


def test_velocity_is_that_of_the_movie(study: cd.Study) -> None:
    movie = study.movie(0)
    for column, frame in (("velocity", "lab"), ("velocity_cell_frame", "cell")):
        known = cd.edge_velocity(movie, SECTORS, frame=frame)
        assert known.attrs["units"] == study.edge.attrs["units"][column]
        for time in MAPPED:
            assert_allclose(table(study.edge, column, time), known[time], rtol=1e-12, atol=1e-15)


def test_edge_is_what_edge_changes_finds_in_the_maps(study: cd.Study) -> None:
    changes = cd.edge_changes(study.movie(0), SECTORS)
    for name in ("velocity_fastest", "velocity_error", "edge_length"):
        assert changes[name].attrs["units"] == study.edge.attrs["units"][name]
        for time in MAPPED:
            assert_allclose(table(study.edge, name, time), changes[name][time], rtol=1e-9)
    swept = study.cells["swept_area"].to_numpy()
    area = (changes["velocity"] * changes["edge_length"] * INTERVAL_S).sum("sector").to_numpy()
    assert np.isnan(swept[[0, GAP, GAP + 1]]).all()
    for time in range(1, GAP):  # pieces of edge go out and in: their areas, without signs, are more
        assert (
            abs(area[time - 1])
            <= swept[time]
            < 1.25 * abs(area[time - 1]) + 0.1 * study.cells["perimeter"][time]
        )


def test_area_won_less_area_lost_is_the_change_of_the_cells_area(study: cd.Study) -> None:
    area = study.cells["area"]
    for time in range(GAP - 1):
        won, lost = (table(study.edge, name, time).sum() for name in MEASURES[3:])
        assert won - lost == pytest.approx(area[time + 1] - area[time], abs=1e-9)


def test_consistency_is_that_of_the_sampled_movie(study: cd.Study, sampled: xr.Dataset) -> None:
    correlation = consecutive_correlation(sampled["mean"])
    moved = centroid_displacement(study.movie(0), sampled).mean("sector", skipna=False)
    assert moved.notnull().any()
    for time in MAPPED:
        assert_allclose(
            table(study.consistency, "correlation", time).reshape(2, LAYERS), correlation[time], rtol=1e-12
        )
        both = np.tile(moved[time], 2)
        assert_allclose(table(study.consistency, "centroid_displacement", time), both, rtol=1e-9)
    assert (study.consistency["completeness"] == 1.0).all()


def test_activity_is_that_of_the_tables(study: cd.Study, sampled: xr.Dataset) -> None:
    activity = study.activity(0)
    assert activity["frame"].to_numpy().tolist() == list(range(FRAMES))
    assert activity["channel"].to_numpy().tolist() == CHANNELS
    for time in MAPPED:
        for name in STATISTICS:
            assert_array_equal(
                activity[name][time], table(study.windows, name, time).reshape(2, LAYERS, SECTORS)
            )
        for name in ("area", "centroid_y", "centroid_x"):
            both = table(study.windows, name, time).reshape(2, LAYERS, SECTORS)
            assert_array_equal(activity[name][time], both[0])
            assert_array_equal(both[0], both[1])
        for name in (*MEASURES, "edge_length"):
            assert_array_equal(activity[name][time], table(study.edge, name, time))
    for name in STATISTICS:
        assert np.isnan(activity[name][GAP]).all()
        assert_array_equal(activity[name], sampled[name])
    assert [str(word) for word in activity["status"].to_numpy()] == study.cells["status"].tolist()
    assert [str(word) for word in activity["reason"].to_numpy()] == study.cells["reason"].tolist()


def test_velocity_nearly_is_the_simulated_one(study: cd.Study, truth: SimulatedMovie) -> None:
    """Over the whole edge both are the change of area per length of edge."""
    for time in range(GAP - 1):
        weights = table(study.edge, "edge_length", time)
        found = np.average(table(study.edge, "velocity", time), weights=weights)
        known = truth.normal_displacement_px[time].mean() * PIXEL_UM / INTERVAL_S
        assert found == pytest.approx(known, abs=0.15 * PIXEL_UM / INTERVAL_S)


def test_provenance_says_what_was_read_and_how(study: cd.Study, files: tuple[Path, Path]) -> None:
    found = study.provenance
    assert (found["status"], found["run"], found["layers"]) == ("complete", "movie", LAYERS)
    assert (found["pixel_size_um"], found["frame_interval_s"]) == (PIXEL_UM, INTERVAL_S)
    assert found["velocity_unit"] == "µm/s"
    assert found["inputs"]["masks"]["read as"].startswith("masks of one cell, 8 frames of ")
    assert found["inputs"]["signal"]["read as"].startswith("channels material, edge; 8 frames")
    assert [warning.split(":")[0] for warning in found["warnings"]] == ["cell 0, frame 6"]


def test_without_a_scale_units_are_pixels_and_frames(
    files: tuple[Path, Path], study: cd.Study, tmp_path: Path
) -> None:
    plain = movie_study(open_movie(files[0], None, SMALL), tmp_path / "out")
    assert plain.cells["time_s"].isna().all()
    assert plain.edge.attrs["units"]["velocity"] == "px/frame"
    assert plain.cells.attrs["units"]["area"] == "px²"
    scale = PIXEL_UM / INTERVAL_S
    assert_allclose(study.edge["velocity"], scale * plain.edge["velocity"], rtol=1e-12)
    assert set(plain.windows["status"]) == {"no signal"}
    assert plain.windows["mean"].isna().all()
    assert plain.consistency["correlation"].isna().all()
    assert plain.consistency["centroid_displacement"].notna().sum() == 5 * LAYERS
    assert "mean" not in plain.activity(0)


def test_a_given_scale_overrules_that_of_the_files(files: tuple[Path, Path]) -> None:
    given = SMALL.model_copy(update={"pixel_size_um": 0.5, "frame_interval_s": 60.0})
    scale = open_movie(*files, given).scale
    assert (scale.pixel_size_um, scale.frame_interval_s) == (0.5, 60.0)


def test_layers_by_depth_are_as_deep_in_every_frame(files: tuple[Path, Path], tmp_path: Path) -> None:
    """About 20 px of radius at 0.16 µm: no place is 9 µm deep."""
    inputs = open_movie(*files, SMALL.model_copy(update={"depth_um": (0.4, 1.0, 9.0, 11.0)}))
    assert inputs.understood["windows"].startswith("layers 0–0.4, 0.4–1, 1–9, 9–11 µm deep and the rest")
    study = movie_study(inputs, tmp_path / "out")
    windows = study.windows
    for (_, layer), depth in windows.groupby(["frame", "layer"])["depth"]:
        if layer < 2:
            assert ((0, 0.4)[layer] < depth).all()
            assert depth.median() == pytest.approx((0.2, 0.7)[layer], abs=0.08)
    beyond = windows[windows["layer"] >= 3]
    assert set(beyond["status"]) == {"deeper than the cell"}
    assert (beyond["area"] == 0).all()
    assert beyond[["mean", "depth", "centroid_y"]].isna().all(axis=None)
    assert set(windows.loc[windows["layer"] < 3, "status"]) == {"ok"}
    by_frame = windows[windows["channel"] == windows["channel"].iloc[0]].groupby("frame")["area"].sum()
    assert by_frame.to_numpy() == pytest.approx(study.cells["area"].dropna().to_numpy(), rel=1e-9)
    assert (study.cells["empty_windows"].dropna() == 0).all()
    consistency = study.consistency
    assert (consistency.loc[consistency["layer"] < 3, "completeness"] == 1).all()
    assert consistency.loc[consistency["layer"] >= 3, "completeness"].isna().all()
    again = polar_grid_of(study.provenance).on(study.movie(0)[2])
    first = windows[(windows["frame"] == 2) & (windows["channel"] == windows["channel"].iloc[0])]
    assert again.scale.area(again.areas).ravel() == pytest.approx(first["area"].to_numpy(), rel=1e-12)


@pytest.mark.slow
def test_results_do_not_depend_on_workers(files: tuple[Path, Path], study: cd.Study, tmp_path: Path) -> None:
    assert_same_movie(study, movie_study(open_movie(*files, SMALL), tmp_path / "two", workers=2))


def test_workers_must_be_positive(files: tuple[Path, Path], tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"workers.*0"):
        movie_study(open_movie(*files, SMALL), tmp_path / "out", workers=0)
    with pytest.raises(ParameterError, match="resume and overwrite exclude each other"):
        movie_study(open_movie(*files, SMALL), tmp_path / "out", resume=True, overwrite=True)
    assert not (tmp_path / "out").exists()

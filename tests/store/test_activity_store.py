import pickle
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from cytodisk.errors import ReadError, StudyError
from cytodisk.scale import Scale
from cytodisk.store.activity_store import ActivityStore, open_activity
from cytodisk.windows.polar_windows import polar_windows

GRID = polar_windows(2, 3)
STATISTICS = ("mean", "sd", "min", "max", "n_pixels", "n_nan")
GEOMETRY = ("area", "centroid_y", "centroid_x", "depth", "depth_p5", "depth_p95")
MOTION = (
    "velocity",
    "velocity_cell_frame",
    "velocity_fastest",
    "velocity_error",
    "protruded_area",
    "retracted_area",
    "edge_length",
)
PER_CHUNK = 64
SCALE = Scale(0.16, 5.0)


def frame_arrays(time: int, channels: int = 2) -> dict[str, Any]:
    random = np.random.default_rng(time)
    arrays = {name: random.normal(size=(2, 3)) for name in GEOMETRY}
    arrays |= {name: random.normal(size=3) for name in MOTION}
    if channels:
        arrays |= {name: random.normal(size=(channels, 2, 3)) for name in STATISTICS}
    return arrays


def write(
    target: Path,
    times: range,
    *,
    cell: int = 0,
    gaps: tuple[int, ...] = (),
    channels: tuple[str, ...] = ("Rac1", "RhoA"),
    scale: Scale = SCALE,
) -> None:
    with ActivityStore.replacing(target) as store:
        group = store.cell(cell, 7, GRID, channels, scale)
        for time in times:
            if time in gaps:
                group.append(time, None, "refused", f"frame {time} is empty")
            else:
                group.append(time, frame_arrays(time, len(channels)), "ok", "")
        group.close()


@pytest.mark.parametrize("frames", [1, PER_CHUNK - 1, PER_CHUNK, PER_CHUNK + 1, 2 * PER_CHUNK + 20])
def test_every_frame_reads_back_as_it_was_written(tmp_path: Path, frames: int) -> None:
    times = range(3, 3 + frames)
    write(tmp_path / "a.zarr.zip", times)
    found = open_activity(tmp_path / "a.zarr.zip", 0)
    assert_array_equal(found["frame"], times)
    assert found["frame"].attrs["units"] == "frame"
    assert_array_equal(found["time_s"], 5.0 * np.array(times))
    assert found["channel"].to_numpy().tolist() == ["Rac1", "RhoA"]
    assert (found["layer"].size, found["sector"].size) == (2, 3)
    written = [frame_arrays(time) for time in times]
    for name in STATISTICS + GEOMETRY + MOTION:
        assert_array_equal(found[name], np.stack([frame[name] for frame in written]), err_msg=name)
    assert set(found["status"].to_numpy()) == {"ok"}


def test_dimensions_are_named(tmp_path: Path) -> None:
    write(tmp_path / "a.zarr.zip", range(2))
    found = open_activity(tmp_path / "a.zarr.zip", 0)
    assert {found[name].dims for name in STATISTICS} == {("time", "channel", "layer", "sector")}
    assert {found[name].dims for name in GEOMETRY} == {("time", "layer", "sector")}
    assert {found[name].dims for name in MOTION} == {("time", "sector")}
    assert found.attrs == {"cell": 0, "label": 7, "pixel_size_um": 0.16, "frame_interval_s": 5.0}


def test_a_gap_is_nan_with_status_and_reason(tmp_path: Path) -> None:
    gaps = (0, 5, PER_CHUNK, PER_CHUNK + 3)
    frames = PER_CHUNK + 4
    write(tmp_path / "a.zarr.zip", range(frames), gaps=gaps)
    found = open_activity(tmp_path / "a.zarr.zip", 0)
    lost = np.isin(np.arange(frames), gaps)
    for name in STATISTICS + GEOMETRY + MOTION:
        missing = np.isnan(found[name].to_numpy()).reshape(frames, -1)
        assert_array_equal(missing.all(axis=1), lost, err_msg=name)
        assert_array_equal(missing.any(axis=1), lost, err_msg=name)
    assert_array_equal(found["status"] == "refused", lost)
    reasons = found["reason"].to_numpy()
    assert [str(reasons[time]) for time in gaps] == [f"frame {time} is empty" for time in gaps]
    assert {str(reason) for reason in reasons[~lost]} == {""}


def test_a_reason_of_a_later_chunk_is_not_cut(tmp_path: Path) -> None:
    with ActivityStore.replacing(tmp_path / "a.zarr.zip") as store:
        group = store.cell(0, 1, GRID, ("a",), Scale())
        for time in range(PER_CHUNK):
            group.append(time, frame_arrays(time, 1), "ok", "")
        group.append(PER_CHUNK, None, "unreadable", "µ" * 300)
        group.close()
    found = open_activity(tmp_path / "a.zarr.zip", 0)
    assert str(found["reason"].to_numpy()[-1]) == "µ" * 300
    assert str(found["status"].to_numpy()[-1]) == "unreadable"


def test_without_channels_there_are_geometry_and_motion_alone(tmp_path: Path) -> None:
    write(tmp_path / "a.zarr.zip", range(3), channels=())
    found = open_activity(tmp_path / "a.zarr.zip", 0)
    assert "channel" not in found.dims
    assert {*found.data_vars, "centroid_y", "centroid_x"} == {*GEOMETRY, *MOTION, "status", "reason"}
    assert_array_equal(found["velocity"][2], frame_arrays(2, 0)["velocity"])


@pytest.mark.parametrize(
    ("scale", "length", "second"),
    [
        (Scale(), "px", "frame"),
        (Scale(0.5), "µm", "frame"),
        (Scale(None, 2.0), "px", "s"),
        (Scale(0.5, 2.0), "µm", "s"),
    ],
)
def test_units_follow_what_is_known(tmp_path: Path, scale: Scale, length: str, second: str) -> None:
    write(tmp_path / "a.zarr.zip", range(1), scale=scale)
    found = open_activity(tmp_path / "a.zarr.zip", 0)
    units = {str(name): values.attrs.get("units") for name, values in found.reset_coords().data_vars.items()}
    for name in ("velocity", "velocity_cell_frame", "velocity_error"):
        assert units[name] == f"{length}/{second}"
    for name in ("area", "protruded_area", "retracted_area"):
        assert units[name] == f"{length}²"
    assert units["edge_length"] == length
    assert (units["mean"], units["n_pixels"], units["centroid_y"]) == ("a.u.", "px²", "px")
    assert ("time_s" in found.coords) == (scale.frame_interval_s is not None)


def test_cells_are_groups_of_their_own(tmp_path: Path) -> None:
    with ActivityStore.replacing(tmp_path / "a.zarr.zip") as store:
        for cell, times in ((0, range(2)), (12, range(5, 8))):
            group = store.cell(cell, cell + 1, GRID, ("a",), Scale())
            for time in times:
                group.append(time, frame_arrays(10 * cell + time, 1), "ok", "")
            group.close()
    first, second = (open_activity(tmp_path / "a.zarr.zip", cell) for cell in (0, 12))
    assert (first["frame"].to_numpy().tolist(), second["frame"].to_numpy().tolist()) == ([0, 1], [5, 6, 7])
    assert_array_equal(second["mean"][1], frame_arrays(126, 1)["mean"])
    with pytest.raises(ReadError, match=r"a\.zarr\.zip has no activity of cell_00001"):
        open_activity(tmp_path / "a.zarr.zip", 1)


def test_a_store_is_one_file_with_the_same_bytes_each_time(tmp_path: Path) -> None:
    for name in ("a.zarr.zip", "b.zarr.zip"):
        write(tmp_path / name, range(PER_CHUNK + 3), gaps=(1,))
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.zarr.zip", "b.zarr.zip"]
    assert (tmp_path / "a.zarr.zip").read_bytes() == (tmp_path / "b.zarr.zip").read_bytes()


def test_a_store_of_an_earlier_version_is_a_folder(tmp_path: Path) -> None:
    write(tmp_path / "a.zarr.zip", range(3))
    found = open_activity(tmp_path / "a.zarr.zip", 0).load()
    with zipfile.ZipFile(tmp_path / "a.zarr.zip") as packed:
        packed.extractall(tmp_path / "a.zarr")
    (tmp_path / "a.zarr.zip").unlink()
    assert open_activity(tmp_path / "a.zarr.zip", 0).identical(found)


def test_an_open_store_goes_to_other_processes(tmp_path: Path) -> None:
    write(tmp_path / "a.zarr.zip", range(3))
    found = open_activity(tmp_path / "a.zarr.zip", 0)
    assert pickle.loads(pickle.dumps(found)).identical(found)


def test_a_store_that_is_cut_off_is_damaged(tmp_path: Path) -> None:
    target = tmp_path / "a.zarr.zip"
    write(target, range(3))
    target.write_bytes(target.read_bytes()[:-100])
    with pytest.raises(ReadError, match=r"a\.zarr\.zip is not the activity that cytodisk movie wrote .*zip"):
        open_activity(target, 0)


class Killed(Exception):
    """What stands for a kill."""


def start_and_die(target: Path) -> None:
    with ActivityStore.replacing(target) as store:
        group = store.cell(0, 7, GRID, ("a",), Scale())
        for time in range(PER_CHUNK + 1):
            group.append(time, frame_arrays(time, 1), "ok", "")
        raise Killed


@pytest.mark.parametrize("before", [False, True])
def test_a_store_that_is_not_finished_does_not_take_the_place_of_another(
    tmp_path: Path, before: bool
) -> None:
    target = tmp_path / "a.zarr.zip"
    if before:
        write(target, range(4))
    with pytest.raises(Killed):
        start_and_die(target)
    assert target.exists() == before
    if before:
        assert_array_equal(open_activity(target, 0)["mean"][3], frame_arrays(3)["mean"])
    write(target, range(2))
    assert open_activity(target, 0)["frame"].size == 2


def test_a_store_in_no_folder_is_an_error_of_the_study(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match=r"cannot write .*a\.zarr\.zip"):
        write(tmp_path / "nowhere" / "a.zarr.zip", range(1))


def test_no_store_is_an_error_that_names_it(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"a\.zarr\.zip has no activity of cell 0"):
        open_activity(tmp_path / "a.zarr.zip", 0)

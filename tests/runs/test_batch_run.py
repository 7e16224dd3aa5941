"""A batch on this machine: what is killed, hangs or finds no room costs no other input anything."""

import errno
import os
import signal
import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from threading import Timer
from unittest.mock import Mock

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import MaskError, OtherRunError, ParameterError, ReadError, StudyError
from cytodisk.files import temporary_name
from cytodisk.runs.batch import compute_input
from cytodisk.runs.batch.batch_file import Batch, read_batch
from cytodisk.runs.batch.batch_study import BatchSummary, batch_study, pending_inputs
from cytodisk.runs.batch.batch_task import expected_seconds, make_tasks
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.worker_process import WorkerProcess
from cytodisk.store.study_room import alone_in
from cytodisk.store.tables import read_table
from cytodisk.store.targets import FolderStore
from deadlines import wait_until

resource = pytest.importorskip("resource", reason="limits, signals and named pipes are POSIX")
TABLES = ("cells", "windows", "edge", "consistency", "inputs")
STUDY = """
[study]
columns = ["dose"]

[parameters]
layers = 2
sectors = 6

[[inputs]]
masks = "movie_*.tif"
condition = "moving"
experiment = 1
dose = 0.5

[[inputs]]
masks = "labels.tif"
kind = "map"
pixel_size_um = 0.5
experiment = "third"

[[inputs]]
masks = "empty.tif"
"""


def write(path: Path, values: np.ndarray, axes: str) -> None:
    tifffile.imwrite(path, values.astype(np.uint8), metadata={"axes": axes}, photometric="minisblack")


def batch_of(folder: Path, text: str = STUDY) -> Batch:
    (folder / "study.toml").write_text(text, encoding="utf-8")
    return read_batch(folder / "study.toml")


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three movies of a cell that moves, an image with two cells, and a movie without a cell."""
    folder = tmp_path_factory.mktemp("batch")
    for seed in range(3):
        cell = np.pad(cd.simulate.random_smooth(seed, radius=12), 4)
        write(folder / f"movie_{seed}.tif", np.stack([np.roll(cell, step, 1) for step in range(4)]), "TYX")
    hollow = cell.copy()
    hollow[27:33, 29:35] = 0
    write(folder / "labels.tif", np.hstack([cell, 2 * hollow]), "YX")
    write(folder / "empty.tif", np.zeros((3, 40, 40)), "TYX")
    batch_of(folder)
    return folder


@pytest.fixture(scope="module")
def quiet(files: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Results of a run by one worker that nothing disturbs."""
    out = tmp_path_factory.mktemp("quiet")
    batch_study(read_batch(files / "study.toml"), out)
    return out


def children() -> list[int]:
    """Processes for inputs, on this machine, that belong to this one or to a run that it started."""
    lines = subprocess.run(["ps", "-eo", "pid,ppid,args"], capture_output=True, text=True, check=True).stdout
    rows = [line.split(None, 2) for line in lines.splitlines()[1:]]
    parents = {os.getpid(), *(int(pid) for pid, parent, _ in rows if int(parent) == os.getpid())}
    return [int(pid) for pid, parent, what in rows if int(parent) in parents and "worker_process" in what]


def rows_done(out: Path) -> int:
    return len(list(out.glob("rows/[!.]*.json")))


def test_inputs_are_merged_with_their_columns_in_front(quiet: Path) -> None:
    inputs, cells, edge = (pd.read_parquet(quiet / f"{name}.parquet") for name in ("inputs", "cells", "edge"))
    names = ["movie_0", "movie_1", "movie_2", "labels", "empty"]
    assert inputs["input"].tolist() == names
    assert inputs["status"].tolist() == ["ok"] * 4 + ["refused"]
    assert "nothing could be mapped" in inputs["reason"].iloc[-1]
    assert inputs["mapped"].tolist() == [4, 4, 4, 2, 0]
    assert inputs["qc_flags"].tolist() == [0, 0, 0, 1, 3]
    assert inputs["length_unit"].tolist() == ["px", "px", "px", "µm", "px"]
    assert inputs["velocity_unit"].tolist() == ["px/frame"] * 3 + ["", "px/frame"]
    assert read_table(quiet / "edge.parquet").attrs["units"]["velocity"] == "px/frame"
    assert read_table(quiet / "cells.parquet").attrs["units"]["area"] == "px² or µm²"
    assert read_table(quiet / "edge.parquet").attrs["units"]["protruded_area"] == "px²"
    assert cells.columns[:5].tolist() == ["input", "condition", "experiment", "dose", "length_unit"]
    assert edge.columns[4:6].tolist() == ["length_unit", "velocity_unit"]
    assert edge["velocity_unit"].unique().tolist() == ["px/frame"]
    assert (
        cells.groupby("input", sort=False)["length_unit"]
        .unique()
        .explode()
        .eq(inputs.set_index("input")["length_unit"])
        .all()
    )
    assert cells["input"].tolist() == np.repeat(names, [4, 4, 4, 2, 3]).tolist()
    assert cells["experiment"].fillna("").unique().tolist() == ["1", "third", ""]
    assert "seconds" not in cells
    whole = cd.open_study(quiet / "inputs" / "movie_1")
    rows = edge[edge["input"] == "movie_1"].reset_index(drop=True)
    pd.testing.assert_frame_equal(rows[whole.edge.columns], whole.edge, check_exact=True, check_dtype=False)
    assert rows["dose"].eq(0.5).all()
    assert not list(quiet.glob("inputs/*/figures"))
    assert pd.read_csv(quiet / "inputs.csv")["input"].tolist() == names


@pytest.mark.slow
def test_killed_and_resumed_by_two_workers_it_is_the_same_to_the_last_bit(
    files: Path, quiet: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    command = [sys.executable, "-m", "cytodisk", "batch", str(files / "study.toml"), "-o", str(out)]
    run = subprocess.Popen([*command, "--workers", "2", "-q"])
    try:
        wait_until(lambda: any(out.glob("inputs/*/.parts/*.json")), "a frame was done")
        for child in children():
            os.kill(child, signal.SIGKILL)
        wait_until(lambda: rows_done(out) > 0, "an input was done")
    finally:
        run.kill()
        run.wait(timeout=60)
    wait_until(lambda: not children(), "the processes of the run were gone")
    assert 1 <= rows_done(out) < 5
    assert not (out / "cells.parquet").exists()
    (out / "rows" / temporary_name(".json")).touch()  # as a kill in the middle of writing leaves it
    summary = batch_study(read_batch(files / "study.toml"), out, workers=2, resume=True)
    assert not list(out.glob("rows/.*"))
    assert summary.statuses == {"ok": 4, "refused": 1}
    units, qc_flags = summary.remarks
    assert units.startswith("inputs have different units")
    assert qc_flags.startswith("2 inputs have cells with QC flags")
    for name in TABLES:
        assert (out / f"{name}.parquet").read_bytes() == (quiet / f"{name}.parquet").read_bytes(), name


@pytest.mark.slow
def test_an_input_that_hangs_or_crashes_has_a_row(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("crashes.tif", "hangs.tif"):
        write(tmp_path / name, np.ones((2, 4, 4)), "TYX")
    answer, tries = WorkerProcess.answer, []

    def crash(process: WorkerProcess, task: bytes, time_limit: float | None) -> object:
        os.kill(process.pid, signal.SIGSTOP)  # it hangs
        if b"crashes" in task:
            tries.append(task)
            os.kill(process.pid, signal.SIGSEGV)
            Timer(0.1, os.kill, (process.pid, signal.SIGCONT)).start()
        return answer(process, task, time_limit)

    monkeypatch.setattr(WorkerProcess, "answer", crash)
    out = tmp_path / "out"
    summary = batch_study(batch_of(tmp_path, "[[inputs]]\nmasks = '*.tif'\n"), out, time_limit=4)
    assert summary.statuses == {"crashed": 1, "timed out": 1}
    assert len(tries) == 2
    crashed, hung = summary.failed
    assert crashed.reason == "its process died of SIGSEGV"
    assert "Segmentation fault" in crashed.log
    assert hung.reason == "took longer than the time limit of 4 s"
    assert not children()
    assert pd.read_parquet(out / "cells.parquet").empty
    with pytest.raises(ReadError, match="holds a run of cytodisk batch"):
        cd.open_study(out)


@pytest.mark.usefixtures("quiet")  # after which no compiled code is left to be written
@pytest.mark.slow
def test_a_full_disk_stops_the_run_and_marks_no_input_as_failed(files: Path, tmp_path: Path) -> None:
    """The system's limit on the size of a file stands for the end of the disk."""
    out = tmp_path / "out"
    command = [sys.executable, "-m", "cytodisk", "batch", str(files / "study.toml"), "-o", str(out)]
    limit = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (12_000, 12_000))  # less than a map
    run = subprocess.run(command, preexec_fn=limit, capture_output=True, text=True, check=False, timeout=200)
    assert run.returncode == 2
    assert "cannot write" in run.stderr
    assert "what was done is kept" in run.stderr
    assert "--resume" in run.stderr
    assert "Traceback" not in run.stderr
    assert rows_done(out) == 0


def test_a_folder_with_other_results_is_not_touched(files: Path, quiet: Path) -> None:
    batch = read_batch(files / "study.toml")
    before = content(quiet)
    with pytest.raises(StudyError, match=r"--resume.*--overwrite"):
        batch_study(batch, quiet)
    changed = replace(batch.inputs[0], parameters=MovieParameters(layers=3, sectors=6))
    with pytest.raises(OtherRunError, match=r"for movie_0: .*remove .*rows/movie_0\.json"):
        batch_study(replace(batch, inputs=(changed, *batch.inputs[1:])), quiet, resume=True)
    with pytest.raises(OtherRunError, match="study of cytodisk movie"):
        batch_study(batch, quiet / "inputs" / "movie_0", overwrite=True)
    with pytest.raises(StudyError, match="is not empty and holds no study"):
        batch_study(batch, files)
    with pytest.raises(StudyError, match="another run is writing there"), alone_in(quiet):
        batch_study(batch, quiet, resume=True)
    with pytest.raises(ParameterError, match=r"time_limit.*above 0.*inf"):
        batch_study(batch, quiet, overwrite=True, time_limit=np.inf)
    with pytest.raises(ParameterError, match="must be an address"):
        batch_study(batch, quiet, overwrite=True, scheduler="nonsense")
    with pytest.raises(ParameterError, match="must be an address"):
        batch_study(batch, quiet / "new", scheduler="nonsense")
    inside = replace(batch.inputs[0], masks=quiet / "inputs" / "movie_0" / "windows.parquet")
    with pytest.raises(StudyError, match="is among the results"):
        batch_study(replace(batch, inputs=(inside,)), quiet, overwrite=True)
    assert content(quiet) == before
    assert not (quiet / "new").exists()


@pytest.mark.slow
def test_a_batch_goes_to_a_url_without_a_cluster_too(files: Path, tmp_path: Path) -> None:
    batch = read_batch(files / "study.toml")
    assert batch_study(replace(batch, inputs=batch.inputs[:1]), f"file://{tmp_path}/out").statuses == {
        "ok": 1
    }
    assert len(pd.read_parquet(tmp_path / "out" / "cells.parquet")) == 4
    assert (tmp_path / "out" / "inputs" / "movie_0" / "cells.parquet").is_file()


def test_resumed_it_does_what_failed_is_new_or_has_changed(files: Path, quiet: Path) -> None:
    batch, store = read_batch(files / "study.toml"), FolderStore(quiet)
    first, *others, last = batch.inputs
    moved = replace(first, columns=("another condition", 1, 2.0))
    new = replace(first, name="new", masks=files / "labels.tif")
    changed = replace(others[0], masks=files / "labels.tif")
    summary = BatchSummary("out")
    now = replace(batch, inputs=(moved, changed, *others[2:], last, new))
    assert pending_inputs(store, now, summary) == [changed, last, new]
    assert summary.remarks == [
        "files changed since they were done, so they are looked at again: movie_1",
        "not in the batch file any more, so not in the tables, though their results stay: movie_2",
    ]


def content(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    ("fault", "status", "reason"),
    [
        (ZeroDivisionError("a fault of ours\nat length"), "failed", "ZeroDivisionError: a fault of ours"),
        (MaskError("mask is empty"), "refused", "mask is empty"),
        (
            OSError(errno.ENOSPC, "No space left on device"),
            "cannot write",
            "[Errno 28] No space left on device",
        ),
    ],
)
def test_what_a_process_answers(
    fault: Exception, status: str, reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compute_input, "_compute", Mock(side_effect=fault))
    answer = compute_input.compute_input(Mock(), Path())
    assert (answer["status"], answer["reason"]) == (status, reason)
    assert ("Traceback" in answer.get("log", "")) == (status == "failed")


def test_small_inputs_share_a_task(files: Path) -> None:
    inputs = read_batch(files / "study.toml").inputs
    alone = list(make_tasks(inputs, "out", seconds=0, time_limit=None))
    assert [task.inputs for task in alone] == [(item,) for item in inputs]
    together = list(make_tasks(inputs * 30, "out", seconds=1.0, time_limit=None))
    assert [item for task in together for item in task.inputs] == list(inputs * 30)
    expected = [sum(map(expected_seconds, task.inputs)) for task in together]
    assert all(1.0 <= seconds < 2.0 for seconds in expected[:-1])


def test_the_process_that_hands_out_inputs_loads_nothing_that_maps() -> None:
    """It would take 100 MB beside the workers."""
    code = "import sys, cytodisk.runs.batch.run_batch; print({'numba', 'skimage', 'zarr'} & set(sys.modules))"
    assert subprocess.check_output([sys.executable, "-c", code], text=True).strip() == "set()"

"""A batch on a Dask cluster whose scheduler and workers are processes of their own."""

import sys
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import StudyError
from cytodisk.runs.batch.batch_file import read_batch
from cytodisk.runs.batch.batch_study import batch_study

pytestmark = pytest.mark.slow
BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
IMAGES = 6
TABLES = ("cells.parquet", "windows.parquet", "edge.parquet", "consistency.parquet", "inputs.parquet")
STUDY = """
[parameters]
layers = 3
sectors = 8

[[inputs]]
masks = "image_*"
kind = "map"

[[inputs]]
masks = "movie.tif"
kind = "movie"
condition = "moving"
"""


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Any]:
    sys.path.insert(0, str(BENCHMARKS))
    try:
        from dask_processes import DaskProcesses
    finally:
        sys.path.remove(str(BENCHMARKS))
    folder = tmp_path / "processes"
    folder.mkdir()
    with DaskProcesses(folder) as processes:
        yield processes


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A batch file: folders with an image each, which are a task each, and a movie."""
    folder = tmp_path_factory.mktemp("batch")
    for seed in range(IMAGES):
        (folder / f"image_{seed}").mkdir()
        write(folder / f"image_{seed}" / "masks.tif", cd.simulate.random_smooth(seed, radius=14), "YX")
    cell = np.pad(cd.simulate.random_smooth(0, radius=14), 4)
    write(folder / "movie.tif", np.stack([np.roll(cell, step, axis=1) for step in range(3)]), "TYX")
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    return folder / "study.toml"


@pytest.fixture(scope="module")
def quiet(study: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The merged tables of a run by one process that nothing disturbs."""
    out = tmp_path_factory.mktemp("quiet")
    batch_study(read_batch(study), out)
    return merged(out)


def write(path: Path, mask: np.ndarray, axes: str) -> None:
    tifffile.imwrite(path, mask.astype(np.uint8), metadata={"axes": axes}, photometric="minisblack")


def merged(out: Path) -> dict[str, bytes]:
    return {name: (out / name).read_bytes() for name in TABLES}


def after(inputs: int, act: Callable[[], Any]) -> Callable[[int, int], None]:
    """A progress callback that does something once, when so many inputs are done."""
    left = [act]

    def see(done: int, total: int) -> None:
        if done >= inputs and left:
            left.pop()()

    return see


def test_a_worker_that_is_killed_changes_nothing_in_the_tables(
    study: Path, quiet: dict[str, bytes], cluster: Any, tmp_path: Path
) -> None:
    cluster.scheduler()
    workers = [cluster.worker(), cluster.worker()]
    cluster.wait_for_workers()
    summary = batch_study(
        read_batch(study),
        f"file://{tmp_path}/out",
        scheduler=cluster.address,
        progress=after(2, workers[0].kill),
        tell=lambda words: None,
    )
    assert workers[0].wait(timeout=60) == -9
    assert summary.statuses == {"ok": IMAGES + 1}
    assert merged(tmp_path / "out") == quiet


def test_a_run_whose_scheduler_was_lost_is_resumed_to_the_same_tables(
    study: Path, quiet: dict[str, bytes], cluster: Any, tmp_path: Path
) -> None:
    scheduler, worker = cluster.scheduler(), cluster.worker()
    run = {"out": tmp_path / "out", "scheduler": cluster.address, "tell": lambda words: None}
    with pytest.raises(StudyError, match=r"scheduler tcp://.* was lost.*--resume"):
        batch_study(read_batch(study), **run, progress=after(2, scheduler.kill))
    scheduler.wait(timeout=60)
    worker.kill()  # it would end the input that it has
    worker.wait(timeout=60)
    done = len(list((tmp_path / "out" / "rows").glob("[!.]*.json")))
    assert 2 <= done <= IMAGES
    cluster.scheduler(), cluster.worker()
    seen = []
    batch_study(read_batch(study), **run, resume=True, progress=lambda done, _: seen.append(done))
    assert seen[0] == done
    assert merged(tmp_path / "out") == quiet


def test_a_worker_of_another_version_is_refused(study: Path, cluster: Any, tmp_path: Path) -> None:
    there = tmp_path / "there" / "cytodisk-0.0.1.dist-info"
    there.mkdir(parents=True)
    (there / "METADATA").write_text("Metadata-Version: 2.1\nName: cytodisk\nVersion: 0.0.1\n")
    cluster.scheduler(), cluster.worker(environment={"PYTHONPATH": str(there.parent)})
    words = rf"worker tcp://127.0.0.1:\d+ has cytodisk 0.0.1, and here is {version('cytodisk')}: install"
    with pytest.raises(StudyError, match=words):
        batch_study(read_batch(study), tmp_path / "out", scheduler=cluster.address, tell=lambda words: None)
    assert not (tmp_path / "out" / "rows").exists()

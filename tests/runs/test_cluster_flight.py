"""How many tasks are on their way to a cluster, which workers get them, and what comes of those that fail."""

import asyncio
import os
import socket
from collections.abc import Iterator, Sequence
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from threading import Thread
from types import SimpleNamespace
from typing import Any

import pytest
from distributed import KilledWorker

from cytodisk.errors import ParameterError, StudyError
from cytodisk.runs.batch import cluster, cluster_workers
from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.batch.batch_target import begin_run, open_store, what_is_hidden
from cytodisk.runs.batch.batch_task import BatchTask
from cytodisk.runs.batch.cluster import PER_THREAD, Flight
from cytodisk.runs.batch.cluster_tasks import as_seen_by_all, give_up, single_inputs
from cytodisk.runs.batch.cluster_workers import Workers
from cytodisk.runs.batch.input_row import read_row
from cytodisk.runs.map.map_parameters import MapParameters

THREADS = 2
HANGS = "hangs"


class DoneFuture:
    """A task that is done as soon as it is sent."""

    def __init__(self, client: "FakeClient", key: str, outcome: Any):
        self.key, self._client, self._outcome = key, client, outcome
        self.status = "error" if isinstance(outcome, Exception) else "finished"

    def add_done_callback(self, call: Any) -> None:
        call(self)

    def result(self, timeout: float) -> Any:
        self._client.flying -= 1
        return self._outcome

    def exception(self, timeout: float) -> Any:
        self._client.flying -= 1
        return self._outcome


class FakeClient:
    """Runs tasks where it is, and answers for workers."""

    def __init__(self, answers: dict[str, Any] | None = None):
        self.workers = {"tcp://a:1": THREADS}
        self.answers = answers or {}
        self.flying = self.most = 0

    def nthreads(self) -> dict[str, int]:
        return dict(self.workers)

    def sync(self, work: Any, *about: Any) -> Any:
        return asyncio.run(work(*about))

    async def run(self, question: Any, *about: str, workers: Sequence[str], on_error: str) -> dict[str, Any]:
        if any(self.answers.get(worker) == HANGS for worker in workers):
            await asyncio.sleep(60)
        return {worker: self.answers.get(worker) or question(*about) for worker in workers}

    def map(self, work: Any, tasks: Sequence[Any], *, key: Sequence[str], pure: bool) -> list[DoneFuture]:
        self.flying += len(tasks)
        self.most = max(self.most, self.flying)
        return [DoneFuture(self, name, work(task)) for name, task in zip(key, tasks, strict=True)]


def watched(client: FakeClient, tmp_path: Path, told: list[str] | None = None, wait_s: float = 0) -> Workers:
    shared = (str(tmp_path), begin_run(str(tmp_path)))
    return Workers(client, "tcp://scheduler:8786", ([] if told is None else told).append, wait_s, shared)


def batch_task(target: Path, *names: str) -> BatchTask:
    inputs = [BatchInput(name, "map", target / f"{name}.tif", None, MapParameters()) for name in names]
    return BatchTask(version("cytodisk"), tuple(inputs), str(target))


def test_few_tasks_are_on_their_way_however_many_there_are(tmp_path: Path) -> None:
    client, drawn = FakeClient(), []

    def tasks() -> Iterator[int]:
        for number in range(100):
            drawn.append(number)
            assert len(drawn) - len(got) <= PER_THREAD * THREADS
            yield number

    got: list[int] = []
    flight = Flight(client, watched(client, tmp_path), lambda number: -number, list, max)
    for result in flight.results(tasks()):
        got += [-result]
    assert sorted(got) == list(range(100))
    assert client.most == PER_THREAD * THREADS


def test_inputs_of_a_task_that_workers_died_of_are_tried_one_by_one(tmp_path: Path) -> None:
    client = FakeClient()
    deadly = KilledWorker("task", SimpleNamespace(address="tcp://a:1"), 3)

    def work(task: BatchTask) -> Any:
        names = [item.name for item in task.inputs]
        return deadly if "bad" in names else names

    flight = Flight(client, watched(client, tmp_path), work, single_inputs, give_up)
    results = list(flight.results([batch_task(tmp_path, "first", "bad", "last")]))
    assert [result for result in results if isinstance(result, list)] == [["first"], ["last"]]
    assert len(results) == 3
    row = read_row(open_store(str(tmp_path)), "bad")
    assert row is not None
    assert row.status == "killed"
    assert row.reason == "its workers died (4, the last one tcp://a:1)"


def test_an_error_of_a_workers_system_is_no_loss_of_the_scheduler(tmp_path: Path) -> None:
    client, broken = FakeClient(), OSError("no such device")
    flight = Flight(client, watched(client, tmp_path), lambda number: broken, list, max)
    with pytest.raises(StudyError, match="a worker failed: no such device"):
        list(flight.results([1]))


def test_a_worker_that_joins_later_is_looked_at_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster_workers, "LOOK_EVERY_S", 0.0)
    client = FakeClient({"tcp://b:1": "0.0.1", "tcp://c:1": PackageNotFoundError("cytodisk")})
    workers = watched(client, tmp_path)
    assert workers.threads() == THREADS
    client.workers["tcp://b:1"] = 1
    with pytest.raises(StudyError, match=r"tcp://b:1.*cytodisk 0\.0\.1"):
        workers.threads()
    client.workers = {"tcp://c:1": 1}
    with pytest.raises(StudyError, match="worker tcp://c:1 has no cytodisk: install"):
        workers.threads()


@pytest.mark.parametrize("answer", [OSError("gone"), HANGS])
def test_a_worker_that_does_not_answer_is_not_counted_until_it_does(
    answer: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster_workers, "LOOK_EVERY_S", 0.0)
    monkeypatch.setattr(cluster_workers, "ANSWER_S", 0.2)
    client = FakeClient({"tcp://b:1": answer})
    client.workers["tcp://b:1"] = 5
    workers = watched(client, tmp_path)
    assert workers.threads() == THREADS
    client.answers.clear()
    assert workers.threads() == THREADS + 5


def test_without_workers_it_is_said_what_to_start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster_workers, "LOOK_EVERY_S", 0.01)
    client, told = FakeClient(), []
    client.workers = {}
    with pytest.raises(StudyError, match=r"no worker.*`dask worker tcp://sched"):
        watched(client, tmp_path, told, wait_s=0.05).threads()
    assert told == ["waiting for a worker: `dask worker tcp://scheduler:8786` starts one"]


def test_a_worker_must_see_results_and_inputs(tmp_path: Path) -> None:
    first = begin_run(str(tmp_path))
    assert what_is_hidden(str(tmp_path), first, str(tmp_path)) == ""
    assert "does not see input" in what_is_hidden(str(tmp_path), first, str(tmp_path / "no.tif"))
    assert "shared by all workers" in what_is_hidden(str(tmp_path / "elsewhere"), first)
    begin_run(str(tmp_path))
    assert "does not see the results" in what_is_hidden(str(tmp_path), first)


def test_on_a_worker_paths_are_full_and_how_names_go_on_is_no_path(tmp_path: Path) -> None:
    masks = Path(os.path.relpath(tmp_path))
    item = BatchInput("a", "map", masks, Path("_img"), MapParameters())
    task = BatchTask(version("cytodisk"), (item, replace(item, signal=masks)), str(tmp_path))
    inputs = as_seen_by_all(task, str(tmp_path), "run").inputs
    assert all(item.masks.is_absolute() for item in inputs)
    assert inputs[0].signal == Path("_img")
    assert inputs[1].signal is not None
    assert inputs[1].signal.samefile(tmp_path)
    assert inputs[1].signal.is_absolute()


def test_what_is_no_scheduler_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    assert cluster.CONNECT_S < 15
    monkeypatch.setattr(cluster, "CONNECT_S", 0.5)
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        with (
            pytest.raises(StudyError, match=f"scheduler {address} does not answer"),
            cluster.connected(address),
        ):
            pass
    with pytest.raises(StudyError, match=f"scheduler {address} does not answer"), cluster.connected(address):
        pass
    with pytest.raises(ParameterError, match="must be an address"), cluster.connected("nonsense"):
        pass
    with pytest.raises(ParameterError, match=r"tls://.* cannot be reached"), cluster.connected("tls://a:1"):
        pass


def test_what_speaks_otherwise_is_no_scheduler() -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        other.settimeout(30)

        def talk() -> None:
            with other.accept()[0] as heard:
                heard.sendall(bytes(64))

        talks = Thread(target=talk)
        talks.start()
        address = f"tcp://127.0.0.1:{other.getsockname()[1]}"
        with pytest.raises(StudyError, match="is no Dask scheduler"), cluster.connected(address):
            pass
        talks.join(timeout=30)
        assert not talks.is_alive()

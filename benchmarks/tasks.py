"""Many tiny tasks through a Dask scheduler, and what a million movies would take.

Tasks are those of `cytodisk batch --scheduler`, sent by the same code, but all that a worker does is to write
the row of an input. Rate, and memory and processor time of scheduler and client, are measured for each number
of tasks; a smaller number predicts the largest, which is measured too. Real movies and label images then say
what an input costs; from both follows what a million movies would take, which `--page` writes for the docs.
"""

import argparse
import json
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path

from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.batch.batch_target import begin_run, open_store
from cytodisk.runs.batch.batch_task import BatchTask, TaskResult
from cytodisk.runs.batch.cluster import Flight, connected
from cytodisk.runs.batch.cluster_workers import Workers
from cytodisk.runs.batch.input_row import ROWS, InputRow, read_row, write_row
from cytodisk.runs.movie.movie_parameters import MovieParameters
from dask_processes import DaskProcesses
from million import Costs, measure_costs, predictions, write_page

NUMBERS = (1000, 10_000, 100_000)
WORKERS, THREADS = 2, 4
_TICKS = os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True)
class Flown:
    """What so many tasks took.

    Attributes
    ----------
    tasks : int
    seconds : float
        By the clock.
    scheduler_cpu_s, client_cpu_s : float
    scheduler_mb, client_mb : float
        Largest memory of the scheduler; what the client's memory grew by.
    row_bytes : float
        Of a row's file, in the mean.
    resume_s : float
        To read all rows again, as `--resume` does.
    """

    tasks: int
    seconds: float
    scheduler_cpu_s: float
    client_cpu_s: float
    scheduler_mb: float
    client_mb: float
    row_bytes: float
    resume_s: float


def write_rows(task: BatchTask) -> TaskResult:
    """What stands for a task: rows of inputs that went well."""
    store = open_store(task.target)
    rows = tuple(
        InputRow(item.name, item.kind, "ok", "", item.settings, "0" * 16, True, 1, 60, 60)
        for item in task.inputs
    )
    for row in rows:
        write_row(store, row)
    return TaskResult(rows)


def tiny_tasks(number: int, target: Path) -> Iterator[BatchTask]:
    here, parameters = version("cytodisk"), MovieParameters()
    for k in range(number):
        masks = target / f"plate_{k // 1000:04d}" / f"{k:07d}_masks.tif"
        yield BatchTask(here, (BatchInput(f"{k:07d}", "movie", masks, None, parameters),), str(target))


def fly(number: int) -> Flown:
    """Send so many tasks through a scheduler and workers that are started for it."""
    with tempfile.TemporaryDirectory() as folder, DaskProcesses(Path(folder)) as processes:
        target = Path(folder) / "out"
        scheduler = processes.scheduler()
        for _ in range(WORKERS):
            processes.worker(THREADS)
        processes.wait_for_workers()
        with connected(processes.address) as client:
            shared = (str(target), begin_run(str(target)))
            workers = Workers(client, processes.address, print, 60, shared)
            flight = Flight(client, workers, write_rows, lambda task: [], _no_death)
            used, before, most = time.process_time(), _memory_mb(os.getpid(), "VmRSS"), 0.0
            started, done = time.perf_counter(), 0
            for done, _ in enumerate(flight.results(tiny_tasks(number, target)), 1):
                if done % 500 == 0:
                    most = max(most, _memory_mb(os.getpid(), "VmRSS") - before)
            seconds, client_cpu = time.perf_counter() - started, time.process_time() - used
            if done != number:
                raise SystemExit(f"{done} of {number} tasks came back")
            scheduler_cpu, peak = _cpu_seconds(scheduler.pid), _memory_mb(scheduler.pid, "VmHWM")
        resume_s, row_bytes = _read_again(target, number)
    return Flown(number, seconds, scheduler_cpu, client_cpu, peak, most, row_bytes, resume_s)


def _no_death(task: BatchTask, reason: str) -> TaskResult:
    raise SystemExit(reason)


def _read_again(target: Path, number: int) -> tuple[float, float]:
    store, started = open_store(str(target)), time.perf_counter()
    rows = [read_row(store, f"{k:07d}") for k in range(number)]
    seconds = time.perf_counter() - started
    if None in rows or len(list(store.names(ROWS))) != number:
        raise SystemExit("rows are missing")
    some = [(target / ROWS / f"{k:07d}.json").stat().st_size for k in range(0, number, 100)]
    return seconds, sum(some) / len(some)


def _memory_mb(process: int, name: str) -> float:
    status = Path(f"/proc/{process}/status").read_text()
    return next(int(line.split()[1]) / 1024 for line in status.splitlines() if line.startswith(name))


def _cpu_seconds(process: int) -> float:
    fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / _TICKS


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tasks", type=int, nargs="+", default=NUMBERS, help="numbers of tasks, growing")
    parser.add_argument("--json", type=Path, help="write what was measured to this file")
    parser.add_argument("--from-json", type=Path, help="take what was measured from this file")
    parser.add_argument("--page", action="store_true", help="write the numbers of the docs page")
    chosen = parser.parse_args()
    if chosen.from_json:
        found = json.loads(chosen.from_json.read_text())
        flown, costs = [Flown(**one) for one in found["tasks"]], Costs(**found["costs"])
    else:
        flown = []
        for number in chosen.tasks:
            flown.append(fly(number))
            print(flown[-1], flush=True)
        costs = measure_costs()
        print(costs, flush=True)
    if chosen.json:
        measured = {"tasks": [asdict(one) for one in flown], "costs": asdict(costs)}
        chosen.json.write_text(json.dumps(measured, indent=1) + "\n")
    for line in predictions(flown):
        print(line)
    if chosen.page:
        write_page(flown, costs)
    return 0


if __name__ == "__main__":
    sys.exit(main())

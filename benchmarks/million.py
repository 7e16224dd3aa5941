"""What an input costs, measured; what many tasks take, predicted; and what follows for a million movies."""

from __future__ import annotations

import csv
import resource
import subprocess
import sys
import tempfile
import time
import tracemalloc
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import tifffile

import cytodisk as cd
from cytodisk.runs.batch.batch_file import read_batch
from cytodisk.runs.batch.batch_target import open_store
from cytodisk.runs.batch.batch_task import expected_seconds
from cytodisk.runs.batch.merged_tables import merge_batch
from pages import PAGES, machine_words, write_words

if TYPE_CHECKING:
    from tasks import Flown

MOVIES, FRAMES, THREADS, PLATE = 1_000_000, 60, 500, 10_000
_FILES = PAGES / "million_movies"
_CELLS = 50  # of a label image
_LISTED = 4000  # inputs of a batch file, to measure what a listed one takes


@dataclass(frozen=True)
class Costs:
    """What inputs take, in one process with one thread.

    Attributes
    ----------
    frame_s, movie_s, cell_s : float
        Processor time of a further frame, of a movie beside its frames, of a cell of a label image.
    frame_kb, movie_kb, cell_kb : float
        Results on disk, beside the merged tables.
    frame_files, movie_files, cell_files : float
    frame_in_kb : float
        Masks and two channels as they are read.
    merged_kb, merged_rows, merged_s : float
        Of a frame in the merged tables: size, rows of windows, time.
    listed_kb, listed_s : float
        Of an input in the process that keeps the books: memory, and time to read its line of the batch file
        and to look at its masks.
    """

    frame_s: float
    movie_s: float
    cell_s: float
    frame_kb: float
    movie_kb: float
    cell_kb: float
    frame_files: float
    movie_files: float
    cell_files: float
    frame_in_kb: float
    merged_kb: float
    merged_rows: float
    merged_s: float
    listed_kb: float
    listed_s: float


@dataclass(frozen=True)
class _Run:
    """A batch: processor time, results of the inputs, merged tables."""

    cpu_s: float
    kb: float
    files: int
    merged_kb: float
    merged_s: float


def measure_costs() -> Costs:
    """Run small batches; differences of two leave out what is paid once."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        one, four, long = (
            _movies(folder / f"m{k}", *size) for k, size in enumerate(((1, 10), (4, 10), (4, 30)))
        )
        few, many = (_images(folder / f"i{number}", number) for number in (1, 4))
        rows = cd.open_study(folder / "m2" / "out" / "inputs" / "0000_masks").windows
        in_kb = sum(file.stat().st_size for file in (folder / "m2").glob("0000_*.tif")) / 1e3 / 30
        listed_kb, listed_s = _listed(folder / "listed")

    def further(what: str) -> tuple[float, float]:
        """Of a frame, and of a movie beside its frames."""
        first, second, third = (getattr(run, what) for run in (one, four, long))
        frame = (third - second) / 80
        return frame, (second - first) / 3 - 10 * frame

    (frame_s, movie_s), (frame_kb, movie_kb), (frame_files, movie_files) = map(
        further, ("cpu_s", "kb", "files")
    )
    return Costs(
        frame_s=frame_s,
        movie_s=movie_s,
        cell_s=(many.cpu_s - few.cpu_s) / (3 * _CELLS),
        frame_kb=frame_kb,
        movie_kb=movie_kb,
        cell_kb=(many.kb - few.kb) / (3 * _CELLS),
        frame_files=frame_files,
        movie_files=movie_files,
        cell_files=(many.files - few.files) / (3 * _CELLS),
        frame_in_kb=in_kb,
        merged_kb=(long.merged_kb - four.merged_kb) / 80,
        merged_rows=len(rows) / 30,
        merged_s=(long.merged_s - four.merged_s) / 80,
        listed_kb=listed_kb,
        listed_s=listed_s,
    )


def predictions(flown: Sequence[Flown]) -> list[str]:
    """What the smaller numbers of tasks predict for the largest, beside what was measured."""
    if len(flown) < 2:
        return []
    *_, before, last = flown
    lines = []
    for name, predicted, measured in _predicted(before, last):
        lines.append(
            f"{name}: {predicted:.4g} predicted, {measured:.4g} measured ({measured / predicted:.2f}×)"
        )
    return lines


def _predicted(before: Flown, last: Flown) -> Iterable[tuple[str, float, float]]:
    times = last.tasks / before.tasks
    yield "seconds", before.seconds * times, last.seconds
    yield "processor seconds of the scheduler", before.scheduler_cpu_s * times, last.scheduler_cpu_s
    yield "processor seconds of the client", before.client_cpu_s * times, last.client_cpu_s
    yield "largest memory of the scheduler, MB", before.scheduler_mb, last.scheduler_mb
    yield "seconds to read all rows again", before.resume_s * times, last.resume_s


def write_page(flown: Sequence[Flown], costs: Costs) -> None:
    """Write the tables of the page."""
    _FILES.mkdir(exist_ok=True)
    write_words(_FILES / "measured.inc", [machine_words()])
    head = ["Tasks", "tasks/s", "scheduler: processor ms a task", "scheduler: largest memory, MB"]
    head += ["client: processor ms a task", "client: memory grew by, MB", "resume: µs a row"]
    lines = [
        [
            f"{one.tasks:,}",
            f"{one.tasks / one.seconds:.0f}",
            f"{1e3 * one.scheduler_cpu_s / one.tasks:.2f}",
            f"{one.scheduler_mb:.0f}",
            f"{1e3 * one.client_cpu_s / one.tasks:.2f}",
            f"{one.client_mb:.0f}",
            f"{1e6 * one.resume_s / one.tasks:.0f}",
        ]
        for one in flown
    ]
    _write("tasks", head, lines)
    *_, before, last = flown
    checked = [
        [name, f"{predicted:.4g}", f"{measured:.4g}", f"{measured / predicted:.2f}"]
        for name, predicted, measured in _predicted(before, last)
    ]
    _write(
        "checked",
        [f"Of {last.tasks:,} tasks", f"predicted from {before.tasks:,}", "measured", "ratio"],
        checked,
    )
    _write("costs", ["What", "Processor time", "Results", "Files"], _cost_lines(costs))
    _write("million", ["What", f"{MOVIES:,} movies", f"a plate of {PLATE:,}"], list(_plan(costs, last)))


def _cost_lines(costs: Costs) -> list[list[str]]:
    movie_s, movie_mb = (
        costs.movie_s + FRAMES * costs.frame_s,
        (costs.movie_kb + FRAMES * costs.frame_kb) / 1e3,
    )
    files = costs.movie_files + FRAMES * costs.frame_files
    return [
        ["a frame", f"{1e3 * costs.frame_s:.0f} ms", f"{costs.frame_kb:.0f} kB", f"{costs.frame_files:.1f}"],
        [f"a movie of {FRAMES} frames", f"{movie_s:.1f} s", f"{movie_mb:.1f} MB", f"{files:.0f}"],
        ["1000 movies", f"{movie_s / 3.6:.1f} core hours", f"{movie_mb:.1f} GB", f"{1000 * files:,.0f}"],
        [
            "1000 cells of label images",
            f"{costs.cell_s / 3.6:.3f} core hours",
            f"{costs.cell_kb:.0f} MB",
            f"{1000 * costs.cell_files:,.0f}",
        ],
    ]


def _plan(costs: Costs, last: Flown) -> Iterable[list[str]]:
    """What grows with the number of movies, for all of them and for a plate."""
    movie_s = costs.movie_s + FRAMES * costs.frame_s
    clock_s = movie_s / THREADS

    def line(what: str, of_one: float, unit: str, digits: str = ",.0f") -> list[str]:
        return [what, *(f"{of_one * number:{digits}} {unit}".rstrip() for number in (MOVIES, PLATE))]

    def time(what: str, of_one: float) -> list[str]:
        return [what, *(_duration(of_one * number) for number in (MOVIES, PLATE))]

    yield line("core hours", movie_s / 3600, "h")
    yield time(f"time with {THREADS} threads", clock_s)
    yield line("images that workers read", FRAMES * costs.frame_in_kb / 1e6, "GB")
    yield line("results of the movies", (costs.movie_kb + FRAMES * costs.frame_kb) / 1e6, "GB")
    yield line("files", costs.movie_files + FRAMES * costs.frame_files + 1, "")
    yield line("rows of windows in the merged table", FRAMES * costs.merged_rows, "")
    yield line("merged tables", FRAMES * costs.merged_kb / 1e6, "GB", ",.1f")
    yield time("to merge, by one process", FRAMES * costs.merged_s)
    yield line("memory of the client for its list", costs.listed_kb / 1e3, "MB")
    yield time("to read the batch file and look at all masks", costs.listed_s)
    yield time("to read the rows again at --resume", last.resume_s / last.tasks)
    yield time("processor time of the scheduler", last.scheduler_cpu_s / last.tasks)
    threads = f"{movie_s * last.tasks / max(last.scheduler_cpu_s, last.client_cpu_s):,.0f}"
    yield ["threads that one scheduler keeps busy, with one movie a task", threads, threads]


def _duration(seconds: float) -> str:
    """In the unit that suits it."""
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if seconds >= size:
            return f"{seconds / size:,.1f} {unit}"
    return f"{seconds:.1f} s"


def _write(name: str, head: Sequence[str], lines: Iterable[Sequence[str]]) -> None:
    with (_FILES / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([head, *lines])


def _movies(folder: Path, number: int, frames: int) -> _Run:
    folder.mkdir()
    for seed in range(number):
        truth = cd.simulate.movie("fluctuating", seed, frames=frames, speed_px=0.5)
        counts = np.random.default_rng(seed).poisson(200 * truth.signal.to_numpy().clip(0)).astype(np.uint16)
        tifffile.imwrite(
            folder / f"{seed:04d}_masks.tif", truth.masks.astype(np.uint8), metadata={"axes": "TYX"}
        )
        tifffile.imwrite(folder / f"{seed:04d}_img.tif", counts, metadata={"axes": "TCYX"})
    return _run(folder, "movie")


def _images(folder: Path, number: int) -> _Run:
    folder.mkdir()
    for seed in range(number):
        labels = cd.simulate.label_image(_CELLS, seed)
        counts = np.random.default_rng(seed).poisson(100 + 200 * (labels > 0)).astype(np.uint16)
        tifffile.imwrite(folder / f"{seed:04d}_masks.tif", labels)
        tifffile.imwrite(folder / f"{seed:04d}_img.tif", counts)
    return _run(folder, "map")


def _run(folder: Path, kind: str) -> _Run:
    file, out = folder / "study.toml", folder / "out"
    file.write_text(
        f'[study]\nkind = "{kind}"\n'
        '[[inputs]]\nmasks = "*_masks.tif"\nname = "{stem}"\nsignal = "{image}_img.tif"\n'
    )
    used = _children_s()
    subprocess.run([sys.executable, "-m", "cytodisk", "batch", str(file), "-o", str(out), "-q"], check=True)
    cpu_s = _children_s() - used
    results = [path for path in (out / "inputs").rglob("*") if path.is_file()]
    started = time.process_time()
    merge_batch(open_store(str(out)), read_batch(file), lambda row: None)
    return _Run(
        cpu_s,
        _kilobytes(results),
        len(results),
        _kilobytes(out.glob("*.parquet")),
        time.process_time() - started,
    )


def _listed(folder: Path) -> tuple[float, float]:
    """Memory and time of an input in the process that keeps the books."""
    folder.mkdir()
    whole = folder / "masks.tif"
    tifffile.imwrite(whole, np.zeros((FRAMES, 64, 64), np.uint8), metadata={"axes": "TYX"})
    for k in range(_LISTED):
        (folder / f"{k:07d}_masks.tif").hardlink_to(whole)
    (folder / "study.toml").write_text('[[inputs]]\nmasks = "*_masks.tif"\n')
    tracemalloc.start()
    batch = read_batch(folder / "study.toml")
    memory = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    del batch
    started = time.process_time()
    for item in read_batch(folder / "study.toml").inputs:
        expected_seconds(item)
    return memory / _LISTED / 1e3, (time.process_time() - started) / _LISTED


def _kilobytes(files: Iterable[Path]) -> float:
    return sum(file.stat().st_size for file in files) / 1e3


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime

"""`cytodisk map` on folders of label images: cells a second, peak memory, and what a damaged file costs."""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import tifffile

import cytodisk as cd

CELLS_AN_IMAGE = 50
GRID = ("--layers", "12", "--sectors", "60")
THE_PAPERS_CELLS, THE_PAPERS_WORKERS = 57_701, 48
_LOOK_EVERY_S = 0.05


@dataclass(frozen=True)
class Run:
    """What a run cost."""

    cells: int
    mapped: int
    unreadable: int
    complete: int
    rows: int
    seconds: float
    cpu_seconds: float
    peak_mb: float
    disk_mb: float


def write_folder(folder: Path, cells: int) -> None:
    """Write label images with an image of each, and one more that is cut short."""
    folder.mkdir()
    for number in range(-(-cells // CELLS_AN_IMAGE)):
        labels = cd.simulate.label_image(min(CELLS_AN_IMAGE, cells - CELLS_AN_IMAGE * number), number)
        counts = np.random.default_rng(number).poisson(100 + 200 * (labels > 0)).astype(np.uint16)
        tifffile.imwrite(folder / f"{number:04d}_masks.tif", labels, compression="zlib")
        tifffile.imwrite(folder / f"{number:04d}_img.tif", counts)
    whole = (folder / "0000_masks.tif").read_bytes()
    (folder / "0000b_masks.tif").write_bytes(whole[: len(whole) // 2])


def resident_mb(process: int) -> float:
    """Memory of a process and all that it started, in MB; pages that they share count in each."""
    total, waiting = 0.0, [process]
    while waiting:
        number = waiting.pop()
        try:
            status = Path(f"/proc/{number}/status").read_text()
            threads = sorted(Path(f"/proc/{number}/task").iterdir())  # any of them may have started a process
            children = " ".join((thread / "children").read_text() for thread in threads)
        except OSError:
            continue  # it has just ended
        resident = [line.split()[1] for line in status.splitlines() if line.startswith("VmRSS")]
        total += float(resident[0]) / 1024 if resident else 0.0
        waiting += [int(child) for child in children.split()]
    return total


def cpu_seconds() -> float:
    """Processor time of all processes that have ended, which does not depend on what else runs."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def map_folder(folder: Path, out: Path, workers: int, *flags: str) -> Run:
    """Run `cytodisk map` in a process of its own and watch its memory."""
    names = ["map", str(folder), "--signal", "_img", "-o", str(out), "--workers", str(workers)]
    command = [sys.executable, "-m", "cytodisk", *names, *GRID, "--figures", "0", "-q", *flags]
    started, used, peak = time.perf_counter(), cpu_seconds(), 0.0
    running = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    while running.poll() is None:
        peak = max(peak, resident_mb(running.pid))
        time.sleep(_LOOK_EVERY_S)
    seconds = time.perf_counter() - started
    said = running.stderr.read() if running.stderr else ""
    if running.returncode not in (0, 2) or "Traceback" in said:  # 2: an input is damaged, as it is here
        raise SystemExit(f"cytodisk map ended with {running.returncode}:\n{said}")
    cells = cd.open_study(out).cells
    mapped = cells[cells["status"] == "ok"]
    return Run(
        cells=len(cells),
        mapped=len(mapped),
        unreadable=int((cells["status"] == "unreadable").sum()),
        complete=int((mapped["empty_windows"] == 0).sum()),
        rows=pq.read_metadata(out / "windows.parquet").num_rows,
        seconds=seconds,
        cpu_seconds=cpu_seconds() - used,
        peak_mb=peak,
        disk_mb=sum(path.stat().st_size for path in out.rglob("*") if path.is_file()) / 1e6,
    )


def print_run(run: Run) -> None:
    print(
        f"{run.cells:>6} rows of cells: {run.mapped} mapped, {run.unreadable} unreadable (the damaged file), "
        f"all windows complete in {run.complete}; {run.rows} rows of windows"
    )
    print(
        f"{run.seconds:>9.1f} s ({run.cpu_seconds:.1f} s of processor) with start and tables, "
        f"{run.mapped / run.seconds:.1f} cells/s; peak memory {run.peak_mb:.0f} MB, "
        f"study {run.disk_mb:.0f} MB on disk"
    )


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=5000, help="cells of the larger folder (default 5000)")
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    parser.add_argument("--no-maps", action="store_true", help="do not keep maps")
    arguments = parser.parse_args()
    flags = ("--no-maps",) if arguments.no_maps else ()
    print(
        f"{arguments.workers} workers on {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} before the run"
    )
    runs = []
    for cells in (arguments.cells // 5, arguments.cells):
        with tempfile.TemporaryDirectory() as folder:
            write_folder(Path(folder) / "in", cells)
            runs.append(map_folder(Path(folder) / "in", Path(folder) / "out", arguments.workers, *flags))
        print_run(runs[-1])
    small, large = runs
    # The difference leaves out what every run costs once: start, imports, compiled code.
    more = large.mapped - small.mapped
    each, busy = (large.seconds - small.seconds) / more, (large.cpu_seconds - small.cpu_seconds) / more
    print(
        f"a further cell: {1000 * each:.0f} ms with {arguments.workers} workers ({1 / each:.1f} cells/s), "
        f"{1000 * busy:.0f} ms of processor"
    )
    print(
        f"the paper's {THE_PAPERS_CELLS} cells: {THE_PAPERS_CELLS * each / 3600:.2f} h at this rate; "
        f"{THE_PAPERS_CELLS * busy / 3600:.2f} h of processor, by its {THE_PAPERS_WORKERS} workers "
        f"{THE_PAPERS_CELLS * busy / 60 / THE_PAPERS_WORKERS:.1f} min each (one process joins the tables)"
    )
    print(f"peak memory, {large.cells} against {small.cells} rows: {large.peak_mb / small.peak_mb:.2f}×")
    kept = all(run.unreadable == 1 and run.complete == run.mapped == run.cells - 1 for run in runs)
    print("every other cell has all its windows" if kept else "NOT every other cell has all its windows")
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())

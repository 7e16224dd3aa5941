"""Every figure that the design asks for, beside its yardstick, in one table.

    benchmarks/suite.py [--only BLOCK …] [--json FILE]
    benchmarks/suite.py --compare OLD NEW [--only BLOCK …] [--rounds N]

Each block runs in a process of its own, with one thread. Times of a single process are processor time, those
of several and of whole commands by the clock, so other work on the machine should rest; beside absolute times
stands the ratio to a factorisation that is the same everywhere. A full run takes less than ten minutes on two
cores. Ends with status 1 if a yardstick is not met or a block could not be measured.

The comparison runs the blocks of two revisions in turns (old, new, old, new …), each with its own files of
this folder, which know where its package has what. It prints medians, their ratio, the range of the ratio
over rounds, and the peak memory of each block's largest process; "WORSE" stands where a time, memory or rate
is worse by more than 5 % in every round, and ends it with status 1. By default it runs the blocks of time and
memory but the exponents. "." stands for the files as they are. What a revision cannot do is said to be
missing.
"""

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import IO, Any

import suite_checks
import suite_costs
from figure import Figure, MissingError

HERE = Path(__file__).parent
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
BLOCK_LIMIT_S = 900.0
BLOCKS: dict[str, Callable[[Path], Iterator[Figure]]] = {
    block.__name__: block
    for block in (
        suite_costs.map_time,
        suite_costs.frame_time,
        suite_costs.doubling,
        suite_costs.movie,
        suite_costs.demo,
        suite_costs.cells,
        suite_costs.batch,
        suite_costs.scaling,
        suite_checks.area,
        suite_checks.random,
        suite_checks.random_nuclei,
        suite_checks.windows,
        suite_checks.same_place,
        suite_checks.tracking,
        suite_checks.false_positives,
    )
}
COMPARED = ("map_time", "frame_time", "doubling", "movie", "demo", "cells", "batch")


def measure_here(name: str, data: Path) -> dict[str, Any]:
    """Figures of a block, or why this revision cannot be measured."""
    import cytodisk

    try:
        figures = [asdict(figure) for figure in BLOCKS[name](data)]
    except (MissingError, ImportError, AttributeError, FileNotFoundError) as error:
        return {"missing": f"{type(error).__name__}: {error}", "package": cytodisk.__file__}
    return {"figures": figures, "package": cytodisk.__file__}


def measure(name: str, data: Path, root: Path | None = None) -> tuple[list[Figure], str]:
    """Figures of a block from a process of its own; if there are none, why.

    Parameters
    ----------
    name : str
    data : Path
    root : Path, optional
        Folder that holds `src` and `benchmarks` of the revision to be measured, whose memory is a figure,
        too; by default the installed package is measured by this file.

    Returns
    -------
    figures : list of Figure
    missing : str
        Empty if the block was measured.
    """
    environment = os.environ | dict.fromkeys(THREADS, "1")
    script = Path(__file__)
    if root is not None:
        environment["PYTHONPATH"] = str(root / "src")
        script = root / "benchmarks" / "suite.py"
    command = [sys.executable, str(script), "--block", name, "--data", str(data)]
    run, peak_mb = run_watched(command, environment)
    if run.returncode:
        return [], (run.stderr.strip() or f"ended with {run.returncode}").splitlines()[-1]
    found = json.loads(run.stdout.splitlines()[-1])
    if root is not None and not Path(found["package"]).is_relative_to(root):
        raise SystemExit(f"{found['package']} was measured, not the package in {root}")
    figures = [Figure(**figure) for figure in found.get("figures", [])]
    if root is not None and figures:
        figures.append(Figure(f"block {name}: peak memory of its largest process", peak_mb, "MB"))
    return figures, found.get("missing", "")


def run_watched(
    command: Sequence[str], environment: Mapping[str, str]
) -> tuple[subprocess.CompletedProcess[str], float]:
    """Run a command, not longer than a block may take; its peak memory in MB, or its largest child's."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as errors:
        process = subprocess.Popen(command, env=environment, stdout=out, stderr=errors, text=True)
        stop = threading.Timer(BLOCK_LIMIT_S, process.kill)
        stop.start()
        _, status, usage = os.wait4(process.pid, 0)
        stop.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        said = [_read_all(stream) for stream in (out, errors)]
    if process.returncode == -signal.SIGKILL:
        said[1] = f"killed, after {BLOCK_LIMIT_S:.0f} s or for want of memory"
    done = subprocess.CompletedProcess(command, process.returncode, *said)
    return done, usage.ru_maxrss / 1024.0


def _read_all(stream: IO[str]) -> str:
    stream.seek(0)
    return stream.read()


def with_progress(names: Sequence[str], work: Callable[[str], Any]) -> dict[str, Any]:
    """Results of the blocks by name, with a line for each."""
    found, started = {}, time.perf_counter()
    for number, name in enumerate(names, start=1):
        print(f"[{number}/{len(names)}] {name} …", file=sys.stderr, flush=True)
        begun = time.perf_counter()
        found[name] = work(name)
        now = time.perf_counter()
        print(f"    {now - begun:.0f} s, {now - started:.0f} s in all", file=sys.stderr, flush=True)
    return found


def print_table(rows: Sequence[Sequence[str]]) -> None:
    """Print rows in columns, the first as head."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for number, row in enumerate(rows):
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
        if not number:
            print("  ".join("-" * width for width in widths))


def table_of(found: dict[str, tuple[list[Figure], str]]) -> list[list[str]]:
    """A row a figure, below the head."""
    words = {True: "yes", False: "NO", None: ""}
    rows = [["what", "yardstick", "measured", "met?", ""]]
    for name, (figures, missing) in found.items():
        rows += [[one.what, one.yardstick, one.measured, words[one.met], one.note] for one in figures]
        if missing:
            rows.append([f"block {name}", "", "not measured", "NO", missing])
    return rows


def as_json(found: dict[str, tuple[list[Figure], str]]) -> str:
    """The same for programs."""
    blocks = {
        name: {"missing": missing, "figures": [asdict(one) | {"met": one.met} for one in figures]}
        for name, (figures, missing) in found.items()
    }
    return json.dumps(blocks, indent=1)


def main() -> int:
    """Run the suite."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    default = Path(os.environ.get("CYTODISK_DATA", HERE.parents[1] / "shared" / "data"))
    parser.add_argument("--data", type=Path, default=default, help="folder of the real data")
    parser.add_argument("--only", nargs="+", choices=tuple(BLOCKS), metavar="BLOCK", help=", ".join(BLOCKS))
    parser.add_argument("--json", type=Path, help="write the figures to this file, too")
    parser.add_argument("--compare", nargs=2, metavar=("OLD", "NEW"), help="revisions to measure in turns")
    parser.add_argument("--rounds", type=int, default=7, help="of a comparison (default 7)")
    parser.add_argument("--block", choices=tuple(BLOCKS), help="measure one block here and print JSON")
    chosen = parser.parse_args()
    if chosen.block:
        print(json.dumps(measure_here(chosen.block, chosen.data)))
        return 0
    if not chosen.data.is_dir():
        print(f"{chosen.data} does not exist, so no figures on real data: set CYTODISK_DATA or pass --data")
    names = chosen.only or list(COMPARED if chosen.compare else BLOCKS)
    if chosen.compare:
        from revisions import compare

        rows = compare(chosen.compare, names, chosen.data, chosen.rounds)
        print_table(rows)
        return int(any(row[-1] == "WORSE" for row in rows))
    found = with_progress(names, lambda name: measure(name, chosen.data))
    print_table(table_of(found))
    if chosen.json:
        chosen.json.write_text(as_json(found), encoding="utf-8")
    return int(any(missing or any(one.met is False for one in ones) for ones, missing in found.values()))


if __name__ == "__main__":
    sys.exit(main())

"""Every figure that the design asks for, beside its yardstick, in one table.

    benchmarks/suite.py [--only BLOCK …] [--json FILE]
    benchmarks/suite.py --compare OLD NEW [--only BLOCK …] [--rounds N]

Each block runs in a process of its own, with one thread. Times of a single process are processor time, those
of several and of whole commands by the clock, so other work on the machine should rest; beside absolute times
stands the ratio to a factorisation that is the same everywhere. A full run takes less than ten minutes on two
cores. Ends with status 1 if a yardstick is not met or a block could not be measured.

The comparison runs the same blocks, as they are now, with the package of two revisions in turns (old, new,
old, new …) and prints the medians, their ratio, and the range of the ratio over rounds. "." stands for the
files as they are. What a revision cannot do is said to be missing.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

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
        suite_checks.windows,
        suite_checks.tracking,
        suite_checks.false_positives,
    )
}


def measure_here(name: str, data: Path) -> dict[str, Any]:
    """Figures of a block, or why this revision cannot be measured."""
    import cytodisk

    try:
        figures = [asdict(figure) for figure in BLOCKS[name](data)]
    except (MissingError, ImportError, AttributeError, FileNotFoundError) as error:
        return {"missing": f"{type(error).__name__}: {error}", "package": cytodisk.__file__}
    return {"figures": figures, "package": cytodisk.__file__}


def measure(name: str, data: Path, source: Path | None = None) -> tuple[list[Figure], str]:
    """Figures of a block from a process of its own; if there are none, why.

    Parameters
    ----------
    name : str
    data : Path
    source : Path, optional
        Folder that holds the package `cytodisk` to be measured; by default the installed one.

    Returns
    -------
    figures : list of Figure
    missing : str
        Empty if the block was measured.
    """
    environment = os.environ | dict.fromkeys(THREADS, "1")
    if source is not None:
        environment["PYTHONPATH"] = str(source)
    command = [sys.executable, __file__, "--block", name, "--data", str(data)]
    try:
        run = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=BLOCK_LIMIT_S)
    except subprocess.TimeoutExpired:
        return [], f"took more than {BLOCK_LIMIT_S:.0f} s"
    if run.returncode:
        return [], (run.stderr.strip() or f"ended with {run.returncode}").splitlines()[-1]
    found = json.loads(run.stdout.splitlines()[-1])
    if source is not None and not Path(found["package"]).is_relative_to(source):
        raise SystemExit(f"{found['package']} was measured, not the package in {source}")
    return [Figure(**figure) for figure in found.get("figures", [])], found.get("missing", "")


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
    parser.add_argument("--rounds", type=int, default=3, help="of a comparison (default 3)")
    parser.add_argument("--block", choices=tuple(BLOCKS), help="measure one block here and print JSON")
    chosen = parser.parse_args()
    if chosen.block:
        print(json.dumps(measure_here(chosen.block, chosen.data)))
        return 0
    if not chosen.data.is_dir():
        print(f"{chosen.data} does not exist, so no figures on real data: set CYTODISK_DATA or pass --data")
    names = chosen.only or list(BLOCKS)
    if chosen.compare:
        from revisions import compare

        rows = compare(chosen.compare, names, chosen.data, chosen.rounds)
        print_table(rows)
        return 0
    found = with_progress(names, lambda name: measure(name, chosen.data))
    print_table(table_of(found))
    if chosen.json:
        chosen.json.write_text(as_json(found), encoding="utf-8")
    return int(any(missing or any(one.met is False for one in ones) for ones, missing in found.values()))


if __name__ == "__main__":
    sys.exit(main())

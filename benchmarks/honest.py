"""Whether motion and correlation can fool a user: every figure that the design asks for, beside its target.

    benchmarks/honest.py [--quick] [--seeds FIRST LAST] [--only BLOCK …] [--workers N]

Prints a Markdown table for each block. All movies are simulated, with known answers, from seeds on which no
threshold was tuned (by default from 1000). They are measured in fresh processes, with one thread each, and
nothing is kept on disk. Ends with status 1 if a target is missed or a block could not be measured.

Blocks:

* area: velocity times length of edge against area won and lost, in every frame of every kind of movie.
* filopodium: the fastest edge of a protrusion 5 px wide that grows 4 px a frame, in each of 14 frames.
* bias: mean velocity against the true one, on waves and on cells that turn 5° and 10° a frame.
* error: standard deviation of (measured - true) / `velocity_error`, for masks with faults of many kinds.
* no_biology: still patterns and a cortex that moves with the edge, through `run_movie` and `run_correlate`.
* no_waves: waves that are found in the same movies, in which none runs.
* no_prediction: links of the same signals with velocity, through `run_predict`.
* coupled: of the coupled windows that are found, those that are found with geometry taken out, too.
* survival: how much of a true signal the controls by geometry leave.
* clusters: coupled windows that are found by clusters and one by one, and movies with a false cluster.
* stress: series that fool a correlation, and whether a flag says so.
* depth: one cortex in cells of four sizes, in the outermost layer, with `depth_um` and without.
* interior: places inside a cell that grows on one side, with `interior="still"` and "area".
* flags: movies in which nothing is wrong, and the flags that they carry all the same.
"""

import argparse
import os
import sys
import time
from importlib import import_module

from cytodisk.errors import CytodiskError
from honest_trials import THREADS, Trials

BLOCKS = {
    "area": "honest_edge",
    "filopodium": "honest_edge",
    "bias": "honest_edge",
    "error": "honest_edge",
    "no_biology": "honest_geometry",
    "no_waves": "honest_waves",
    "no_prediction": "honest_waves",
    "coupled": "honest_geometry",
    "survival": "honest_geometry",
    "clusters": "honest_clusters",
    "stress": "honest_stress",
    "depth": "honest_places",
    "interior": "honest_places",
    "flags": "honest_flags",
}
"""Module of each block, imported when it is run: one that cannot be does not keep others from running."""
FAILURES = (CytodiskError, ImportError, AttributeError, TypeError, ValueError, LookupError, OSError)
"""What a block may end with that must not keep others from running."""


def print_row(cells: list[str], head: bool = False) -> None:
    """Print a row of a Markdown table."""
    print(f"| {' | '.join(cells)} |", flush=True)
    if head:
        print(f"|{'---|' * len(cells)}", flush=True)


def run(name: str, trials: Trials) -> bool:
    """Measure a block and print its table; whether all targets are met."""
    words = {True: "yes", False: "NO", None: ""}
    print(f"\n## {name}\n", flush=True)
    print_row(["what", "target", "measured", "met?", ""], head=True)
    good, started = True, time.perf_counter()
    try:
        for figure in getattr(import_module(BLOCKS[name]), name)(trials):
            good &= figure.met is not False
            print_row([figure.what, figure.yardstick, figure.measured, words[figure.met], figure.note])
    except FAILURES as error:
        print_row([f"block {name}", "", "not measured", "NO", f"{type(error).__name__}: {error}"])
        good = False
    print(f"\n{time.perf_counter() - started:.0f} s", flush=True)
    return good


def main() -> int:
    """Run the blocks."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="few movies: what runs, not what holds")
    parser.add_argument(
        "--seeds", type=int, nargs=2, metavar=("FIRST", "LAST"), help="of each case, in place of the block's"
    )
    parser.add_argument("--only", nargs="+", choices=tuple(BLOCKS), metavar="BLOCK", help=", ".join(BLOCKS))
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    chosen = parser.parse_args()
    os.environ |= dict.fromkeys(THREADS, "1")
    trials = Trials(chosen.quick, chosen.seeds and (chosen.seeds[0], chosen.seeds[1]), chosen.workers)
    met = [run(name, trials) for name in chosen.only or BLOCKS]
    print(f"\n{'all targets are met' if all(met) else 'a target is MISSED'}")
    return 0 if all(met) else 1


if __name__ == "__main__":
    sys.exit(main())

"""What does a nucleus cost? Time of a map by vertex of its outlines, with a nucleus and without.

    benchmarks/nucleus_speed.py [--only SET …] [--count 40] [--rounds 3]

Sets: "schwann" and "osteosarcoma" (real cells, as in `schwann_nuclei.py`), "smooth", "spiky" and "branched"
(random cells with a nucleus). Each cell is mapped with and without its nucleus, in turn, in one thread, the
first time uncounted; the least processor time of the rounds counts. Both outlines count where there are two.
A row a set: median and 90th percentile over cells of the ratio of the times by vertex, the same of the sums
over all cells, steps of the relaxation, and the ratio of memory at its peak by vertex (arrays of NumPy).
"""

import argparse
import sys
import time
import tracemalloc
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

import numpy as np

import cytodisk as cd
from cytodisk.arrays import BoolArray
from cytodisk.errors import NucleusError
from cytodisk.simulate.nuclei.random_pairs import random_pair, random_pair_kinds
from real_masks import DATA
from schwann_nuclei import osteosarcoma_cases, schwann_cases

SETS = ("schwann", "osteosarcoma", "smooth", "spiky", "branched")
Pair = tuple[BoolArray, BoolArray]


def pairs_of(name: str, data: Path) -> Iterator[Pair]:
    """Cells of a set with their nuclei."""
    if name in ("schwann", "osteosarcoma"):
        cases = schwann_cases(data) if name == "schwann" else osteosarcoma_cases(data)
        yield from ((case.mask, case.nucleus) for case in cases)
        return
    yield from (random_pair(seed) for seed in range(100_000) if random_pair_kinds(seed)[0] == name)


def cost(mask: BoolArray, nucleus: BoolArray | None) -> tuple[float, int, int]:
    """Processor time of a map in seconds, vertices of its outlines, and steps."""
    start = time.process_time()
    disk = cd.map_to_disk(mask, nucleus=nucleus)
    seconds = time.process_time() - start
    inner = 0 if disk.nucleus is None else len(disk.nucleus.boundary)
    return seconds, len(disk.boundary) + inner, disk.steps


def peak(mask: BoolArray, nucleus: BoolArray | None, vertices: int) -> float:
    """Bytes at the peak of a map, by vertex of its outlines."""
    tracemalloc.start()
    cd.map_to_disk(mask, nucleus=nucleus)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return most / vertices


def measure(mask: BoolArray, nucleus: BoolArray, rounds: int) -> list[float]:
    """Times by vertex without and with the nucleus, times, steps, vertices and memory by vertex."""
    found = np.array([[cost(mask, own) for own in (None, nucleus)] for _ in range(rounds)])
    seconds, vertices, steps = found[:, :, 0].min(axis=0), found[0, :, 1], found[0, :, 2]
    memory = [peak(mask, own, int(count)) for own, count in zip((None, nucleus), vertices, strict=True)]
    return [*(seconds / vertices), *seconds, *steps, *vertices, *memory]


def print_row(name: str, rows: Sequence[Sequence[float]]) -> None:
    """Print what a set came to."""
    plain, both, plain_s, both_s, plain_steps, both_steps, plain_n, both_n, plain_b, both_b = np.array(rows).T
    ratio = both / plain
    whole = (both_s.sum() / both_n.sum()) / (plain_s.sum() / plain_n.sum())
    print(
        f"{name:<14}{len(rows):>7}{np.median(ratio):>9.2f}{np.percentile(ratio, 90):>8.2f}{whole:>9.2f}"
        f"{np.median(plain_steps):>8.0f} → {np.median(both_steps):<5.0f}{np.median(both_b / plain_b):>9.2f}"
        f"{1e3 * np.median(both_s):>9.1f}"
    )


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", nargs="+", choices=SETS, default=SETS)
    parser.add_argument("--count", type=int, default=40, help="cells of a set (default 40)")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--data", type=Path, default=DATA)
    chosen = parser.parse_args()
    mask, nucleus = random_pair(0)
    for own in (None, nucleus):
        cd.map_to_disk(mask, nucleus=own)
    head = ("set", "cells", "median", "90 %", "in all", "steps", "memory", "ms")
    print("{:<14}{:>7}{:>9}{:>8}{:>9}{:>16}{:>9}{:>9}".format(*head))
    for name in chosen.only:
        rows = []
        for pair in islice(pairs_of(name, chosen.data), chosen.count):
            try:
                rows.append(measure(*pair, chosen.rounds))
            except NucleusError as refused:
                print(f"{name}: left out, {refused}", file=sys.stderr)
        if rows:
            print_row(name, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())

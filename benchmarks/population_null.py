"""False positives of `compare_conditions` in studies in which conditions differ by chance alone.

    benchmarks/population_null.py [--studies 4000] [--first-block 0] [--results FILE] [--all] [--workers 1]

Cells of 4 × 12 windows, 8 in each condition and experiment, with 0, 10 and 30 % of the variance between
experiments; 3 to 8 experiments of each condition, unpaired, and 3 to 8 pairs; as they are, and aligned
by the nucleus, by the front (cells turned at random, with a known direction) and by the signal that is
tested. Prints, for each case, the share of studies in which something is found at .05: a window by
max-T, a cluster by its mass, the mean of a cell, any of the scalars corrected together; beside the
largest level of at most .05 that an exact test can have with so few exchanges. "met?" says whether max-T
and the mean are within three standard errors of it, and clusters and scalars, which can be conservative,
not above it. Then the same with single cells exchanged in place of experiments: how often that finds
something where there is nothing.

Without `--all` alignment is tried with 5 + 5 experiments and with 6 pairs. With `--results` each case
that is done is kept, and the same command goes on. Ends with status 1 if a case is not met.
"""

import argparse
import json
import os
import sys
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import cytodisk as cd
from population_cases import (
    ALIGNMENTS,
    BLOCK,
    TESTS,
    Case,
    Studies,
    attainable,
    is_found,
    p_values_of_comparison,
    standard_error,
)

SHARES, SIZES = (0.0, 0.1, 0.3), range(3, 9)
ALIGNED_SIZES = {"unpaired": 5, "paired": 6}
CELL_SIZE = {"unpaired": 5, "paired": 6}
EXACT, AT_MOST = ("windows", "mean"), ("clusters", "scalars")


def cases(every: bool) -> Iterator[Case]:
    """Those with experiments as units."""
    for alignment in ALIGNMENTS:
        for share in SHARES:
            for design in ("unpaired", "paired"):
                few = alignment != "none" and not every
                for experiments in (ALIGNED_SIZES[design],) if few else SIZES:
                    yield Case(share, design, experiments, alignment)


def cell_cases() -> Iterator[Case]:
    """Those with cells as units."""
    for share in SHARES:
        for design, experiments in CELL_SIZE.items():
            yield Case(share, design, experiments, unit="cell")


def count(block: int, case: Case, permutations: int) -> Counter[str]:
    """How many studies of a block find something, by test."""
    studies, found = Studies(case, block, permutations), Counter[str]()
    for number in range(BLOCK):
        p_values = studies.p_values(number, block * BLOCK + number)
        if not (block or number):
            _check(case, studies, p_values, permutations)
        found.update(name for name, p in p_values.items() if is_found(p))
    return found


def _check(case: Case, studies: Studies, fast: dict[str, float], permutations: int) -> None:
    """Stop unless the p-values of the first study are those of `compare_conditions`."""
    whole = p_values_of_comparison(case, studies.alone(0), 0, permutations)
    if any(abs(whole[name] - fast[name]) > 1e-12 for name in TESTS):
        raise SystemExit(f"{case.key}: compare_conditions gives {whole}, not {fast}")


class Results:
    """Counts of cases, which a file can keep."""

    def __init__(self, path: Path | None, settings: dict[str, int | str]) -> None:
        self._path, self._done = path, {}
        if path is not None and path.exists():
            head, *lines = path.read_text(encoding="utf-8").splitlines()
            if json.loads(head) != settings:
                raise SystemExit(f"{path} is of other settings, {head}: pass another file")
            whole = [line for line in lines if line.endswith("}}")]
            self._done = {entry["case"]: Counter(entry["found"]) for entry in map(json.loads, whole)}
        elif path is not None:
            path.write_text(json.dumps(settings) + "\n", encoding="utf-8")

    def get(self, case: Case) -> Counter[str] | None:
        """Counts of a case that is done."""
        return self._done.get(case.key)

    def keep(self, case: Case, found: Counter[str]) -> None:
        """Write the counts of a case."""
        if self._path is not None:
            with self._path.open("a", encoding="utf-8") as file:
                file.write("\n" + json.dumps({"case": case.key, "found": dict(found)}))


def rates(
    case: Case, chosen: argparse.Namespace, studies: int, pool: ProcessPoolExecutor, results: Results
) -> dict[str, float]:
    """Share of the studies in which each test finds something."""
    found = results.get(case)
    if found is None:
        blocks = range(chosen.first_block, chosen.first_block + studies // BLOCK)
        work = partial(count, case=case, permutations=chosen.permutations)
        found = sum(pool.map(work, blocks), Counter())
        results.keep(case, found)
    return {name: found[name] / studies for name in TESTS}


def is_met(rate: dict[str, float], level: float, studies: int) -> bool:
    """Whether an exact test gives these rates."""
    room = 3.0 * standard_error(level, studies)
    exact = all(abs(rate[name] - level) <= room for name in EXACT)
    return exact and all(rate[name] <= level + room for name in AT_MOST)


def line(case: Case, rate: dict[str, float], *more: str) -> str:
    """A row of the table."""
    design = (
        f"{case.experiments} + {case.experiments}"
        if case.design == "unpaired"
        else f"{case.experiments} pairs"
    )
    cells = [f"{case.share:.0%}", design, case.alignment, *(f"{rate[name]:.4f}" for name in TESTS), *more]
    return f"| {' | '.join(cells)} |"


def head(*more: str) -> str:
    """The first two rows of the table."""
    names = ["between", "design", "aligned by", "max-T", "clusters", "mean", "scalars", *more]
    return f"| {' | '.join(names)} |\n|{'---|' * len(names)}"


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--studies", type=int, default=4000, help="of each case (default 4000)")
    parser.add_argument("--cell-studies", type=int, default=400, help="with cells as units (default 400)")
    parser.add_argument("--permutations", type=int, default=999, help="at most (default 999)")
    parser.add_argument("--first-block", type=int, default=0, help=f"seed of the first {BLOCK} studies")
    parser.add_argument("--results", type=Path, help="file of cases that are done, to go on with")
    parser.add_argument("--all", action="store_true", help="alignments with all numbers of experiments")
    parser.add_argument("--workers", type=int, default=1, help="processes (default 1)")
    chosen = parser.parse_args()
    if chosen.studies % BLOCK or chosen.cell_studies % BLOCK:
        parser.error(f"studies are simulated {BLOCK} at a time: pass a multiple of it")
    os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    names = ("studies", "cell_studies", "permutations", "first_block")
    settings = {"version": cd.__version__} | {name: getattr(chosen, name) for name in names}
    results, good, started = Results(chosen.results, settings), True, time.perf_counter()
    with ProcessPoolExecutor(chosen.workers) as pool:
        print(
            f"\nExperiments exchanged, {chosen.studies} studies a case\n\n{head('level', 'met?')}", flush=True
        )
        for case in cases(chosen.all):
            level = attainable(case, chosen.permutations)
            rate = rates(case, chosen, chosen.studies, pool, results)
            met = is_met(rate, level, chosen.studies)
            good &= met
            print(line(case, rate, f"{level:.4f}", "yes" if met else "NO"), flush=True)
        print(f"\nCells exchanged, {chosen.cell_studies} studies a case\n\n{head()}", flush=True)
        for case in cell_cases():
            print(line(case, rates(case, chosen, chosen.cell_studies, pool, results)), flush=True)
    print(f"\n{time.perf_counter() - started:.0f} s; {'all cases are met' if good else 'a case is NOT met'}")
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())

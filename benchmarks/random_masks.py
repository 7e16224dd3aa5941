"""Map many random masks and check every map: certificate, flips, lost pixels, exact inverse, windows.

    benchmarks/random_masks.py [--count N] [--results FILE]

No window of a 10 × 60 grid may be empty, and areas and intensities of the windows must sum to those of the
cell; one in twenty of the cells of at least 500 px is also divided into 100 × 200 windows. With `--results`,
every mask is written to the file, and a run that was stopped goes on where it was; a file of another version
of the package is refused. Prints a table with a row a kind; ends with status 1 if any mask failed or was
refused.
"""

import argparse
import os
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import cytodisk as cd
from checked_windows import SUM_ERROR, check_windows
from cytodisk.disk.mapping import map_to_disk
from cytodisk.errors import CytodiskError
from cytodisk.simulate.random_masks import KINDS, random_mask
from stored_trials import StoredTrials
from suite import THREADS

_ROUND_TRIP_PX = 1e-6
_GRIDS, _FINE_GRIDS = ((10, 60),), ((10, 60), (100, 200))
_FINE_EVERY, _FINE_PIXELS = 20, 500


@dataclass(frozen=True)
class Trial:
    """What one random mask came to."""

    kind: str
    seed: int
    pixels: int
    seconds: float
    refused: str = ""
    valid: bool = False
    flips: int = 0
    lost: int = 0
    round_trip: float = np.nan
    converged: bool = False
    empty: int = 0
    sum_error: float = np.nan
    fine: bool = False

    @property
    def failed(self) -> bool:
        """True unless the mask was mapped and every check held."""
        good = self.valid and not self.flips and not self.lost and self.round_trip < _ROUND_TRIP_PX
        return bool(self.refused) or not good or bool(self.empty) or not self.sum_error <= SUM_ERROR


def try_mask(kind: str, seed: int) -> Trial:
    """Map one random mask and check the map."""
    mask = random_mask(kind, seed)
    start = time.process_time()
    try:
        disk = map_to_disk(mask)
    except CytodiskError as error:
        seconds = time.process_time() - start
        return Trial(kind, seed, int(mask.sum()), seconds, f"{type(error).__name__}: {error}")
    seconds = time.process_time() - start
    certificate = disk.certificate
    pixels = np.argwhere(disk.mask).astype(np.float64)
    uv = disk.to_disk(pixels)
    lost = ~np.isfinite(uv).all(axis=1)
    back = disk.to_cell(uv[~lost])
    away = np.abs(back - pixels[~lost])
    fine = seed % _FINE_EVERY == 0 and disk.mask.sum() >= _FINE_PIXELS
    empty, sum_error = check_windows(disk, _FINE_GRIDS if fine else _GRIDS)
    return Trial(
        kind,
        seed,
        int(mask.sum()),
        seconds,
        valid=certificate.valid,
        flips=len(certificate.flipped_in_cell) + len(certificate.flipped_in_disk),
        lost=int(lost.sum()),
        round_trip=float(np.where(np.isnan(away), np.inf, away).max(initial=0.0)),
        converged=disk.converged,
        empty=empty,
        sum_error=sum_error,
        fine=bool(fine),
    )


def print_table(trials: Sequence[Trial]) -> None:
    """Print a row per kind and a last row for all."""
    print(
        f"{'kind':<14}{'masks':>7}{'max px':>8}{'refused':>9}{'invalid':>9}{'flips':>7}{'lost px':>9}"
        f"{'round trip px':>15}{'empty':>7}{'sums off by':>13}"
        f"{'median s':>10}{'max s':>8}{'not converged':>15}"
    )
    for kind in (*KINDS, "all"):
        rows = [trial for trial in trials if kind in (trial.kind, "all")]
        if not rows:
            continue
        mapped = [trial for trial in rows if not trial.refused]
        seconds = [trial.seconds for trial in rows]
        print(
            f"{kind:<14}{len(rows):>7}{max(trial.pixels for trial in rows):>8}{len(rows) - len(mapped):>9}"
            f"{sum(not trial.valid for trial in mapped):>9}{sum(trial.flips for trial in mapped):>7}"
            f"{sum(trial.lost for trial in mapped):>9}"
            f"{max((trial.round_trip for trial in mapped), default=np.nan):>15.1e}"
            f"{sum(trial.empty for trial in mapped):>7}"
            f"{max((trial.sum_error for trial in mapped), default=np.nan):>13.1e}"
            f"{np.median(seconds):>10.4f}{max(seconds):>8.3f}"
            f"{sum(not trial.converged for trial in mapped):>15}"
        )


def print_failures(trials: Sequence[Trial], shown: int = 20) -> None:
    """Print why masks were refused, and the first that failed or did not converge, with their seeds."""
    failures = [trial for trial in trials if trial.failed]
    for reason, count in Counter(trial.refused for trial in failures if trial.refused).most_common(shown):
        print(f"refused {count} times: {reason}")
    for trial in failures[:shown]:
        print(f"failed: random_mask({trial.kind!r}, {trial.seed}): {trial}")
    slow = [trial for trial in trials if not (trial.refused or trial.converged)]
    for trial in slow[:shown]:
        print(f"not converged: random_mask({trial.kind!r}, {trial.seed})")


def run(jobs: Sequence[tuple[str, int]], results: Path | None, workers: int) -> Iterator[Trial]:
    """Trials of all jobs: those in the file of results, then the others, which are written there."""
    stored = StoredTrials(results, Path(cd.__file__).parent)
    done = {(row["kind"], row["seed"]): Trial(**row) for row in stored.read()}
    yield from (done[job] for job in jobs if job in done)
    left = [job for job in jobs if job not in done]
    if done:
        print(f"{len(jobs) - len(left)} of {len(jobs)} masks stand in {results}", file=sys.stderr, flush=True)
    if not left:
        return
    with ProcessPoolExecutor(workers) as pool, stored.writing() as write:
        for trial in pool.map(try_mask, *zip(*left, strict=True), chunksize=10):
            write(trial)
            yield trial


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=20_000, help="masks in all (default 20000)")
    parser.add_argument("--seed", type=int, default=0, help="first seed (default 0)")
    parser.add_argument("--results", type=Path, help="file of results: go on with what is missing in it")
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    arguments = parser.parse_args()
    os.environ.update(dict.fromkeys(THREADS, "1"))
    jobs = [(KINDS[n % len(KINDS)], arguments.seed + n // len(KINDS)) for n in range(arguments.count)]
    trials = list(run(jobs, arguments.results, arguments.workers))
    print_table(trials)
    failures = [trial for trial in trials if trial.failed]
    print_failures(trials)
    fine = sum(trial.fine for trial in trials)
    print(f"{len(trials)} masks, {fine} of them with 100 × 200 windows, too; {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

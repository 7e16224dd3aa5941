"""Map many random masks and check every map: valid certificate, no flip, no pixel lost, exact inverse.

Prints a table with a row per kind; ends with status 1 if any mask failed or was refused.
"""

import argparse
import sys
import time
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np

from cytodisk.disk.mapping import map_to_disk
from cytodisk.errors import CytodiskError
from cytodisk.simulate.random_masks import KINDS, random_mask

_ROUND_TRIP_PX = 1e-6


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

    @property
    def failed(self) -> bool:
        """True unless the mask was mapped and every check held."""
        good = self.valid and not self.flips and not self.lost and self.round_trip < _ROUND_TRIP_PX
        return bool(self.refused) or not good


def try_mask(kind: str, seed: int) -> Trial:
    """Map one random mask and check the map."""
    mask = random_mask(kind, seed)
    start = time.perf_counter()
    try:
        disk = map_to_disk(mask)
    except CytodiskError as error:
        return Trial(
            kind, seed, int(mask.sum()), time.perf_counter() - start, f"{type(error).__name__}: {error}"
        )
    seconds = time.perf_counter() - start
    certificate = disk.certificate
    pixels = np.argwhere(disk.mask).astype(np.float64)
    uv = disk.to_disk(pixels)
    lost = ~np.isfinite(uv).all(axis=1)
    back = disk.to_cell(uv[~lost])
    away = np.abs(back - pixels[~lost])
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
    )


def print_table(trials: Sequence[Trial]) -> None:
    """Print a row per kind and a last row for all."""
    print(
        f"{'kind':<14}{'masks':>7}{'max px':>8}{'refused':>9}{'invalid':>9}{'flips':>7}{'lost px':>9}"
        f"{'round trip px':>15}{'median s':>10}{'max s':>8}{'not converged':>15}"
    )
    for kind in (*KINDS, "all"):
        rows = [trial for trial in trials if kind in (trial.kind, "all")]
        mapped = [trial for trial in rows if not trial.refused]
        seconds = [trial.seconds for trial in rows]
        print(
            f"{kind:<14}{len(rows):>7}{max(trial.pixels for trial in rows):>8}{len(rows) - len(mapped):>9}"
            f"{sum(not trial.valid for trial in mapped):>9}{sum(trial.flips for trial in mapped):>7}"
            f"{sum(trial.lost for trial in mapped):>9}"
            f"{max((trial.round_trip for trial in mapped), default=np.nan):>15.1e}"
            f"{np.median(seconds):>10.4f}{max(seconds):>8.3f}"
            f"{sum(not trial.converged for trial in mapped):>15}"
        )


def print_failures(failures: Sequence[Trial], shown: int = 20) -> None:
    """Print why masks were refused, and the first failures with the seed that makes them again."""
    for reason, count in Counter(trial.refused for trial in failures if trial.refused).most_common(shown):
        print(f"refused {count} times: {reason}")
    for trial in failures[:shown]:
        print(f"failed: random_mask({trial.kind!r}, {trial.seed}): {trial}")


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=10_000, help="masks in all (default 10000)")
    parser.add_argument("--seed", type=int, default=0, help="first seed (default 0)")
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    arguments = parser.parse_args()
    kinds = [KINDS[n % len(KINDS)] for n in range(arguments.count)]
    seeds = [arguments.seed + n // len(KINDS) for n in range(arguments.count)]
    with ProcessPoolExecutor(arguments.workers) as pool:
        trials = list(pool.map(try_mask, kinds, seeds, chunksize=50))
    print_table(trials)
    failures = [trial for trial in trials if trial.failed]
    print_failures(failures)
    print(f"{len(trials)} masks, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

"""Map many random cells with a nucleus and check every map: certificate, flips, inverse, windows, sums.

    benchmarks/random_nuclei.py [--count N] [--results FILE]

Every pixel must be mapped into its own compartment. No window of a grid of 8 layers of cytoplasm and 3 of
nucleus, 60 sectors, may be empty, and areas and intensities of the windows must sum to those of nucleus and
cytoplasm; one in twenty of the cells of at least 500 px is also divided into 60 + 20 layers and 200 sectors.
One map in four gives the nucleus the radius of its own area. With `--results`, every pair is written to the
file, and a run that was stopped goes on where it was; a file of another version of the package is refused.
Prints a table with a row for each kind of cell and of nucleus; ends with status 1 if any pair failed or was
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
from checked_windows import SUM_ERROR, check_compartments
from cytodisk.errors import CytodiskError
from cytodisk.simulate import PAIR_CELLS, PAIR_NUCLEI, random_pair, random_pair_kinds
from stored_trials import StoredTrials
from suite import THREADS

ROUND_TRIP_PX = 1e-6
_GRID, _FINE_GRID = (8, 60, 3), (60, 200, 20)
_FINE_EVERY, _FINE_PIXELS = 20, 500
_OWN_RADIUS_EVERY = 4
_RANDOM_POINTS = 500


@dataclass(frozen=True)
class Trial:
    """What one random pair came to."""

    seed: int
    pixels: int
    nucleus_pixels: int
    seconds: float
    own_radius: bool
    refused: str = ""
    valid: bool = False
    faults: str = ""
    flips: int = 0
    lost: int = 0
    astray: int = 0
    round_trip: float = np.nan
    converged: bool = False
    empty: int = 0
    sum_error: float = np.nan
    fine: bool = False

    @property
    def kinds(self) -> tuple[str, str]:
        """Of the cell and of the nucleus."""
        return random_pair_kinds(self.seed)

    @property
    def failed(self) -> bool:
        """True unless the pair was mapped and every check held."""
        wrong = self.refused or not self.valid or self.flips or self.lost or self.astray or self.empty
        return bool(wrong) or not self.round_trip < ROUND_TRIP_PX or not self.sum_error <= SUM_ERROR


def try_pair(seed: int) -> Trial:
    """Map one random pair and check the map."""
    mask, nucleus = random_pair(seed)
    own_radius = seed // len(PAIR_CELLS) // len(PAIR_NUCLEI) % _OWN_RADIUS_EVERY == _OWN_RADIUS_EVERY - 1
    sizes = int(mask.sum()), int(nucleus.sum())
    start = time.process_time()
    try:
        disk = cd.map_to_disk(mask, nucleus=nucleus, nucleus_radius="area" if own_radius else 0.5)
    except CytodiskError as error:
        seconds = time.process_time() - start
        return Trial(seed, *sizes, seconds, own_radius, f"{type(error).__name__}: {error}")
    seconds = time.process_time() - start
    fine = seed % _FINE_EVERY == 0 and mask.sum() >= _FINE_PIXELS
    try:
        empty, sum_error = check_compartments(disk, (_GRID, _FINE_GRID) if fine else (_GRID,))
    except CytodiskError as error:
        return Trial(seed, *sizes, seconds, own_radius, f"windows: {type(error).__name__}: {error}")
    certificate = disk.certificate
    lost, astray, round_trip = check_points(disk, np.random.default_rng([23, seed]))
    return Trial(
        seed,
        *sizes,
        seconds,
        own_radius,
        valid=certificate.valid,
        faults="; ".join(certificate.faults),
        flips=len(certificate.flipped_in_cell) + len(certificate.flipped_in_disk),
        lost=lost,
        astray=astray,
        round_trip=round_trip,
        converged=disk.converged,
        empty=empty,
        sum_error=sum_error,
        fine=bool(fine),
    )


def check_points(disk: cd.DiskMap, random: np.random.Generator) -> tuple[int, int, float]:
    """Pixels that are not mapped, those mapped into the other compartment, and the round trip's error in px.

    The round trip is made by all pixel centres and by random points of the cell.
    """
    pixels = np.argwhere(disk.mask)
    uv = disk.to_disk(pixels)
    mapped = np.isfinite(uv).all(axis=1)
    inside = disk.nucleus.mask[tuple(pixels.T)]
    in_circle = np.hypot(*uv.T) <= disk.nucleus.radius
    points = random.choice(pixels, _RANDOM_POINTS) + random.uniform(-0.5, 0.5, (_RANDOM_POINTS, 2))
    points_uv = disk.to_disk(points)
    within = np.isfinite(points_uv).all(axis=1)  # the others lie between the outline and a pixel's corner
    start = np.concatenate([pixels[mapped], points[within]])
    back = disk.to_cell(np.concatenate([uv[mapped], points_uv[within]]))
    away = np.abs(back - start)
    error = np.where(np.isnan(away), np.inf, away).max(initial=0.0)
    return int((~mapped).sum()), int((mapped & (inside != in_circle)).sum()), float(error)


def print_table(trials: Sequence[Trial]) -> None:
    """Print a row for each kind of cell and of nucleus, and a last row for all."""
    print(
        f"{'cell':<10}{'nucleus':<11}{'pairs':>7}{'nucleus/cell':>14}{'refused':>9}{'invalid':>9}{'flips':>7}"
        f"{'lost px':>9}{'astray':>8}{'round trip px':>15}{'empty':>7}{'sums off by':>13}"
        f"{'median s':>10}{'max s':>8}{'not converged':>15}"
    )
    kinds = [(cell, nucleus) for cell in PAIR_CELLS for nucleus in PAIR_NUCLEI]
    for kind in (*kinds, ("all", "")):
        rows = [trial for trial in trials if kind in (trial.kinds, ("all", ""))]
        if not rows:
            continue
        mapped = [trial for trial in rows if not trial.refused]
        seconds = [trial.seconds for trial in rows]
        shares = [trial.nucleus_pixels / trial.pixels for trial in rows]
        print(
            f"{kind[0]:<10}{kind[1]:<11}{len(rows):>7}{f'{min(shares):.2f} to {max(shares):.2f}':>14}"
            f"{len(rows) - len(mapped):>9}{sum(not trial.valid for trial in mapped):>9}"
            f"{sum(trial.flips for trial in mapped):>7}{sum(trial.lost for trial in mapped):>9}"
            f"{sum(trial.astray for trial in mapped):>8}"
            f"{max((trial.round_trip for trial in mapped), default=np.nan):>15.1e}"
            f"{sum(trial.empty for trial in mapped):>7}"
            f"{max((trial.sum_error for trial in mapped), default=np.nan):>13.1e}"
            f"{np.median(seconds):>10.4f}{max(seconds):>8.3f}"
            f"{sum(not trial.converged for trial in mapped):>15}"
        )


def print_failures(trials: Sequence[Trial], shown: int = 20) -> None:
    """Print why pairs were refused, and the first that failed or did not converge, with their seeds."""
    failures = [trial for trial in trials if trial.failed]
    for reason, count in Counter(trial.refused for trial in failures if trial.refused).most_common(shown):
        print(f"refused {count} times: {reason}")
    for trial in failures[:shown]:
        print(f"failed: random_pair({trial.seed}): {trial}")
    slow = [trial for trial in trials if not (trial.refused or trial.converged)]
    for trial in slow[:shown]:
        print(f"not converged: random_pair({trial.seed})")


def run(seeds: Sequence[int], results: Path | None, workers: int) -> Iterator[Trial]:
    """Trials of all seeds: those in the file of results, then the others, which are written there."""
    stored = StoredTrials(results, Path(cd.__file__).parent)
    done = {row["seed"]: Trial(**row) for row in stored.read()}
    yield from (done[seed] for seed in seeds if seed in done)
    left = [seed for seed in seeds if seed not in done]
    if done:
        print(f"{len(seeds) - len(left)} of {len(seeds)} stand in {results}", file=sys.stderr, flush=True)
    if not left:
        return
    with ProcessPoolExecutor(workers) as pool, stored.writing() as write:
        for trial in pool.map(try_pair, left, chunksize=10):
            write(trial)
            yield trial


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=20_000, help="pairs in all (default 20000)")
    parser.add_argument("--seed", type=int, default=0, help="first seed (default 0)")
    parser.add_argument("--results", type=Path, help="file of results: go on with what is missing in it")
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    arguments = parser.parse_args()
    os.environ.update(dict.fromkeys(THREADS, "1"))
    seeds = range(arguments.seed, arguments.seed + arguments.count)
    trials = list(run(seeds, arguments.results, arguments.workers))
    print_table(trials)
    failures = [trial for trial in trials if trial.failed]
    print_failures(trials)
    fine = sum(trial.fine for trial in trials)
    layers, sectors, inner = _FINE_GRID
    print(
        f"{len(trials)} pairs, {fine} of them with {layers} + {inner} layers of {sectors} sectors, too; "
        f"{len(failures)} failures"
    )
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

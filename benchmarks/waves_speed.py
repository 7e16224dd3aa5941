"""Speed and direction that `edge_waves` finds of waves that are known.

    benchmarks/waves_speed.py [--trials 100] [--surrogates 19]

Waves that run or stand along an edge of 60 µm, of random speed (0.05 to 2 µm/s), direction, mode (1 to 4),
sectors (12, 24 or 60) and frames per period (8 to 20), with as many periods as the row says and up to a
fifth more, and noise of 0.3 to 1 times the wave's standard deviation: with equal sectors, unequal ones of
known length, and a cell that turns while sectors do not. Prints for each: the share of the waves whose
speed is within 10 % (of a standing wave: the period), whose mode is right, and whose direction is (from −1
to 1) within 0.1 of the truth, the median error of the speed, and the share with p ≤ 0.05 and the right
kind. Ends with status 1 unless all speeds and directions are within 10 % in 95 % of the trials of each row.
"""

import argparse
import sys
import warnings
from collections.abc import Iterator

import numpy as np

import cytodisk as cd
from waves_cases import FIRST_SEED, WaveCase, random_case

ROWS = [
    (kind, way, periods, noise)
    for kind, way in (
        ("running", "equal"),
        ("running", "unequal"),
        ("running", "turns"),
        ("standing", "equal"),
    )
    for periods in (1.5, 2.0, 3.0, 6.0)
    for noise in (0.3, 1.0)
]
HEAD = (
    "| wave | sectors | periods | noise | speed ± 10 % | mode | direction ± 0.1 | median error | kind and p |"
)


def measured(case: WaveCase, surrogates: int) -> tuple[bool, bool, bool, float, bool]:
    """Whether speed, mode and direction are right, the error of the speed, and whether p and kind are."""
    values, edge, speed = case.series()
    found = cd.edge_waves(values, case.interval, edge, surrogates=surrogates, seed=case.seed)
    is_running = case.kind == "running"
    wanted = abs(speed) if is_running else case.speed
    error = abs(abs(found["speed_um_s"].item()) / wanted - 1.0) if found["mode"] > 0 else np.inf
    truth = np.sign(speed)
    direction = abs(found["direction"].item() - truth) <= 0.1
    kind = found["kind"].item() == ("rotating" if is_running else "standing")
    return error <= 0.1, found["mode"].item() == case.mode, direction, error, kind


def rows(trials: int, surrogates: int) -> Iterator[tuple[str, bool]]:
    """Lines of the table, and whether each is as it must be."""
    for number, (kind, way, periods, noise) in enumerate(ROWS):
        seeds = range(FIRST_SEED + 10_000 * number, FIRST_SEED + 10_000 * number + trials)
        found = np.array(
            [measured(random_case(kind, periods, noise, way, seed), surrogates) for seed in seeds]
        )
        speed, mode, direction, _, right = found.mean(axis=0)
        cells = [kind, way, f"{periods:g}", f"{noise:g}", f"{speed:.3f}", f"{mode:.3f}", f"{direction:.3f}"]
        cells += [f"{np.median(found[:, 3]):.2%}", f"{right:.3f}"]
        yield f"| {' | '.join(cells)} |", min(speed, direction) >= 0.95


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--trials", type=int, default=100, help="of each row (default 100)")
    parser.add_argument("--surrogates", type=int, default=19, help="of each movie (default 19)")
    chosen = parser.parse_args()
    warnings.simplefilter("error")
    print(HEAD)
    print("|" + "---|" * (HEAD.count("|") - 1))
    met = []
    for line, is_met in rows(chosen.trials, chosen.surrogates):
        print(line + ("" if is_met else " NO"), flush=True)
        met.append(is_met)
    return 0 if all(met) else 1


if __name__ == "__main__":
    sys.exit(main())

"""How often `edge_waves` finds a wave in noise, and whether its score of order knows how long a movie is.

    benchmarks/waves_null.py [--trials 1000] [--surrogates 39] [--noise NAME ...] [--sectors 36]

Noise that is white, autoregressive, slow, or oscillates in each sector by itself, noise in which neighbours
are alike, and bursts at random times and places: the share of movies with p ≤ 0.05, with three standard
errors, beside 0.03 to 0.07. Then, of each noise, the scores of order of movies of 150 s and of 900 s at 2 s
a frame: their medians, and the p of a Kolmogorov–Smirnov test. Ends with status 1 if a rate is not
within 0.03 to 0.07 and three standard errors, or medians differ by more than 0.25.
"""

import argparse
import sys

import numpy as np
from numpy.typing import NDArray
from scipy.stats import ks_2samp

import cytodisk as cd
from waves_cases import BURSTS, FIRST_SEED, NOISES, noise

SHORT, LONG = 75, 450  # frames of 2 s: 150 and 900 s
LOW, HIGH = 0.03, 0.07
SHIFT = 0.25  # of the medians, in standard deviations of movies without a wave


def tested(name: str, frames: int, sectors: int, trials: int, surrogates: int) -> NDArray[np.float64]:
    """p and order of movies without a wave, shape (trials, 2)."""
    found = []
    for seed in range(FIRST_SEED, FIRST_SEED + trials):
        wave = cd.edge_waves(noise(name, seed, frames, sectors), 2.0, surrogates=surrogates, seed=seed)
        found.append((wave["p"].item(), wave["order"].item()))
    return np.array(found)


def rate_line(name: str, frames: int, p: NDArray[np.float64]) -> tuple[str, bool]:
    """Line of the table of rates."""
    rate, error = float((p <= 0.05).mean()), float(np.sqrt(0.05 * 0.95 / len(p)))
    is_met = LOW - 3.0 * error <= rate <= HIGH + 3.0 * error
    return (
        f"| {name} | {2 * frames} | {len(p)} | {rate:.3f} ± {3 * error:.3f} | {'yes' if is_met else 'NO'} |",
        is_met,
    )


def length_line(name: str, short: NDArray[np.float64], long: NDArray[np.float64]) -> tuple[str, bool]:
    """Line of the table of lengths."""
    medians = [float(np.median(order)) for order in (short, long)]
    p = float(ks_2samp(short, long).pvalue)
    is_met = abs(medians[0] - medians[1]) <= SHIFT
    return f"| {name} | {medians[0]:.2f} | {medians[1]:.2f} | {p:.3f} | {'yes' if is_met else 'NO'} |", is_met


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--trials", type=int, default=1000, help="movies of each noise (default 1000)")
    parser.add_argument("--long-trials", type=int, default=200, help="movies of 900 s (default 200)")
    parser.add_argument("--surrogates", type=int, default=39, help="of each movie (default 39)")
    parser.add_argument("--sectors", type=int, default=36, help="(default 36)")
    parser.add_argument(
        "--noise", nargs="+", default=[*NOISES, BURSTS], choices=[*NOISES, BURSTS], help="(default all)"
    )
    chosen = parser.parse_args()
    met, orders = [], {}
    print("| noise | seconds | movies | p ≤ 0.05 | 0.03 to 0.07? |\n|---|---|---|---|---|")
    for name in chosen.noise:
        for frames, trials in ((SHORT, chosen.trials), (LONG, chosen.long_trials)):
            found = tested(name, frames, chosen.sectors, trials, chosen.surrogates)
            orders[name, frames] = found[:, 1]
            line, is_met = rate_line(name, frames, found[:, 0])
            print(line, flush=True)
            met.append(is_met)
    print("\n| noise | median order, 150 s | 900 s | p of KS | medians alike? |\n|---|---|---|---|---|")
    for name in chosen.noise:
        line, is_met = length_line(name, orders[name, SHORT], orders[name, LONG])
        print(line)
        met.append(is_met)
    return 0 if all(met) else 1


if __name__ == "__main__":
    sys.exit(main())

"""How much of a planted region max-T finds, by how much windows share their standard error.

    benchmarks/population_statistic.py [--studies 40] [--first-seed 0]

Studies of 12 cells in each experiment with a tenth of the variance between experiments, in 10 × 60 windows of
which 30 are raised by 1, 1.5 and 2 standard deviations of a cell in that window; windows that vary alike,
and windows whose standard deviations lie anywhere within a factor of 10. Prints the share of the region that
is found at .05 and the share of studies with a window found outside: with the error of each window alone (0),
averaged with that of all windows (0.5, what `compare_conditions` does), and with that of all windows alone
(1), each by step-down max-T, and with 0 by single steps.
"""

import argparse
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

LAYERS, SECTORS, CELLS, BETWEEN = 10, 60, 12, 0.1
WAYS = (("0, single step", 0.0, False), ("0", 0.0, True), ("0.5", 0.5, True), ("1", 1.0, True))
Floats = NDArray[np.float64]


def study(experiments: int, effect: float, spread: Floats, seed: int) -> tuple[Floats, NDArray[np.bool_]]:
    """Means of experiments (units, windows), and the region."""
    rng = np.random.default_rng(seed)
    region = np.zeros((LAYERS, SECTORS), dtype=bool)
    region[:3, 10:20] = True
    deviation = np.sqrt(BETWEEN + (1.0 - BETWEEN) / CELLS)
    values = rng.normal(0.0, deviation, (2 * experiments, LAYERS * SECTORS))
    values[experiments:, region.ravel()] += effect
    return values * spread, region.ravel()


def labels_of(experiments: int) -> Floats:
    """All ways to choose the treated units, the observed one first."""
    ways = list(combinations(range(2 * experiments), experiments))
    labels = np.zeros((len(ways), 2 * experiments))
    for row, way in zip(labels, reversed(ways), strict=True):  # the last has the second half
        row[list(way)] = 1.0
    return labels


def scores(values: Floats, labels: Floats, shared: float) -> Floats:
    """Sizes of studentised differences (ways, windows)."""
    n = len(values) / 2
    values = values - values.mean(axis=0)
    total, squares = labels @ values, labels @ values**2
    within = squares - total**2 / n
    other = (values**2).sum(axis=0) - squares - total**2 / n
    error = (within + other) / (n * (n - 1))
    common = np.median((values**2).sum(axis=0) / (2 * n - 1)) * 2 / n
    return np.asarray(np.abs(2 * total / n) / np.sqrt((1 - shared) * error + shared * common))


def corrected(sizes: Floats, step_down: bool) -> Floats:
    """p of each window for all together."""
    order = np.argsort(-sizes[0])
    largest = np.maximum.accumulate(sizes[:, order[::-1]], axis=1)[:, ::-1]
    if not step_down:
        largest = np.repeat(largest[:, :1], len(order), axis=1)
    p = np.empty(len(order))
    reach = sizes[0, order] * (1 - 1e-9)
    p[order] = np.maximum.accumulate((largest >= reach).mean(axis=0))
    return p


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--studies", type=int, default=40)
    parser.add_argument("--first-seed", type=int, default=0)
    chosen = parser.parse_args()
    seeds = range(chosen.first_seed, chosen.first_seed + chosen.studies)
    print("| windows vary | experiments | effect | " + " | ".join(name for name, *_ in WAYS) + " |")
    print("|---|---|---|" + "---|" * len(WAYS))
    alike = np.ones(LAYERS * SECTORS)
    apart = 10.0 ** np.random.default_rng(0).uniform(-0.5, 0.5, LAYERS * SECTORS)
    for words, spread in (("alike", alike), ("by a factor of 10", apart)):
        for experiments in (4, 6):
            labels = labels_of(experiments)
            for effect in (1.0, 1.5, 2.0):
                found = np.zeros((2, len(WAYS)))
                for seed in seeds:
                    values, region = study(experiments, effect, spread, seed)
                    for k, (_, shared, step_down) in enumerate(WAYS):
                        hits = corrected(scores(values, labels, shared), step_down) <= 0.05
                        found[:, k] += hits[region].mean(), hits[~region].any()
                cells = " | ".join(f"{a:.2f} ({b:.2f})" for a, b in found.T / len(seeds))
                print(f"| {words} | {experiments} + {experiments} | {effect} | {cells} |", flush=True)
    print("Share of the region found, and in brackets share of studies with a window found outside.")


if __name__ == "__main__":
    main()

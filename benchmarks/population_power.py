"""How often a region that differs is found, and whether `cytodisk population --power` says so beforehand.

    benchmarks/population_power.py [--studies 200] [--cells 12] [--between 0.1] [--dishes 0.05] [--workers 1]

Simulated studies of cells of 6 × 24 windows, of which a sixth is raised by so many standard deviations of
a cell, with 3 to 8 experiments of each condition, and with 3 to 8 pairs. Each goes through
`compare_conditions`. Prints the share of the studies in which max-T finds a window of the region, and in
which a cluster at .05 holds one; beside each what `population_power` says, from other studies. Ends with
status 1 if two of them differ by more than three standard errors.
"""

import argparse
import math
import os
import sys
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np

import cytodisk as cd
from population_cases import ALPHA

EFFECTS = (0.5, 1.0, 1.5, 2.0)
SIZES = range(3, 9)
OTHER_SEED = 1_000_000  # of the studies of `population_power`


def measure(seed: int, effect: float, experiments: int, paired: bool, how: dict[str, float]) -> np.ndarray:
    """Whether a window of the region is found, and a cluster that holds one."""
    truth = cd.simulate.population(seed, effect=effect, experiments=experiments, paired=paired, **how)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = cd.compare_conditions(
            cd.Population(truth.values, truth.cells), "control", "drug", permutations=999, seed=seed
        )
    region = truth.region.to_numpy()
    windows = (found.windows["p_fwer"].squeeze() <= ALPHA).to_numpy()[region]
    sure = found.clusters.loc[found.clusters["p"] <= ALPHA, "cluster"]
    clusters = found.windows["cluster"].squeeze().isin(sure).to_numpy()[region]
    return np.array([windows.any(), clusters.any()], dtype=float)


def agree(one: float, other: float, studies: int) -> bool:
    """Whether two shares of so many studies each can be of one true share."""
    mean = 0.5 * (one + other)
    return abs(one - other) <= 3.0 * math.sqrt(2.0 * mean * (1.0 - mean) / studies)


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--studies", type=int, default=200, help="of each number (default 200)")
    parser.add_argument("--cells", type=int, default=12, help="in each condition and experiment (default 12)")
    parser.add_argument("--between", type=float, default=0.1, help="share of the variance (default 0.1)")
    parser.add_argument("--dishes", type=float, default=0.05, help="share of the variance (default 0.05)")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=1, help="processes (default 1)")
    chosen = parser.parse_args()
    os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    started, seeds = time.perf_counter(), range(chosen.first_seed, chosen.first_seed + chosen.studies)
    shares = {"cells": chosen.cells, "between_experiments": chosen.between, "between_dishes": chosen.dishes}
    said = cd.population_power(
        effects=EFFECTS, experiments=tuple(SIZES), studies=chosen.studies, seed=OTHER_SEED, **shares
    )
    grid = dict(zip(("layers", "sectors"), said.attrs["windows"], strict=True))
    said = said.set_index(["design", "experiments", "effect"])
    print("| design | smallest p | effect | window | said | cluster | said | agree? |")
    print(f"|{'---|' * 8}", flush=True)
    good = True
    with ProcessPoolExecutor(chosen.workers) as pool:
        for design, experiments, effect in said.index:
            work = partial(
                measure,
                effect=effect,
                experiments=experiments,
                paired=design == "paired",
                how=shares | grid,
            )
            window, cluster = np.mean(list(pool.map(work, seeds, chunksize=10)), axis=0)
            row = said.loc[(design, experiments, effect)]
            alike = agree(window, row["window"], chosen.studies)
            alike &= agree(cluster, row["cluster"], chosen.studies)
            good &= alike
            words = f"{experiments} pairs" if design == "paired" else f"{experiments} + {experiments}"
            print(
                f"| {words} | {row['smallest_p']:.4f} | {effect:g} sd | {window:.3f} | {row['window']:.3f} "
                f"| {cluster:.3f} | {row['cluster']:.3f} | {'yes' if alike else 'NO'} |",
                flush=True,
            )
    print(f"\n{time.perf_counter() - started:.0f} s; {'all agree' if good else 'some do NOT agree'}")
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())

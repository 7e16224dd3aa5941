"""How often a region that differs is found, by its size of effect and the number of experiments.

    benchmarks/population_power.py [--studies 200] [--cells 12] [--between 0.1] [--first-seed 0] [--workers 1]

Simulated studies of cells of 4 × 12 windows, of which a region of 2 × 4 is raised by so many standard
deviations of a cell. For 3 to 8 experiments of each condition, and for 3 to 8 pairs, prints the share of
the studies in which max-T finds a window of the region, in which a cluster at .05 holds one, and the
share of the region's windows that max-T finds; and the smallest p-value that can be reached.
"""

import argparse
import os
import sys
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np

import cytodisk as cd
from population_cases import ALPHA, LAYERS, SECTORS

EFFECTS = (0.5, 1.0, 1.5, 2.0)
SIZES = range(3, 9)


def measure(seed: int, effect: float, experiments: int, paired: bool, cells: int, share: float) -> np.ndarray:
    """A window found, a cluster found, share of windows found, smallest p."""
    truth = cd.simulate.population(
        seed,
        effect=effect,
        experiments=experiments,
        cells=cells,
        paired=paired,
        between_experiments=share,
        layers=LAYERS,
        sectors=SECTORS,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = cd.compare_conditions(
            cd.Population(truth.values, truth.cells), "control", "drug", permutations=999, seed=seed
        )
    region = truth.region.to_numpy()
    windows = (found.windows["p_fwer"].squeeze() <= ALPHA).to_numpy()[region]
    sure = found.clusters.loc[found.clusters["p"] <= ALPHA, "cluster"]
    clusters = found.windows["cluster"].squeeze().isin(sure).to_numpy()[region]
    return np.array([windows.any(), clusters.any(), windows.mean(), found.smallest_p], dtype=float)


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--studies", type=int, default=200, help="of each number (default 200)")
    parser.add_argument("--cells", type=int, default=12, help="in each condition and experiment (default 12)")
    parser.add_argument("--between", type=float, default=0.1, help="share of the variance (default 0.1)")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=1, help="processes (default 1)")
    chosen = parser.parse_args()
    os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    started, seeds = time.perf_counter(), range(chosen.first_seed, chosen.first_seed + chosen.studies)
    effects = " | ".join(f"{effect:g} sd" for effect in EFFECTS)
    print("Studies with a window by max-T / with a cluster / share of the region's windows by max-T\n")
    print(f"| design | smallest p | {effects} |\n|{'---|' * (2 + len(EFFECTS))}", flush=True)
    with ProcessPoolExecutor(chosen.workers) as pool:
        for paired in (False, True):
            for experiments in SIZES:
                cells, smallest = [], 1.0
                for effect in EFFECTS:
                    work = partial(
                        measure,
                        effect=effect,
                        experiments=experiments,
                        paired=paired,
                        cells=chosen.cells,
                        share=chosen.between,
                    )
                    *shares, smallest = np.mean(list(pool.map(work, seeds, chunksize=10)), axis=0)
                    cells.append(" / ".join(f"{share:.2f}" for share in shares))
                design = f"{experiments} pairs" if paired else f"{experiments} + {experiments}"
                print(f"| {design} | {smallest:.4f} | {' | '.join(cells)} |", flush=True)
    print(f"\n{time.perf_counter() - started:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Does a planted region come back, with its border and nothing else?

    benchmarks/population_region.py [--studies 100] [--effects 1.5 2.0] [--first-seed 0] [--workers 1]

Studies of 12 cells in each of 6 + 6 experiments, with a tenth of the variance between experiments, in 12
× 60 windows of which 120, 6 layers of 20 sectors, are raised by 1.5 and by 2 standard deviations of a
cell; once with independent windows, once with neighbours that are alike. Prints for max-T, clusters and
q (BH), each at .05:

* found: share of the region's windows;
* inside: the same without the region's outermost windows;
* outside, beyond: windows that are found outside of the region, and more than one window away from it, per
  study;
* any outside, any beyond: share of the studies that have one;
* false share: of the windows that are found, mean over studies.

Ends with status 1 unless max-T finds 90 % of the windows raised by 2 standard deviations and has a
window outside in at most 5 % of the studies, within three standard errors.
"""

import argparse
import os
import sys
import time
import warnings
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np
from scipy import ndimage

import cytodisk as cd
from population_cases import ALPHA, standard_error

LAYERS, SECTORS = 12, 60
METHODS = ("max-T", "clusters", "q")
LENGTHS = (0.0, 1.0)
TARGET = 0.9
COLUMNS = ("found", "inside", "outside", "beyond", "any outside", "any beyond", "false share")


def planted_region() -> np.ndarray:
    """Layers 0 to 5, sectors 50 to 59 and 0 to 9: it goes around sector 0."""
    region = np.zeros((LAYERS, SECTORS), dtype=bool)
    region[:6, [*range(50, 60), *range(10)]] = True
    return region


def grown(region: np.ndarray, by: int) -> np.ndarray:
    """The region with the windows around it, or for -1 without its outermost; sectors close to a ring."""
    around = np.pad(region, ((0, 0), (1, 1)), mode="wrap")
    square = np.ones((3, 3), dtype=bool)
    if by < 0:
        return ndimage.binary_erosion(around, square, border_value=1)[:, 1:-1]
    return ndimage.binary_dilation(around, square)[:, 1:-1]


def windows_of(found: cd.ConditionComparison) -> Iterator[np.ndarray]:
    """Windows (layer, sector) that each method finds."""
    single = {"layer": LAYERS, "sector": SECTORS}
    of_windows = found.windows.squeeze()
    yield (of_windows["p_fwer"] <= ALPHA).transpose(*single).to_numpy()
    sure = found.clusters.loc[found.clusters["p"] <= ALPHA, "cluster"]
    yield found.windows["cluster"].squeeze().isin(sure).transpose(*single).to_numpy()
    yield (of_windows["q"] <= ALPHA).transpose(*single).to_numpy()


def measure(seed: int, effect: float, length: float) -> np.ndarray:
    """Figures of one study, shape (methods, columns)."""
    region = planted_region()
    truth = cd.simulate.population(
        seed,
        region=region,
        effect=effect,
        experiments=6,
        cells=12,
        layers=LAYERS,
        sectors=SECTORS,
        between_experiments=0.1,
        correlation_length=length,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = cd.compare_conditions(cd.Population(truth.values, truth.cells), "control", "drug", seed=seed)
    near, inner = grown(region, 1), grown(region, -1)
    rows = []
    for windows in windows_of(found):
        outside, beyond = (windows & ~region).sum(), (windows & ~near).sum()
        false = outside / max(windows.sum(), 1)
        shares = windows[region].mean(), windows[inner].mean()
        rows.append([*shares, outside, beyond, outside > 0, beyond > 0, false])
    return np.array(rows, dtype=float)


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--studies", type=int, default=100, help="of each effect (default 100)")
    parser.add_argument("--effects", type=float, nargs="+", default=[1.5, 2.0])
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=1, help="processes (default 1)")
    chosen = parser.parse_args()
    os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    print(f"| neighbours | effect | by | {' | '.join(COLUMNS)} |\n|{'---|' * (3 + len(COLUMNS))}", flush=True)
    good, started = True, time.perf_counter()
    seeds = range(chosen.first_seed, chosen.first_seed + chosen.studies)
    with ProcessPoolExecutor(chosen.workers) as pool:
        for length in LENGTHS:
            for effect in chosen.effects:
                work = partial(measure, effect=effect, length=length)
                means = np.mean(list(pool.map(work, seeds, chunksize=5)), axis=0)
                for method, row in zip(METHODS, means, strict=True):
                    words = " | ".join(f"{value:.3f}" for value in row)
                    print(
                        f"| {'alike' if length else 'apart'} | {effect:g} | {method} | {words} |", flush=True
                    )
                most = ALPHA + 3.0 * standard_error(ALPHA, chosen.studies)
                good &= means[0, 4] <= most and (effect < 2.0 or means[0, 0] >= TARGET)
    print(
        f"\n{time.perf_counter() - started:.0f} s; {'the target is met' if good else 'the target is MISSED'}"
    )
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())

"""Conditions whose experiments differ in spread, not in mean: how often is a difference found, and warned of?

    benchmarks/population_spread.py [--studies 300] [--first-seed 0]

Means of experiments in 4 × 12 windows, neighbours alike, drawn around one mean; those of the drug vary 1, 2
and 4 times as much. Prints the share of studies in which max-T finds a window at .05, and the share with the
warning "unequal spread" of `compare_conditions`.
"""

import argparse

import numpy as np
import pandas as pd
import xarray as xr

import cytodisk as cd

SIZES = ((6, 6), (5, 5), (8, 4), (4, 8))
SPREADS = (1.0, 2.0, 4.0)
LAYERS, SECTORS = 4, 12


def study(sizes: tuple[int, int], paired: bool, spread: float, seed: int) -> cd.Population:
    """One cell for each experiment."""
    rng = np.random.default_rng(seed)
    noise = rng.normal(size=(sum(sizes), LAYERS, SECTORS))
    values = (noise + np.roll(noise, 1, -1) + np.roll(noise, -1, -1)) / np.sqrt(3.0)
    values[sizes[0] :] *= spread
    names = [f"day {k}" for k in range(sum(sizes))]
    if paired:
        names = names[: sizes[0]] * 2
    cells = pd.DataFrame({"condition": np.repeat(["control", "drug"], sizes), "experiment": names})
    return cd.Population(xr.DataArray(values, dims=("cell", "layer", "sector"), name="Rac1"), cells)


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--studies", type=int, default=300)
    parser.add_argument("--first-seed", type=int, default=0)
    chosen = parser.parse_args()
    print("| design | spread of the drug | max-T | warned |\n|---|---|---|---|")
    for sizes, paired in (*((sizes, False) for sizes in SIZES), ((7, 7), True)):
        for spread in SPREADS:
            found = warned = 0
            for seed in range(chosen.first_seed, chosen.first_seed + chosen.studies):
                pop = study(sizes, paired, spread, seed)
                result = cd.compare_conditions(pop, "control", "drug", permutations=999, seed=seed)
                found += bool((result.windows["p_fwer"] <= 0.05).any())
                warned += any(one.name == "unequal spread" for one in result.warnings)
            design = f"{sizes[0]} pairs" if paired else f"{sizes[0]} + {sizes[1]}"
            shares = f"{found / chosen.studies:.3f} | {warned / chosen.studies:.3f}"
            print(f"| {design} | × {spread:g} | {shares} |", flush=True)


if __name__ == "__main__":
    main()

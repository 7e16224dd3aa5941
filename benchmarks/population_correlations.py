"""Pooled correlation curves: how often they are found where there is a coupling, and where there is none.

    benchmarks/population_correlations.py [--studies 200] [--first-seed 0]

Series of signal and velocity of 2 layers × 8 sectors in 60 frames (autoregressive, .8 from frame to frame),
6 cells in each of 6 or 8 experiments. "no coupling": independent. "dishes differ": each experiment has a
coupling of its own in layer 0, r of mean 0 and standard deviation .1, so that cells of a dish are alike by
chance. "coupled": in layer 0 velocity and signal 3 frames apart correlate, with a mean r of .3 and the same
spread. Each cell gives a curve by layer; `pool_curves` tests the mean over experiments and, for comparison,
the mean over cells as if they were independent.

Prints the share of studies with any layer and lag at p_fwer ≤ .05, and for "coupled" the share whose peak is
at the known layer and lag. Then the same between two conditions of 6 experiments each, both coupled alike,
and one without coupling. Ends with status 1 if a null case is more than three standard errors above what can
be attained, or a coupling is found at its place in fewer than 60 % (6 experiments) or 90 % (8) of studies.
"""

import argparse
import sys
import warnings
from collections import Counter
from collections.abc import Iterator

import numpy as np
import pandas as pd
import xarray as xr

import cytodisk as cd
from cytodisk.runs.population.correlations.peak_words import LEVEL, strongest
from cytodisk.runs.population.correlations.pooled_curves import pool_curves
from cytodisk.runs.population.pooling.pool_parameters import PoolParameters

NAMES, LAG, MAX_LAG = ("signal", "velocity"), 3, 8
BETWEEN = 6  # experiments of each of two conditions
CELLS, FRAMES, LAYERS, SECTORS = 6, 60, 2, 8
SPREAD, COUPLING = 0.1, 0.3
POWER = {6: 0.6, 8: 0.9}  # wanted
ATTAINED = {6: 2 / 64, 8: 12 / 256}
"""Largest level up to .05 that so many experiments can attain against 0."""

PLACES = ["input", "cell", "condition", "experiment"]


def curves_of(seed: int, strength: float) -> pd.DataFrame:
    """Curves of the cells of one experiment by layer and lag; their sectors are drawn beside each other."""
    windows = np.zeros((LAYERS, CELLS * SECTORS), dtype=bool)
    windows[0] = True
    activity, velocity = cd.simulate.coupled_series(
        "ar1", seed, FRAMES, *windows.shape, lag_frames=-LAG, windows=windows, strength=abs(strength)
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cd.errors.StationarityWarning)
        found = cd.cross_correlate(
            activity, velocity * (-1.0 if strength < 0 else 1.0), MAX_LAG, surrogates=0
        )
    of_cell = xr.DataArray(np.repeat(np.arange(CELLS), SECTORS), dims="sector", name="cell")
    table = found["correlation"].groupby(of_cell).mean().to_dataframe().reset_index()
    return table.assign(lag_s=np.nan, correlation_partial=np.nan)


def cells_of(
    seed: int, experiments: int, condition: str, mean: float, spread: float
) -> Iterator[pd.DataFrame]:
    """Curves of a condition's cells."""
    rng = np.random.default_rng([seed, sum(map(ord, condition))])
    for experiment in range(experiments):
        strength = np.clip(rng.normal(mean, spread), -0.95, 0.95) if mean or spread else 0.0
        name = f"{condition} {experiment}"
        curves = curves_of(int(rng.integers(2**31)), float(strength))
        yield curves.assign(input=name, condition=condition, experiment=name)


def study(seed: int, experiments: int, *conditions: tuple[str, float, float]) -> pd.DataFrame:
    """Curves of all cells of a study."""
    parts = [one for condition in conditions for one in cells_of(seed, experiments, *condition)]
    return pd.concat(parts, ignore_index=True)


def tables_of(curves: pd.DataFrame, by_cell: bool = False) -> dict[str, pd.DataFrame]:
    """Pooled tables, with experiments as units, or cells."""
    cells = curves[PLACES].drop_duplicates(ignore_index=True)
    if by_cell:
        cells = cells.assign(experiment=cells["input"] + " " + cells["cell"].astype(str))
    return pool_curves(curves.drop(columns=PLACES[2:]), cells, NAMES, PoolParameters(permutations=999)).tables


def against_zero(first: int, studies: int, experiments: int, mean: float, spread: float) -> Counter[str]:
    """How many studies are found by experiments and by cells, and at the known place."""
    counts: Counter[str] = Counter()
    for seed in range(first, first + studies):
        curves = study(seed, experiments, ("control", mean, spread))
        peak = strongest(tables_of(curves)["pooled"])
        found = bool(peak["p_fwer"] <= LEVEL)
        counts["experiments"] += found
        counts["place"] += found and (peak["layer"], abs(peak["lag"])) == (0, LAG)
        counts["cells"] += bool((tables_of(curves, by_cell=True)["pooled"]["p_fwer"] <= LEVEL).any())
    return counts


def between(first: int, studies: int, of_drug: float) -> int:
    """How many studies find a difference between a coupled control and another condition."""
    conditions = ("control", COUPLING, SPREAD), ("drug", of_drug, SPREAD)
    found = (
        tables_of(study(seed, BETWEEN, *conditions))["comparisons"] for seed in range(first, first + studies)
    )
    return sum(bool((table["p_fwer"] <= LEVEL).any()) for table in found)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--studies", type=int, default=200)
    parser.add_argument("--first-seed", type=int, default=0)
    given = parser.parse_args()
    first, studies, met = given.first_seed, given.studies, []

    def is_level(found: int, level: float) -> bool:
        return found / studies <= level + 3.0 * np.sqrt(level * (1.0 - level) / studies)

    print(f"{studies} studies a case: share with anything at p_fwer ≤ {LEVEL:g}")
    print(f"{'against 0':16} experiments  attainable  found  at its place  cells as units: found")
    cases = {"no coupling": (0.0, 0.0), "dishes differ": (0.0, SPREAD), "coupled": (COUPLING, SPREAD)}
    for name, (mean, spread) in cases.items():
        for experiments, level in ATTAINED.items():
            counts = against_zero(first, studies, experiments, mean, spread)
            found, place, by_cell = (counts[key] / studies for key in ("experiments", "place", "cells"))
            at_place = f"{place:12.3f}" if mean else " " * 12
            print(
                f"{name:16} {experiments:11}  {level:10.3f}  {found:5.3f}  {at_place}  {by_cell:21.3f}",
                flush=True,
            )
            met.append(place >= POWER[experiments] if mean else is_level(counts["experiments"], level))
    for name, of_drug in (("both coupled alike", COUPLING), ("drug without coupling", 0.0)):
        found_between = between(first, studies, of_drug)
        print(f"{BETWEEN} + {BETWEEN} experiments, {name}: {found_between / studies:.3f}", flush=True)
        met.append(is_level(found_between, LEVEL) if of_drug else True)
    print("met" if all(met) else "not met")
    sys.exit(not all(met))


if __name__ == "__main__":
    main()

"""Waves over experiments: how often they are found where there are none, and where there are some.

    benchmarks/waves_over_experiments.py [--cells 300] [--studies 300] [--first-seed 0]

Stores of cells are made once: series of 36 sectors in 60 to 240 frames, "none", with the spectrum of waves
and no course, and "running", with noise as large as the wave. `edge_waves` gives order, period, speed,
direction and persistence of each. Studies of 3 to 8 experiments with 1 to 5 cells each are drawn from them,
and tested over experiments as `cytodisk waves BATCH` does.

Prints the share of studies whose mean order is above 0 beyond chance, without waves and with; and the share
of pairs of equal conditions of which any number differs. Ends with status 1 if a share without a cause is
more than three standard errors above the level that so many experiments can attain, or waves are found in
fewer than 80 % of studies with 6 experiments.
"""

import argparse
import sys

import numpy as np
import pandas as pd

import cytodisk as cd
from cytodisk.population.significance import LEVEL
from cytodisk.runs.population.pooling.number_population import number_population
from cytodisk.runs.population.wave_numbers.pooled_wave_numbers import ORDER, wave_numbers
from drawn_studies import attained, drawn_study, is_level

SECTORS, FRAMES, INTERVAL_S, EDGE_UM = 36, (60, 240), 5.0, 50.0
SURROGATES, NOISE = 99, 1.0
EXPERIMENTS = (3, 5, 6, 8)
POWER = 0.8  # wanted, of studies with 6 experiments
NUMBERS = ("wave_order", "wave_speed_um_s", "wave_direction", "wave_period_s", "wave_persistence_s")


def numbers_of(seed: int, kind: str) -> pd.DataFrame:
    """Numbers of the wave of one cell."""
    rng = np.random.default_rng([seed, len(kind)])
    frames, period = int(rng.integers(*FRAMES)), float(rng.uniform(60.0, 150.0))
    values = cd.simulate.wave_series(
        kind,
        seed,
        frames,
        SECTORS,
        mode=int(rng.integers(1, 4)),
        period_s=period,
        noise=NOISE,
        frame_interval_s=INTERVAL_S,
    )
    found = cd.edge_waves(
        values, frame_interval_s=INTERVAL_S, edge_length_um=EDGE_UM, surrogates=SURROGATES, seed=seed
    )
    row = {name: float(found[name]) for name in ("order", "p", "period_s", "direction", "persistence_s")}
    row |= {"speed_um_s": float(found["speed_um_s"]), "kind": found["kind"].item()}
    row |= {"cell": 0, "layer": np.nan, "status": "ok"}
    cells = pd.DataFrame([row])
    return wave_numbers(cells, cells[["cell", "layer", "order", "p"]])


def store_of(first: int, cells: int, kind: str) -> list[pd.DataFrame]:
    """Numbers of many cells."""
    return [numbers_of(first + number, kind) for number in range(cells)]


def found_waves(first: int, studies: int, experiments: int, store: list[pd.DataFrame]) -> int:
    """In how many studies the mean order is above 0 beyond chance."""
    found = 0
    for seed in range(first, first + studies):
        numbers, cells = drawn_study(
            np.random.default_rng([seed, experiments]), {"cells": (experiments, store)}
        )
        population = number_population(numbers, cells, [ORDER], "value")
        assert population is not None
        windows = cd.compare_with_zero(population, "cells", permutations=999).windows
        found += bool(((windows["p_fwer"] <= LEVEL) & (windows["difference"] > 0)).any())
    return found


def differing(first: int, studies: int, experiments: int, store: list[pd.DataFrame]) -> int:
    """In how many studies any number of two equal conditions differs."""
    found = 0
    for seed in range(first, first + studies):
        rng = np.random.default_rng([seed, experiments, 2])
        numbers, cells = drawn_study(rng, dict.fromkeys(("control", "drug"), (experiments, store)))
        population = number_population(numbers, cells, NUMBERS, "value")
        assert population is not None
        compared = cd.compare_conditions(population, "control", "drug", permutations=999)
        found += bool((compared.windows["p_fwer"] <= LEVEL).any())
    return found


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cells", type=int, default=300)
    parser.add_argument("--studies", type=int, default=300)
    parser.add_argument("--first-seed", type=int, default=0)
    given = parser.parse_args()
    first, studies, met = given.first_seed, given.studies, []
    none, running = (
        store_of(first + given.cells * k, given.cells, kind) for k, kind in enumerate(("none", "running"))
    )
    print("Share of studies with waves beyond chance\nexperiments | attainable | none  | running")
    for experiments in EXPERIMENTS:
        level = attained(experiments)
        a, b = (found_waves(first, studies, experiments, store) for store in (none, running))
        print(f"{experiments:11d} | {level:10.3f} | {a / studies:5.3f} | {b / studies:7.3f}", flush=True)
        met.append(is_level(a, studies, level))
        met.append(experiments != 6 or b >= POWER * studies)
    print("\nTwo equal conditions: share of studies in which any number differs")
    for experiments in (4, 6):
        for name, store in (("none", none), ("running", running)):
            count = differing(first, studies, experiments, store)
            print(f"{experiments} + {experiments}, {name}: {count / studies:.3f}", flush=True)
            met.append(is_level(count, studies, LEVEL))
    sys.exit(0 if all(met) else 1)


if __name__ == "__main__":
    main()

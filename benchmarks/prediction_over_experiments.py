"""Predictions over experiments: how often they are found where there are none, and where there is one.

    benchmarks/prediction_over_experiments.py [--cells 600] [--studies 400] [--first-seed 0]

Stores of cells are made once: series of a source by 2 layers × 12 sectors and of a target by 12 sectors, of
all kinds of `predicting_series` in turn, in 60 to 240 frames: "none" without a coupling, "coupled" with one
from the source's layer 0 to the target (partial correlation .15). `predict` gives each link's gain and p in
both directions. Studies of 3 to 8 experiments with 1 to 5 cells each are drawn from them; means over
experiments are tested by `compare_with_zero`, as `cytodisk predict BATCH` does.

Prints, of studies without a coupling, the share with any link and layer beyond chance, above and below 0: by
the scores of p, which the command tests, and, for comparison, by the gains themselves; then the share of
coupled studies in which the true link is found in its layer, and any other link; and the share of pairs of
equal conditions that differ. Below 0 nothing is called a prediction; scores are there more
often than gains would need, as p is on the safe side for some kinds of series. Ends with status 1 if a share
above 0 without a cause is more than three standard errors above the level that so many experiments can
attain, or the true link is found in fewer than 60 % of studies with 6 experiments, or 85 % with 8.
"""

import argparse
import sys
from collections import Counter

import numpy as np
import pandas as pd

import cytodisk as cd
from cytodisk.population.significance import LEVEL
from cytodisk.runs.population.movies.normal_score import normal_score
from cytodisk.runs.population.movies.prediction_summaries import link_name
from cytodisk.runs.population.pooling.number_population import number_population
from cytodisk.simulate.predicting.predicting_series import PREDICTING_KINDS
from drawn_studies import attained, drawn_study, is_level

LAYERS, SECTORS, FRAMES = 2, 12, (60, 240)
SURROGATES, STRENGTH = 199, 0.15
EXPERIMENTS = (3, 4, 5, 6, 8)
POWER = {6: 0.6, 8: 0.85}  # wanted
SOURCE, TARGET = "signal", "velocity"


def links_of(seed: int, coupling: str) -> pd.DataFrame:
    """Links of a cell in both directions: gain beyond chance and score by layer."""
    rng = np.random.default_rng([seed, len(coupling)])
    kind = PREDICTING_KINDS[seed % len(PREDICTING_KINDS)]
    frames = int(rng.integers(*FRAMES))
    strength = STRENGTH if coupling != "none" else 0.0
    pair = cd.simulate.predicting_series(
        kind, seed, frames, LAYERS, SECTORS, coupling=coupling, strength=strength
    )
    series = {SOURCE: pair["source"], TARGET: pair["target"]}
    parts = []
    for source, target in ((SOURCE, TARGET), (TARGET, SOURCE)):
        found = cd.predict(series[source], series[target], surrogates=SURROGATES, seed=seed)
        score = normal_score(found["p"].to_numpy(), found.attrs["surrogates"])
        gain = found["gain_excess"].to_numpy()
        parts.append(pd.DataFrame({"layer": range(LAYERS), "gain_excess": gain, "score": score}))
        parts[-1] = parts[-1].assign(channel=link_name(source, target))
    return pd.concat(parts, ignore_index=True)


def store_of(first: int, cells: int, coupling: str) -> list[pd.DataFrame]:
    """Links of many cells."""
    return [links_of(first + number, coupling) for number in range(cells)]


def beyond_chance(links: pd.DataFrame, cells: pd.DataFrame, value: str) -> pd.DataFrame:
    """Links and layers whose mean over experiments is not 0, with that mean."""
    population = number_population(links, cells, [*links["channel"].unique()], value)
    assert population is not None
    windows = cd.compare_with_zero(population, "cells", permutations=999).windows
    table = windows[["difference", "p_fwer"]].to_dataframe().reset_index()
    return table[table["p_fwer"] <= LEVEL]


def against_zero(first: int, studies: int, experiments: int, store: list[pd.DataFrame]) -> Counter[str]:
    """In how many studies something is found by scores and by gains, above and below 0, and where."""
    counts: Counter[str] = Counter()
    for seed in range(first, first + studies):
        rng = np.random.default_rng([seed, experiments])
        links, cells = drawn_study(rng, {"cells": (experiments, store)})
        for value in ("score", "gain_excess"):
            found = beyond_chance(links, cells, value)
            above = found[found["difference"] > 0]
            is_true = (above["channel"] == link_name(SOURCE, TARGET)) & (above["layer"] == 0)
            counts[f"{value} above"] += bool(len(above))
            counts[f"{value} below"] += bool((found["difference"] < 0).any())
            counts[f"{value}, true link"] += bool(is_true.any())
            counts[f"{value}, other way"] += bool((above["channel"] == link_name(TARGET, SOURCE)).any())
    return counts


def between(first: int, studies: int, experiments: int, store: list[pd.DataFrame]) -> int:
    """In how many studies two equal conditions differ in any gain."""
    found = 0
    for seed in range(first, first + studies):
        rng = np.random.default_rng([seed, experiments, 2])
        links, cells = drawn_study(rng, dict.fromkeys(("control", "drug"), (experiments, store)))
        population = number_population(links, cells, [*links["channel"].unique()], "gain_excess")
        assert population is not None
        compared = cd.compare_conditions(population, "control", "drug", permutations=999)
        found += bool((compared.windows["p_fwer"] <= LEVEL).any())
    return found


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cells", type=int, default=600)
    parser.add_argument("--studies", type=int, default=400)
    parser.add_argument("--first-seed", type=int, default=0)
    given = parser.parse_args()
    first, studies, met = given.first_seed, given.studies, []
    stores = {
        "none": store_of(first, given.cells, "none"),
        "one way": store_of(first + given.cells, given.cells, "one way"),
    }
    print("No coupling: share of studies with any link and layer beyond chance")
    print("experiments | attainable | score > 0 | < 0   | gain > 0 | < 0")
    for experiments in EXPERIMENTS:
        found = against_zero(first, studies, experiments, stores["none"])
        level = attained(experiments)
        names = ("score above", "score below", "gain_excess above", "gain_excess below")
        a, b, c, d = (found[name] / studies for name in names)
        print(f"{experiments:11d} | {level:10.3f} | {a:9.3f} | {b:5.3f} | {c:8.3f} | {d:5.3f}", flush=True)
        met.append(is_level(found["score above"], studies, level))
    print("\nCoupled one way: share of studies in which a link is found")
    print("experiments | true link and layer | the other way | true link by gain")
    for experiments in EXPERIMENTS:
        found = against_zero(first, studies, experiments, stores["one way"])
        names = ("score, true link", "score, other way", "gain_excess, true link")
        a, b, c = (found[name] / studies for name in names)
        print(f"{experiments:11d} | {a:19.3f} | {b:13.3f} | {c:17.3f}", flush=True)
        met.append(a >= POWER.get(experiments, 0.0))
        met.append(is_level(found["score, other way"], studies, LEVEL))
    print("\nTwo equal conditions: share of studies in which any gain differs")
    for experiments in (4, 6):
        for name, store in stores.items():
            found_between = between(first, studies // 4, experiments, store)
            print(f"{experiments} + {experiments}, {name}: {found_between / (studies // 4):.3f}", flush=True)
            met.append(is_level(found_between, studies // 4, LEVEL))
    sys.exit(0 if all(met) else 1)


if __name__ == "__main__":
    main()

"""How often `predict` finds what is not there, how often what is there, and where it fails.

    benchmarks/prediction_calibration.py [--only BLOCK …] [--case WORDS] [--pairs N] [--results FILE]
                                         [--workers 2]

All signals are simulated, from seeds on which nothing was set (from 100 000; what sets parameters takes
those below, by `--first`). Prints a Markdown table for each block:

* null: pairs that have nothing to do with each other; the share with p ≤ 0.05, of 1 000 pairs a row.
* one way: the source predicts the target with a partial correlation of 0.3 at lags 1 to 3; the share that is
  found, the share found backwards, and that in which the gain is larger in the true direction.
* given: a common driver that is given.
* failures: what fools it, or hides what is there.
* direction: noise of measurement, and two true directions: what is significant, and what of it is marked as a
  direction that noise alone may make (`weaker_direction`).
* frames: how many frames r = 0.3 needs, with 24 and 60 sectors, whose neighbours may be alike.
* ways: other nulls and tests on the same pairs, see `prediction_ways.py`.

With `--results` each pair that is done is kept, and the same command goes on where it was stopped. Ends with
status 1 if a target is missed.
"""

import argparse
import multiprocessing
import os
import sys
import warnings
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import cytodisk as cd
from cytodisk.analysis.prediction.direction_support import weaker_direction
from cytodisk.arrays import FloatArray
from figure import Figure
from honest_trials import THREADS
from prediction_cases import BLOCKS, Make, Signals, pair, unlike
from prediction_ways import WAYS, p_values
from stored_trials import StoredTrials

FIRST_SEED = 100_000
SURROGATES = 99  # p-values of exactly 0.05 and less are then 5 of 100
PAIRS = {
    "null": 1000,
    "one way": 300,
    "given": 300,
    "failures": 100,
    "direction": 100,
    "frames": 100,
    "ways": 100,
}
NAMES = ("p", "gain", "gain_reversed", "gain_excess", "effect")
_ALPHA = 0.05
_AHEAD = 16  # pairs a process takes at once
_WAY_SURROGATES = 39

WAY_CASES: dict[str, Make] = {
    "nothing: white": pair("white", coupling="none"),
    "nothing: slow": pair("slow", coupling="none"),
    "nothing: smooth": pair("smooth", coupling="none"),
    "nothing: ar1, neighbours alike": pair("ar1", coupling="none", correlation_length=5.0),
    "nothing: slow source, white target": unlike("slow", "white"),
    "nothing: smooth, one sector": pair("smooth", sectors=1, coupling="none"),
    "nothing: driver given, slow": pair("slow", give=True, coupling="common driver", strength=0.6),
    "nothing: backwards, slow": lambda seed: pair("slow", strength=0.5)(seed).back,
    "one way: ar1, r = 0.1": pair("ar1", strength=0.1),
}


@dataclass(frozen=True)
class Trial:
    """What one pair gave: p and gain in both directions, or p by each way."""

    block: str
    case: str
    seed: int
    values: dict[str, float]


def measure(job: tuple[str, str, int]) -> Trial:
    """Try one pair."""
    block, case, seed = job
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if block == "ways":
            return Trial(*job, p_values(WAY_CASES[case](seed), seed, _WAY_SURROGATES, "bic"))
        signals = BLOCKS[block][case](seed)
        values = _predicted(signals, seed, "")
        if block in ("one way", "failures", "direction"):
            values |= _predicted(signals.back, seed, "_back")
    return Trial(*job, values)


def _predicted(signals: Signals, seed: int, suffix: str) -> dict[str, float]:
    settings = {"surrogates": SURROGATES, "seed": seed} | signals.settings
    found = cd.predict(signals.source, signals.target, signals.given, **settings)
    return {f"{name}{suffix}": found[name].item() for name in NAMES}


def cases_of(block: str, words: str = "") -> dict[str, Make]:
    """Cases of a block with some words in their names."""
    every = WAY_CASES if block == "ways" else BLOCKS[block]
    return {case: make for case, make in every.items() if words in case}


def rows(block: str, trials: Sequence[Trial]) -> Iterator[list[str | Figure]]:
    """Rows of the table of a block."""
    for case in cases_of(block):
        of_case = [trial.values for trial in trials if trial.case == case]
        if not of_case:
            continue
        table = {name: np.array([values[name] for values in of_case]) for name in of_case[0]}

        def share(name: str, least: float | None = None, most: float | None = None) -> Figure:
            return Figure(name, float((table[name] <= _ALPHA).mean()), "", least, most)  # noqa: B023

        count = str(len(of_case))
        if block == "ways":
            yield [case, count, *(share(way) for way in WAYS)]
        elif block == "frames":
            yield [case, count, share("p")]
        elif block == "null":
            yield [case, count, share("p", 0.03, 0.07)]
        elif block == "direction":
            yield [case, count, *_marked(table)]
        elif block == "given":
            yield [case, count, share("p", most=0.07)]
        else:
            true = block == "one way"
            excess = Figure("gain", float(np.median(table["gain_excess"])))
            larger = float((table["gain"] > table["gain_back"]).mean())
            yield [
                case,
                count,
                share("p", 0.9 if true else None),
                share("p_back", most=0.07 if true else None),
                Figure("direction", larger, "", 0.95 if true else None),
                excess,
            ]


def _marked(table: dict[str, FloatArray]) -> Iterator[Figure]:
    """What is significant in both directions, and what is marked."""
    for end, other in (("", "_back"), ("_back", "")):
        found = table[f"p{end}"] <= _ALPHA
        gains = (f"gain{end}", f"gain{other}", f"gain_reversed{end}", f"gain_reversed{other}")
        marked = weaker_direction(*(table[name] for name in gains))
        yield Figure("found", float(found.mean()))
        yield Figure("marked", float((found & marked).mean()))


HEADS = {
    "null": ["pairs", "p ≤ 0.05 (0.03–0.07)"],
    "one way": ["pairs", "found (≥ 0.9)", "backwards (≤ 0.07)", "gain larger forwards (≥ 0.95)", "gain"],
    "given": ["pairs", "p ≤ 0.05 (≤ 0.07)"],
    "failures": ["pairs", "p ≤ 0.05", "backwards", "gain larger forwards", "gain"],
    "direction": ["pairs", "forwards", "and marked", "backwards", "and marked"],
    "frames": ["pairs", "p ≤ 0.05"],
    "ways": ["pairs", *WAYS],
}


def print_block(block: str, trials: Sequence[Trial]) -> bool:
    """Print the table of a block; whether all targets are met."""
    heads = [block, *HEADS[block]]
    print(f"\n| {' | '.join(heads)} |\n|{'---|' * len(heads)}")
    met = True
    for row in rows(block, trials):
        words = []
        for cell in row:
            missed = isinstance(cell, Figure) and cell.met is False
            met = met and not missed
            words.append(cell if isinstance(cell, str) else f"{cell.value:.3f}{' NO' if missed else ''}")
        print(f"| {' | '.join(words)} |", flush=True)
    return met


def run(chosen: argparse.Namespace, stored: StoredTrials) -> bool:
    """Try what is missing and print all tables."""
    done = [Trial(**line) for line in stored.read()]
    known = {(trial.block, trial.case, trial.seed) for trial in done}
    context = multiprocessing.get_context("spawn")
    met = True
    with stored.writing() as write, ProcessPoolExecutor(chosen.workers, context) as pool:
        for block in chosen.only:
            seeds = range(chosen.first, chosen.first + (chosen.pairs or PAIRS[block]))
            jobs = [(block, case, seed) for case in cases_of(block, chosen.case) for seed in seeds]
            missing = [job for job in jobs if job not in known]
            for number, trial in enumerate(pool.map(measure, missing, chunksize=_AHEAD), 1):
                write(trial)
                done.append(trial)
                print(f"{block}: {number}/{len(missing)}", end="\033[K\r", file=sys.stderr, flush=True)
            wanted = set(jobs)
            of_block = [one for one in done if (one.block, one.case, one.seed) in wanted]
            met = print_block(block, of_block) and met
    return met


def main() -> None:
    """Print the tables of the chosen blocks."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", nargs="+", choices=PAIRS, default=list(PAIRS))
    parser.add_argument("--case", default="", help="only cases with these words in their names")
    parser.add_argument("--pairs", type=int, help="of each case, in place of the block's number")
    parser.add_argument("--first", type=int, default=FIRST_SEED, help="first seed")
    parser.add_argument("--results", type=Path, help="file that keeps what is done")
    parser.add_argument("--workers", type=int, default=2)
    chosen = parser.parse_args()
    os.environ.update(dict.fromkeys(THREADS, "1"))
    package = Path(cd.__file__).parent / "analysis" / "prediction"
    stored = StoredTrials(chosen.results, package)
    sys.exit(0 if run(chosen, stored) else 1)


if __name__ == "__main__":
    main()

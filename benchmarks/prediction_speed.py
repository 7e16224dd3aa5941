"""How long `predict` takes on a long movie, and how much memory: against 60 s on two cores and 2 GB.

    benchmarks/prediction_speed.py [--frames 600] [--layers 10] [--sectors 60] [--surrogates 999] [--given 1]

Prints a Markdown table: without and with signals that are given. Ends with status 1 if a target is missed.
"""

import argparse
import resource
import sys
import time

import numpy as np

import cytodisk as cd
from figure import Figure

MOST_SECONDS, MOST_GB = 60.0, 2.0


def measured(frames: int, layers: int, sectors: int, surrogates: int, given: int) -> Figure:
    """Seconds that all layers take."""
    random = np.random.default_rng(0)
    source, *others = random.normal(size=(1 + given, frames, layers, sectors))
    target = random.normal(size=(frames, sectors))
    start = time.perf_counter()
    found = cd.predict(source, target, others, surrogates=surrogates)
    taken = time.perf_counter() - start
    made = found.attrs["surrogates"]
    what = f"{frames} frames × {layers * sectors} windows × {made} surrogates, {given} given"
    return Figure(what, taken, "s", most=MOST_SECONDS)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    sizes = {"frames": 600, "layers": 10, "sectors": 60, "surrogates": 999, "given": 1}
    for name, size in sizes.items():
        parser.add_argument(f"--{name}", type=int, default=size)
    chosen = parser.parse_args()
    cd.predict(*np.random.default_rng(1).normal(size=(2, 60, 6)), surrogates=19)  # what is loaded once
    size = (chosen.frames, chosen.layers, chosen.sectors, chosen.surrogates)
    figures = [measured(*size, given) for given in sorted({0, chosen.given})]
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    figures.append(Figure("memory at its peak", peak, "GB", most=MOST_GB))
    print("| what | target | measured | met? |\n|---|---|---|---|")
    for figure in figures:
        print(f"| {figure.what} | {figure.yardstick} | {figure.measured} | {'yes' if figure.met else 'NO'} |")
    sys.exit(0 if all(figure.met for figure in figures) else 1)


if __name__ == "__main__":
    main()

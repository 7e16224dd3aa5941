"""Time and memory of comparing two conditions, with many cells.

    benchmarks/population_speed.py [--cells 10000 100000] [--units experiment cell] [--permutations 9999]

Cells of 12 × 60 windows in 8 + 8 experiments, float32, in one process each. Prints the seconds of
`compare_conditions`, the process's memory before it, with the values, and at its peak. Ends with status 1 if
10 000 cells take 60 s or more, or if 100 000 need more than 2 GB; both with experiments as units.
"""

import argparse
import json
import resource
import subprocess
import sys
import time
import warnings
from pathlib import Path

import cytodisk as cd

MOST_SECONDS, MOST_MB = {10_000: 60.0}, {100_000: 2000.0}
EXPERIMENTS, LAYERS, SECTORS = 8, 12, 60


def peak_mb() -> float:
    """Most memory of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0  # Linux counts in kB


def compare(cells: int, unit: str, permutations: int) -> dict[str, float]:
    """Seconds and memory of a comparison in this process."""
    truth = cd.simulate.population(
        0,
        experiments=EXPERIMENTS,
        cells=cells // (2 * EXPERIMENTS),
        layers=LAYERS,
        sectors=SECTORS,
        precision="float32",
    )
    population = cd.Population(truth.values, truth.cells)
    before, started = peak_mb(), time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = cd.compare_conditions(population, "control", "drug", unit=unit, permutations=permutations)
    seconds = time.perf_counter() - started
    windows = int((found.windows["p_fwer"] <= 0.05).sum())
    return {"seconds": seconds, "before": before, "peak": peak_mb(), "windows": windows}


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cells", type=int, nargs="+", default=[10_000, 100_000])
    parser.add_argument("--units", nargs="+", default=["experiment", "cell"], choices=("experiment", "cell"))
    parser.add_argument("--permutations", type=int, default=9999)
    parser.add_argument("--child", action="store_true", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.child:
        print(json.dumps(compare(chosen.cells[0], chosen.units[0], chosen.permutations)))
        return 0
    print(
        "| cells | unit | s | MB before | MB at the peak | windows by max-T |\n|---|---|---|---|---|---|",
        flush=True,
    )
    good = True
    for cells in chosen.cells:
        for unit in chosen.units:
            words = ["--cells", str(cells), "--units", unit, "--permutations", str(chosen.permutations)]
            command = [sys.executable, str(Path(__file__)), "--child", *words]
            ran = subprocess.run(command, check=True, stdout=subprocess.PIPE)
            row = json.loads(ran.stdout)
            print(
                f"| {cells} | {unit} | {row['seconds']:.1f} | {row['before']:.0f} | {row['peak']:.0f} "
                f"| {row['windows']} |",
                flush=True,
            )
            if unit == "experiment":
                good &= row["seconds"] < MOST_SECONDS.get(cells, float("inf"))
                good &= row["peak"] <= MOST_MB.get(cells, float("inf"))
    print(f"\n{'both limits are held' if good else 'a limit is NOT held'}")
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())

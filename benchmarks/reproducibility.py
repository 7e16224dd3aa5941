"""Does the same place come into the same window, in two maps of nearly the same cell?

    benchmarks/reproducibility.py [--judges | --tuning] [--only NAME …] [--methods METHOD …] [--seeds A B]

Each cell is drawn, mapped, and mapped again mirrored, with 1 px of noise on its edge (each pixel beside the
edge flips with probability 0.5), turned by 17°, and drawn twice as large. 800 points inside are followed. A
row a cell and method, means over seeds: area error by triangle, 1st and 99th percentile of λ by triangle,
area error of 10 × 60 windows (mean |ln| of their areas over their mean), share of points in the same of
10 × 60 windows, and how far noise moves the places of the disk, in pixels and in percent of the cell's
diameter (median). Then, with noise, the share in the same window of other grids. A seed chooses where the
cell lies between the pixels, the points, and the noise.

With `--judges`: the five shapes with targets, ten seeds; ends with status 1 if the default method misses one.
The targets were measured at `--phase 0.3 0.3`. No default may be chosen by these shapes. With `--tuning`: all
others. Real cells are read from the folder in CYTODISK_DATA, if it is there.
"""

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from pathlib import Path
from typing import Any, get_args

import pandas as pd

from cell_outlines import Shape, judges, others, real_cells
from cytodisk.disk.mapping_parameters import MappingParameters, Method
from same_places import CHANGES, GRIDS, measure
from suite import THREADS

DATA = Path(os.environ.get("CYTODISK_DATA", Path(__file__).parents[2] / "shared" / "data"))
DEFAULT = MappingParameters().method
METHODS = tuple(method for method in get_args(Method) if method != "advection")
SEEDS, JUDGES_SEEDS = (0, 3), (0, 10)  # first, and the first that is left out
# Share of points in the same 10 × 60 window, mirrored and with noise; area error of windows, mirrored or not.
TARGETS = {
    "star": (0.90, 0.67, 0.034),
    "L": (0.96, 0.71, 0.040),
    "blob": (0.96, 0.85, 0.018),
    "comb": (0.84, 0.28, 0.110),
    "branched cell": (0.73, 0.38, 0.089),
}
_QUALITY = {
    "area_error": "|log λ|",
    "area_ratio_p1": "λ p1",
    "area_ratio_p99": "λ p99",
    "window_error_10x60": "windows",
}


def measured(
    shapes: Sequence[Shape],
    methods: Sequence[str],
    seeds: Sequence[int],
    workers: int,
    phase: tuple[float, float] | None = None,
) -> pd.DataFrame:
    """A row for each shape, method, seed and change."""
    jobs = list(product(shapes, methods, seeds, [phase]))
    with ProcessPoolExecutor(workers) as pool:
        found = list(pool.map(_measured, *zip(*jobs, strict=True)))
    return pd.DataFrame([row for rows in found for row in rows])


def _measured(
    shape: Shape, method: str, seed: int, phase: tuple[float, float] | None
) -> list[dict[str, Any]]:
    return list(measure(shape, method, seed, phase))


def means(rows: pd.DataFrame) -> Iterator[tuple[str, str, pd.DataFrame]]:
    """Shape, method, and means over seeds by change."""
    for (shape, method), some in rows.groupby(["shape", "method"], sort=False):
        yield str(shape), str(method), some.groupby("change").mean(numeric_only=True)


def print_places(rows: pd.DataFrame) -> None:
    """Both area errors and the share in the same 10 × 60 window."""
    heads = [f"{head:>9}" for head in (*_QUALITY.values(), *CHANGES, "noise px", "noise %")]
    print(f"\n{'cell':<22}{'map':<18}{''.join(heads)}")
    for shape, method, mean in means(rows):
        quality = [f"{mean[name].iloc[0]:9.3f}" for name in _QUALITY]
        same = [f"{100.0 * mean['same_10x60'][change]:8.0f}%" for change in CHANGES]
        moved = [f"{mean[name]['noise']:9.2f}" for name in ("shift_px", "shift_percent")]
        print(f"{shape:<22}{method:<18}{''.join([*quality, *same, *moved])}")
    print(f"invalid maps: {int((~rows['valid']).sum())}")


def print_grids(rows: pd.DataFrame) -> None:
    """Share in the same window with noise, by grid."""
    print(f"\nSame window with noise\n{'cell':<22}{'map':<18}" + "".join(f"{name:>9}" for name in GRIDS))
    for shape, method, mean in means(rows):
        shares = [f"{100.0 * mean[f'same_{name}']['noise']:8.0f}%" for name in GRIDS]
        print(f"{shape:<22}{method:<18}{''.join(shares)}")


def judged(rows: pd.DataFrame) -> Iterator[tuple[str, str, str, float, float, float, bool]]:
    """Shape, method, what, mean over seeds, worst seed, target, and whether the mean meets it."""
    for (shape, method), some in rows.groupby(["shape", "method"], sort=False):
        for what, target in zip(("mirrored", "noise", "windows"), TARGETS[str(shape)], strict=True):
            if what == "windows":
                values = some["window_error_10x60"]
                yield (
                    str(shape),
                    str(method),
                    what,
                    values.mean(),
                    values.max(),
                    target,
                    values.mean() <= target,
                )
            else:
                values = some.loc[some["change"] == what, "same_10x60"]
                yield (
                    str(shape),
                    str(method),
                    what,
                    values.mean(),
                    values.min(),
                    target,
                    values.mean() >= target,
                )


def print_judged(rows: pd.DataFrame) -> bool:
    """Print figures beside their targets; whether the default method meets all."""
    print(f"\n{'cell':<16}{'map':<18}{'what':<12}{'mean':>9}{'worst seed':>12}{'target':>9}")
    met = True
    for shape, method, what, mean, worst, target, good in judged(rows):
        met &= good or method != DEFAULT
        note = "" if good else "  MISSED" if method == DEFAULT else "  (missed)"
        print(f"{shape:<16}{method:<18}{what:<12}{mean:>9.4f}{worst:>12.4f}{target:>9.3f}{note}")
    return met


def chosen_shapes(which: str, data: Path, only: Sequence[str]) -> list[Shape]:
    """The shapes of a set, real cells where there are any, or those of them that are named."""
    shapes = judges() if which != "tuning" else []
    if which != "judges":
        shapes += others()
        if data.is_dir():
            shapes += real_cells(data)
        else:
            print(f"{data} does not exist, so no real cells: set CYTODISK_DATA or pass --data")
    unknown = set(only) - {shape.name for shape in shapes}
    if unknown:
        raise SystemExit(
            f"--only must name some of {', '.join(shape.name for shape in shapes)}, got {unknown}"
        )
    return [shape for shape in shapes if not only or shape.name in only]


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    sets = parser.add_mutually_exclusive_group()
    for name, words in (("judges", "the five shapes with targets"), ("tuning", "all but these")):
        sets.add_argument(f"--{name}", dest="which", action="store_const", const=name, help=words)
    parser.add_argument("--only", nargs="+", default=(), metavar="NAME", help="names of cells")
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=METHODS)
    parser.add_argument("--seeds", nargs=2, type=int, metavar=("A", "B"), help="from A to B - 1")
    parser.add_argument(
        "--phase", nargs=2, type=float, metavar=("Y", "X"), help="where cells lie between the pixels (0 to 1)"
    )
    parser.add_argument("--csv", type=Path, help="write all rows to this file, too")
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    arguments = parser.parse_args()
    which = arguments.which or "all"
    os.environ.update(dict.fromkeys(THREADS, "1"))
    first, last = arguments.seeds or (JUDGES_SEEDS if which == "judges" else SEEDS)
    if last <= first:
        parser.error("--seeds A B: B must be larger than A")
    shapes = chosen_shapes(which, arguments.data, arguments.only)
    phase = tuple(arguments.phase) if arguments.phase else None
    rows = measured(shapes, arguments.methods, range(first, last), arguments.workers, phase)
    print_places(rows)
    print_grids(rows)
    if arguments.csv:
        rows.to_csv(arguments.csv, index=False, float_format="%.5g")
    return int(not print_judged(rows)) if which == "judges" else 0


if __name__ == "__main__":
    sys.exit(main())

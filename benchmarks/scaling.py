"""How time and memory grow with outline, area, frames, cells, windows and workers, beside how fast they may.

Each point is measured in a process of its own with one thread: processor seconds (seconds by the clock for
workers), and its memory. For each series exponents are printed, the slopes of a line through the logarithms:
over all points, and with its standard error over the upper half of the range (3 points at least), where what
is paid once at every size bends it least. The verdict is on the latter: "yes" at most the limit, "within
error" if it is so less twice its error, "NO" else. The page "Scaling" is written with `--page`.
"""

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.ticker import LogLocator, NullFormatter
from scipy.stats import linregress

from cytodisk.arrays import FloatArray
from cytodisk.plot.style import MM_PER_INCH, PAPER, SINGLE_COLUMN_MM
from pages import PAGES, machine_words, write_words
from scaling_series import SERIES, Growth
from speed import THREADS

FILES = PAGES / "scaling"
LEAST_MB = 2.0  # that memory must have grown by to be fitted: below, it is what the allocator held anyway
_LEAST_POINTS = 3


@dataclass(frozen=True)
class Fit:
    """How one quantity of a series grows.

    Attributes
    ----------
    series, y, x : str
    first, last : float
        Range of x that was fitted.
    over_all, exponent, error : float
        Slope over all points; over the upper ones, with its standard error (0 for two points).
    at_most : float
    why : str
    """

    series: str
    y: str
    x: str
    first: float
    last: float
    over_all: float
    exponent: float
    error: float
    at_most: float
    why: str

    @property
    def verdict(self) -> str:
        """Whether the growth is as slow as it should be."""
        if self.exponent <= self.at_most:
            return "yes"
        return "within error" if self.exponent - 2.0 * self.error <= self.at_most else "NO"


def measure(name: str, sizes: Sequence[int]) -> list[dict[str, float]]:
    """Points of a series, each from a process of its own."""
    points = []
    for size in sizes:
        print(f"{name}: {size}", file=sys.stderr, flush=True)
        command = [sys.executable, __file__, "--point", name, str(size)]
        environment = os.environ | dict.fromkeys(THREADS, "1")
        run = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
        points.append(json.loads(run.stdout.splitlines()[-1]))
    return points


def slope(x: FloatArray, y: FloatArray) -> tuple[float, float]:
    """Exponent and its standard error of a power law through some points."""
    line = linregress(np.log(x), np.log(y))
    return float(line.slope), float(line.stderr) if len(x) > 2 else 0.0


def fit(series: str, growth: Growth, points: Sequence[Mapping[str, float]]) -> Fit | None:
    """How a quantity grows, or None if fewer than two points can be fitted."""
    x, y = (np.array([point[name] for point in points]) for name in (growth.x, growth.y))
    grown = y >= LEAST_MB if growth.y == "memory (MB)" else y > 0.0
    x, y = x[grown], y[grown]
    if len(x) < 2:
        return None
    upper = np.log(x) >= 0.5 * np.log(x[0] * x[-1]) - 1e-9
    upper[-_LEAST_POINTS:] = True
    exponent, error = slope(x[upper], y[upper])
    ends = float(x[upper][0]), float(x[-1])
    whole = slope(x, y)[0]
    return Fit(series, growth.y, growth.x, *ends, whole, exponent, error, growth.at_most, growth.why)


def fits_of(measured: Mapping[str, Sequence[Mapping[str, float]]]) -> list[Fit]:
    """Fits of all series, in order."""
    found = [
        fit(name, growth, points) for name, points in measured.items() for growth in SERIES[name].growths
    ]
    return [one for one in found if one is not None]


def print_points(name: str, points: Sequence[Mapping[str, float]]) -> None:
    """Print the numbers of a series."""
    print(f"\n{name}")
    print(pd.DataFrame(points).to_string(index=False, float_format=lambda value: f"{value:.4g}"), flush=True)


def table_of(fits: Sequence[Fit]) -> pd.DataFrame:
    """A row a fit, in words."""
    return pd.DataFrame(
        {
            "work": one.series,
            "grows": one.y,
            "with": one.x,
            "fitted from, to": " to ".join(f"{end:,.0f}".replace(",", " ") for end in (one.first, one.last)),
            "exponent": f"{one.exponent:.2f} ± {one.error:.2f}",
            "all sizes": f"{one.over_all:.2f}",
            "at most": f"{one.at_most:g}",
            "met": one.verdict,
            "because": one.why,
        }
        for one in fits
    )


def draw(measured: Mapping[str, Sequence[Mapping[str, float]]], fits: Sequence[Fit]) -> Any:
    """Time (left) and memory (right) of each series; dashed is the growth that is granted."""
    rows = [name for name in measured if "workers" not in name]
    with plt.rc_context(PAPER):
        width = SINGLE_COLUMN_MM / MM_PER_INCH
        figure, axes = plt.subplots(len(rows), 2, figsize=(width, 1.25 * len(rows)), layout="constrained")
        for pair, name in zip(axes, rows, strict=True):
            pair[0].set_title(name, loc="left", fontweight="bold")
            for ax, kinds in zip(pair, (("seconds",), ("memory (MB)", "peak (MB)")), strict=True):
                found = next(one for one in fits if one.series == name and one.y in kinds)
                draw_growth(ax, found, measured[name])
    return figure


def draw_growth(ax: Any, found: Fit, points: Sequence[Mapping[str, float]]) -> None:
    """Points of a quantity, its exponent in words, and the limit as a dashed line."""
    x, y = (np.array([point[key] for point in points]) for key in (found.x, found.y))
    ax.loglog(x, y, "o-", markersize=2.0, linewidth=0.8)
    fitted = np.array([found.first, x[-1]])
    ax.loglog(fitted, y[-1] * (fitted / x[-1]) ** found.at_most, "--", color="0.6", linewidth=0.6)
    middle, decades = np.sqrt(y.min() * y.max()), max(0.5, 0.6 * np.log10(y.max() / y.min()))
    ax.set_ylim(middle / 10.0**decades, middle * 10.0**decades)
    ax.set_xlim(0.6 * x[0], 1.7 * x[-1])
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_minor_formatter(NullFormatter())
        axis.set_major_locator(LogLocator(numticks=4))
    ax.set_xlabel(found.x)
    ax.set_ylabel("time (s)" if found.y == "seconds" else found.y)
    ax.text(0.05, 0.95, f"{found.exponent:.2f} ± {found.error:.2f}", transform=ax.transAxes, va="top")


def write_page(measured: Mapping[str, Sequence[Mapping[str, float]]], fits: Sequence[Fit]) -> None:
    """Write tables and picture of the page."""
    FILES.mkdir(parents=True, exist_ok=True)
    table_of(fits).to_csv(FILES / "exponents.csv", index=False)
    rows = [{"work": name, **point} for name, points in measured.items() for point in points]
    pd.DataFrame(rows).to_csv(FILES / "points.csv", index=False, float_format="%.4g")
    workers = pd.DataFrame(row for row in rows if "workers" in row)
    shown = workers[["work", "workers", "seconds", "frames a second", "cells a second"]]
    shown.to_csv(FILES / "workers.csv", index=False, float_format="%.3g")
    missed = [f"{f.y} of {f.series} with {f.x}" for f in fits if f.verdict == "NO" and f.x != "workers"]
    sentence = f"Grows faster than it may: {'; '.join(missed)}." if missed else "Nothing grows too fast."
    write_words(FILES / "measured.inc", [machine_words(), "", sentence])
    draw(measured, fits).savefig(FILES / "scaling.png", dpi=200)


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", action="append", choices=tuple(SERIES), help="one series; may be repeated")
    parser.add_argument("--quick", action="store_true", help="few and small sizes")
    parser.add_argument("--json", type=Path, help="write points and exponents to this file")
    parser.add_argument("--page", action="store_true", help="write tables and picture of the docs page")
    parser.add_argument("--point", nargs=2, metavar=("SERIES", "SIZE"), help="measure one point here")
    chosen = parser.parse_args()
    if chosen.point:
        print(json.dumps(SERIES[chosen.point[0]].measure(int(chosen.point[1]))))
        return 0
    if chosen.page and (chosen.only or chosen.quick):
        parser.error("--page needs all series and sizes: leave out --only and --quick")
    measured = {}
    for name in chosen.only or SERIES:
        series = SERIES[name]
        measured[name] = measure(name, series.few if chosen.quick else series.sizes)
        print_points(name, measured[name])
    fits = fits_of(measured)
    print()
    print(table_of(fits).to_string(index=False))
    if chosen.json:
        found = {"points": measured, "fits": [asdict(one) | {"met": one.verdict} for one in fits]}
        chosen.json.write_text(json.dumps(found, indent=1), encoding="utf-8")
    if chosen.page:
        write_page(measured, fits)
    return int(any(one.verdict == "NO" for one in fits))


if __name__ == "__main__":
    sys.exit(main())

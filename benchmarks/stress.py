"""Whether independent series that fool a correlation are flagged, and what helps.

Prints two Markdown tables, of series without any correlation, on seeds from 1000 on, which no threshold was
tuned on.

1. Flagged: share of movies with any stress mark, and in brackets with the mark of their own name, in percent.
   The upper rows should have one, the lower rows none: series of all autocorrelations, with a straight trend
   in both, and with bleaching of the signal.
2. False positives: share of windows with p <= 0.05 for values, for ranks, with shifted surrogates and lags as
   short as they need, for differences between frames, and after leaving out what the mark names: the frames
   of a pulse, or all that lies outside the longer calm part beside an episode; in percent, with the standard
   error over movies.

Ends with status 1 if a stress case is flagged in less than 95 %, or another in more than 5 % of the movies.
"""

import argparse
import sys
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import xarray as xr

from correlation import percent, pool, print_row
from cytodisk.analysis.correlation.cross_correlation import cross_correlate
from cytodisk.analysis.correlation.peaks import peak_correlation
from cytodisk.analysis.stress.stress_marks import StressMarks, stress_marks
from cytodisk.errors import ParameterError, StationarityWarning
from cytodisk.simulate import independent_series

ALPHA = 0.05
FIRST_SEED = 1000
FRAMES = (40, 100, 300)
GRIDS = ((1, 8), (3, 12), (10, 60))  # layers, sectors
STRESS = {
    "pulse": "common pulse",
    "restless": "restless episode",
    "rising": "variance change",
    "steady": "steady oscillation",
    "heavy tails": "heavy tails",
}
QUIET = ("white", "ar1", "slow", "smooth", "oscillating", "trend", "bleaching")
REQUIRED_QUIET = ("white", "ar1", "trend", "bleaching")
_SMALL = (3, 12)
Series = tuple[xr.DataArray, xr.DataArray]


def series_of(kind: str, seed: int, frames: int, grid: tuple[int, int]) -> Series:
    """Activity and velocity without any correlation; those with a trend are "ar1" else."""
    if kind not in ("trend", "bleaching"):
        return independent_series(kind, seed, frames, *grid)  # type: ignore[arg-type]
    activity, velocity = independent_series("ar1", seed, frames, *grid)
    time = activity["frame"] / frames
    if kind == "trend":
        return activity + 3.0 * time, velocity + 2.0 * time
    return activity + 4.0 * np.exp(-2.0 * time), velocity


def max_lag(frames: int) -> int:
    """The usual lag of `cytodisk correlate`."""
    return min(20, frames // 4)


def marked(trial: tuple[str, int, tuple[int, int], int]) -> tuple[str, ...]:
    """Stress marks of one movie."""
    kind, frames, grid, seed = trial
    marks = stress_marks(*series_of(kind, seed, frames, grid), max_lag(frames), seed=seed)
    return marks.found if marks is not None else ()


def flagged(movies: int, workers: int) -> list[str]:
    """Print how many movies have marks; what missed its figure."""
    print(f"\nMovies with a stress mark in percent, in brackets that of the case; {movies} movies a figure\n")
    heads = [f"{layers} × {sectors}, {frames} frames" for layers, sectors in GRIDS for frames in FRAMES]
    print_row(["case", *heads], head=True)
    places = [(grid, frames) for grid in GRIDS for frames in FRAMES]
    missed = []
    with pool(workers) as processes:
        for kind in (*STRESS, *QUIET):
            shown = []
            for grid, frames in places:
                trials = [(kind, frames, grid, FIRST_SEED + number) for number in range(movies)]
                found = list(processes.map(marked, trials, chunksize=8))
                share = 100.0 * float(np.mean([bool(names) for names in found]))
                own = 100.0 * float(np.mean([STRESS.get(kind) in names for names in found]))
                shown.append(f"{share:.0f} ({own:.0f})" if kind in STRESS else f"{share:.1f}")
                wrong = share < 95.0 if kind in STRESS else kind in REQUIRED_QUIET and share > 5.0
                if wrong:
                    missed.append(f"{kind}, {grid[0]} × {grid[1]}, {frames} frames: {share:.1f} %")
            print_row([kind, *shown])
    return missed


def share_of_windows(series: Series, lag: int, seed: int, **settings: Any) -> float:
    """Share of windows with p <= 0.05; NaN where the movie is too short for it."""
    try:
        found = cross_correlate(*series, lag, surrogates=199, seed=seed, **settings)
    except ParameterError:
        return np.nan
    return float((peak_correlation(found)["p"] <= ALPHA).mean())


def without_marked(series: Series, marks: StressMarks) -> Series:
    """Series without the frames of a pulse, or the longer calm part beside an episode."""
    activity, velocity = series
    frame = activity["frame"]
    if "common pulse" in marks.found:
        left = ~frame.isin(marks.pulse_frames)
        return activity.where(left), velocity.where(left)
    first, last = marks.episode_frames
    before = first - int(frame[0]) >= int(frame[-1]) - last
    calm = frame < first if before else frame > last
    return activity[calm.to_numpy()], velocity[calm.to_numpy()]


def remedied(trial: tuple[str, int, int]) -> list[float]:
    """Shares of windows with p <= 0.05 of one movie, by what is done about it."""
    warnings.simplefilter("ignore", StationarityWarning)
    kind, frames, seed = trial
    series, lag = series_of(kind, seed, frames, _SMALL), max_lag(frames)
    short = max(1, int((frames / 21.0 - 1.0) // 2.0))  # leaves 19 shifts, which p = 0.05 takes
    shares = [
        share_of_windows(series, short if "null" in settings else lag, seed, **settings)
        for settings in _WAYS.values()
    ]
    marks = stress_marks(*series, lag, seed=seed)
    named = marks is not None and {"common pulse", "restless episode"} & set(marks.found)
    if not named:
        return [*shares, np.nan]
    part = without_marked(series, marks)
    return [*shares, share_of_windows(part, min(lag, part[0].sizes["time"] // 4), seed)]


_WAYS: dict[str, dict[str, Any]] = {
    "values": {},
    "ranks": {"statistic": "spearman"},
    "shift, short lags": {"null": "shift"},
    "differences": {"difference": True},
}


def remedies(movies: int, workers: int) -> None:
    """Print the false positives by what is done."""
    print(f"\nWindows with p <= 0.05 in percent, {movies} movies of 3 × 12 windows a row\n")
    print_row(["case", "frames", *_WAYS, "without marked frames"], head=True)
    run: Callable[..., Iterator[list[float]]]
    with pool(workers) as processes:
        run = processes.map
        for kind in (*STRESS, "ar1"):
            for frames in FRAMES:
                trials = [(kind, frames, FIRST_SEED + number) for number in range(movies)]
                table = np.array(list(run(remedied, trials)))
                print_row([kind, frames, *map(percent, table.T)])


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    parser.add_argument("--movies", type=int, default=200, help="movies a figure (default 200)")
    parser.add_argument("--only", choices=("flagged", "remedies"), help="one table")
    arguments = parser.parse_args()
    missed = flagged(arguments.movies, arguments.workers) if arguments.only != "remedies" else []
    if arguments.only != "flagged":
        remedies(arguments.movies, arguments.workers)
    print(*missed, sep="\n")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())

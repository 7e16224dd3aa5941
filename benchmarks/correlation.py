"""Whether correlations are found where they are and only there, and what it costs.

Prints five parts as Markdown tables.

1. False positives: simulated activity and velocity that have nothing to do with each other, 3 layers × 12
   sectors, 199 surrogates: share of windows with p <= 0.05 and with q <= 0.05, and of layers (means over
   sectors) with p <= 0.05, in percent, with its standard error over movies (windows of one movie are
   correlated). "waves" run around the edge, one sector a frame, and are few patterns: the level of layers is
   not quite held there. Of 199 surrogates, 4 of the 36 windows must reach the smallest p for a q <= 0.05.
   Shifts need more than four times the longest lag.
2. Detection: movies of images through the whole pipeline. Channel "edge" follows the edge's velocity with a
   known lag along half of the edge, and that of another cell along the rest. "lag found": windows of layers 0
   and 1 in coupled sectors whose peak lies within one frame of the truth; "found": those with q < 0.05;
   "false": windows of all layers in sectors that are not coupled with q < 0.05; all in percent, with the
   standard error over movies. "no threshold" is the paper's rule without surrogates' help.
3. Pairs: time and peak memory of all pairs of 1200 windows at 41 lags of 500 frames, each in a process of
   its own.
4. Jitter: a pattern carried by the cell's material, which has nothing to do with the edge, where the drawn
   outline lies beside the true one by so many pixels (standard deviation). Mean correlation of layer 0
   with velocity at lags -1 and 0, what `jitter_step` makes of it, and the share of its windows with p < 0.05
   with all lags and without these two, in percent.
5. Clusters: series of 10 layers × 60 sectors, of which layers 0 and 1 in half of the sectors follow the
   velocity with r = 0.3; what neighbours have of their own falls to exp(-1/2) over the given number of
   windows (0: independent). "alone": coupled windows with p < 0.05; "in clusters": coupled windows in
   a cluster with p <= 0.05 whose lag is within one frame of the truth; "movies": with any of these; "not
   coupled": windows of true clusters that are not coupled; "false": movies with a cluster that lies wholly
   where nothing is. Then movies with any cluster where nothing is coupled, 4 layers × 24 sectors. All in
   percent, 199 surrogates. Last, time and memory of 600 windows at 41 lags of 500 frames.

Ends with status 1 if the default, "phase", has not between 3 % and 7 % false windows in each row, or if
"nearest" finds less than 95 % of the lags, or 5 % or more of the windows that are not coupled; if clusters
find less than 60 % of the coupled windows in 120 frames of any kind, or if more than 5 % of all movies in
which nothing is coupled have one, or three standard errors more than 5 % of those of a row.
"""

import argparse
import multiprocessing
import os
import resource
import sys
import time
import warnings
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
import xarray as xr

from cluster_tables import cluster_rows
from cytodisk.analysis.accuracy import share_by_sector
from cytodisk.analysis.activity import sample_movie
from cytodisk.analysis.correlation.clusters import correlation_clusters
from cytodisk.analysis.correlation.correlation_parameters import Null
from cytodisk.analysis.correlation.cross_correlation import correlation_by_layer, cross_correlate
from cytodisk.analysis.correlation.jitter_mark import JITTERED_LAGS, jitter_step
from cytodisk.analysis.correlation.peaks import peak_correlation
from cytodisk.analysis.pairs.pair_correlation import correlate_pairs
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import StationarityWarning
from cytodisk.motion.map_movie import map_movie
from cytodisk.motion.velocity import edge_velocity
from cytodisk.simulate import SERIES_KINDS, independent_series, movie
from cytodisk.simulate.null_series import SeriesKind
from cytodisk.windows.polar_windows import polar_windows

ALPHA = 0.05
NULLS: tuple[Null, ...] = ("phase", "shift")
FRAMES = (40, 100, 200)
LAGS = (-4, 3, 0)
JITTERS_PX = (0.0, 0.25, 0.5, 1.0)
RULES = ("nearest", "largest", "no threshold")
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
_LAYERS, _SECTORS = 10, 60
_COUPLED_LAYERS = 2
_MAX_LAG = 20
WAVES = "waves"
_SMALL = 3, 12  # layers, sectors of series without images


@dataclass(frozen=True)
class Independent:
    """Simulated movies without any correlation: kind of series, their null, and how long."""

    kind: SeriesKind | Literal["waves"]
    null: Null
    frames: int
    seeds: range


@dataclass(frozen=True)
class Coupled:
    """One movie of images in which the edge follows the velocity."""

    lag: int
    seed: int
    frames: int
    cache: Path | None


def pool(workers: int) -> ProcessPoolExecutor:
    """Fresh processes that compute with one thread each."""
    os.environ |= dict.fromkeys(_THREADS, "1")
    return ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"))


def percent(shares: Sequence[float] | FloatArray) -> str:
    """Mean of the movies' shares in percent, with its standard error."""
    values = 100.0 * np.asarray(shares)[np.isfinite(shares)]
    if not values.size:
        return "–"
    error = values.std(ddof=1) / np.sqrt(values.size) if values.size > 1 else np.nan
    return f"{values.mean():.1f} ± {error:.1f}"


def print_row(cells: Iterable[object], head: bool = False) -> None:
    """Print a row of a table, below the first the line that makes it a head."""
    shown = [str(cell) for cell in cells]
    print(f"| {' | '.join(shown)} |", flush=True)
    if head:
        print(f"|{'---|' * len(shown)}", flush=True)


def independent(trial: Independent, seed: int) -> tuple[xr.DataArray, xr.DataArray]:
    """Activity and velocity that have nothing to do with each other."""
    if trial.kind != WAVES:
        return independent_series(trial.kind, seed, trial.frames, _SMALL[0], _SMALL[1])
    sectors = np.arange(_SMALL[1])
    long = independent_series("ar1", seed, trial.frames + _SMALL[1], _SMALL[0], 1)
    noise = independent_series("white", seed, trial.frames, *_SMALL)
    found = []
    for series, rest in zip(long, noise, strict=True):
        line = series.isel(sector=0).to_numpy()
        running = np.stack([line[k : k + trial.frames] for k in sectors], axis=-1)
        found.append(rest.copy(data=running + 0.3 * rest.to_numpy()))
    return found[0], found[1]


def false_shares(trial: Independent) -> FloatArray:
    """Shares of windows with p, and with q, and of layers with p, of at most 0.05, shape (movies, 3)."""
    warnings.simplefilter("ignore", StationarityWarning)
    max_lag = min(_MAX_LAG, trial.frames // 4)
    if trial.null == "shift" and trial.frames < 4 * max_lag + 2:
        return np.full((len(trial.seeds), 3), np.nan)
    found = []
    for seed in trial.seeds:
        correlations = cross_correlate(
            *independent(trial, seed), max_lag, surrogates=199, null=trial.null, seed=seed
        )
        peak, layers = peak_correlation(correlations), peak_correlation(correlation_by_layer(correlations))
        found.append([float((values <= ALPHA).mean()) for values in (peak["p"], peak["q"], layers["p"])])
    return np.array(found)


def false_positives(movies: int, workers: int) -> bool:
    """Print how often independent series seem correlated; whether that is as often as it should be."""
    print(f"\nFalse positives in percent: p, q of windows, p of layers at most 0.05; {movies} movies a row\n")
    heads = [f"{null}: {name}" for null in NULLS for name in ("p", "q", "p of layers")]
    print_row(["kind", "frames", *heads], head=True)
    rows = [(kind, frames) for kind in (*SERIES_KINDS, WAVES) for frames in FRAMES]
    trials = [
        Independent(kind, null, frames, range(row * movies, (row + 1) * movies))
        for row, (kind, frames) in enumerate(rows)
        for null in NULLS
    ]
    tables, failures = [], []
    with pool(workers) as processes:
        results = processes.map(false_shares, trials)
        for kind, frames in rows:
            tables.append(np.concatenate([next(results) for _ in NULLS], axis=1))
            print_row([kind, frames, *map(percent, tables[-1].T)])
            share = float(tables[-1][:, 0].mean())
            if not 0.03 <= share <= 0.07:
                failures.append(f"{kind}, {frames} frames: {share:.1%}")
    every = np.concatenate(tables)
    print_row(["all", "all", *map(percent, every.T)])
    share = float(every[:, 0].mean())
    print(f"\n{verdict(not failures)}: {share:.1%} of the windows have p <= 0.05 with 'phase'", end="")
    print(" (required of each row: 3 to 7 %)")
    print(*failures, sep="\n")
    return not failures


def series_of(trial: Coupled) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Activity (T, layer, sector), velocity (T, sector) and coupling (sector) of a movie of images."""
    name = f"coupled_{trial.lag}_{trial.seed}_{trial.frames}.npz"
    if trial.cache is not None and (trial.cache / name).exists():
        with np.load(trial.cache / name) as stored:
            return stored["activity"], stored["velocity"], stored["share"]
    truth = movie("fluctuating", trial.seed, frames=trial.frames, lag_frames=trial.lag, coupled=0.5)
    mapped = map_movie(truth.masks)
    sampled = sample_movie(mapped, polar_windows(_LAYERS, _SECTORS), truth.signal)
    activity = sampled["mean"].sel(channel="edge").to_numpy()
    velocity = edge_velocity(mapped, _SECTORS).to_numpy()
    share = share_by_sector(mapped, truth.boundary_yx, truth.coupled, _SECTORS)
    if trial.cache is not None:
        trial.cache.mkdir(parents=True, exist_ok=True)
        np.savez(trial.cache / name, activity=activity, velocity=velocity, share=share)
    return activity, velocity, share


def peak_by(correlations: xr.Dataset, rule: str) -> xr.Dataset:
    """Peak by a rule of the table."""
    if rule == "largest":
        return peak_correlation(correlations, rule="largest")
    return peak_correlation(
        correlations.drop_vars("threshold") if rule == "no threshold" else correlations, rule="nearest"
    )


def detected(trial: Coupled) -> dict[str, list[float]]:
    """By rule: share of coupled windows with the right lag, with q < 0.05; of the others with q < 0.05."""
    warnings.simplefilter("ignore", StationarityWarning)
    activity, velocity, share = series_of(trial)
    correlations = cross_correlate(activity, velocity, _MAX_LAG, surrogates=999, seed=trial.seed)
    on, off = share > 0.95, share < 0.05
    found = {}
    for rule in RULES:
        peak = peak_by(correlations, rule)
        near: BoolArray = np.abs(peak["lag"].to_numpy() + trial.lag) <= 1.0  # the edge follows: b goes before
        significant: BoolArray = peak["q"].to_numpy() < ALPHA
        coupled = slice(0, _COUPLED_LAYERS), on
        found[rule] = [float(near[coupled].mean()), float(significant[coupled].mean())]
        found[rule].append(float(significant[:, off].mean()))
    return found


def detection(movies: int, frames: int, workers: int, cache: Path | None) -> bool:
    """Print how surely lags are found; whether the default does so well enough."""
    print(f"\nDetection in percent of windows, {movies} movies of {frames} frames a lag, 999 surrogates\n")
    print_row(["lag of edge", "rule", "lag found", "found", "false"], head=True)
    trials = [Coupled(lag, seed, frames, cache) for lag in LAGS for seed in range(movies)]
    failures = []
    with pool(workers) as processes:
        results: Iterator[dict[str, list[float]]] = processes.map(detected, trials)
        for lag in LAGS:
            found = [next(results) for _ in range(movies)]
            for rule in RULES:
                shares = np.array([figures[rule] for figures in found])
                print_row([lag, rule, *map(percent, shares.T)])
                right, _, false = shares.mean(axis=0)
                if rule == "nearest" and (right < 0.95 or false >= 0.05):
                    failures.append(f"lag {lag}: {right:.1%} of lags found, {false:.1%} false")
    print(f"\n{verdict(not failures)}: 'nearest' (required: 95 % of lags, less than 5 % false)")
    print(*failures, sep="\n")
    return not failures


def cost_of_pairs(missing: float, frames: int, windows: tuple[int, int]) -> tuple[float, float, float]:
    """Seconds of one run, and memory before it and at its peak, in MB."""
    random = np.random.default_rng(0)
    a, b = random.normal(size=(2, frames, *windows))
    if missing:
        a[random.random(a.shape) < missing] = np.nan
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    start = time.perf_counter()
    correlate_pairs(a, b, 20)
    return (
        time.perf_counter() - start,
        before,
        resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
    )


def pairs(frames: int, windows: tuple[int, int]) -> None:
    """Print what correlations of all pairs cost."""
    count = windows[0] * windows[1]
    print(f"\nAll pairs of {count} windows, 41 lags, {frames} frames\n")
    print_row(["series", "seconds", "MB before", "MB at the peak"], head=True)
    for name in _THREADS:
        os.environ.pop(name, None)
    for name, missing in (("whole", 0.0), ("1 % missing", 0.01)):
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as process:
            figures = process.submit(cost_of_pairs, missing, frames, windows).result()
        print_row([name, *(f"{figure:.0f}" for figure in figures)])


def jittered(trial: tuple[float, int]) -> list[float]:
    """Figures of one movie for `jitter`."""
    warnings.simplefilter("ignore", StationarityWarning)
    jitter_px, seed = trial
    truth = movie("fluctuating", seed, frames=100, jitter_px=jitter_px)
    mapped = map_movie(truth.masks)
    activity = sample_movie(mapped, polar_windows(_LAYERS, _SECTORS), truth.signal)["mean"]
    material, velocity = activity.sel(channel="material"), edge_velocity(mapped, _SECTORS)
    shares = []
    for skipped in ((), JITTERED_LAGS):
        found = cross_correlate(material, velocity, _MAX_LAG, skip_lags=skipped, surrogates=199, seed=seed)
        shares.append(float((peak_correlation(found)["p"].sel(layer=0) < ALPHA).mean()))
        if not skipped:
            mean = correlation_by_layer(found)
    curve = mean["correlation"].sel(layer=0)
    at = [float(curve.sel(lag=lag)) for lag in JITTERED_LAGS]
    return [*at, float(jitter_step(mean).sel(layer=0)), *shares]


def jitter(movies: int, workers: int) -> None:
    """Print what jitter of the masks makes of a signal that has nothing to do with the edge."""
    print(f"\nJitter of the masks, {movies} movies of 100 frames each\n")
    heads = [
        "jitter px",
        "r at lag -1",
        "r at lag 0",
        "jitter_step",
        "p < 0.05",
        "p < 0.05 without lags -1, 0",
    ]
    print_row(heads, head=True)
    trials = [(size, seed) for size in JITTERS_PX for seed in range(movies)]
    with pool(workers) as processes:
        results: Iterator[list[float]] = processes.map(jittered, trials)
        for size in JITTERS_PX:
            found = np.array([next(results) for _ in range(movies)])
            means = [f"{value:+.2f}" for value in found[:, :3].mean(axis=0)]
            print_row([size, *means, *map(percent, found[:, 3:].T)])


def clusters(movies: int, workers: int) -> bool:
    """Print what clusters find, and how often one is false; whether that is good enough."""
    heads = ["kind", "own noise", "frames"]
    failures, false = [], []
    print(f"\nClusters, {movies // 5} movies a row\n")
    coupled = ["alone", "in clusters", "movies", "not coupled", "false"]
    print_row([*heads, *coupled], head=True)
    with pool(workers) as processes:
        for kind, length, frames, found in cluster_rows(
            processes, True, movies // 5, (_LAYERS, _SECTORS), 199
        ):
            print_row([kind, f"{length:g}", frames, *map(percent, found.T)])
            if frames == 120 and found[:, 1].mean() < 0.6:
                failures.append(f"{kind}, {length:g}: {found[:, 1].mean():.1%} of windows found")
        print(f"\nMovies with a false cluster, {movies} a row\n")
        print_row([*heads, "false"], head=True)
        for kind, length, frames, found in cluster_rows(processes, False, movies, (4, 24), 199):
            print_row([kind, f"{length:g}", frames, *map(percent, found.T)])
            false.append(float(found.mean()))
            if false[-1] > ALPHA + 3.0 * np.sqrt(ALPHA * (1.0 - ALPHA) / movies):
                failures.append(f"{kind}, {length:g}, {frames} frames: {false[-1]:.1%} false")
    good = not failures and float(np.mean(false)) <= ALPHA
    print(f"\n{verdict(good)}: clusters, {np.mean(false):.1%} of movies with a false one (required: 5 %)")
    print(*failures, sep="\n")
    return good


def cost_of_clusters(with_clusters: bool) -> tuple[float, float, float]:
    """Processor seconds of one run with 1999 surrogates, and memory before it and at its peak, in MB."""
    random = np.random.default_rng(0)
    a, b = random.normal(size=(500, _LAYERS, _SECTORS)), random.normal(size=(500, _SECTORS))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    start = time.process_time()
    found = cross_correlate(a, b, _MAX_LAG, surrogates=1999, clusters=with_clusters)
    if with_clusters:
        correlation_clusters(found)
    return (
        time.process_time() - start,
        before,
        resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
    )


def costs_of_clusters() -> None:
    """Print what clusters cost."""
    print("\n600 windows, 41 lags, 500 frames, 1999 surrogates (499 of clusters)\n")
    print_row(["clusters", "processor seconds", "MB before", "MB at the peak"], head=True)
    for name, wanted in (("no", False), ("yes", True)):
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as process:
            figures = process.submit(cost_of_clusters, wanted).result()
        print_row([name, *(f"{figure:.0f}" for figure in figures)])


def verdict(good: bool) -> str:
    """What to print before a required figure."""
    return "ok" if good else "FAILED"


def parse_arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    parser.add_argument("--movies", type=int, default=200, help="of independent series a row (default 200)")
    parser.add_argument("--image-movies", type=int, default=8, help="of images a lag (default 8)")
    parser.add_argument("--frames", type=int, default=150, help="of a movie of images (default 150)")
    parser.add_argument("--cache", type=Path, help="folder that keeps the series of the movies of images")
    parser.add_argument(
        "--only", choices=("false", "detection", "pairs", "jitter", "clusters"), help="one table"
    )
    parser.add_argument("--quick", action="store_true", help="20 movies of series, 2 of images, 300 windows")
    return parser.parse_args()


def main() -> int:
    """Run the benchmark."""
    arguments = parse_arguments()
    movies, image_movies, windows = arguments.movies, arguments.image_movies, (20, 60)
    if arguments.quick:
        movies, image_movies, windows = 20, 2, (5, 60)
    good = True
    if arguments.only in (None, "false"):
        good &= false_positives(movies, arguments.workers)
    if arguments.only in (None, "detection"):
        good &= detection(image_movies, arguments.frames, arguments.workers, arguments.cache)
    if arguments.only in (None, "pairs"):
        pairs(500, windows)
    if arguments.only in (None, "jitter"):
        jitter(min(image_movies, 4), arguments.workers)
    if arguments.only in (None, "clusters"):
        good &= clusters(movies, arguments.workers)
        costs_of_clusters()
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())

"""How far boundary trackers are from the truth on simulated movies with known answers.

Prints a Markdown table per tracker, a row per kind of movie; every number is a mean over the seeds.

* "error 10", "p95 10": distance along the outline, in pixels, between where material points of the first
  frame's edge are after 10 frames and where the tracked points that they lay between have gone: mean over
  the edge, and 95th percentile.
* "velocity": root mean square, over frames and 60 sectors, of the edge velocity's error in px/frame. The
  true velocity of a sector is the mean, by length of edge, over the material points that were in it in the
  first frame. It contains what the tracker lost, and the noise of a mask that knows its edge to a pixel.
* "5×24 10", "10×60 10": share of the points inside the cell that are after 10 frames in the same window of a
  grid of 5 layers × 24 sectors (10 × 60) as in the first frame.
* "disorder": tracked points that changed places, and times that tracking started anew.
* "invalid": frames that have a cell but no map with a valid certificate.
* "frame ms": time to carry the boundary to the next frame, with registration; "step ms": without it.

Where a frame was dropped, the nearest one that is present stands for it. Ends with status 1 if "matching" has
disorder or any frame is invalid.
"""

import argparse
import csv
import sys
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import get_args

import numpy as np

from cytodisk import simulate
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.geometry.polygon import edge_lengths
from cytodisk.motion.contour import Contour
from cytodisk.motion.demons import propagate
from cytodisk.motion.demons_parameters import DemonsParameters
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.edge import sector_of
from cytodisk.motion.map_movie import map_movie
from cytodisk.motion.matching import carry, first_guess, match
from cytodisk.motion.tracking import TrackedBoundary, follow
from cytodisk.motion.tracking_parameters import SMOOTHNESS_PX2, Tracker, TrackingSettings
from cytodisk.motion.velocity import edge_velocity
from cytodisk.simulate import EDGE_KINDS, SimulatedMovie
from cytodisk.simulate import MOVIE_KINDS as ALL_KINDS
from cytodisk.simulate.movie_kinds import MovieKind
from cytodisk.windows.polar_windows import PolarGrid, polar_windows

MOVIE_KINDS = tuple(kind for kind in ALL_KINDS if kind not in EDGE_KINDS)  # of whose matter all is known
TRACKERS: tuple[Tracker, ...] = get_args(Tracker)
HORIZONS = (1, 10, 50)
GRIDS = {"5×24": polar_windows(5, 24), "10×60": polar_windows(10, 60)}
_SECTORS = 60
_POINTS = 400
_TIMED_STEPS = 8  # of each movie


@dataclass(frozen=True)
class Trial:
    """Numbers of one tracker on one movie, by the name of their column."""

    tracker: str
    kind: str
    seed: int
    figures: Mapping[str, float]


def frame_near(truth: SimulatedMovie, horizon: int) -> int:
    """Frame with a cell that is nearest to a number of frames after the first."""
    present = np.flatnonzero(truth.present)
    return int(present[np.abs(present - horizon).argmin()])


def projected(points_yx: FloatArray, contour: Contour) -> FloatArray:
    """Distance along a contour of the place nearest to each point, in pixels."""
    edge, fraction = nearest_on_outline(points_yx, contour.points_yx)
    return contour.arc[edge] + fraction * (contour.arc[edge + 1] - contour.arc[edge])


def tracking_error(truth: SimulatedMovie, first: TrackedBoundary, last: TrackedBoundary) -> FloatArray:
    """Distance along the outline between tracked and true places of material points, in pixels."""
    every = np.linspace(0, truth.boundary_yx.shape[1], _POINTS, endpoint=False).astype(np.int64)
    start, stop = (projected(truth.boundary_yx[found.frame, every], found.contour) for found in (first, last))
    number = np.arange(len(first.s), dtype=np.float64)
    place = carry(start, first.s, number, first.contour.length, len(number))
    tracked = carry(place, number, last.s, len(number), last.contour.length)
    half = 0.5 * last.contour.length
    return np.abs(np.mod(tracked - stop + half, 2.0 * half) - half)


def true_velocity(truth: SimulatedMovie, sector: IntArray) -> FloatArray:
    """Mean normal displacement of the material points of each sector, shape (T, sectors), in pixels."""
    velocity = np.full((len(truth.masks), _SECTORS), np.nan)
    for frame, displacement in enumerate(truth.normal_displacement_px):
        after = edge_lengths(truth.boundary_yx[frame])
        weight = 0.5 * (after + np.roll(after, 1))
        total = np.bincount(sector, weight, _SECTORS)
        has_edge = total > 0.0
        summed = np.bincount(sector, weight * displacement, _SECTORS)
        velocity[frame, has_edge] = summed[has_edge] / total[has_edge]
    return velocity


def velocity_error(truth: SimulatedMovie, movie: DiskMovie, first: TrackedBoundary) -> float:
    """Root mean square error of the edge velocity over frames and sectors, in px/frame."""
    start = projected(truth.boundary_yx[0], first.contour)
    angle = carry(start, first.s, movie.point_angles, first.contour.length, 2.0 * np.pi)
    error = edge_velocity(movie, _SECTORS, frame="lab") - true_velocity(truth, sector_of(angle, _SECTORS))
    return float(np.sqrt(np.square(error).mean()))


def share_in_place(truth: SimulatedMovie, movie: DiskMovie, grid: PolarGrid, frame: int) -> float:
    """Share of the points inside the cell that are in the window that they were in in the first frame."""
    first, last = (
        grid.window_of(movie[number].to_disk(truth.interior_yx[number], outside="nearest"))
        for number in (0, frame)
    )
    return float((first == last).mean())


def disorder(found: TrackedBoundary) -> int:
    """Points of a frame that changed places, before or after order was restored, and its restart."""
    gaps = np.diff(found.s, append=found.s[0] + found.contour.length)
    return found.order_violations + int((gaps <= 0.0).sum()) + bool(found.restarted)


def invalid_frames(truth: SimulatedMovie, movie: DiskMovie) -> int:
    """How many frames have a cell, but no map with a valid certificate."""
    good = [mapped and movie[frame].certificate.valid for frame, mapped in enumerate(movie.mapped)]
    return int((truth.present & ~np.array(good)).sum())


def seconds_of_step(here: Contour, there: Contour, s: FloatArray, tracker: Tracker) -> float:
    """Time of the tracker alone between two registered outlines."""
    start = time.perf_counter()
    if tracker == "demons":
        propagate(here, there, here.at(s), DemonsParameters())
    else:
        match(here, there, s, first_guess(here, there, s, SMOOTHNESS_PX2), SMOOTHNESS_PX2)
    return time.perf_counter() - start


def median_milliseconds(boundaries: Sequence[TrackedBoundary], tracker: Tracker) -> tuple[float, float]:
    """Median time to carry a boundary to the next frame, with and without registration."""
    settings = TrackingSettings(tracker=tracker)
    whole, step = [], []
    for number in np.linspace(0, len(boundaries) - 2, _TIMED_STEPS).astype(int):
        last, following = boundaries[number], boundaries[number + 1]
        start = time.perf_counter()
        follow(following.frame, following.contour, last, last, settings)
        whole.append(time.perf_counter() - start)
        here, there = (found.alignment.of(found.contour) for found in (last, following))
        step.append(seconds_of_step(here, there, last.s, tracker))
    return 1e3 * float(np.median(whole)), 1e3 * float(np.median(step))


def figures_of(truth: SimulatedMovie, tracker: Tracker) -> dict[str, float]:
    """All numbers of one movie."""
    movie = map_movie(truth.masks, tracker=tracker)
    boundaries = [record.boundary for record in movie.records if record.boundary is not None]
    by_frame = {found.frame: found for found in boundaries}
    figures: dict[str, float] = {}
    for horizon in HORIZONS:
        error = tracking_error(truth, boundaries[0], by_frame[frame_near(truth, horizon)])
        figures[f"error {horizon}"] = float(error.mean())
        figures[f"p95 {horizon}"] = float(np.percentile(error, 95))
    figures["velocity"] = velocity_error(truth, movie, boundaries[0])
    for name, grid in GRIDS.items():
        for horizon in HORIZONS:
            figures[f"{name} {horizon}"] = share_in_place(truth, movie, grid, frame_near(truth, horizon))
    figures["disorder"] = sum(disorder(found) for found in boundaries)
    figures["invalid"] = invalid_frames(truth, movie)
    figures["frame ms"], figures["step ms"] = median_milliseconds(boundaries, tracker)
    return figures


def mean_figures(trials: Sequence[Trial]) -> dict[str, float]:
    """Mean of each number; what must not occur is summed."""
    return {
        name: float(
            (np.sum if name in ("disorder", "invalid") else np.mean)(
                [trial.figures[name] for trial in trials]
            )
        )
        for name in trials[0].figures
    }


def print_row(kind: str, figures: Mapping[str, float]) -> None:
    """Print a row of a table."""
    shown = {"disorder": ".0f", "invalid": ".0f", "frame ms": ".1f", "step ms": ".1f"}
    cells = [format(value, shown.get(name, ".2f")) for name, value in figures.items()]
    print(f"| {' | '.join([kind, *cells])} |", flush=True)


def print_header(tracker: str, names: Sequence[str]) -> None:
    """Print the name of a tracker and the head of its table."""
    print(f"\n{tracker}\n\n| {' | '.join(['kind', *names])} |")
    print(f"|---|{'---:|' * len(names)}", flush=True)


def run(tracker: Tracker, kinds: Sequence[MovieKind], seeds: int, frames: int) -> Iterator[Trial]:
    """Simulate, track and print; a trial for each movie, as soon as it is known."""
    for kind in kinds:
        trials = []
        for seed in range(seeds):
            print(f"{tracker}: {kind} {seed}", end="\033[K\r", file=sys.stderr, flush=True)
            truth = simulate.movie(kind, seed, frames=frames, signals=False)
            trials.append(Trial(tracker, kind, seed, figures_of(truth, tracker)))
            yield trials[-1]
        means = mean_figures(trials)
        if kind == kinds[0]:
            print_header(tracker, list(means))
        print_row(kind, means)


def with_table(trials: Iterable[Trial], path: Path) -> Iterator[Trial]:
    """Write each trial to a CSV file before it goes on."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        for number, trial in enumerate(trials):
            if not number:
                writer.writerow(["tracker", "kind", "seed", *trial.figures])
            writer.writerow([trial.tracker, trial.kind, trial.seed, *trial.figures.values()])
            file.flush()
            yield trial


def warm_up() -> None:
    """Load the compiled kernels, so that no time contains them."""
    truth = simulate.movie("growing", frames=3, signals=False)
    for tracker in TRACKERS:
        figures_of(truth, tracker)


def print_comparison(trials: Sequence[Trial], kinds: Sequence[str]) -> None:
    """Print for each kind where "matching" has the lower mean error, and how many times it is faster."""
    lower = 0
    times_as_fast: dict[str, list[float]] = {"frame ms": [], "step ms": []}
    print("\nMean error in pixels of matching and demons:\n")
    for kind in kinds:
        ours, theirs = (
            mean_figures([trial for trial in trials if (trial.kind, trial.tracker) == (kind, tracker)])
            for tracker in ("matching", "demons")
        )
        verdicts = []
        for horizon in HORIZONS:
            here, there = ours[f"error {horizon}"], theirs[f"error {horizon}"]
            lower += here < there
            verdict = "lower" if here < there else "NOT LOWER"
            verdicts.append(f"{verdict} at {horizon} ({here:.2f}, {there:.2f})")
        print(f"* {kind}: {', '.join(verdicts)}")
        for name, ratios in times_as_fast.items():
            ratios.append(theirs[name] / ours[name])
    print(
        f"\nmatching is lower in {lower} of {len(kinds) * len(HORIZONS)}; it is "
        f"{np.median(times_as_fast['frame ms']):.1f} times as fast with registration, "
        f"{np.median(times_as_fast['step ms']):.1f} times without"
    )


def parse_arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=5, help="movies of each kind (default 5)")
    parser.add_argument("--frames", type=int, default=51, help="frames of each movie (default 51)")
    parser.add_argument("--trackers", default=",".join(TRACKERS), help="comma-separated (default all)")
    parser.add_argument("--kinds", default=",".join(MOVIE_KINDS), help="comma-separated (default all)")
    parser.add_argument("--out", type=Path, help="write the numbers of every movie to this CSV file")
    parser.add_argument("--quick", action="store_true", help="2 seeds")
    return parser.parse_args()


def main() -> int:
    """Run the benchmark."""
    arguments = parse_arguments()
    trackers, kinds = arguments.trackers.split(","), arguments.kinds.split(",")
    warm_up()
    seeds = 2 if arguments.quick else arguments.seeds
    running: Iterable[Trial] = chain.from_iterable(
        run(tracker, kinds, seeds, arguments.frames) for tracker in trackers
    )
    trials = list(running if arguments.out is None else with_table(running, arguments.out))
    if set(TRACKERS) <= set(trackers):
        print_comparison(trials, kinds)
    failed = any(
        trial.figures["invalid"] or (trial.tracker == "matching" and trial.figures["disorder"])
        for trial in trials
    )
    print(
        "FAILED: disorder of matching or invalid maps"
        if failed
        else "no disorder of matching, all maps valid"
    )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

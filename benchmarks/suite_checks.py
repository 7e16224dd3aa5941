"""Blocks of `suite.py` for what must be right, by the functions of the other benchmarks.

What a block needs is imported in it, so that a block which another revision of the package cannot run does
not keep others from running.
"""

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

from figure import Figure

RANDOM_MASKS = 2800
RANDOM_PAIRS = 720
GRIDS = ((1, 1), (5, 12), (10, 60), (20, 120), (50, 100), (100, 200))
TRACKED_FRAMES = 12
PLACE_SEEDS = 3
SERIES_MOVIES = 12


def area(data: Path) -> Iterator[Figure]:
    """Area error of the reference masks, flips and lost pixels."""
    from reference_masks import TARGETS, measure

    rows = {name: measure(name, "newton", data / "reference_masks")[0] for name in TARGETS}
    for name, row in rows.items():
        yield Figure(f"area error of the windows of {name}", row["window_error"], most=TARGETS[name])
    for name, row in rows.items():
        yield Figure(f"area error of the triangles of {name}", row["area_error"])
    yield Figure("flips on the reference masks", sum(row["flips"] for row in rows.values()), most=0)
    outside = sum(row["outside"] for row in rows.values())
    yield Figure("mask pixels outside the map, reference masks", outside, "px", most=0)


def random(_data: Path) -> Iterator[Figure]:
    """Random masks, fewer than `random_masks.py` tries."""
    from random_masks import KINDS, try_mask

    kinds = [KINDS[number % len(KINDS)] for number in range(RANDOM_MASKS)]
    seeds = [number // len(KINDS) for number in range(RANDOM_MASKS)]
    with ProcessPoolExecutor(2) as pool:
        trials = list(pool.map(try_mask, kinds, seeds, chunksize=20))
    what = f"{RANDOM_MASKS} random masks"
    yield Figure(
        f"{what}: flips", sum(trial.flips for trial in trials), most=0, note="20 000: random_masks.py"
    )
    yield Figure(f"{what}: refused, invalid or inexact", sum(trial.failed for trial in trials), most=0)
    yield Figure(f"{what}: mask pixels outside the map", sum(trial.lost for trial in trials), "px", most=0)
    yield Figure(f"{what}: empty windows", sum(trial.empty for trial in trials), most=0)
    yield Figure(f"{what}: not converged", sum(not trial.converged for trial in trials))


def random_nuclei(_data: Path) -> Iterator[Figure]:
    """Random cells with a nucleus, fewer than `random_nuclei.py` tries."""
    from random_nuclei import try_pair

    with ProcessPoolExecutor(2) as pool:
        trials = list(pool.map(try_pair, range(RANDOM_PAIRS), chunksize=20))
    what = f"{RANDOM_PAIRS} random cells with a nucleus"
    flips = sum(trial.flips for trial in trials)
    yield Figure(f"{what}: flips", flips, most=0, note="20 000: random_nuclei.py")
    yield Figure(f"{what}: refused, invalid or inexact", sum(trial.failed for trial in trials), most=0)
    yield Figure(f"{what}: pixels in the other compartment", sum(trial.astray for trial in trials), most=0)
    yield Figure(f"{what}: empty windows", sum(trial.empty for trial in trials), most=0)
    yield Figure(f"{what}: not converged", sum(not trial.converged for trial in trials))


def same_place(_data: Path) -> Iterator[Figure]:
    """Points in the same window of two maps of nearly the same cell, and area error of windows."""
    from cell_outlines import judges
    from reproducibility import DEFAULT, judged, measured

    rows = measured(judges(), [DEFAULT], range(PLACE_SEEDS), workers=2)
    note = f"{PLACE_SEEDS} seeds; ten: reproducibility.py --judges"
    for shape, _, what, mean, _, target, _ in judged(rows):
        if what == "windows":
            yield Figure(f"area error of 10 × 60 windows, {shape}", mean, most=target, note=note)
        else:
            words = {"mirrored": "mirrored", "noise": "with 1 px of noise"}[what]
            figure = f"points in the same 10 × 60 window, {shape} {words}"
            yield Figure(figure, 100.0 * mean, "%", least=100.0 * target, note=note)


def windows(data: Path) -> Iterator[Figure]:
    """Empty windows, and sums over windows, of grids up to 100 × 200."""
    import tifffile

    from checked_windows import check_windows
    from cytodisk import simulate
    from cytodisk.disk.mapping import map_to_disk

    masks = [tifffile.imread(path) > 0 for path in sorted((data / "reference_masks").glob("*.tif"))]
    masks.append(simulate.disk(12.8))  # of 517 pixels
    empty, errors = zip(*(check_windows(map_to_disk(mask), GRIDS) for mask in masks), strict=True)
    what = f"grids up to 100 × 200 on {len(masks)} masks"
    yield Figure(f"{what}: empty windows", sum(empty), most=0)
    yield Figure(f"{what}: sums of area and intensity off by", max(errors), most=1e-9)


def tracking(_data: Path) -> Iterator[Figure]:
    """Both trackers on movies with known answers."""
    from truth_movies import MOVIE_KINDS, TRACKERS

    jobs = [(tracker, kind) for kind in MOVIE_KINDS for tracker in TRACKERS]
    with ProcessPoolExecutor(2) as pool:
        found = dict(zip(jobs, pool.map(_tracked, *zip(*jobs, strict=True)), strict=True))
    ours, theirs = ([found[tracker, kind] for kind in MOVIE_KINDS] for tracker in ("matching", "demons"))
    lower = sum(a["error 10"] < b["error 10"] for a, b in zip(ours, theirs, strict=True))
    kinds, note = len(MOVIE_KINDS), f"after 10 frames, one movie of {TRACKED_FRAMES} frames a kind"
    yield Figure("kinds of movies on which matching errs less than demons", lower, least=kinds, note=note)
    for name, figures in (("matching", ours), ("demons", theirs)):
        error = float(np.mean([one["error 10"] for one in figures]))
        yield Figure(f"tracking error of {name}, mean over {kinds} kinds", error, "px", note=note)
    faster = float(np.median([b["step ms"] / a["step ms"] for a, b in zip(ours, theirs, strict=True)]))
    yield Figure("matching is faster than demons, without registration", faster, "×", least=50)
    invalid = sum(one["invalid"] for one in (*ours, *theirs))
    yield Figure("frames without a valid map, truth movies", invalid, most=0)


def _tracked(tracker: str, kind: str) -> dict[str, float]:
    from cytodisk import simulate
    from truth_movies import figures_of

    return figures_of(simulate.movie(kind, frames=TRACKED_FRAMES, signals=False), tracker)


def false_positives(_data: Path) -> Iterator[Figure]:
    """Correlations found between independent series."""
    from correlation import WAVES, Independent, false_shares
    from cytodisk.simulate import SERIES_KINDS

    kinds = (*SERIES_KINDS, WAVES)
    trials = [
        Independent(kind, "phase", 100, range(SERIES_MOVIES * row, SERIES_MOVIES * (row + 1)))
        for row, kind in enumerate(kinds)
    ]
    with ProcessPoolExecutor(2) as pool:
        shares = np.concatenate(list(pool.map(false_shares, trials)))[:, 0]
    error = shares.std(ddof=1) / np.sqrt(len(shares))
    note = f"± {error:.3f}, {len(shares)} movies of 100 frames; by kind: correlation.py"
    yield Figure("false positives at α = 0.05", float(shares.mean()), least=0.03, most=0.07, note=note)

"""The blocks of `suite.py`: each measures some figures with the functions of the other benchmarks.

What a block needs is imported in it, so that a block which another revision of the package cannot run does
not keep others from running.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

MOVIE_MB = 600.0
RANDOM_MASKS = 1400
GRIDS = ((1, 1), (5, 12), (10, 60), (20, 120), (50, 100), (100, 200))
TRACKED_FRAMES = 12
SERIES_MOVIES = 12
_SCALED = ("map of a fishbone", "600 windows on a disk", "windows on one disk", "frames of a movie")


class MissingError(Exception):
    """This revision of the package, or this machine, lacks what a block measures."""


@dataclass(frozen=True)
class Figure:
    """One measured number beside its yardstick.

    Attributes
    ----------
    what : str
    value : float
    unit : str
    least, most : float or None
        What the value must reach or not exceed; None where nothing is asked.
    note : str
        What else is to be known.
    """

    what: str
    value: float
    unit: str = ""
    least: float | None = None
    most: float | None = None
    note: str = ""

    @property
    def met(self) -> bool | None:
        """Whether the yardstick is met, or None if there is none."""
        if self.least is None and self.most is None:
            return None
        above = self.least is None or self.value >= self.least
        return above and (self.most is None or self.value <= self.most)

    @property
    def yardstick(self) -> str:
        """The yardstick in words."""
        if self.least is None:
            return "" if self.most is None else f"≤ {self.most:g} {self.unit}".strip()
        return (
            f"≥ {self.least:g} {self.unit}".strip() if self.most is None else f"{self.least:g}–{self.most:g}"
        )

    @property
    def measured(self) -> str:
        """The value in words."""
        whole = float(self.value).is_integer() and abs(self.value) < 1e6
        return f"{self.value:.0f} {self.unit}".strip() if whole else f"{self.value:.3g} {self.unit}".strip()


def map_time(data: Path) -> Iterator[Figure]:
    """Time of a warm map, beside the machine's own yardstick."""
    import tifffile

    from cytodisk.disk.mapping import map_to_disk
    from speed import median_seconds, yardstick

    mask = tifffile.imread(data / "reference_masks" / "example.tif") > 0
    seconds = median_seconds(lambda: map_to_disk(mask), 21, time.process_time)
    unit = median_seconds(yardstick(), 11, time.process_time)
    yield Figure("map_to_disk on example, warm, one thread", seconds, "s", most=0.06, note="processor time")
    yield Figure(
        "the same over splu of a 200 × 200 Laplacian", seconds / unit, note=f"which takes {unit:.3f} s"
    )


def frame_time(data: Path) -> Iterator[Figure]:
    """Time of a frame of the melanoma movie."""
    from profile_frame import COUNTED, profile_movie

    profile = profile_movie(data)
    yield Figure(
        "melanoma frame, 2 channels, 10 × 60 windows",
        profile.counted_ms / 1e3,
        "s",
        most=0.12,
        note=f"processor time of {', '.join(COUNTED)}",
    )
    yield Figure("the same with files, edge motion and rows", profile.clock.medians()[0], "s")


def movie(data: Path) -> Iterator[Figure]:
    """`cytodisk movie` on the melanoma movie: memory, and frames a second."""
    import tifffile

    from real_movies import MOVIES, run

    frames = len(tifffile.TiffFile(data / MOVIES[0].masks).pages)
    for workers in (1, 2):
        with tempfile.TemporaryDirectory() as folder:
            options = ["--workers", str(workers), "--figures", "0"]
            _, seconds, megabytes = run(MOVIES[0], data, Path(folder), options)
        if workers == 1:
            yield Figure("melanoma movie, one worker: peak memory", megabytes, "MB", most=MOVIE_MB)
        yield Figure(
            f"melanoma movie, {workers} worker(s), with start and tables", frames / seconds, "frames/s"
        )


def demo(_data: Path) -> Iterator[Figure]:
    """`cytodisk demo` with an empty and with a filled kernel cache."""
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"NUMBA_CACHE_DIR": str(Path(folder) / "cache")}
        for name, most in (("empty", 60.0), ("filled", 15.0)):
            command = [sys.executable, "-m", "cytodisk", "demo", "--quiet", "-o", str(Path(folder) / name)]
            started, used = time.perf_counter(), _children_seconds()
            subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL)
            seconds, used = time.perf_counter() - started, _children_seconds() - used
            what = f"cytodisk demo, {name} kernel cache"
            yield Figure(what, seconds, "s", most=most, note=f"{used:.0f} s of processor")


def cells(_data: Path) -> Iterator[Figure]:
    """`cytodisk map` on folders of label images: cells a second."""
    from scale import map_folder, write_folder

    for workers in (1, 2):
        runs = []
        with tempfile.TemporaryDirectory() as folder:
            for number in (100, 400):
                images = Path(folder) / f"{number}"
                write_folder(images, number)
                runs.append(map_folder(images, Path(folder) / f"{number}_out", workers, "--no-maps"))
        more = (runs[1].mapped - runs[0].mapped) / (runs[1].seconds - runs[0].seconds)
        what = f"cells of label images, {workers} worker(s)"
        yield Figure(what, more, "cells/s", note="of a run's further cells, 12 × 60 windows")
        yield Figure(f"{what}: peak memory of all", runs[1].peak_mb, "MB", most=workers * MOVIE_MB)


def batch(data: Path) -> Iterator[Figure]:
    """`cytodisk batch` on two movies: memory of all processes together."""
    from real_movies import MOVIES, shortened
    from scale import resident_mb

    helped = subprocess.run([sys.executable, "-m", "cytodisk", "batch", "--help"], capture_output=True)
    if helped.returncode:
        raise MissingError("this revision has no command batch")
    for workers in (1, 2):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            rows = []
            for copy in ("a", "b"):
                (folder / copy).mkdir()
                files = (data / MOVIES[0].masks, data / str(MOVIES[0].signal))
                masks, signal = (shortened(path, 10, folder / copy) for path in files)
                rows.append(f'[[inputs]]\nname = "{copy}"\nmasks = "{masks}"\nsignal = "{signal}"\n')
            (folder / "study.toml").write_text('[study]\nkind = "movie"\n\n' + "\n".join(rows))
            command = [sys.executable, "-m", "cytodisk", "batch", str(folder / "study.toml"), "--quiet"]
            running = subprocess.Popen([*command, "--workers", str(workers), "--out", str(folder / "out")])
            peak = 0.0
            while running.poll() is None:
                peak = max(peak, resident_mb(running.pid))
                time.sleep(0.05)
            if running.returncode:
                raise SystemExit(f"cytodisk batch ended with {running.returncode}")
        what = f"batch of two melanoma movies, {workers} worker(s): peak memory of all"
        yield Figure(what, peak, "MB", most=workers * MOVIE_MB)


def scaling(_data: Path) -> Iterator[Figure]:
    """Exponents of growth, from few sizes."""
    from scaling import fits_of, measure
    from scaling_series import SERIES

    for fit in fits_of({name: measure(name, SERIES[name].few) for name in _SCALED}):
        most = fit.at_most + (2.0 * fit.error if fit.verdict == "within error" else 0.0)
        what = f"exponent of {fit.y} with {fit.x}: {fit.series}"
        yield Figure(
            what, round(fit.exponent, 2), most=round(most, 2), note=f"± {fit.error:.2f}, 2 or 3 sizes"
        )


def area(data: Path) -> Iterator[Figure]:
    """Area error of the reference masks, flips and lost pixels."""
    from reference_masks import TARGETS, measure

    rows = {name: measure(name, "newton", data / "reference_masks")[0] for name in TARGETS}
    for name, row in rows.items():
        yield Figure(f"area error of {name}", row["area_error"], most=TARGETS[name])
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
        f"{what}: flips", sum(trial.flips for trial in trials), most=0, note="10 000: random_masks.py"
    )
    yield Figure(f"{what}: refused, invalid or inexact", sum(trial.failed for trial in trials), most=0)
    yield Figure(f"{what}: mask pixels outside the map", sum(trial.lost for trial in trials), "px", most=0)


def windows(data: Path) -> Iterator[Figure]:
    """Empty windows, and sums over windows, of grids up to 100 × 200."""
    import tifffile

    from cytodisk import simulate
    from cytodisk.disk.mapping import map_to_disk
    from cytodisk.windows.grid import polar_windows
    from cytodisk.windows.sample import sample

    masks = [tifffile.imread(path) > 0 for path in sorted((data / "reference_masks").glob("*.tif"))]
    empty, worst = 0, 0.0
    for mask in [*masks, simulate.disk(12.8)]:  # the last has 517 pixels
        disk = map_to_disk(mask)
        signal = np.random.default_rng(0).uniform(1.0, 2.0, mask.shape)
        known = disk.mask.sum(), signal[disk.mask].sum()
        for layers, sectors in GRIDS:
            on_cell = polar_windows(layers, sectors).on(disk)
            found = sample(on_cell, signal)
            empty += int((on_cell.areas <= 0).sum())
            sums = on_cell.areas.sum(), float((found["mean"] * found["n_pixels"]).sum())
            worst = max(worst, *(abs(a / b - 1.0) for a, b in zip(sums, known, strict=True)))
    what = f"grids up to 100 × 200 on {len(masks) + 1} masks"
    yield Figure(f"{what}: empty windows", empty, most=0)
    yield Figure(f"{what}: sums of area and intensity off by", worst, most=1e-9)


def doubling(data: Path) -> Iterator[Figure]:
    """What the same shape costs when it is drawn twice as large."""
    from speed import doubling as pairs

    ratios = {name: after / before for name, before, after, _ in pairs(data, 5, time.process_time)}
    worst = max(ratios, key=lambda name: ratios[name])
    yield Figure("time of a shape drawn twice as large", ratios[worst], "×", most=2.3, note=f"worst: {worst}")


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


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


BLOCKS: dict[str, Callable[[Path], Iterator[Figure]]] = {
    block.__name__: block
    for block in (
        map_time,
        frame_time,
        doubling,
        movie,
        demo,
        cells,
        batch,
        scaling,
        area,
        random,
        windows,
        tracking,
        false_positives,
    )
}

"""Blocks of `suite.py` for time and memory, by the functions of the other benchmarks.

What a block needs is imported in it, so that a block which another revision of the package cannot run does
not keep others from running.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pandas as pd

from figure import Figure, MissingError

MOVIE_MB = 600.0
_SCALED = ("map of a fishbone", "600 windows on a disk", "windows on one disk", "frames of a movie")


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


def doubling(data: Path) -> Iterator[Figure]:
    """What the same shape costs when it is drawn twice as large."""
    from speed import doubling as pairs

    ratios = {name: after / before for name, before, after, _ in pairs(data, 5, time.process_time)}
    for what, drawn in (("simulated shapes", False), ("reference masks", True)):
        some = [name for name in ratios if name.endswith("×2") == drawn]
        worst = max(some, key=lambda name: ratios[name])
        figure = Figure(f"time of {what} drawn twice as large", ratios[worst], "×", most=2.3)
        yield replace(figure, note=f"worst of {len(some)}: {worst}")


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
            found = pd.read_parquet(folder / "out" / "inputs.parquet")
            if running.returncode or set(found["status"]) != {"ok"}:
                raise SystemExit(
                    f"cytodisk batch ended with {running.returncode}: {found['status'].tolist()}"
                )
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


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime

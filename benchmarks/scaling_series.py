"""What `scaling.py` measures: each series makes the same work larger, one point in a process of its own."""

import re
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import tifffile

import cytodisk as cd
from cytodisk.arrays import BoolArray
from cytodisk.motion.mapped_frame import MovieSettings, map_frame
from cytodisk.study.map_inputs import open_inputs
from cytodisk.study.map_run import run_map
from cytodisk.study.movie_inputs import open_movie
from cytodisk.study.movie_run import run_movie
from cytodisk.study.parameters import MapParameters, MovieParameters
from scale import write_folder

_REPEAT_BELOW_S = 0.3
_WIDTH_PX = 6  # of the spine and the teeth of a fishbone, and of the gaps between them
_RADIUS_PX = 60.0  # of the disk that more and more windows are put on
_ONCE_PAID, _FURTHER = 50, 100  # frames or cells: of the shorter run, and how many the longer one has more
_SWING = 8  # frames of a simulated movie that is run forth and back


@dataclass(frozen=True)
class Growth:
    """How fast a quantity may grow.

    Attributes
    ----------
    y, x : str
        Names of the quantity and of what it grows with, among the numbers of the series' points.
    at_most : float
        Largest exponent.
    why : str
        Where that comes from.
    """

    y: str
    x: str
    at_most: float
    why: str


@dataclass(frozen=True)
class Series:
    """One kind of work at growing sizes.

    Attributes
    ----------
    name : str
    sizes : tuple of int
        In the order of measurement; `few` for a quick run.
    few : tuple of int
    measure : callable
        Numbers of a point, by name.
    growths : tuple of Growth
    """

    name: str
    sizes: tuple[int, ...]
    few: tuple[int, ...]
    measure: Callable[[int], dict[str, float]]
    growths: tuple[Growth, ...]


def fishbone(teeth: int) -> BoolArray:
    """A spine with teeth on both sides, all 6 px wide; both get longer with the number of teeth."""
    long, period = _WIDTH_PX * teeth, 2 * _WIDTH_PX
    mask = np.zeros((2 * long + _WIDTH_PX, teeth * period - _WIDTH_PX), dtype=bool)
    mask[long : long + _WIDTH_PX] = True
    mask[:, np.arange(mask.shape[1]) % period < _WIDTH_PX] = True
    return np.pad(mask, 4)


def megabytes(what: Literal["VmRSS", "VmHWM"]) -> float:
    """Memory of this process, at present or at its peak."""
    found = re.search(rf"{what}:\s+(\d+) kB", Path("/proc/self/status").read_text())
    if found is None:
        raise SystemExit("/proc/self/status tells no memory: memory is measured on Linux only")
    return int(found[1]) / 1024.0


def cost(work: Callable[[], Any], clock: Callable[[], float] = time.process_time) -> dict[str, float]:
    """Seconds of some work, and the memory at its peak beyond what was held before, in MB."""
    before = megabytes("VmRSS")
    Path("/proc/self/clear_refs").write_text("5")  # forget the peak so far
    seconds = []
    while not seconds or (sum(seconds) < _REPEAT_BELOW_S and len(seconds) < 9):
        start = clock()
        work()
        seconds.append(clock() - start)
        if len(seconds) == 1:
            peak = megabytes("VmHWM")
    return {"seconds": float(np.median(seconds)), "memory (MB)": peak - before, "peak (MB)": peak}


def _map_cost(mask: BoolArray) -> dict[str, float]:
    cd.map_to_disk(cd.simulate.disk(20.0))
    found = cost(lambda: cd.map_to_disk(mask))
    disk = cd.map_to_disk(mask)
    steps = max(disk.steps, 1)
    return found | {
        "outline (vertices)": len(disk.boundary),
        "area (px)": float(mask.sum()),
        "vertices": len(disk.vertices_yx),
        "Newton steps": steps,
        "seconds a step": found["seconds"] / steps,
    }


def _disk(vertices: int) -> BoolArray:
    return cd.simulate.disk(vertices / 8.0)  # its outline has 8 vertices a pixel of radius


def _windows_by_area(area: int) -> dict[str, float]:
    return _window_cost(cd.simulate.disk((area / np.pi) ** 0.5), 10, 60)


def _windows_by_number(layers: int) -> dict[str, float]:
    return _window_cost(cd.simulate.disk(_RADIUS_PX), layers, 2 * layers)


def _window_cost(mask: BoolArray, layers: int, sectors: int) -> dict[str, float]:
    warm = cd.map_to_disk(cd.simulate.disk(20.0))
    signal = np.random.default_rng(0).normal(size=(2, *mask.shape))
    disk, grid = cd.map_to_disk(mask), cd.polar_windows(layers, sectors)
    cd.sample(grid.on(warm), np.zeros(warm.mask.shape))
    disk.to_disk([[0.0, 0.0]])  # lays out the bins of its triangles
    found = cost(lambda: cd.sample(grid.on(disk), signal))
    return found | {"area (px)": float(mask.sum()), "windows": float(layers * sectors)}


def _next_frame(vertices: int) -> dict[str, float]:
    settings = MovieSettings()
    masks = [np.pad(_disk(vertices), ((0, 1), (0, 1))), np.pad(_disk(vertices), ((1, 0), (1, 0)))]
    small = cd.simulate.disk(20.0)
    map_frame(1, small, map_frame(0, small, None, settings), settings)
    last = map_frame(0, masks[0], None, settings)
    found = cost(lambda: map_frame(1, masks[1], last, settings))
    return found | {"outline (vertices)": len(last.disk.boundary), "area (px)": float(masks[0].sum())}


def _write_movie(folder: Path, frames: int) -> tuple[Path, Path]:
    """A simulated cell that moves forth and back, written frame by frame."""
    truth = cd.simulate.movie("bulging", frames=_SWING, radius_px=35.0)
    order = np.abs((np.arange(frames) + _SWING - 1) % (2 * _SWING - 2) - _SWING + 1)
    paths = folder / f"{frames}_masks.tif", folder / f"{frames}_signal.tif"
    assert truth.signal is not None
    for path, values, axes in zip(
        paths, (truth.masks, truth.signal.to_numpy()), ("TYX", "TCYX"), strict=True
    ):
        pages = (np.asarray(values[number], np.uint16) for number in order)
        shape = (frames, *values.shape[1:])
        tifffile.imwrite(path, pages, shape=shape, dtype=np.uint16, metadata={"axes": axes})
    return paths


def _movie(frames: int) -> dict[str, float]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _run_movie(_write_movie(folder, 3), folder / "warm", 1)
        files = _write_movie(folder, frames)
        return cost(lambda: _run_movie(files, folder / "study", 1)) | {"frames": frames}


def _run_movie(files: tuple[Path, Path], out: Path, workers: int) -> None:
    run_movie(open_movie(*files, MovieParameters()), out, workers=workers, overwrite=True)


def _cells(cells: int) -> dict[str, float]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _run_map(_write_cells(folder, 3), folder / "warm", 1)
        images = _write_cells(folder, cells)
        return cost(lambda: _run_map(images, folder / "study", 1)) | {"cells": cells}


def _write_cells(folder: Path, cells: int) -> Path:
    write_folder(folder / f"{cells}", cells)
    (folder / f"{cells}" / "0000b_masks.tif").unlink()  # the damaged one
    return folder / f"{cells}"


def _run_map(images: Path, out: Path, workers: int) -> None:
    run_map(open_inputs(images, "_img", MapParameters(layers=12)), out, workers=workers, overwrite=True)


def _movie_workers(workers: int) -> dict[str, float]:
    return _by_workers(workers, _write_movie, _run_movie, "frames")


def _cell_workers(workers: int) -> dict[str, float]:
    return _by_workers(workers, _write_cells, _run_map, "cells")


def _by_workers(
    workers: int, write: Callable[[Path, int], Any], run: Callable[[Any, Path, int], None], unit: str
) -> dict[str, float]:
    """Seconds by the clock that `_FURTHER` more frames or cells take, without what each run costs once."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        seconds = []
        for number in (3, _ONCE_PAID, _ONCE_PAID + _FURTHER):
            inputs, start = write(folder, number), time.perf_counter()
            run(inputs, folder / f"{number}_out", workers)
            seconds.append(time.perf_counter() - start)
    more = seconds[2] - seconds[1]
    return {"workers": workers, "seconds": more, f"{unit} a second": _FURTHER / more}


_OUTLINE, _AREA = "outline (vertices)", "area (px)"
_FACTORS = "sparse factors of a plane mesh take n^1.5 (nested dissection)"
_PIXELS = "every pixel is looked at a fixed number of times"
_FILL = "factors of a plane mesh hold n log n numbers, 1.2 over this range"
_STREAMED = "streamed: nothing may stay in memory (0.05 is 4 % a doubling)"
_SIZES = (100, 250, 630, 1600, 4000, 10000, 20000)

SERIES: dict[str, Series] = {
    series.name: series
    for series in (
        Series(
            "map of a disk",
            _SIZES,
            (250, 1000, 4000),
            lambda size: _map_cost(_disk(size)),
            (
                Growth("seconds", _OUTLINE, 2.0, "its area, in pixels, grows with the square of the outline"),
                Growth("seconds", _AREA, 1.0, _PIXELS),
                Growth("memory (MB)", _AREA, 1.0, _PIXELS),
            ),
        ),
        Series(
            "map of a fishbone",
            (2, 3, 5, 8, 13, 20, 28),
            (3, 6, 12),
            lambda size: _map_cost(fishbone(size)),
            (
                Growth("seconds", _OUTLINE, 1.5, _FACTORS),
                Growth("seconds a step", _OUTLINE, 1.5, _FACTORS),
                Growth("Newton steps", _OUTLINE, 0.2, "Newton's method need not know the size of the mesh"),
                Growth("memory (MB)", _OUTLINE, 1.2, _FILL),
            ),
        ),
        Series(
            "next frame of a disk",
            (250, 630, 1600, 4000, 10000),
            (250, 1000, 4000),
            _next_frame,
            (
                Growth("seconds", _OUTLINE, 2.0, "as the map of a disk"),
                Growth("seconds", _AREA, 1.0, _PIXELS),
                Growth("memory (MB)", _AREA, 1.0, _PIXELS),
            ),
        ),
        Series(
            "600 windows on a disk",
            (1000, 5000, 20000, 100000, 500000, 2000000),
            (2000, 20000, 200000),
            _windows_by_area,
            (Growth("seconds", _AREA, 1.0, _PIXELS), Growth("memory (MB)", _AREA, 1.0, _PIXELS)),
        ),
        Series(
            "windows on one disk",
            (5, 10, 20, 40, 70, 100),
            (5, 20, 70),
            _windows_by_number,
            (
                Growth("seconds", "windows", 1.0, "a window costs no more where there are many"),
                Growth("memory (MB)", "windows", 1.0, "a window costs no more where there are many"),
            ),
        ),
        Series(
            "frames of a movie",
            (8, 16, 32, 64, 128, 256),
            (8, 32),
            _movie,
            (
                Growth("seconds", "frames", 1.0, "a frame costs no more late in a movie"),
                Growth("peak (MB)", "frames", 0.05, _STREAMED),
            ),
        ),
        Series(
            "cells of label images",
            (50, 100, 200, 400, 800),
            (50, 200),
            _cells,
            (
                Growth("seconds", "cells", 1.0, "a cell costs no more late in a folder"),
                Growth("peak (MB)", "cells", 0.05, _STREAMED),
            ),
        ),
        Series(
            "workers on a movie",
            (1, 2),
            (1, 2),
            _movie_workers,
            (Growth("seconds", "workers", 0.0, "a frame's map waits for that of the frame before"),),
        ),
        Series(
            "workers on label images",
            (1, 2),
            (1, 2),
            _cell_workers,
            (Growth("seconds", "workers", -0.6, "cells do not wait for each other: 1.5 times as fast"),),
        ),
    )
}

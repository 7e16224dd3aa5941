"""What the points of `scaling.py` cost: time and memory of one kind of work at one size, in this process."""

import re
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import numpy as np
import tifffile

import cytodisk as cd
from cytodisk.arrays import BoolArray
from cytodisk.motion.mapped_frame import map_frame
from cytodisk.motion.tracking_parameters import MovieSettings
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.map.map_study import map_study
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from scale import write_folder

_REPEAT_BELOW_S = 0.3
_WIDTH_PX = 6  # of the spine and the teeth of a fishbone, and of the gaps between them
_RADIUS_PX = 60.0  # of the disk that more and more windows are put on
_ONCE_PAID, _FURTHER = 50, 200  # frames or cells: of the shorter run, and how many the longer one has more
_SWING = 8  # frames of a simulated movie that is run forth and back


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


def map_cost(mask: BoolArray) -> dict[str, float]:
    """Of `map_to_disk`, warm."""
    cd.map_to_disk(cd.simulate.disk(20.0))
    maps: list[cd.DiskMap] = []
    found = cost(lambda: maps.append(cd.map_to_disk(mask)))
    steps = max(maps[0].steps, 1)
    return found | {
        "outline (vertices)": len(maps[0].boundary),
        "area (px)": float(mask.sum()),
        "vertices": len(maps[0].vertices_yx),
        "Newton steps": steps,
        "seconds a step": found["seconds"] / steps,
    }


def disk_of(vertices: int) -> BoolArray:
    """A disk whose outline has about so many vertices, 8 for each pixel of its radius."""
    return cd.simulate.disk(vertices / 8.0)


def windows_by_area(area: int) -> dict[str, float]:
    """Of 10 × 60 windows on a disk of so many pixels, and of sampling two channels."""
    return _window_cost(cd.simulate.disk((area / np.pi) ** 0.5), 10, 60)


def windows_by_number(layers: int) -> dict[str, float]:
    """Of so many layers with twice as many sectors on one disk, and of sampling two channels."""
    return _window_cost(cd.simulate.disk(_RADIUS_PX), layers, 2 * layers)


def _window_cost(mask: BoolArray, layers: int, sectors: int) -> dict[str, float]:
    warm = cd.map_to_disk(cd.simulate.disk(20.0))
    signal = np.random.default_rng(0).normal(size=(2, *mask.shape))
    disk, grid = cd.map_to_disk(mask), cd.polar_windows(layers, sectors)
    cd.sample(grid.on(warm), np.zeros(warm.mask.shape))
    disk.to_disk([[0.0, 0.0]])  # lays out the bins of its triangles
    found = cost(lambda: cd.sample(grid.on(disk), signal))
    return found | {"area (px)": float(mask.sum()), "windows": float(layers * sectors)}


def next_frame(vertices: int) -> dict[str, float]:
    """Of a disk's second frame, a pixel away from the first: tracking and map."""
    settings = MovieSettings()
    masks = [np.pad(disk_of(vertices), ((0, 1), (0, 1))), np.pad(disk_of(vertices), ((1, 0), (1, 0)))]
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


def movie(frames: int) -> dict[str, float]:
    """Of the run of a movie with two channels."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _run_movie(_write_movie(folder, 3), folder / "warm", 1)
        files = _write_movie(folder, frames)
        return cost(lambda: _run_movie(files, folder / "study", 1)) | {"frames": frames}


def _run_movie(files: tuple[Path, Path], out: Path, workers: int) -> None:
    movie_study(open_movie(*files, MovieParameters()), out, workers=workers, overwrite=True)


def cells(number: int) -> dict[str, float]:
    """Of the run of label images with 50 cells each."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _run_map(_write_cells(folder, 3), folder / "warm", 1)
        images = _write_cells(folder, number)
        return cost(lambda: _run_map(images, folder / "study", 1)) | {"cells": number}


def _write_cells(folder: Path, cells: int) -> Path:
    write_folder(folder / f"{cells}", cells)
    (folder / f"{cells}" / "0000b_masks.tif").unlink()  # the damaged one
    return folder / f"{cells}"


def _run_map(images: Path, out: Path, workers: int) -> None:
    map_study(open_inputs(images, "_img", MapParameters(layers=12)), out, workers=workers, overwrite=True)


def movie_workers(workers: int) -> dict[str, float]:
    """Of further frames with so many processes."""
    return _by_workers(workers, _write_movie, _run_movie, "frames")


def cell_workers(workers: int) -> dict[str, float]:
    """Of further cells with so many processes."""
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

"""Memory of `cytodisk map` on one large label image, and of `cytodisk movie` by the size of the frames.

A label image of 10 000 × 10 000 pixels with 2 000 cells is mapped, and a movie of 100 cells is followed
twice: the same cells in frames of 1024² and of 2048² pixels. Printed are the peak memory of the process and
its workers together (pages that they share count in each), and what it comes to in bytes a pixel: above the
memory of the same run on a small image, and of the larger frames above the smaller. Ends with status 1 if a
target is missed.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import tifffile

import cytodisk as cd
from scale import resident_mb

MOST_MB = 600.0  # of a label image of 10 000 × 10 000 with 2 000 cells, in one process
MOST_BYTES_A_PIXEL = 12.0  # of a movie's larger frames: one frame of labels, and what looks at it
SMALL = 1000
LAYOUTS = {
    "strips": {"compression": "zlib"},
    "tiles": {"compression": "zlib", "tile": (512, 512)},
    "plain": {},
}
_LOOK_EVERY_S = 0.02


def label_image(side: int, cells: int, seed: int = 0, room: int | None = None) -> np.ndarray:
    """Cells on a square grid, none of which touches another."""
    across = int(np.ceil(np.sqrt(cells)))
    step = side // across
    shapes = list(_shapes(min(step, room or step) - 4, seed))
    image = np.zeros((side, side), dtype=np.uint16)
    for number in range(cells):
        y, x = (step * place + 2 for place in divmod(number, across))
        mask = shapes[number % len(shapes)]
        image[y : y + mask.shape[0], x : x + mask.shape[1]] = np.where(mask, number + 1, 0)
    return image


def _shapes(most: int, seed: int) -> Iterator[np.ndarray]:
    for number in range(20):
        mask = cd.simulate.random_smooth(seed + number, radius=0.3 * most, margin=0)
        yield mask[:most, :most]


def write_image(folder: Path, image: np.ndarray, layout: str, channels: int) -> list[str]:
    """Masks, and a signal if it has channels; gives the words of the command line that name them."""
    folder.mkdir()
    masks, signal = folder / "masks.tif", folder / "signal.tif"
    if layout == "npy":
        masks = folder / "masks.npy"
        np.save(masks, image)
    else:
        tifffile.imwrite(masks, image, **LAYOUTS[layout])
    if not channels:
        return [str(masks)]
    row = np.random.default_rng(0).poisson(100.0, image.shape[1]).astype(np.uint16)
    counts = np.stack([np.roll(row, 37 * number) for number in range(image.shape[0])])
    axes = {"axes": "CYX"} if channels > 1 else {"axes": "YX"}
    planes = np.broadcast_to(counts, (channels, *counts.shape)) if channels > 1 else counts
    tifffile.imwrite(
        signal, planes, photometric="minisblack", metadata=axes, **LAYOUTS.get(layout, LAYOUTS["plain"])
    )
    return [str(masks), "--signal", str(signal)]


def write_movie(folder: Path, side: int, cells: int, frames: int) -> list[str]:
    """The same cells in frames of any size, one pixel further right in each frame."""
    folder.mkdir()
    first = label_image(side, cells, room=100)
    stack = np.stack([np.roll(first, frame, axis=1) for frame in range(frames)])
    tifffile.imwrite(folder / "masks.tif", stack, compression="zlib", metadata={"axes": "TYX"})
    counts = np.random.default_rng(0).poisson(100.0, stack.shape).astype(np.uint16)
    tifffile.imwrite(folder / "signal.tif", counts, compression="zlib", metadata={"axes": "TYX"})
    return [str(folder / "masks.tif"), "--signal", str(folder / "signal.tif")]


def peak_mb(command: str, words: list[str], out: Path, workers: int) -> float:
    """Run a command in a process of its own; the largest memory of it and its workers, in MB."""
    grid = ["--layers", "3", "--sectors", "12", "--figures", "0"]
    line = [sys.executable, "-m", "cytodisk", command, *words, "-o", str(out), "--workers", str(workers)]
    running = subprocess.Popen([*line, *grid, "-q"], stderr=subprocess.PIPE, text=True)
    peak = last = 0.0
    while running.poll() is None:
        now = resident_mb(running.pid)
        peak = max(peak, min(last, now))  # a process that is just being started counts its parent's pages
        last = now
        time.sleep(_LOOK_EVERY_S)
    status = pd.read_parquet(out / "cells.parquet")["status"] if not running.returncode else None
    if status is None or set(status) != {"ok"}:
        said = running.stderr.read() if running.stderr else ""
        raise SystemExit(f"cytodisk {command} ended with {running.returncode}:\n{said}")
    return peak


def image_memory(folder: Path, chosen: argparse.Namespace) -> bool:
    """Map a large label image; whether its memory is within the target."""
    peaks = {}
    for side, cells in ((SMALL, 20), (chosen.side, chosen.cells)):
        words = write_image(folder / f"{side}", label_image(side, cells), chosen.layout, chosen.channels)
        peaks[side] = peak_mb("map", words, folder / f"{side}_out", chosen.workers)
    small, large = peaks.values()
    by_pixel = (large - small) * 2**20 / (chosen.side**2 - SMALL**2)
    met = large < MOST_MB * chosen.workers
    print(
        f"map, {chosen.side}² pixels, {chosen.cells} cells, {chosen.layout}, {chosen.channels} channels, "
        f"{chosen.workers} worker(s): {large:.0f} MB at most {MOST_MB * chosen.workers:.0f}, "
        f"{by_pixel:.1f} bytes a pixel above the {small:.0f} MB of {SMALL}² pixels: "
        f"{'met' if met else 'NOT MET'}",
        flush=True,
    )
    return met


def movie_memory(folder: Path, chosen: argparse.Namespace) -> bool:
    """Follow the same cells in frames of two sizes; whether memory grows with the cells' boxes alone."""
    peaks = {}
    for side in (chosen.movie_side // 2, chosen.movie_side):
        words = write_movie(folder / f"movie_{side}", side, chosen.movie_cells, chosen.frames)
        peaks[side] = peak_mb("movie", words, folder / f"movie_{side}_out", chosen.workers)
    (half, small), (whole, large) = peaks.items()
    by_pixel = (large - small) * 2**20 / (whole**2 - half**2)
    met = by_pixel < MOST_BYTES_A_PIXEL * (chosen.workers + 1)
    print(
        f"movie, {chosen.frames} frames, {chosen.movie_cells} cells, {chosen.workers} worker(s): "
        f"{small:.0f} MB with {half}² pixels, {large:.0f} MB with {whole}²: {by_pixel:.1f} bytes a "
        f"pixel more, at most {MOST_BYTES_A_PIXEL * (chosen.workers + 1):.0f}: {'met' if met else 'NOT MET'}",
        flush=True,
    )
    return met


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--side", type=int, default=10_000, help="of the label image (default 10 000)")
    parser.add_argument("--cells", type=int, default=2000, help="in it (default 2000)")
    parser.add_argument("--layout", choices=(*LAYOUTS, "npy"), default="strips", help="of the files")
    parser.add_argument("--channels", type=int, default=0, help="of a signal (default 0: none)")
    parser.add_argument("--movie-side", type=int, default=2048, help="of the larger frames (default 2048)")
    parser.add_argument("--movie-cells", type=int, default=100, help="in a frame (default 100)")
    parser.add_argument("--frames", type=int, default=3, help="of the movie (default 3)")
    parser.add_argument("--workers", type=int, default=1, help="processes (default 1)")
    parser.add_argument("--only", choices=("map", "movie"), help="one of the two")
    chosen = parser.parse_args()
    met = []
    with tempfile.TemporaryDirectory() as folder:
        if chosen.only != "movie":
            met.append(image_memory(Path(folder), chosen))
        if chosen.only != "map":
            met.append(movie_memory(Path(folder), chosen))
    return 0 if all(met) else 1


if __name__ == "__main__":
    sys.exit(main())

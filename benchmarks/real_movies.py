"""What `cytodisk movie` makes of real movies: completeness, consistency, time and memory.

A row a movie: frames with a map and without, maps without a valid certificate, empty windows, NaN among the
window means of mapped frames, the paper's two measures (correlation of consecutive frames, and how far window
centroids move, mean over layers and frames), seconds from start to end (loading, tracking, mapping, sampling,
velocity, tables, figures), and peak memory of the largest process.

With `--memory`: the same run on the first 40 and 400 frames of one movie, without figures.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tifffile

import cytodisk as cd


@dataclass(frozen=True)
class Movie:
    """Files of a movie below the data folder, and how many of its frames are used."""

    name: str
    masks: str
    signal: str | None = None
    frames: int | None = None
    interval_s: float | None = None


MOVIES = (
    Movie("melanoma", "melanoma_vasp_lpd/mask.tif", "melanoma_vasp_lpd/signal.ome.tif"),
    Movie("dictyostelium", "dictyostelium_rac1/mask.tif", "dictyostelium_rac1/rac1.tif", 200, 1.29),
    Movie("U373 cell", "tracked_cells/PhC-C2DH-U373_01_ST_cell02_t043-102.tif"),
    Movie("HeLa cell", "tracked_cells/DIC-C2DH-HeLa_01_ST_cell01_t000-029.tif"),
    Movie("U373 labels", "label_movies/PhC-C2DH-U373_01_ST_SEG_labels.tif"),
)


def shortened(path: Path, frames: int | None, folder: Path) -> Path:
    """The file itself, or a copy of its first frames."""
    if frames is None:
        return path
    target = folder / f"{frames}_{path.name}"
    tifffile.imwrite(target, tifffile.imread(path, key=slice(0, frames)), metadata={"axes": "TYX"})
    return target


def run(movie: Movie, data: Path, folder: Path, options: Sequence[str]) -> tuple[Path, float, float]:
    """Run the command; its study, seconds and peak memory in MB."""
    out = folder / movie.name.replace(" ", "_")
    command = [sys.executable, "-m", "cytodisk", "movie", "-o", str(out), "--overwrite", "--quiet", *options]
    command.append(str(shortened(data / movie.masks, movie.frames, folder)))
    if movie.signal is not None:
        command += ["--signal", str(shortened(data / movie.signal, movie.frames, folder))]
    if movie.interval_s is not None:
        command += ["--frame-interval", str(movie.interval_s)]
    start = time.perf_counter()
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    if os.waitstatus_to_exitcode(status):
        raise SystemExit(f"cytodisk movie failed on {movie.name}: {' '.join(command)}")
    return out, seconds, usage.ru_maxrss / 1024.0


def row_of(name: str, path: Path, seconds: float, memory: float) -> str:
    """A row of the table."""
    study = cd.open_study(path)
    cells, consistency = study.cells, study.consistency
    mapped = cells[cells["status"] == "ok"]
    means = study.windows["mean"]
    missing = int(means.isna().sum()) if study.windows["channel"].notna().any() else 0
    assert consistency is not None
    unit = consistency.attrs["units"]["centroid_displacement"]
    figures = [
        f"{len(mapped)}",
        f"{len(cells) - len(mapped)}",
        f"{int((~mapped['certificate_valid'].astype(bool)).sum())}",
        f"{int(mapped['empty_windows'].sum())}",
        f"{missing}",
        f"{consistency['correlation'].mean():.3f}",
        f"{consistency['centroid_displacement'].mean():.3f} {unit}",
        f"{seconds:.1f}",
        f"{memory:.0f}",
    ]
    return f"| {' | '.join([name, *figures])} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, default=Path(os.environ.get("CYTODISK_DATA", "../shared/data")))
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--only", help="name of one movie")
    parser.add_argument("--memory", action="store_true", help="compare 40 with 400 frames instead")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if arguments.memory:
            for frames in (40, 400):
                movie = Movie(f"{frames} frames", MOVIES[1].masks, MOVIES[1].signal, frames)
                _, seconds, memory = run(movie, arguments.data, folder, ["--figures", "0"])
                print(f"{frames} frames: {memory:.0f} MB at most, {seconds:.1f} s", flush=True)
            return
        print("| movie | mapped | not | invalid | empty | NaN | correlation | moved | seconds | MB |")
        print(f"|---|{'---:|' * 9}", flush=True)
        for movie in MOVIES:
            if arguments.only in (None, movie.name):
                options = ["--workers", str(arguments.workers)]
                print(row_of(movie.name, *run(movie, arguments.data, folder, options)), flush=True)


if __name__ == "__main__":
    np.seterr(all="raise", under="ignore")
    main()

"""How still windows stay from frame to frame on real movies, by method or by revision of the package.

    benchmarks/still_windows.py [--methods METHOD …] [--interior area|still] [--frames N]
    benchmarks/still_windows.py --compare OLD NEW

A row a movie and method: how far the centroids of 10 × 60 windows move from a frame to the next, the cell's
rigid motion taken out (median, mean and 95th percentile over windows and frames, in pixels), and the
correlation of window means over sectors with the next frame's (mean over layers and frames; layer 0; and the
innermost layer). The comparison measures two revisions, each with its own default method unless one is named;
"." stands for the files as they are. Reads the folder in CYTODISK_DATA.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import get_args

import numpy as np
import tifffile

import cytodisk as cd
from cytodisk.disk.mapping_parameters import Method
from suite import THREADS

DATA = Path(os.environ.get("CYTODISK_DATA", Path(__file__).parents[2] / "shared" / "data"))
LAYERS, SECTORS = 10, 60
MOVIES = {
    "melanoma": ("melanoma_vasp_lpd/mask.tif", "melanoma_vasp_lpd/signal.ome.tif"),
    "dictyostelium": ("dictyostelium_rac1/mask.tif", "dictyostelium_rac1/rac1.tif"),
}
_HEADS = ("median px", "mean px", "p95 px", "correlation", "layer 0", "innermost", "invalid")


def figures_of(masks: np.ndarray, signal: np.ndarray, **settings: str) -> list[float]:
    """The figures of a movie, in the order of the table."""
    movie = cd.map_movie(masks, **settings)
    activity = cd.sample_movie(movie, cd.polar_windows(LAYERS, SECTORS), signal)
    moved = cd.centroid_displacement(movie, activity).to_numpy()
    alike = cd.consecutive_correlation(activity["mean"])
    by_layer = alike.mean([dim for dim in alike.dims if dim != "layer"]).to_numpy()
    invalid = sum(not disk.certificate.valid for disk in movie)
    return [
        float(np.nanmedian(moved)),
        float(np.nanmean(moved)),
        float(np.nanpercentile(moved, 95)),
        float(by_layer.mean()),
        float(by_layer[0]),
        float(by_layer[-1]),
        invalid,
    ]


def print_rows(data: Path, methods: list[str], frames: int, interior: str) -> None:
    """A row for each movie and method."""
    for name, (masks, signal) in MOVIES.items():
        held = tifffile.imread(data / masks)[:frames] > 0
        values = tifffile.imread(data / signal)[:frames]
        if values.ndim == 3:
            values = values[:, None]
        for method in methods:
            words = {"interior": interior} | ({"method": method} if method != "default" else {})
            row = figures_of(held, values, **words)
            label = f"{name}, {len(held)} frames"
            print(f"{label:<28}{method:<18}" + "".join(f"{one:>12.4g}" for one in row), flush=True)


def compare(revisions: list[str], words: list[str]) -> int:
    """Run this script with the package of each revision."""
    from revisions import files_of

    with tempfile.TemporaryDirectory() as folder:
        for number, revision in enumerate(revisions):
            source = files_of(revision, Path(folder) / str(number)) / "src"
            print(f"\n{revision}", flush=True)
            environment = os.environ | {"PYTHONPATH": str(source)}
            run = subprocess.run([sys.executable, __file__, *words], env=environment, check=False)
            if run.returncode:
                return run.returncode
    return 0


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    methods = ("default", *(method for method in get_args(Method) if method not in ("advection", "harmonic")))
    parser.add_argument("--compare", nargs=2, metavar=("OLD", "NEW"), help="two revisions")
    parser.add_argument("--methods", nargs="+", default=None, metavar="METHOD", help=", ".join(methods))
    parser.add_argument("--interior", choices=("area", "still"), default="area")
    parser.add_argument("--frames", type=int, default=100, help="first frames of each movie (default 100)")
    parser.add_argument("--data", type=Path, default=DATA)
    chosen = parser.parse_args()
    if not chosen.data.is_dir():
        print(f"{chosen.data} does not exist: set CYTODISK_DATA or pass --data")
        return 1
    os.environ.update(dict.fromkeys(THREADS, "1"))
    if chosen.compare:
        words = ["--interior", chosen.interior, "--frames", str(chosen.frames), "--data", str(chosen.data)]
        return compare(chosen.compare, [*words, "--methods", *(chosen.methods or ["default"])])
    unknown = set(chosen.methods or ()) - set(methods)
    if unknown:
        parser.error(f"--methods must be some of {', '.join(methods)}, got {', '.join(unknown)}")
    print(f"package: {Path(cd.__file__).parent}", file=sys.stderr)
    print(f"{'movie':<28}{'method':<18}" + "".join(f"{head:>12}" for head in _HEADS))
    print_rows(chosen.data, chosen.methods or list(methods[1:]), chosen.frames, chosen.interior)
    return 0


if __name__ == "__main__":
    sys.exit(main())

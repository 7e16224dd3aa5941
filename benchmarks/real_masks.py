"""Map every real mask on its own and check every map: certificate, flips, lost pixels, windows.

    benchmarks/real_masks.py [--quick] [--only SOURCE …] [--results FILE]

Reads reference masks, single cells, neurons, merged Schwann cells, and each cell of each frame of the movies
from the folder in CYTODISK_DATA. No pixel may be lost, no window of a 10 × 60 or 12 × 60 grid be empty, sums
over windows must be those of the cell, and no osteosarcoma cell of at least 7 200 px may have an area error
of 12 × 60 windows (mean |ln| of their areas over their mean) above 0.15. With `--results`, a run that was
stopped goes on where it was. Prints a row a source; ends with status 1 if anything failed.
"""

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

import numpy as np
import tifffile

import cytodisk as cd
from checked_windows import SUM_ERROR, check_windows
from cytodisk.arrays import BoolArray
from cytodisk.disk.mapping_parameters import MappingParameters, Method
from cytodisk.errors import CytodiskError
from same_places import window_error
from stored_trials import StoredTrials
from suite import THREADS

DATA = Path(os.environ.get("CYTODISK_DATA", Path(__file__).parents[2] / "shared" / "data"))
SOURCES = {
    "reference": "reference_masks/*.tif",
    "osteosarcoma": "osteosarcoma/masks.tif",
    "neurons": "neurons/masks.tif",
    "schwann": "schwann_nuclei/*_cells.tif",
    "melanoma": "melanoma_vasp_lpd/mask.tif",
    "dictyostelium": "dictyostelium_rac1/mask.tif",
    "tracked cells": "tracked_cells/*.tif",
    "label movies": "label_movies/*.tif",
}
_MOVIES = ("melanoma", "dictyostelium", "tracked cells", "label movies")
_QUICK = {"osteosarcoma": 8, "neurons": 4} | dict.fromkeys(_MOVIES, 20)  # one in so many
_GRIDS = ((10, 60), (12, 60))
LARGE_PX, MOST_WINDOW_ERROR = 7200, 0.15


@dataclass(frozen=True)
class Job:
    """One cell: a page of a file, and its label there (0 for a mask)."""

    source: str
    file: str
    page: int
    label: int

    def read(self, data: Path) -> BoolArray:
        """Its mask, without most of the background."""
        image = tifffile.imread(data / self.file, key=self.page)
        mask = image == self.label if self.label else image > 0
        rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
        return np.asarray(mask[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1])


@dataclass(frozen=True)
class Check:
    """What one cell came to."""

    source: str
    file: str
    page: int
    label: int
    pixels: int = 0
    refused: str = ""
    valid: bool = False
    flips: int = 0
    lost: int = 0
    empty: int = 0
    sum_error: float = np.nan
    area_error: float = np.nan
    window_error: float = np.nan
    converged: bool = False

    @property
    def job(self) -> Job:
        """The cell."""
        return Job(self.source, self.file, self.page, self.label)

    @property
    def uneven(self) -> bool:
        """Whether it is a large osteosarcoma cell whose windows differ too much in area."""
        large = self.source == "osteosarcoma" and self.pixels >= LARGE_PX
        return large and not self.window_error <= MOST_WINDOW_ERROR

    @property
    def failed(self) -> bool:
        """True unless the cell was mapped and every check held."""
        wrong = bool(self.flips or self.lost or self.empty or self.refused) or self.uneven
        return wrong or not self.valid or not self.sum_error <= SUM_ERROR


def jobs_of(data: Path, names: Sequence[str], quick: bool) -> Iterator[Job]:
    """Every cell of the sources, or one in so many."""
    for name in names:
        for path in sorted(data.glob(SOURCES[name])):
            with tifffile.TiffFile(path) as stack:
                pages = range(0, len(stack.pages), _QUICK.get(name, 1) if quick else 1)
                for page in pages:
                    image = stack.pages[page].asarray()
                    labels = np.unique(image[image > 0]).tolist() if name == "label movies" else [0]
                    if image.any():
                        for label in labels:
                            yield Job(name, str(path.relative_to(data)), page, label)


def check(job: Job, data: Path, method: str) -> Check:
    """Map a cell and check the map."""
    place = (job.source, job.file, job.page, job.label)
    mask = job.read(data)
    try:
        disk = cd.map_to_disk(mask, method=method)
    except CytodiskError as error:
        return Check(*place, int(mask.sum()), f"{type(error).__name__}: {error}")
    certificate = disk.certificate
    empty, sum_error = check_windows(disk, _GRIDS)
    return Check(
        *place,
        int(disk.mask.sum()),
        valid=certificate.valid,
        flips=len(certificate.flipped_in_cell) + len(certificate.flipped_in_disk),
        lost=int(np.isnan(disk.to_disk(np.argwhere(disk.mask))[:, 0]).sum()),
        empty=empty,
        sum_error=sum_error,
        area_error=disk.distortion.area,
        window_error=window_error(disk, 12, 60),
        converged=disk.converged,
    )


def run(jobs: Sequence[Job], chosen: argparse.Namespace) -> Iterator[Check]:
    """Checks of all cells: those in the file of results, then the others, which are written there."""
    stored = StoredTrials(chosen.results, Path(cd.__file__).parent, chosen.method)
    done = {found.job: found for found in (Check(**row) for row in stored.read())}
    yield from (done[job] for job in jobs if job in done)
    left = [job for job in jobs if job not in done]
    with ProcessPoolExecutor(chosen.workers) as pool, stored.writing() as write:
        futures = [pool.submit(check, job, chosen.data, chosen.method) for job in left]
        for future in futures:
            write(future.result())
            yield future.result()


def print_table(checks: Sequence[Check]) -> None:
    """Print a row a source and a last one for all."""
    heads = ("cells", "refused", "invalid", "flips", "lost px", "empty")
    print(
        f"{'source':<16}"
        + "".join(f"{head:>9}" for head in heads)
        + f"{'sums off':>10}{'|log λ|':>9}{'windows':>9}{'worst':>8}{'not converged':>15}"
    )
    for source in (*SOURCES, "all"):
        rows = [one for one in checks if source in (one.source, "all")]
        mapped = [one for one in rows if not one.refused]
        if not mapped:
            continue
        counts = (
            len(rows),
            len(rows) - len(mapped),
            sum(not one.valid for one in mapped),
            sum(one.flips for one in mapped),
            sum(one.lost for one in mapped),
            sum(one.empty for one in mapped),
        )
        windows = [one.window_error for one in mapped]
        print(
            f"{source:<16}"
            + "".join(f"{count:>9}" for count in counts)
            + f"{max(one.sum_error for one in mapped):>10.1e}"
            f"{np.median([one.area_error for one in mapped]):>9.3f}{np.median(windows):>9.3f}"
            f"{max(windows):>8.3f}{sum(not one.converged for one in mapped):>15}"
        )


def print_failures(checks: Sequence[Check], shown: int = 20) -> None:
    """Print what failed, and the large osteosarcoma cells whose windows differ most in area."""
    failures = [one for one in checks if one.failed]
    for one in failures[:shown]:
        print(f"failed: {one}")
    large = [one for one in checks if one.source == "osteosarcoma" and one.pixels >= LARGE_PX]
    worst = sorted(large, key=lambda one: -one.window_error)[:5]
    if large:
        words = ", ".join(f"{one.page} ({one.pixels} px) {one.window_error:.3f}" for one in worst)
        above = sum(one.uneven for one in large)
        print(
            f"osteosarcoma cells of at least {LARGE_PX} px: {len(large)}, {above} above {MOST_WINDOW_ERROR}"
        )
        print(f"area error of their 12 × 60 windows, worst: {words}")
    print(f"{len(checks)} masks, {len(failures)} failures")


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--quick", action="store_true", help="one cell in 8, one neuron in 4, one frame in 20"
    )
    parser.add_argument("--only", nargs="+", choices=tuple(SOURCES), default=tuple(SOURCES))
    parser.add_argument("--method", choices=get_args(Method), default=MappingParameters().method)
    parser.add_argument("--results", type=Path, help="file of results: go on with what is missing in it")
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    chosen = parser.parse_args()
    if not chosen.data.is_dir():
        print(f"{chosen.data} does not exist: set CYTODISK_DATA or pass --data")
        return 1
    os.environ.update(dict.fromkeys(THREADS, "1"))
    checks = list(run(list(jobs_of(chosen.data, chosen.only, chosen.quick)), chosen))
    print_table(checks)
    print_failures(checks)
    return int(any(one.failed for one in checks))


if __name__ == "__main__":
    sys.exit(main())

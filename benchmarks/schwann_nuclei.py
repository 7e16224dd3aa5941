"""Map every real cell with its nucleus and check every map: certificate, flips, inverse, windows, sums.

    benchmarks/schwann_nuclei.py [--only SOURCE …] [--quick]

Reads the folder in CYTODISK_DATA. "schwann": fields of touching cells, whose merged mask is cut by a
watershed that starts from the nuclei. "osteosarcoma": single cells, in each a drawn nucleus, a disk at the
deepest place with half its depth as radius. Prints a row a source and why cells were refused; ends with
status 1 if a cell that was mapped failed, or a drawn nucleus was refused.
"""

import argparse
import os
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tifffile
from scipy import ndimage
from skimage.morphology import remove_small_objects
from skimage.segmentation import watershed

import cytodisk as cd
from checked_windows import SUM_ERROR, check_compartments
from cytodisk.arrays import BoolArray
from cytodisk.errors import CytodiskError
from cytodisk.simulate.nuclei.cells_with_nuclei import deepest_place
from random_nuclei import ROUND_TRIP_PX, check_points
from real_masks import DATA
from suite import THREADS

SOURCES = ("schwann", "osteosarcoma")
_QUICK = {"schwann": 4, "osteosarcoma": 16}  # one in so many
_GRID = (8, 60, 3)
_SPECK_PX = 100  # of a nuclear mask
_AROUND_PX = 30  # kept of the background, for what stands out of a cell


@dataclass(frozen=True, eq=False)
class Case:
    """A cell and its nucleus, cut out of their image, and (row, column) of the piece's first pixel in it."""

    source: str
    name: str
    mask: BoolArray
    nucleus: BoolArray
    corner: tuple[int, int]


@dataclass(frozen=True)
class Check:
    """What one cell came to."""

    source: str
    name: str
    pixels: int
    nucleus_pixels: int
    seconds: float = np.nan
    refused: str = ""
    notes: tuple[str, ...] = ()
    valid: bool = False
    flips: int = 0
    lost: int = 0
    astray: int = 0
    round_trip: float = np.nan
    empty: int = 0
    sum_error: float = np.nan
    window_error: float = np.nan
    converged: bool = False

    @property
    def failed(self) -> bool:
        """Whether the cell was mapped and a check did not hold, or a drawn nucleus was refused."""
        if self.refused:
            return self.source == "osteosarcoma"
        wrong = not self.valid or self.flips or self.lost or self.astray or self.empty
        return bool(wrong) or not self.round_trip < ROUND_TRIP_PX or not self.sum_error <= SUM_ERROR


def schwann_cases(data: Path) -> Iterator[Case]:
    """Cells of the fields, each cut around one piece of the nuclear mask."""
    for path in sorted((data / "schwann_nuclei").glob("*_cells.tif")):
        cells = tifffile.imread(path) > 0
        nuclei = tifffile.imread(path.with_name(path.name.replace("_cells", "_nuclei"))) > 0
        nuclei, _ = ndimage.label(remove_small_objects(nuclei, max_size=_SPECK_PX))
        away = ndimage.distance_transform_edt(nuclei == 0)
        cut = watershed(away, np.where(cells, nuclei, 0), mask=cells)
        labels = np.unique(cut[cut > 0])
        print(f"{path.stem[:2]}: {len(labels)} nuclei lie in cells, {nuclei.max() - len(labels)} in none")
        for label in labels:
            yield cropped("schwann", f"{path.stem[:2]} {label}", cut == label, nuclei == label)


def osteosarcoma_cases(data: Path) -> Iterator[Case]:
    """Single cells with a drawn nucleus."""
    for page, image in enumerate(tifffile.imread(data / "osteosarcoma" / "masks.tif")):
        mask, _ = cd.clean_mask(image > 0)
        (row, column), deep = deepest_place(mask)
        y, x = np.indices(mask.shape)
        yield cropped("osteosarcoma", str(page), mask, np.hypot(y - row, x - column) <= 0.5 * deep)


_CASES = {"schwann": schwann_cases, "osteosarcoma": osteosarcoma_cases}


def cropped(source: str, name: str, mask: BoolArray, nucleus: BoolArray) -> Case:
    """A case without most of the background."""
    rows, columns = (np.flatnonzero((mask | nucleus).any(axis=axis)) for axis in (1, 0))
    box = tuple(
        slice(max(int(found[0]) - _AROUND_PX, 0), int(found[-1]) + _AROUND_PX + 1)
        for found in (rows, columns)
    )
    corner = box[0].start, box[1].start
    return Case(source, name, mask[box].copy(), nucleus[box].copy(), corner)


def check(case: Case) -> Check:
    """Map a cell with its nucleus and check the map."""
    place = (case.source, case.name, int(case.mask.sum()), int(case.nucleus.sum()))
    start = time.process_time()
    try:
        disk = cd.map_to_disk(case.mask, nucleus=case.nucleus)
    except CytodiskError as error:
        return Check(*place, refused=f"{type(error).__name__}: {error}")
    seconds = time.process_time() - start
    empty, sum_error = check_compartments(disk, (_GRID,))
    lost, astray, round_trip = check_points(disk, np.random.default_rng(0))
    layers, sectors, nucleus_layers = _GRID
    windows = cd.polar_windows(layers, sectors, nucleus_layers=nucleus_layers).on(disk)
    return Check(
        *place,
        seconds=seconds,
        notes=disk.nucleus.report.notes,
        valid=disk.certificate.valid,
        flips=len(disk.certificate.flipped_in_cell) + len(disk.certificate.flipped_in_disk),
        lost=lost,
        astray=astray,
        round_trip=round_trip,
        empty=empty,
        sum_error=sum_error,
        window_error=max(windows.area_errors.values()),
        converged=disk.converged,
    )


def print_table(checks: Sequence[Check]) -> None:
    """Print a row a source."""
    print(
        f"{'source':<14}{'cells':>7}{'refused':>9}{'clipped':>9}{'invalid':>9}{'flips':>7}{'lost px':>9}"
        f"{'astray':>8}{'round trip px':>15}{'empty':>7}{'sums off by':>13}{'windows':>9}{'median s':>10}"
        f"{'max s':>8}{'not converged':>15}"
    )
    for source in SOURCES:
        rows = [one for one in checks if one.source == source]
        mapped = [one for one in rows if not one.refused]
        if not mapped:
            continue
        seconds = [one.seconds for one in mapped]
        print(
            f"{source:<14}{len(rows):>7}{len(rows) - len(mapped):>9}"
            f"{sum(bool(one.notes) for one in mapped):>9}"
            f"{sum(not one.valid for one in mapped):>9}{sum(one.flips for one in mapped):>7}"
            f"{sum(one.lost for one in mapped):>9}{sum(one.astray for one in mapped):>8}"
            f"{max(one.round_trip for one in mapped):>15.1e}{sum(one.empty for one in mapped):>7}"
            f"{max(one.sum_error for one in mapped):>13.1e}"
            f"{np.median([one.window_error for one in mapped]):>9.3f}"
            f"{np.median(seconds):>10.3f}{max(seconds):>8.3f}{sum(not one.converged for one in mapped):>15}"
        )


def print_failures(checks: Sequence[Check], shown: int = 20) -> None:
    """Print why cells were refused, and what failed or did not converge."""
    reasons = Counter(one.refused.split("(")[0] for one in checks if one.refused)
    for reason, count in reasons.most_common(shown):
        print(f"refused {count} times: {reason}")
    for one in [one for one in checks if one.failed][:shown]:
        print(f"failed: {one}")
    slow = [f"{one.source} {one.name}" for one in checks if not (one.refused or one.converged)]
    if slow:
        print(f"not converged: {', '.join(slow[:shown])}")
    print(f"{len(checks)} cells, {sum(one.failed for one in checks)} failures")


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", nargs="+", choices=SOURCES, default=SOURCES)
    parser.add_argument("--quick", action="store_true", help="one Schwann cell in 4, one osteosarcoma in 16")
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    chosen = parser.parse_args()
    if not chosen.data.is_dir():
        print(f"{chosen.data} does not exist: set CYTODISK_DATA or pass --data")
        return 1
    os.environ.update(dict.fromkeys(THREADS, "1"))
    cases: list[Case] = []
    for source in chosen.only:
        cases += list(_CASES[source](chosen.data))[:: _QUICK[source] if chosen.quick else 1]
    with ProcessPoolExecutor(chosen.workers) as pool:
        checks = list(pool.map(check, cases))
    print_table(checks)
    print_failures(checks)
    return int(any(one.failed for one in checks))


if __name__ == "__main__":
    sys.exit(main())

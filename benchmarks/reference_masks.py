"""Map the reference masks and print how far each map is from keeping area and shape.

Areas are compared by triangle (|log λ|) and by window of a 10 × 60 grid of equal areas: windows are what is
read, and the default map lets triangles differ so that its windows come out the same on another mesh. Reads
`reference_masks/*.tif` from the folder in CYTODISK_DATA; ends with status 1 if the windows of the default map
miss a target. Beside advection stand figures measured with the published code, which are not measured here.
"""

import argparse
import csv
import os
import sys
import time
from pathlib import Path
from typing import Any, get_args

import numpy as np
import tifffile

from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.mapping_parameters import Method
from cytodisk.windows.polar_windows import polar_windows

TARGETS = {  # largest mean |log (area share of a window / 1 in 600)|
    "example": 0.04,
    "disk60": 0.007,
    "ellipse5to1": 0.03,
    "star5": 0.09,
    "dumbbell3px": 0.13,
    "neuron": 0.40,
}
_METHODS: tuple[Method, ...] = ("harmonic", "advection", "newton-triangles", "newton")
_DEFAULT_DATA = Path(__file__).parents[2] / "shared" / "data"
# The published u-Unwrap (on u-Unwrap3D 1.0.2), run once on these masks with one thread; "area" is
# its variant with the cell's triangle areas as target. 500 iterations, 100 on disk60 and ellipse5to1;
# dumbbell3px ended in an error at 197, in 124 s on a busy machine. The other times are those of an idle one.
# (mask, flow): seconds, flips, |log λ|, λ p1, λ p99, K median, K p95, share of the mask outside.
PUBLISHED: dict[tuple[str, str], tuple[float, ...]] = {
    ("example", "uniform"): (160, 69, 0.80, 0.16, 6.1, 3.5, 22, 0.019),
    ("example", "area"): (160, 121, 0.39, 0.46, 4.0, 4.0, 28, 0.019),
    ("disk60", "area"): (45, 0, 0.01, 0.87, 1.14, 1.1, 1.3, 0.0),
    ("ellipse5to1", "area"): (22, 0, 0.03, 0.85, 1.18, 4.8, 5.8, 0.004),
    ("star5", "area"): (50, 70, 0.27, 0.41, 3.4, 4.4, 21, 0.066),
    ("dumbbell3px", "area"): (124, 730, 0.14, 0.59, 18, 5.6, 719, 0.009),
    ("neuron", "area"): (10, 54, 1.09, 0.23, 61, 3.2, 63, 0.42),
}
_TABLE = (  # column of the file, head and format of the printed one
    ("mask", "mask", "<13"),
    ("map", "map", "<19"),
    ("vertices", "vertices", ">9"),
    ("steps", "steps", ">7"),
    ("flips", "flips", ">7"),
    ("window_error", "windows", ">9.4f"),
    ("target", "target", ">8"),
    ("area_error", "|log λ|", ">9.4f"),
    ("area_ratio_p1", "λ p1", ">9.3f"),
    ("area_ratio_p99", "λ p99", ">9.3f"),
    ("stretch_median", "K median", ">9.2f"),
    ("stretch_p95", "K p95", ">10.2f"),
    ("outside", "outside", ">9"),
    ("seconds", "seconds", ">9.2f"),
)
_COLUMNS = tuple(column for column, _, _ in _TABLE)


def data_folder() -> Path:
    """Folder of the masks: CYTODISK_DATA, or `shared/data` beside the repository."""
    return Path(os.environ.get("CYTODISK_DATA", _DEFAULT_DATA))


def measure(name: str, method: Method, folder: Path) -> tuple[dict[str, Any], bool]:
    """Map one mask; its row, and whether it meets the target of the default map."""
    mask = tifffile.imread(folder / f"{name}.tif")
    start = time.perf_counter()
    disk = map_to_disk(mask, method=method)
    seconds = time.perf_counter() - start
    area, stretch = disk.distortion.area_percentiles, disk.distortion.angle_percentiles
    flips = len(disk.certificate.flipped_in_cell) + len(disk.certificate.flipped_in_disk)
    outside = int(np.isnan(disk.to_disk(np.argwhere(disk.mask))[:, 0]).sum())
    error = window_error(disk)
    met = error <= TARGETS[name] and disk.certificate.valid and not outside
    values = (name, method, len(disk.vertices_yx), disk.steps, flips, error, TARGETS[name])
    spread = (disk.distortion.area, area[1], area[99], stretch[50], stretch[95], outside, seconds)
    return dict(zip(_COLUMNS, values + spread, strict=True)), met


def window_error(disk: DiskMap) -> float:
    """Mean |log| of the area shares of a cell's windows, over equal shares; of earlier versions, too."""
    areas = polar_windows(10, 60, spacing="area").on(disk).areas
    return float(np.abs(np.log(areas * areas.size / areas.sum())).mean())


def published(name: str) -> list[dict[str, Any]]:
    """Rows of the published code for one mask; what was not noted is left out."""
    rows = []
    for (mask, flow), figures in PUBLISHED.items():
        if mask == name:
            seconds, flips, error, *spread, outside = figures
            known = {"mask": name, "map": f"published {flow}", "flips": int(flips), "area_error": error}
            known |= dict(zip(_COLUMNS[8:12], spread, strict=True))
            rows.append(known | {"outside": f"{outside:.1%}", "seconds": seconds})
    return rows


def print_row(row: dict[str, Any], note: str = "") -> None:
    """One line of the table; a figure that is not known is a dash."""
    cells = [
        f"{row[column]:{form}}" if column in row else f"{'-':{form.split('.')[0]}}"
        for column, _, form in _TABLE
    ]
    print("".join(cells) + note, flush=True)


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=data_folder(), help="folder that holds reference_masks/")
    parser.add_argument("--method", choices=(*get_args(Method), "all"), default="newton")
    parser.add_argument("--csv", type=Path, help="write the table to this file, too")
    arguments = parser.parse_args()
    folder = arguments.data / "reference_masks"
    if not folder.is_dir():
        print(f"{folder} does not exist: set CYTODISK_DATA or pass --data")
        return 1
    methods: tuple[Method, ...] = _METHODS if arguments.method == "all" else (arguments.method,)
    for method in methods:
        map_to_disk(np.ones((5, 5), dtype=bool), method=method)  # loads the compiled kernels
    print("".join(f"{head:{form.split('.')[0]}}" for _, head, form in _TABLE))
    rows, missed = [], False
    for name in TARGETS:
        for method in methods:
            row, met = measure(name, method, folder)
            print_row(row, "  MISSED" if method == "newton" and not met else "")
            missed |= method == "newton" and not met
            rows.append(row)
            for known in published(name) if method == "advection" else []:
                print_row(known)
                rows.append(known)
    if arguments.csv:
        with arguments.csv.open("w", newline="", encoding="utf-8") as stream:
            writer = csv.DictWriter(stream, _COLUMNS)
            writer.writeheader()
            writer.writerows(rows)
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())

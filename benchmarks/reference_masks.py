"""Map the reference masks and print how far each map is from keeping area and shape.

Reads `reference_masks/*.tif` from the folder in CYTODISK_DATA; ends with status 1 if a target is missed.
"""

import argparse
import os
import sys
import time
from pathlib import Path

import numpy as np
import tifffile

from cytodisk.disk.mapping import map_to_disk

TARGETS = {  # largest mean |log λ|
    "example": 0.04,
    "disk60": 0.007,
    "ellipse5to1": 0.03,
    "star5": 0.09,
    "dumbbell3px": 0.13,
    "neuron": 0.40,
}
_DEFAULT_DATA = Path(__file__).parents[2] / "shared" / "data"


def data_folder() -> Path:
    """Folder of the masks: CYTODISK_DATA, or `shared/data` beside the repository."""
    return Path(os.environ.get("CYTODISK_DATA", _DEFAULT_DATA))


def print_row(name: str, target: float, folder: Path) -> bool:
    """Map one mask, print its row, and say whether it meets its target."""
    mask = tifffile.imread(folder / f"{name}.tif")
    start = time.perf_counter()
    disk = map_to_disk(mask)
    seconds = time.perf_counter() - start
    area, stretch = disk.distortion.area_percentiles, disk.distortion.angle_percentiles
    flips = len(disk.certificate.flipped_in_cell) + len(disk.certificate.flipped_in_disk)
    outside = int(np.isnan(disk.to_disk(np.argwhere(disk.mask))[:, 0]).sum())
    met = disk.distortion.area <= target and disk.certificate.valid and not outside
    print(
        f"{name:<13}{len(disk.vertices_yx):>9}{disk.steps:>7}{flips:>7}{disk.distortion.area:>9.4f}{target:>8}"
        f"{area[1]:>9.3f}{area[99]:>9.3f}{stretch[50]:>9.2f}{stretch[95]:>10.2f}{outside:>9}{seconds:>9.3f}"
        f"{'' if met else '  MISSED'}"
    )
    return met


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=data_folder(), help="folder that holds reference_masks/")
    folder = parser.parse_args().data / "reference_masks"
    if not folder.is_dir():
        print(f"{folder} does not exist: set CYTODISK_DATA or pass --data")
        return 1
    map_to_disk(np.ones((5, 5), dtype=bool))  # loads the compiled kernels
    print(
        f"{'mask':<13}{'vertices':>9}{'steps':>7}{'flips':>7}{'|log λ|':>9}{'target':>8}{'λ p1':>9}"
        f"{'λ p99':>9}{'K median':>9}{'K p95':>10}{'outside':>9}{'seconds':>9}"
    )
    met = [print_row(name, target, folder) for name, target in TARGETS.items()]
    return 0 if all(met) else 1


if __name__ == "__main__":
    sys.exit(main())

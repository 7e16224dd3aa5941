"""How far "upright" turns when a mask changes by a pixel, is shifted or is turned.

Compares the angles of outline points that two masks share; prints the worst and the median turn.
"""

import argparse
import os
import sys
from pathlib import Path

import numpy as np
import tifffile
from scipy import ndimage

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.circle import boundary_angles
from cytodisk.errors import MaskError
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.outline import trace_outline

_DEFAULT_DATA = Path(__file__).parents[2] / "shared" / "data"
_LIMIT_DEGREES = 2.0


def angle_by_point(mask: BoolArray) -> dict[tuple[float, float], float]:
    """Angle of each outline point, in radians."""
    outline = trace_outline(mask)
    return {(y, x): a for (y, x), a in zip(outline.tolist(), boundary_angles(outline), strict=True)}


def turns(mask: BoolArray, other: BoolArray, move: tuple[float, float] = (0.0, 0.0)) -> FloatArray:
    """Change of angle at each shared outline point, in degrees; `other` is displaced by `move`."""
    before, after = angle_by_point(mask), angle_by_point(other)
    pairs = [
        (angle, after[y + move[0], x + move[1]])
        for (y, x), angle in before.items()
        if (y + move[0], x + move[1]) in after
    ]
    first, second = np.array(pairs).T
    return np.degrees(np.angle(np.exp(1j * (second - first))))


def with_one_pixel_changed(mask: BoolArray, random: np.random.Generator) -> BoolArray:
    """Add or remove a random pixel at the edge so that the cell stays one piece without holes."""
    grown, shrunk = ndimage.binary_dilation(mask) & ~mask, mask & ~ndimage.binary_erosion(mask)
    while True:
        candidates = np.argwhere(grown if random.random() < 0.5 else shrunk)
        row, column = candidates[random.integers(len(candidates))]
        changed = mask.copy()
        changed[row, column] ^= True
        cleaned, report = clean_mask(changed)
        if report.components == 1 and not report.holes:
            return cleaned


def read_masks(data: Path, count: int) -> dict[str, BoolArray]:
    """Reference masks and the first osteosarcoma cells that are in one piece, each with a border."""
    raw = {path.stem: tifffile.imread(path) for path in sorted((data / "reference_masks").glob("*.tif"))}
    cells = tifffile.imread(data / "osteosarcoma" / "masks.tif", key=range(count))
    raw |= {f"osteosarcoma {n}": cell for n, cell in enumerate(cells)}
    masks = {}
    for name, mask in raw.items():
        try:
            masks[name] = np.pad(clean_mask(mask, fragments="error")[0], 6)
        except MaskError:
            continue
    return masks


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--changes", type=int, default=20, help="random changes of each mask (default 20)")
    parser.add_argument("--cells", type=int, default=60, help="osteosarcoma masks to read (default 60)")
    parser.add_argument(
        "--data",
        type=Path,
        default=Path(os.environ.get("CYTODISK_DATA", _DEFAULT_DATA)),
        help="folder that holds reference_masks/ and osteosarcoma/",
    )
    arguments = parser.parse_args()
    if not arguments.data.is_dir():
        print(f"{arguments.data} does not exist: set CYTODISK_DATA or pass --data")
        return 1
    random = np.random.default_rng(0)
    print(
        f"{'mask':<18}{'one pixel: median turn, worst turn':>36}{'worst point':>13}{'shift':>10}"
        f"{'quarter':>10}"
    )
    worst = 0.0
    for name, mask in read_masks(arguments.data, arguments.cells).items():
        changes = [turns(mask, with_one_pixel_changed(mask, random)) for _ in range(arguments.changes)]
        whole = [abs(float(np.median(change))) for change in changes]
        point = max(float(np.abs(change).max()) for change in changes)
        shift = np.abs(turns(mask, np.roll(mask, (3, -4), axis=(0, 1)), (3.0, -4.0))).max()
        quarter = np.abs(quarter_turn(mask)).max()
        print(
            f"{name:<18}{np.median(whole):>24.3f}{max(whole):>12.3f}{point:>13.3f}{shift:>10.1e}{quarter:>10.1e}"
        )
        worst = max(worst, *whole)
    print(f"worst turn by one pixel: {worst:.3f}° (limit {_LIMIT_DEGREES}°)")
    return 0 if worst < _LIMIT_DEGREES else 1


def quarter_turn(mask: BoolArray) -> FloatArray:
    """What is left of the change of angle, in degrees, when mask and angles are turned by 90°."""
    before, after = angle_by_point(mask), angle_by_point(np.rot90(mask))
    last = mask.shape[1] - 1
    # np.rot90 takes (row, column) to (last - column, row): from +y towards +x, by -90° in (u, v).
    left = [after[last - x, y] - angle + 0.5 * np.pi for (y, x), angle in before.items()]
    return np.degrees(np.angle(np.exp(1j * np.array(left))))


if __name__ == "__main__":
    sys.exit(main())

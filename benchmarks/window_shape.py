"""How regular windows are by layer, for other weights of shape, spacings and maps, beside edge-based ones.

Medians over every n-th osteosarcoma cell, from the folder in CYTODISK_DATA. The last column is the area
error of the map: what a more regular shape would cost. The spread of log (length / width) stands beside
that of eccentricity, which is steep for windows that are about as long as they are wide.
"""

import argparse
import os
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import tifffile

import cytodisk as cd
from cytodisk.arrays import FloatArray
from cytodisk.windows.on_cell import WindowsOnCell

DEFAULT_DATA = Path(__file__).parents[2] / "shared" / "data"
MAPS = {
    "newton (default)": ({}, "area"),
    "newton, spacing radius": ({}, "radius"),
    "newton, shape_weight 0.02": ({"shape_weight": 0.02}, "area"),
    "newton, shape_weight 0.1": ({"shape_weight": 0.1}, "area"),
    "newton, shape_weight 0.5": ({"shape_weight": 0.5}, "area"),
    "harmonic": ({"method": "harmonic"}, "area"),
}
MEASURES = ("CV of area", "CV of eccentricity", "spread of log (length / width)", "mean eccentricity")


def measures(windows: WindowsOnCell) -> FloatArray:
    """The measures of each layer over its windows that hold signal, shape (measures, layers)."""
    held = windows.areas > 0
    rows = []
    for areas, eccentricities, there in zip(windows.areas, windows.eccentricities, held, strict=True):
        area, eccentricity = areas[there], np.minimum(eccentricities[there], 1.0 - 1e-12)
        if len(area) < 2:
            rows.append([np.nan] * len(MEASURES))
            continue
        elongation = -0.5 * np.log(1.0 - eccentricity**2)
        mean = eccentricity.mean()
        rows.append([area.std() / area.mean(), eccentricity.std() / mean, elongation.std(), mean])
    return np.array(rows).T


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, default=Path(os.environ.get("CYTODISK_DATA", DEFAULT_DATA)))
    parser.add_argument("--every", type=int, default=10, help="take every n-th cell")
    parser.add_argument("--layers", type=int, default=12)
    parser.add_argument("--sectors", type=int, default=60)
    chosen = parser.parse_args()
    path = chosen.data / "osteosarcoma" / "masks.tif"
    if not path.exists():
        print(f"{path} does not exist: set CYTODISK_DATA or pass --data")
        return 1
    masks = tifffile.imread(path)[:: chosen.every]
    found: dict[str, list[FloatArray]] = {}
    errors: dict[str, list[float]] = {}
    for mask in masks:
        for name, (options, spacing) in MAPS.items():
            disk = cd.map_to_disk(mask, **options)
            windows = cd.polar_windows(chosen.layers, chosen.sectors, spacing).on(disk)
            found.setdefault(name, []).append(measures(windows))
            errors.setdefault(name, []).append(disk.distortion.area)
        edge = cd.edge_windows(mask, chosen.layers, chosen.sectors)
        found.setdefault("edge-based", []).append(measures(edge))
    print(f"{len(masks)} cells, {chosen.layers} × {chosen.sectors} windows; medians over cells, by layer")
    for number, measure in enumerate(MEASURES):
        table = pd.DataFrame(
            {name: np.nanmedian([one[number] for one in all_], axis=0) for name, all_ in found.items()}
        ).T
        if measure == "CV of area":
            table["area error"] = pd.Series({name: np.median(values) for name, values in errors.items()})
        print(f"\n{measure}\n{table.to_string(float_format='%.3f', na_rep='')}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

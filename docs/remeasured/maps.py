"""The reference masks: area error, flips and time of each method, beside the published code's."""

import time
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import tifffile

import cytodisk as cd
from cytodisk.disk.by_advection.advection import advect
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.harmonic import harmonic_map
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.geometry.mesh import triangle_areas

MASKS = ("example", "disk60", "ellipse5to1", "star5", "dumbbell3px", "neuron")
METHODS = ("harmonic", "advection", "newton")
FREE = ("ellipse5to1", "star5")  # on others, flips that may turn triangles over in the cell tear the mesh
PUBLISHED = Path(__file__).parent / "published_code.csv"


def measure(folder: Path) -> pd.DataFrame:
    """One row a mask and method."""
    cd.map_to_disk(np.ones((5, 5), dtype=bool))  # loads the compiled kernels
    cd.map_to_disk(np.ones((5, 5), dtype=bool), method="advection")
    return pd.DataFrame([_row(folder, mask, method) for mask in MASKS for method in METHODS])


def free_flips(folder: Path) -> dict[str, int]:
    """Triangles that the paper's relaxation turns over on two masks, if flips may do so in the cell."""
    turned = {"disk": 0, "cell": 0}
    for name in FREE:
        cell = mesh_cell(tifffile.imread(folder / f"{name}.tif"), MappingParameters(method="advection"))
        angles = boundary_angles(cell.outline)
        start, _ = harmonic_map(cell.mesh, np.column_stack([np.cos(angles), np.sin(angles)]))
        free = advect(cell.mesh, start, whole_cell=False)
        turned["disk"] += int((triangle_areas(free.vertices_uv[:, ::-1], free.triangles) <= 0).sum())
        turned["cell"] += int((triangle_areas(cell.mesh.vertices_yx, free.triangles) <= 0).sum())
    return turned


def _row(folder: Path, name: str, method: Any) -> dict[str, Any]:
    mask = tifffile.imread(folder / f"{name}.tif")
    start = time.perf_counter()
    disk = cd.map_to_disk(mask, method=method)
    seconds = time.perf_counter() - start
    area, stretch = disk.distortion.area_percentiles, disk.distortion.angle_percentiles
    outside = np.isnan(disk.to_disk(np.argwhere(disk.mask))[:, 0]).mean()
    windows = cd.polar_windows(10, 60).on(disk)
    flipped = disk.certificate.flipped_in_disk + disk.certificate.flipped_in_cell
    return {
        "mask": name,
        "method": method,
        "seconds": seconds,
        "flips": len(flipped),
        "error": disk.distortion.area,
        "of_windows": windows.area_error,
        "p1": area[1],
        "p99": area[99],
        "stretch": stretch[50],
        "stretch_95": stretch[95],
        "outside": outside,
        "windows": float((windows.areas > 0).mean()),
    }


def write(found: dict[str, Any], files: Path) -> dict[str, Any]:
    """The table of the page, `reference_masks.csv`: the published code's rows, then ours."""
    rows = [_published_words(row) for row in pd.read_csv(PUBLISHED).itertuples()]
    rows += [_our_words(row) for row in found["maps"].itertuples()]
    order = {name: place for place, name in enumerate(MASKS)}
    table = pd.DataFrame(rows).sort_values("mask", key=lambda masks: masks.map(order), kind="stable")
    table.to_csv(files / "reference_masks.csv", index=False)
    ours = found["maps"]
    advection = ours[(ours["method"] == "advection") & ours["mask"].isin(FREE)]
    return {
        "kept_flips": int(advection["flips"].sum()),
        "free_in_disk": found["free_flips"]["disk"],
        "free_in_cell": found["free_flips"]["cell"],
    }


def _published_words(row: Any) -> dict[str, Any]:
    return {
        "mask": row.mask,
        "map": f"published code, {row.flow}",
        "seconds": f"≈ {row.seconds}",
        "triangles turned over": row.flips,
        "area error of triangles": f"{row.final:.2f} (harmonic {row.harmonic:.2f})",
        "area error of 10 × 60 windows": "not measured",
        "λ, 1 % to 99 %": f"{row.lambda_p1:g} to {row.lambda_p99:g}",
        "stretch K, median / 95 %": f"{row.stretch_median:g} / {row.stretch_p95:g}",
        "pixels outside": f"{row.outside_percent:g} %",
        "10 × 60 windows with signal": f"{row.windows_percent:g} %",
    }


def _our_words(row: Any) -> dict[str, Any]:
    return {
        "mask": row.mask,
        "map": f"cytodisk, {row.method}",
        "seconds": f"{row.seconds:.2f}",
        "triangles turned over": row.flips,
        "area error of triangles": f"{row.error:.3f}",
        "area error of 10 × 60 windows": f"{row.of_windows:.3f}",
        "λ, 1 % to 99 %": f"{row.p1:.2f} to {row.p99:.2f}",
        "stretch K, median / 95 %": f"{row.stretch:.1f} / {row.stretch_95:.0f}",
        "pixels outside": f"{100 * row.outside:.1f} %",
        "10 × 60 windows with signal": f"{100 * row.windows:.1f} %",
    }

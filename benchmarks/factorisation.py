"""Processor time of one Newton step's linear system, as it is and in two other ways.

"blocks": with a pressure at each vertex, by 3×3 blocks, as in `disk.pressure_blocks`. "numbers": the same
matrix by single numbers (QDLDL). "no pressure": the pressures are eliminated first, which couples each vertex
with its neighbours' neighbours (QDLDL). The system is that of the first step of each mask. Last, the time of
the order of elimination with the pattern of the factors, which is found once for a mesh.
"""

import argparse
import os
import sys
import time
from pathlib import Path

import numpy as np
import qdldl
import tifffile
from scipy import sparse

from cytodisk import simulate
from cytodisk.arrays import BoolArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.harmonic import harmonic_map
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.disk.pressure_blocks import PressureSystem
from cytodisk.disk.vertex_energy import averaged_elements, fill_step
from cytodisk.geometry.mesh import hat_gradients, triangle_areas
from speed import _DEFAULT_DATA, median_seconds, restart_with_one_thread


def whole_matrix(system: PressureSystem) -> sparse.csc_matrix:
    """The matrix of a system, both triangles."""
    pattern = system.pattern
    column = np.repeat(np.arange(len(pattern.vertex)), np.diff(pattern.first))
    p, q = np.meshgrid(range(3), range(3), indexing="ij")
    rows, columns = 3 * pattern.row[:, None, None] + p, 3 * column[:, None, None] + q
    size = 3 * len(pattern.vertex)
    stored = sparse.coo_matrix((system.blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))
    upper = sparse.csc_matrix(sparse.triu(stored))
    return sparse.csc_matrix(upper + sparse.triu(upper, 1).T)


def compare(name: str, mask: BoolArray, repeats: int) -> None:
    """Print the times for one mask, and how far apart the steps are."""
    parameters = MappingParameters()
    cell = mesh_cell(mask, parameters)
    mesh, shared = cell.mesh, BlockSystem(cell.mesh)
    angles = boundary_angles(cell.outline)
    uv, _ = harmonic_map(mesh, np.column_stack([np.cos(angles), np.sin(angles)]), shared)
    areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
    scale = np.sqrt(triangle_areas(uv[:, ::-1], mesh.triangles).sum() / areas.sum())
    hats = hat_gradients(mesh.vertices_yx * scale, mesh.triangles)
    elements = averaged_elements(mesh.triangles, hats, areas / areas.sum(), shared.unknown)
    system, right = PressureSystem(shared.pattern), np.empty((len(shared.vertex), 3))
    place, diagonal = shared.pattern.place, shared.pattern.diagonal
    fill_step(uv, elements, parameters.shape_weight, place, diagonal, system.blocks, right)

    matrix = whole_matrix(system)
    upper = sparse.csc_matrix(sparse.triu(matrix))
    pressure = np.arange(matrix.shape[0]) % 3 == 2
    shapes, areas_of = matrix[~pressure][:, ~pressure], matrix[pressure][:, ~pressure]
    eliminated = sparse.csc_matrix(sparse.triu(shapes + 2.0 * areas_of.T @ areas_of))
    eliminated_right = right[:, :2].ravel() + 2.0 * (areas_of.T @ right[:, 2])
    numbers, fewer = qdldl.Solver(upper, upper=True), qdldl.Solver(eliminated, upper=True)

    def by_blocks() -> object:
        system.factorise()
        return system.solve(right)

    def by_numbers() -> object:
        numbers.update(upper, upper=True)
        return numbers.solve(right.ravel())

    def without_pressure() -> object:
        fewer.update(eliminated, upper=True)
        return fewer.solve(eliminated_right)

    step = np.asarray(by_blocks())[:, :2].ravel()
    others = (np.asarray(by_numbers()).reshape(-1, 3)[:, :2].ravel(), np.asarray(without_pressure()))
    apart = max(float(np.abs(step - other).max()) for other in others) / float(np.abs(step).max())
    times = [
        median_seconds(way, repeats, time.process_time) for way in (by_blocks, by_numbers, without_pressure)
    ]
    found = median_seconds(lambda: BlockSystem(mesh), max(3, repeats // 5), time.process_time)
    print(
        f"{name:<18}{len(right):>8}"
        + "".join(f"{1e3 * seconds:>13.2f}" for seconds in (*times, found))
        + f"{apart:>10.0e}"
    )


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=25, help="timed calls of each kind (default 25)")
    parser.add_argument(
        "--data", type=Path, default=Path(os.environ.get("CYTODISK_DATA", _DEFAULT_DATA)),
        help="folder that holds reference_masks/",
    )  # fmt: skip
    arguments = parser.parse_args()
    restart_with_one_thread()
    masks = {"disk of radius 30": simulate.disk(30.0), "disk of radius 90": simulate.disk(90.0)}
    for path in sorted((arguments.data / "reference_masks").glob("*.tif")):
        masks[path.stem] = tifffile.imread(path) > 0
    print("milliseconds for factors and one solve; last, the pattern and its order of elimination\n")
    titles = ("blocks", "numbers", "no pressure", "pattern")
    print(f"{'mask':<18}{'vertices':>8}{''.join(f'{title:>13}' for title in titles)}{'apart':>10}")
    for name, mask in masks.items():
        compare(name, mask, arguments.repeats)
    return 0


if __name__ == "__main__":
    sys.exit(main())

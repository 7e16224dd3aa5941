"""Time of one Newton step's linear system: by 2×2 blocks (`disk.blocks`) and by single numbers (QDLDL)."""

import argparse
import os
import sys
from pathlib import Path

import numpy as np
import qdldl
import tifffile
from scipy import sparse

from cytodisk import simulate
from cytodisk.arrays import BoolArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.mapping import mesh_cell
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.geometry.mesh import Mesh
from speed import _DEFAULT_DATA, median_seconds, restart_with_one_thread


def fill(system: BlockSystem, mesh: Mesh) -> sparse.csc_matrix:
    """The same positive definite matrix in a block system and as the upper triangle of a sparse one."""
    random = np.random.default_rng(0)
    system.blocks[:] = 0.0
    half = random.normal(size=(len(mesh.triangles), 6, 2))
    element = (half @ half.transpose(0, 2, 1) + np.eye(6)).reshape(-1, 3, 2, 3, 2)
    stored = system.place >= 0
    t, k, l = np.nonzero(stored)
    np.add.at(system.blocks, system.place[stored], element[t, k, :, l])
    corner = system.unknown[mesh.triangles]
    row, column = np.broadcast_arrays(corner[:, :, None], corner[:, None, :])
    p, q = np.meshgrid([0, 1], [0, 1], indexing="ij")
    value = element[t, k, :, l]
    rows = 2 * row[stored][:, None, None] + p
    columns = 2 * column[stored][:, None, None] + q
    size = 2 * len(system.vertex)
    matrix = sparse.coo_matrix((value.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))
    return sparse.csc_matrix(sparse.triu(matrix))


def compare(name: str, mask: BoolArray, repeats: int) -> None:
    """Print both times for one mask, after checking that the solutions agree."""
    mesh = mesh_cell(mask, MappingParameters()).mesh
    system = BlockSystem(mesh)
    upper = fill(system, mesh)
    right = np.random.default_rng(1).normal(size=(len(system.vertex), 2))
    solver = qdldl.Solver(upper, upper=True)

    def by_blocks() -> object:
        system.factorise()
        return system.solve(right)

    def by_numbers() -> object:
        solver.update(upper, upper=True)
        return solver.solve(right.ravel())

    apart = float(np.abs(np.asarray(by_blocks()).ravel() - np.asarray(by_numbers())).max())
    blocks, numbers = median_seconds(by_blocks, repeats), median_seconds(by_numbers, repeats)
    found = median_seconds(lambda: BlockSystem(mesh), max(3, repeats // 5))
    anew = median_seconds(lambda: qdldl.Solver(upper, upper=True), max(3, repeats // 5))
    print(
        f"{name:<18}{len(right):>8}{1e3 * blocks:>11.2f}{1e3 * numbers:>9.2f}{numbers / blocks:>7.2f}"
        f"{1e3 * found:>15.2f}{1e3 * anew:>9.2f}{apart:>10.0e}"
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
    print(
        f"{'':<18}{'':>8}{'one step, ms':>20}{'':>7}{'once a mesh, ms':>24}\n"
        f"{'shape':<18}{'inside':>8}{'blocks':>11}{'QDLDL':>9}{'ratio':>7}{'blocks':>15}{'QDLDL':>9}{'apart':>10}"
    )
    for name, mask in masks.items():
        compare(name, mask, arguments.repeats)
    return 0


if __name__ == "__main__":
    sys.exit(main())

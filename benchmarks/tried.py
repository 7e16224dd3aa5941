"""Ways to a faster map that were tried: Newton steps, time, and area error as seen by a finer mesh.

The first row of a mask is the package as it is; the others change one thing each. A coarser mesh has a
smaller error on its own triangles than the cell has, so all are compared on one mesh that is finer than any.
With `--page` the table of the page "What was tried" is written.
"""

import argparse
import csv
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import tifffile

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.harmonic import harmonic_map, weighted_means
from cytodisk.disk.newton import relax
from cytodisk.disk.newton_triangles import relax_triangles
from cytodisk.disk.untangle import untangled
from cytodisk.geometry.locate import TriangleLocator
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mesh import Mesh, mesh_inside, triangle_areas
from cytodisk.geometry.outline import trace_outline
from pages import PAGES
from reference_masks import data_folder
from speed import restart_with_one_thread

_SHAPE_WEIGHT = 0.005
_STRETCH_ROUNDS = 10


@dataclass(frozen=True)
class Cell:
    """A cleaned mask with its outline and the angles of the outline's points."""

    mask: BoolArray
    outline_yx: FloatArray
    angles: FloatArray

    @property
    def circle(self) -> FloatArray:
        """Outline points on the circle."""
        return np.column_stack([np.cos(self.angles), np.sin(self.angles)])


@dataclass(frozen=True)
class Way:
    """One way to a map: its mesh, start and energy."""

    name: str
    start: Callable[[Cell, Mesh, BlockSystem], FloatArray]
    growth: float = 0.5
    edge_length: float = 0.9
    by_triangle: bool = False


def cell_of(mask: BoolArray) -> Cell:
    """The cell of a mask."""
    cleaned, _ = clean_mask(mask)
    inside = cleaned[np.ix_(cleaned.any(axis=1), cleaned.any(axis=0))]  # its box: the cell is in one piece
    outline = trace_outline(inside)
    return Cell(inside, outline, boundary_angles(outline))


def from_harmonic(cell: Cell, mesh: Mesh, system: BlockSystem) -> FloatArray:
    """The harmonic map."""
    return harmonic_map(mesh, cell.circle, system)[0]


def from_stretch(cell: Cell, mesh: Mesh, system: BlockSystem) -> FloatArray:
    """A few steps of the fixed-point iteration for stretch energy, on positive weights."""
    share = triangle_areas(mesh.vertices_yx, mesh.triangles)
    weights = np.full((3, len(share)), 0.5)
    uv = weighted_means(mesh, weights.ravel(), cell.circle, system)
    for _ in range(_STRETCH_ROUNDS):
        stretch = triangle_areas(uv[:, ::-1], mesh.triangles) / share
        uv = weighted_means(mesh, (weights * stretch / stretch.mean()).ravel(), cell.circle, system)
    return uv


def from_coarser(cell: Cell, mesh: Mesh, system: BlockSystem) -> FloatArray:
    """The relaxed map of a mesh with every other outline point; the harmonic map if that cannot be mended."""
    half = Cell(cell.mask, cell.outline_yx[::2], cell.angles[::2])
    coarse = mesh_inside(half.outline_yx, half.mask, edge_length=1.8)
    uv = relax(coarse, harmonic_map(coarse, half.circle)[0], _SHAPE_WEIGHT).vertices_uv
    inside = TriangleLocator(coarse.vertices_yx, coarse.triangles).carry(
        mesh.vertices_yx[mesh.n_boundary :], uv[coarse.triangles]
    )
    start = untangled(mesh, np.concatenate([cell.circle, inside]))
    return from_harmonic(cell, mesh, system) if start is None else start


WAYS = (
    Way("as it is", from_harmonic),
    Way("areas by triangle", from_harmonic, by_triangle=True),
    Way("stretch energy first", from_stretch),
    Way("coarser mesh first", from_coarser),
    Way("larger triangles inside", from_harmonic, growth=0.75),
    Way("larger triangles everywhere", from_harmonic, edge_length=1.1),
)


def measure(cell: Cell, way: Way, fine: Mesh, repeats: int) -> tuple[int, float, float, float]:
    """Newton steps, least milliseconds from outline to map; area error and share folded, on the fine mesh."""
    best = np.inf
    relaxation = relax_triangles if way.by_triangle else relax
    for _ in range(repeats + 1):  # the first may compile
        started = time.process_time()
        mesh = mesh_inside(cell.outline_yx, cell.mask, edge_length=way.edge_length, growth=way.growth)
        system = BlockSystem(mesh)
        found = relaxation(mesh, way.start(cell, mesh, system), _SHAPE_WEIGHT, system=system)
        best = min(best, time.process_time() - started)
    locator = TriangleLocator(mesh.vertices_yx, mesh.triangles)
    uv = locator.carry(fine.vertices_yx, found.vertices_uv[mesh.triangles])
    in_cell = triangle_areas(fine.vertices_yx, fine.triangles)
    in_disk = triangle_areas(uv[:, ::-1], fine.triangles)
    share, seen = in_cell / in_cell.sum(), in_disk / np.nansum(in_disk)
    whole = seen > 0  # a triangle of the fine mesh across two of the coarse one may be folded
    error = (share * np.abs(np.log(np.where(whole, seen / share, 1.0)))).sum()
    return found.steps, 1e3 * best, float(error), float(share[~whole].sum())


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5, help="timed maps of each kind (default 5)")
    parser.add_argument("--page", action="store_true", help="write the table of the page, too")
    arguments = parser.parse_args()
    restart_with_one_thread()
    rows = []
    for path in sorted((data_folder() / "reference_masks").glob("*.tif")):
        cell = cell_of(tifffile.imread(path) > 0)
        fine = mesh_inside(cell.outline_yx, cell.mask, edge_length=0.45, growth=0.25)
        for way in WAYS:
            steps, milliseconds, error, folded = measure(cell, way, fine, arguments.repeats)
            row = [path.stem, way.name, str(steps), f"{milliseconds:.0f}", f"{error:.3f}", f"{folded:.2%}"]
            rows.append(row)
            print("".join(f"{text:<{width}}" for text, width in zip(row, (14, 30, 7, 7, 8, 8), strict=True)))
    if arguments.page:
        folder = PAGES / "tried"
        folder.mkdir(exist_ok=True)
        with (folder / "ways.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([["mask", "way", "steps", "ms", "area error", "folded"], *rows])
    return 0


if __name__ == "__main__":
    sys.exit(main())

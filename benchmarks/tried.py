"""Ways to a faster map that were tried: Newton steps, processor time, and area error of windows.

The first row of a mask is the package as it is; the others change one thing each. The area error is the mean
|ln| of the areas of 10 × 60 windows over their mean, from 4 × 4 parts of each pixel, so that maps on several
meshes can be compared. With `--page` the table of the page "What was tried" is written.
"""

import argparse
import csv
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any
from unittest.mock import patch

import numpy as np
import tifffile

import cytodisk as cd
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk import newton
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.harmonic import harmonic_map, weighted_means
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.disk.newton import relax
from cytodisk.disk.newton_triangles import relax_triangles
from cytodisk.disk.untangle import untangled
from cytodisk.disk.vertex_energy import AveragedElements, averaged_elements
from cytodisk.geometry.locate import TriangleLocator
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mesh import Mesh, mesh_inside, triangle_areas
from cytodisk.geometry.outline import trace_outline
from pages import PAGES
from reference_masks import data_folder
from scaling_points import fishbone
from speed import restart_with_one_thread

DEFAULT = MappingParameters()
GRID = cd.polar_windows(10, 60)
_STRETCH_ROUNDS = 10
_PARTS = 4  # of the side of a pixel
_TEETH = 12  # on each side of the fishbone


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
    """One way to a map: its mesh, its start, and what is changed in the relaxation."""

    name: str
    start: Callable[[Cell, Mesh, BlockSystem], FloatArray]
    growth: float = 0.5
    edge_length: float = DEFAULT.spacing_px
    shape_weight: float = DEFAULT.shape_weight
    by_triangle: bool = False
    instead: Mapping[str, Any] = field(default_factory=dict)  # of what the module `newton` has by that name


def cell_of(mask: BoolArray) -> Cell:
    """The cell of a mask."""
    cleaned, _ = clean_mask(mask)
    inside = cleaned[np.ix_(cleaned.any(axis=1), cleaned.any(axis=0))]  # its box: the cell is in one piece
    outline = trace_outline(inside)
    return Cell(inside, outline, boundary_angles(outline))


def from_harmonic(cell: Cell, mesh: Mesh, system: BlockSystem) -> FloatArray:
    """The harmonic map."""
    return harmonic_map(mesh, cell.circle, system)[0]


def from_tutte(cell: Cell, mesh: Mesh, system: BlockSystem) -> FloatArray:
    """Each vertex at the plain mean of its neighbours."""
    return weighted_means(mesh, np.full(3 * len(mesh.triangles), 0.5), cell.circle, system)


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
    coarse = mesh_inside(half.outline_yx, half.mask, edge_length=2.0 * DEFAULT.spacing_px)
    uv = relax(coarse, harmonic_map(coarse, half.circle)[0], DEFAULT.shape_weight).vertices_uv
    locator = TriangleLocator(coarse.vertices_yx, coarse.triangles)
    inside = locator.carry(mesh.vertices_yx[mesh.n_boundary :], uv)
    start = untangled(mesh, np.concatenate([cell.circle, inside]))
    return from_harmonic(cell, mesh, system) if start is None else start


def without_edge(*of: Any) -> AveragedElements:
    """Elements whose areas at the edge do not count by themselves."""
    elements = averaged_elements(*of)
    return elements._replace(edge=np.zeros_like(elements.edge))


WAYS = (
    Way("as it is", from_harmonic),
    Way("areas by triangle", from_harmonic, by_triangle=True),
    Way("no areas at the edge", from_harmonic, instead={"averaged_elements": without_edge}),
    Way("one shape weight throughout", from_harmonic, instead={"_STIFFEST": 0.0}),
    Way("stops ten times later", from_harmonic, instead={"DECREMENT": 0.1 * newton.DECREMENT}),
    Way("stops ten times sooner", from_harmonic, instead={"DECREMENT": 10.0 * newton.DECREMENT}),
    Way("plain means first", from_tutte),
    Way("stretch energy first", from_stretch),
    Way("coarser mesh first", from_coarser),
    Way("larger triangles inside", from_harmonic, growth=0.75),
    Way("larger triangles everywhere", from_harmonic, edge_length=0.9),
    Way("shape counts more", from_harmonic, shape_weight=0.005),
)


def parts_of_pixels(mask: BoolArray) -> FloatArray:
    """Centres of the parts of a mask's pixels, (row, column)."""
    inside = (np.arange(_PARTS) + 0.5) / _PARTS - 0.5
    parts = np.stack(np.meshgrid(inside, inside, indexing="ij"), axis=-1).reshape(1, -1, 2)
    return (np.argwhere(mask)[:, None, :] + parts).reshape(-1, 2)


def window_error(cell: Cell, mesh: Mesh, uv: FloatArray) -> float:
    """Mean |ln| of the areas of windows over their mean."""
    places = TriangleLocator(mesh.vertices_yx, mesh.triangles).carry(parts_of_pixels(cell.mask), uv)
    window = GRID.window_of(places[np.isfinite(places[:, 0])])
    areas = np.bincount(window, minlength=GRID.n_windows) + 0.0
    return float(np.abs(np.log(np.maximum(areas, 0.5) / areas.mean())).mean())


def measure(cell: Cell, way: Way, repeats: int) -> tuple[int, float, float]:
    """Newton steps, least milliseconds from outline to map, area error of windows."""
    best = np.inf
    relaxation = relax_triangles if way.by_triangle else relax
    with patch.multiple(newton, **{"DECREMENT": newton.DECREMENT} | way.instead):
        for _ in range(repeats + 1):  # the first may compile
            started = time.process_time()
            mesh = mesh_inside(cell.outline_yx, cell.mask, edge_length=way.edge_length, growth=way.growth)
            system = BlockSystem(mesh)
            found = relaxation(mesh, way.start(cell, mesh, system), way.shape_weight, system=system)
            best = min(best, time.process_time() - started)
    return found.steps, 1e3 * best, window_error(cell, mesh, found.vertices_uv)


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5, help="timed maps of each kind (default 5)")
    parser.add_argument("--page", action="store_true", help="write the table of the page, too")
    arguments = parser.parse_args()
    restart_with_one_thread()
    rows = []
    paths = sorted((data_folder() / "reference_masks").glob("*.tif"))
    masks = {path.stem: tifffile.imread(path) > 0 for path in paths} | {"fishbone": fishbone(_TEETH)}
    for name, mask in masks.items():
        cell = cell_of(mask)
        for way in WAYS:
            steps, milliseconds, error = measure(cell, way, arguments.repeats)
            row = [name, way.name, str(steps), f"{milliseconds:.0f}", f"{error:.3f}"]
            rows.append(row)
            print("".join(f"{text:<{width}}" for text, width in zip(row, (14, 30, 7, 7, 8), strict=True)))
    if arguments.page:
        folder = PAGES / "tried"
        folder.mkdir(exist_ok=True)
        with (folder / "ways.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([["mask", "way", "steps", "ms", "area error of windows"], *rows])
    return 0


if __name__ == "__main__":
    sys.exit(main())

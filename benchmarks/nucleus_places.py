"""Does the same place come into the same window, in two maps of nearly the same cell with its nucleus?

    benchmarks/nucleus_places.py [--set judges|others|all] [--only NAME …] [--seeds A B]

Cells are those of `reproducibility.py`. Each gets a round nucleus at its deepest place with half its depth as
radius, and another one that is moved from there until a quarter of the depth is left beside it. Each pair is
mapped, and mapped again mirrored, with 1 px of noise on both outlines, turned by 17°, and drawn twice as
large. Points more than 1 px away from both outlines are followed. A row a cell and place of nucleus, means
over seeds: the share of points of the cytoplasm in the same of 10 × 60 windows of the plain map, and of the
map with the nucleus (as many windows; the nucleus has as many layers as fit its share of the area); the share
of points of the nucleus in the same window of the plain map of the nucleus alone, and of the map of both, in
windows of the same number; and how far noise moves the places of the disk, in pixels (median). Then the same
by class of cells; "WORSE" stands where the map with the nucleus keeps less by more than 0.02.
"""

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import shapely

import cytodisk as cd
from cell_outlines import Shape, judges, others, real_cells
from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.simulate.drawing import half_covered
from cytodisk.simulate.nuclei.nucleus_shapes import oval
from cytodisk.windows.nucleus.nucleus_grid import with_nucleus_of
from real_masks import DATA
from same_places import CHANGES, Change, changes, inner_points
from suite import THREADS

PLACES = ("deepest", "aside")
LAYERS, SECTORS = 10, 60
_RADIUS, _LEFT = 0.5, 0.25  # of the depth: radius of the nucleus, and what is left beside one that is aside
_FLIPPED = 0.5  # of the pixels on either side of the nuclear outline
_WORSE = 0.02
_PARTS = ("cytoplasm", "nucleus")


def nucleus_of(shape: Shape, place: str) -> FloatArray:
    """Outline of the nucleus, in the frame of the shape's."""
    circle = shapely.maximum_inscribed_circle(shapely.Polygon(shape.outline_yx), tolerance=0.05)
    deepest, on_edge = shapely.get_coordinates(circle)
    depth = float(np.hypot(*(on_edge - deepest)))
    aside = (1.0 - _RADIUS - _LEFT) * (on_edge - deepest) if place == "aside" else np.zeros(2)
    return oval(np.pi * (_RADIUS * depth) ** 2) + deepest + aside


def measure(shape: Shape, place: str, seed: int) -> list[dict[str, Any]]:
    """Rows of a shape, one for each change and compartment."""
    random = np.random.default_rng([seed, 31])
    drawing = shape.drawn(random.random(2))
    outline = drawing.places(nucleus_of(shape, place))
    nucleus = drawn(outline, drawing.mask)
    layers = max(round(LAYERS * nucleus.sum() / drawing.mask.sum()), 1)
    maps = Maps.of(drawing.mask, nucleus)
    points = {
        "cytoplasm": inner_points(drawing.mask & ~nucleus, random),
        "nucleus": inner_points(nucleus, random),
    }
    rows = []
    for change in changes(shape, drawing.places, drawing.mask, random):
        others = Maps.of(change.mask, changed(change, outline, nucleus, random))
        for part in _PARTS:
            row = {"shape": shape.name, "family": shape.family, "place": place, "seed": seed}
            row |= {"change": change.name, "part": part}
            row |= {"valid": maps.both.certificate.valid and others.both.certificate.valid}
            row |= {"converged": maps.both.converged and others.both.converged}
            plain = (maps.cell, others.cell) if part == "cytoplasm" else (maps.nucleus, others.nucleus)
            for name, pair in (("plain", plain), ("with", (maps.both, others.both))):
                plain_layers = LAYERS if part == "cytoplasm" else layers
                row[f"same_{name}"], row[f"shift_{name}"] = compared(
                    *pair, points[part], change, (plain_layers, layers)
                )
            rows.append(row)
    return rows


@dataclass(frozen=True, eq=False)
class Maps:
    """Plain maps of a cell and of its nucleus alone, and the map of both."""

    cell: DiskMap
    nucleus: DiskMap
    both: DiskMap

    @classmethod
    def of(cls, mask: BoolArray, nucleus: BoolArray) -> "Maps":
        """The maps of a pair of masks."""
        both = cd.map_to_disk(mask, nucleus=nucleus)
        return cls(cd.map_to_disk(mask), cd.map_to_disk(both.nucleus.mask), both)


def drawn(outline_yx: FloatArray, mask: BoolArray) -> BoolArray:
    """Pixels of a nucleus in the image of a cell."""
    return half_covered(outline_yx, (mask.shape[0], mask.shape[1])) & mask


def changed(
    change: Change, outline_yx: FloatArray, nucleus: BoolArray, random: np.random.Generator
) -> BoolArray:
    """The nucleus in the other mask of the cell."""
    if change.name == "mirrored":
        return nucleus[:, ::-1]
    if change.name == "noise":
        return cd.simulate.flipped_masks(nucleus[None], _FLIPPED, int(random.integers(2**31)))[0]
    return drawn(change.place(outline_yx), change.mask)


def compared(
    disk: DiskMap, other: DiskMap, points: FloatArray, change: Change, layers: tuple[int, int]
) -> tuple[float, float]:
    """Share of points in the same window, and how far places of the disk are moved in pixels (median).

    `layers` are those of a plain map, and those of the nucleus in a map with one.
    """
    moved = change.place(points)
    here, there = disk.to_disk(points), other.to_disk(moved, outside="nearest") @ change.turn
    same = [window_numbers(one, uv, *layers) for one, uv in ((disk, here), (other, there))]
    shift = np.hypot(*(other.to_cell(here @ change.turn.T) - moved).T) / change.size
    return float((same[0] == same[1]).mean()), float(np.median(shift))


def window_numbers(disk: DiskMap, uv: FloatArray, layers: int, nucleus_layers: int) -> IntArray:
    """Number of the window of each point, in a grid for this kind of map."""
    if disk.nucleus is None:
        return cd.polar_windows(layers, SECTORS).window_of(uv)
    grid = cd.polar_windows(LAYERS - nucleus_layers, SECTORS, nucleus_layers=nucleus_layers)
    return with_nucleus_of(grid, disk).window_of(uv)


def lines(rows: pd.DataFrame, by: list[str]) -> Iterator[str]:
    """A line for each group, from plain to with nucleus, for each compartment."""
    for group, some in rows.groupby(by, sort=False):
        for part in _PARTS:
            mean = some[some["part"] == part].groupby("change").mean(numeric_only=True)
            cells, worse = [], []
            for change in CHANGES:
                plain, with_nucleus = mean.loc[change, ["same_plain", "same_with"]]
                cells.append(f"{100 * plain:7.0f} → {100 * with_nucleus:3.0f} %")
                worse += [change] if with_nucleus < plain - _WORSE else []
            plain, with_nucleus = mean.loc["noise", ["shift_plain", "shift_with"]]
            cells.append(f"{plain:9.2f} → {with_nucleus:.2f}")
            slow = int((~some["converged"]).sum()) // 2
            cells += [f"{slow:5d} not converged"] if slow else []
            note = f"  WORSE: {', '.join(worse)}" if worse else ""
            yield f"{' '.join(group):<30}{part:<11}{''.join(cells)}{note}"


def print_table(rows: pd.DataFrame, by: list[str]) -> None:
    """Print the lines under their heads."""
    heads = "".join(f"{change:>15}" for change in CHANGES)
    print(f"\n{' and '.join(by):<30}{'part':<11}{heads}{'noise px':>16}")
    print("\n".join(lines(rows, by)))


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--set", choices=("judges", "others", "all"), default="judges")
    parser.add_argument("--only", nargs="+", default=(), metavar="NAME", help="names of cells")
    parser.add_argument("--seeds", nargs=2, type=int, default=(0, 3), metavar=("A", "B"), help="A to B - 1")
    parser.add_argument("--csv", type=Path, help="write all rows to this file, too")
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    chosen = parser.parse_args()
    os.environ.update(dict.fromkeys(THREADS, "1"))
    jobs = list(product(shapes(chosen), PLACES, range(*chosen.seeds)))
    with ProcessPoolExecutor(chosen.workers) as pool:
        found = list(pool.map(measure, *zip(*jobs, strict=True)))
    rows = pd.DataFrame([row for some in found for row in some])
    print_table(rows, ["shape", "place"])
    print_table(rows, ["family", "place"])
    pairs = rows[rows["part"] == "nucleus"]
    print(f"\n{len(pairs)} pairs of maps, invalid {(~pairs['valid']).sum()}", end="")
    print(f", not converged {(~pairs['converged']).sum()}")
    if chosen.csv:
        rows.to_csv(chosen.csv, index=False, float_format="%.5g")
    return int((~rows["valid"]).any())


def shapes(chosen: argparse.Namespace) -> Sequence[Shape]:
    """The cells that were asked for."""
    found = judges() if chosen.set != "others" else []
    if chosen.set != "judges":
        found += others() + (real_cells(chosen.data) if chosen.data.is_dir() else [])
    return [shape for shape in found if not chosen.only or shape.name in chosen.only]


if __name__ == "__main__":
    sys.exit(main())

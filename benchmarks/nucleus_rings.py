"""Rings between nucleus and edge, as others draw them, beside windows of the map: what is wrong with them?

    benchmarks/nucleus_rings.py [--only SOURCE …] [--quick] [--layers 8] [--sectors 60] [--nucleus-layers 3]

Reads the folder in CYTODISK_DATA. "osteosarcoma": single cells, in each a drawn nucleus of half its depth at
its deepest place. "schwann": cells of crowded fields with their own nuclei. Prints a row a method for each:

* folded: cells in which triangles between rings, or of the map, are turned over;
* outside: cells in which rings leave the cell; points: share of ring points that do, mean over all cells;
* overlap: share of the cell's area in several windows, mean;
* empty: empty windows, cells that have any, and their share of all windows;
* cytoplasm, nucleus: mean |ln| of areas of windows over their mean in it, median over cells;
* outer fifth: share of the cytoplasm in the outermost of five layers, mean (0.2 if layers are equal);
* nearness: rank correlation of layers with nearness to the nucleus, over the cytoplasm, mean;
* one piece: share of filled windows that are in one piece; eccentricity: mean of a window.

Ends with status 1 if a map has a turned triangle or an empty window.
"""

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

import cytodisk as cd
from cytodisk.analysis.compartment_measures import compartment_measures, nearness, outer_fifth
from cytodisk.arrays import BoolArray
from cytodisk.errors import CytodiskError
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.rings.nucleus_edges import NucleusEdges
from real_masks import DATA
from schwann_nuclei import Case, osteosarcoma_cases, schwann_cases

SOURCES = {"osteosarcoma": osteosarcoma_cases, "schwann": schwann_cases}
_QUICK = {"osteosarcoma": 16, "schwann": 4}  # one in so many


@dataclass(frozen=True)
class Counts:
    """How many windows there are."""

    layers: int
    sectors: int
    nucleus_layers: int

    @property
    def settings(self) -> dict[str, int]:
        return {"layers": self.layers, "sectors": self.sectors, "nucleus_layers": self.nucleus_layers}


@dataclass(frozen=True)
class Found:
    """What one method made of one cell."""

    source: str
    cell: str
    method: str
    flipped: int
    outside: float
    overlap: float
    empty: int
    windows: int
    cytoplasm: float
    nucleus: float
    outer_fifth: float
    nearness: float
    one_piece: float
    eccentricity: float


Lay = Callable[[BoolArray, BoolArray, Counts], WindowsOnCell]


def nuclear(mask: BoolArray, nucleus: BoolArray, counts: Counts) -> WindowsOnCell:
    return cd.nucleus_ring_windows(mask, nucleus, **counts.settings)


def interpolated(
    mask: BoolArray, nucleus: BoolArray, counts: Counts, harmonics: int | None = None
) -> WindowsOnCell:
    return cd.interpolated_ring_windows(mask, nucleus, **counts.settings, harmonics=harmonics)


def mapped(mask: BoolArray, nucleus: BoolArray, counts: Counts) -> WindowsOnCell:
    return cd.polar_windows(**counts.settings).on(cd.map_to_disk(mask, nucleus=nucleus))


METHODS: dict[str, Lay] = {
    "interpolated": interpolated,
    "… 64 harmonics": partial(interpolated, harmonics=64),
    "… 16 harmonics": partial(interpolated, harmonics=16),
    "by distance": nuclear,
    "cytodisk": mapped,
}


def measure(case: Case, counts: Counts) -> list[Found]:
    """What each method makes of a cell; nothing where the nucleus is refused."""
    try:
        mask, _ = cd.clean_mask(case.mask)
        nucleus, _ = cd.fit_nucleus(mask, case.nucleus)
    except CytodiskError:
        return []
    return [_measured(case, name, lay(mask, nucleus, counts)) for name, lay in METHODS.items()]


def _measured(case: Case, name: str, windows: WindowsOnCell) -> Found:
    compartments = windows.grid.compartments  # type: ignore[attr-defined]
    found = compartment_measures(windows, compartments)
    held = windows.areas > 0
    return Found(
        case.source,
        case.name,
        name,
        _flipped(windows),
        getattr(windows, "outside", 0.0),
        getattr(windows, "overlap", 0.0),
        windows.n_empty,
        windows.areas.size,
        found["area_error_cytoplasm"],
        found["area_error_nucleus"],
        outer_fifth(windows),
        nearness(windows, compartments, NucleusEdges.of(case.mask, case.nucleus)),
        float((windows.pieces[held] == 1).mean()),
        float(np.nanmean(windows.eccentricities)),
    )


def _flipped(windows: Any) -> int:
    if isinstance(windows, cd.InterpolatedRingWindows):
        return windows.n_turned_over
    return len(windows.disk.certificate.flipped_in_disk) if isinstance(windows, cd.CellWindows) else 0


def print_table(found: Sequence[Found]) -> None:
    """Print a row a method for cells of one source."""
    cells = len({one.cell for one in found})
    print(f"{cells} cells of {found[0].source}")
    heads = ("folded", "outside", "points", "overlap", "empty", "cells", "of windows")
    more = ("cytoplasm", "nucleus", "outer fifth", "nearness", "one piece", "eccentricity")
    print(
        f"{'':<16}"
        + "".join(f"{head:>{len(head) + 3}}" for head in (*heads[:6], heads[6]))
        + "".join(f"{head:>{len(head) + 3}}" for head in more)
    )
    for name in METHODS:
        rows = [one for one in found if one.method == name]
        values = (
            str(sum(one.flipped > 0 for one in rows)),
            str(sum(one.outside > 0 for one in rows)),
            f"{np.mean([one.outside for one in rows]):.3f}",
            f"{np.mean([one.overlap for one in rows]):.3f}",
            str(sum(one.empty for one in rows)),
            str(sum(one.empty > 0 for one in rows)),
            f"{sum(one.empty for one in rows) / sum(one.windows for one in rows):.2%}",
            f"{np.median([one.cytoplasm for one in rows]):.3f}",
            f"{np.median([one.nucleus for one in rows]):.3f}",
            f"{np.mean([one.outer_fifth for one in rows]):.3f}",
            f"{np.mean([one.nearness for one in rows]):.3f}",
            f"{np.mean([one.one_piece for one in rows]):.3f}",
            f"{np.mean([one.eccentricity for one in rows]):.3f}",
        )
        print(
            f"{name:<16}"
            + "".join(
                f"{value:>{len(head) + 3}}" for head, value in zip((*heads, *more), values, strict=True)
            )
        )


def run(chosen: argparse.Namespace) -> Iterator[Found]:
    """What every method made of every cell."""
    counts = Counts(chosen.layers, chosen.sectors, chosen.nucleus_layers)
    with ProcessPoolExecutor(chosen.workers) as pool:
        for source in chosen.only:
            cases = islice(SOURCES[source](chosen.data), 0, None, _QUICK[source] if chosen.quick else 1)
            for rows in pool.map(partial(measure, counts=counts), list(cases)):
                yield from rows


def main() -> int:
    """Print the table; 1 if a map has a turned triangle or an empty window."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", nargs="+", choices=SOURCES, default=list(SOURCES), help="sources")
    parser.add_argument("--data", type=Path, default=DATA, help="folder of the data")
    parser.add_argument("--quick", action="store_true", help="a few cells of each source")
    parser.add_argument("--layers", type=int, default=8, help="layers of the cytoplasm (default 8)")
    parser.add_argument("--sectors", type=int, default=60, help="sectors (default 60)")
    parser.add_argument("--nucleus-layers", type=int, default=3, help="layers of the nucleus (default 3)")
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    found = list(run(parser.parse_args()))
    for source in dict.fromkeys(one.source for one in found):
        print_table([one for one in found if one.source == source])
    ours = [one for one in found if one.method == "cytodisk"]
    return int(any(one.flipped or one.empty for one in ours))


if __name__ == "__main__":
    sys.exit(main())

"""What the comparators' parameters do on simulated cells: how their defaults were chosen.

Prints a Markdown table for each parameter, a row a value, and says with which seeds.

* "evenness" of the springs between windows (`spring_windows`), over cells of several kinds, 8 layers × 60
  sectors: share of windows that hold a part of the cell, in all and in the deepest quarter of the layers;
  coefficients of variation of area and eccentricity within a layer, median; number of pieces of a window.
  Edge-based windows without springs stand above.
* "line tension" of the edge that springs follow: the shortest and the longest of 60 sectors of the edge after
  60 frames, over their mean, in the worst movie. Without tension sectors vanish and others take their place.
* "line tension" and the settings of the registration to the first frame, over movies of known motion: "in
  place" is the share of points inside the cell that are in the last frame in the same of 5 × 24 windows as in
  the first; completeness, coverage, the share of the cell where the field folds, and the share of what is
  carried that comes to lie outside of the cell are means over frames.

The default evenness is the smallest with nearly the best completeness and regularity (`--seeds setting`), the
default line tension the largest that costs at most 2 % of the points in place against none. `--seeds judging`
uses other cells. The registration is the one of the tracker "demons", started from the frame before.
"""

import argparse
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

import cytodisk as cd
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.circle import boundary_angles
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.polygon import smooth_closed
from cytodisk.motion.contour import SMOOTHING_PX
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.runs.compare_windows.laid_frames import (
    LaidFrame,
    lay_frames,
    registered_frames,
    spring_frames,
)
from cytodisk.simulate import SimulatedMovie
from cytodisk.simulate.movie_kinds import MovieKind
from cytodisk.windows.edge_windows import CellEdge
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.springs.edge_beads import EdgeBeads

SEEDS = {"setting": 100, "judging": 500}
EVENNESS = (0.0, 0.5, 1.0, 2.0, 4.0, 8.0, 1000.0)
LINE_TENSION = (0.0, 0.25, 0.5, 1.0, 2.0, 4.0)
REGISTRATION = ((100, 1.0, False), (100, 1.0, True), (300, 1.0, False), (100, 2.0, True))
KINDS: tuple[MovieKind, ...] = ("bulging", "migrating", "neutrophil", "spiky", "ruffling", "turning")
LAYERS, SECTORS = 8, 60
MOVIE_LAYERS, MOVIE_SECTORS = 5, 24
LONG = 60  # frames of the movies in which sectors may shrink


def cells(first_seed: int, count: int) -> Iterator[BoolArray]:
    """Cells of three kinds in turn."""
    for seed in range(first_seed, first_seed + count):
        yield cd.simulate.migrating(seed, size=0.7)
        yield cd.simulate.random_smooth(seed, radius=40)
        yield cd.simulate.random_spiky(seed, radius=35)


def regularity(windows: Iterable[WindowsOnCell]) -> list[float]:
    """Completeness, in all and deep inside, spread of area and eccentricity, and pieces."""
    found = []
    for one in windows:
        layers = cd.measures_by_layer(one)
        complete = one.completeness
        found.append(
            [
                complete.mean(),
                complete[-LAYERS // 4 :].mean(),
                float(layers["area_cv"].median()),
                float(layers["eccentricity_cv"].median()),
                float(layers["pieces"].mean()),
            ]
        )
    return [float(value) for value in np.median(found, axis=0)]


def windows_at(frame: LaidFrame, points_yx: FloatArray) -> FloatArray:
    """Number of the window of the pixel that each point is in; -1 for none."""
    labels = frame.windows.labels
    row, column = np.clip(np.round(points_yx).astype(int), 0, np.array(labels.shape) - 1).T
    return np.asarray(labels[row, column])


def kept(truth: SimulatedMovie, frames: Iterable[LaidFrame]) -> list[float]:
    """Points in place, completeness, coverage, folding and what lies outside."""
    first, last, measures = None, None, []
    for frame in frames:
        first, last = first or frame, frame
        shares = [frame.shares.get(name, np.nan) for name in ("folded", "carried_outside")]
        measures.append([frame.windows.completeness.mean(), frame.windows.coverage, *shares])
    assert first is not None
    assert last is not None
    here, there = (windows_at(one, truth.interior_yx[one.frame]) for one in (first, last))
    return [float(((here == there) & (here >= 0)).mean()), *np.mean(measures, axis=0).tolist()]


def movies(seed: int, frames: int) -> list[tuple[SimulatedMovie, DiskMovie]]:
    """A movie of each kind with its maps."""
    shown = [cd.simulate.movie(kind, seed=seed, frames=frames) for kind in KINDS]
    return [(truth, cd.map_movie(truth.masks, method="harmonic")) for truth in shown]


def print_table(head: Sequence[str], rows: Iterable[tuple[str, Sequence[float]]]) -> None:
    """Print a Markdown table, each row as it is known."""
    print(f"\n| {' | '.join(head)} |\n|{'---|' * len(head)}")
    for name, values in rows:
        shown = ["–" if np.isnan(value) else f"{value:.3f}" for value in values]
        print(f"| {' | '.join([name, *shown])} |", flush=True)


def evenness_rows(first_seed: int, count: int) -> Iterator[tuple[str, list[float]]]:
    """One row for windows without springs, and one a value."""
    masks = list(cells(first_seed, count))
    yield "edge-based", regularity(cd.edge_windows(mask, LAYERS, SECTORS) for mask in masks)
    for value in EVENNESS:
        laid = (cd.spring_windows(mask, LAYERS, SECTORS, evenness=value) for mask in masks)
        yield f"evenness {value:g}", regularity(laid)


def tension_rows(found: list[tuple[SimulatedMovie, DiskMovie]]) -> Iterator[tuple[str, list[float]]]:
    """One row a line tension, and one for windows that follow cytodisk's own tracking."""
    grids = [
        cd.SpringGrid(MOVIE_LAYERS, MOVIE_SECTORS, CellEdge.of(movie[0]).greatest_depth / MOVIE_LAYERS)
        for _, movie in found
    ]
    of = list(zip(found, grids, strict=True))
    own = [kept(truth, lay_frames("edge", movie, grid)) for (truth, movie), grid in of]
    yield "cytodisk's tracking", np.mean(own, axis=0).tolist()
    for value in LINE_TENSION:
        rows = [kept(truth, spring_frames(movie, grid, line_tension=value)) for (truth, movie), grid in of]
        yield f"line tension {value:g}", np.mean(rows, axis=0).tolist()


def length_rows(first_seed: int, frames: int) -> Iterator[tuple[str, list[float]]]:
    """Shortest and longest sector of the last frame over their mean, in the worst movie, a row a tension."""
    movies_ = [cd.simulate.movie(kind, seed=first_seed, frames=frames, signals=False) for kind in KINDS]
    outlines = [
        [trace_outline(cd.clean_mask(mask)[0]) for mask in truth.masks[truth.present]] for truth in movies_
    ]
    for value in LINE_TENSION:
        ends = [last_lengths(found, value) for found in outlines]
        yield f"line tension {value:g}", [min(low for low, _ in ends), max(high for _, high in ends)]


def last_lengths(outlines: Sequence[FloatArray], line_tension: float) -> tuple[float, float]:
    """Shortest and longest sector in the last frame over their mean; outlines as they lie in the image."""
    beads = EdgeBeads.along(outlines[0], boundary_angles(outlines[0]), SECTORS)
    for outline in outlines[1:]:
        beads = beads.carried(smooth_closed(outline, SMOOTHING_PX), line_tension)
    closed = np.append(beads.places, beads.places[0] + beads.border.length)
    lengths = np.diff(closed).reshape(SECTORS, -1).sum(axis=1) / (beads.border.length / SECTORS)
    return float(lengths.min()), float(lengths.max())


def registration_rows(found: list[tuple[SimulatedMovie, DiskMovie]]) -> Iterator[tuple[str, list[float]]]:
    """One row for the maps themselves, and one a setting."""
    grid = cd.polar_windows(MOVIE_LAYERS, MOVIE_SECTORS)
    for iterations, sigma, warm in REGISTRATION:
        how = {"iterations": iterations, "sigma": sigma, "warm_start": warm}
        rows = [kept(truth, registered_frames(movie, grid, **how)) for truth, movie in found]
        start = "the last field" if warm else "rest"
        yield f"{iterations} iterations, sigma {sigma:g}, from {start}", np.mean(rows, axis=0).tolist()


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", choices=SEEDS, default="judging")
    parser.add_argument("--cells", type=int, default=10, help="of each of three kinds")
    parser.add_argument("--frames", type=int, default=16)
    parser.add_argument("--tables", nargs="*", default=["evenness", "tension", "registration"])
    chosen = parser.parse_args()
    seed = SEEDS[chosen.seeds]
    print(f"Seeds from {seed} on ({chosen.seeds}).")
    if "evenness" in chosen.tables:
        head = ("springs", "completeness", "deepest quarter", "CV of area", "CV of eccentricity", "pieces")
        print_table(head, evenness_rows(seed, chosen.cells))
    if not {"tension", "registration"} & set(chosen.tables):
        return
    found = movies(seed, chosen.frames)
    head = ("windows", "in place", "completeness", "coverage", "folded", "outside")
    if "tension" in chosen.tables:
        print_table(("windows", "shortest", "longest"), length_rows(seed, LONG))
        print_table(head, tension_rows(found))
    if "registration" in chosen.tables:
        print_table(head, registration_rows(found))


if __name__ == "__main__":
    main()

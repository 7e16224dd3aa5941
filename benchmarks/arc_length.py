"""Which measure of the outline's length sends the edge of a cell to the circle: noise, truth and thin parts.

    benchmarks/arc_length.py [--seeds N] [--cells N] [--windows]

Noise flips the pixels on both sides of the edge with probability 0.5. A row a measure: how far noise moves
places 2-4 px inside the edge along it (harmonic map, rms of a mask; median in px, and mean ratio to the first
measure), on drawn shapes and on osteosarcoma cells from the folder in CYTODISK_DATA; error of angles against
true arc length, in px along the edge; least share of the circle that a thin protrusion gets (2-6 px wide,
20-60 px long), over its true share; largest error of angle on disks of radius 5-60 px. With --windows: share
of places in the same of 10 × 60 windows, and steps, with the default method under noise. The last measure
reads places off the outline that the mask was drawn from, so no measure can do much better.

Then the length that a spike of one pixel adds to an outline; and what is left in thin arms: how far noise
moves their middle line and changes their width, and the share of places that stay in the same window of one
and the same map when they move by a quarter or by half of a pixel.
"""

import argparse
import os
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import shapely
import tifffile
from scipy import ndimage

import cytodisk as cd
from cell_outlines import Drawing, Shape, branched, ellipse, others, polar
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.cell_mesh import CellMesh, mesh_cell
from cytodisk.disk.circle import angles_of_lengths
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_mesh
from cytodisk.disk.mapping_parameters import MapToDiskParameters
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.polygon import arc_lengths, edge_lengths, smooth_along, smooth_closed

DATA = Path(os.environ.get("CYTODISK_DATA", Path(__file__).parents[2] / "shared" / "data"))
PHASE = (0.3, 0.6)  # of a shape between the pixels
_FLIPPED = 0.5
_LEAST_LEFT = 0.8  # of a cell's area: where noise cuts off more, the shape is another one
_TRACED = ("amoeboid", "amoeboid 2", "spiky", "spiky 2", "neurite")  # from masks: no true length is known
Measure = Callable[[FloatArray], FloatArray]


def of_smoothed(outline_yx: FloatArray, sigma_px: float) -> FloatArray:
    """Length of each edge of a smoothed copy, at least a tenth of its own."""
    return np.maximum(edge_lengths(smooth_closed(outline_yx, sigma_px)), 0.1 * edge_lengths(outline_yx))


def of_drawing(outline_yx: FloatArray, true: shapely.LinearRing) -> FloatArray:
    """Length of each edge by its ends' nearest points of the true outline, evened out as by default."""
    along = true.project(shapely.points(outline_yx[:, ::-1]))
    half = 0.5 * true.length
    steps = np.mod(np.diff(along, append=along[:1]) + half, true.length) - half
    raw = edge_lengths(outline_yx)
    counted, whole = smooth_along(np.column_stack([np.sign(steps.sum()) * steps, raw]), outline_yx, 3.0).T
    return raw * np.maximum(counted / whole, 0.2)


OLD, DEFAULT = "smoothed copy, 1 px", "along its way, default"
MEASURES: dict[str, Measure] = {
    OLD: partial(of_smoothed, sigma_px=1.0),
    "smoothed copy, 2 px": partial(of_smoothed, sigma_px=2.0),
    "smoothed copy, 3 px": partial(of_smoothed, sigma_px=3.0),
    "smoothed copy, 5 px": partial(of_smoothed, sigma_px=5.0),
    DEFAULT: arc_lengths,
    "  direction over 3 px": partial(arc_lengths, direction_px=3.0),
    "  direction over 4 px": partial(arc_lengths, direction_px=4.0),
    "  direction over 6 px": partial(arc_lengths, direction_px=6.0),
    "  direction over 8 px": partial(arc_lengths, direction_px=8.0),
    "  spread over 0.5 px": partial(arc_lengths, spread_px=0.5),
    "  spread over 2 px": partial(arc_lengths, spread_px=2.0),
    "  spread over 5 px": partial(arc_lengths, spread_px=5.0),
    "  least share 0.02": partial(arc_lengths, least_share=0.02),
    "  least share 0.1": partial(arc_lengths, least_share=0.1),
    "  least share 0.4": partial(arc_lengths, least_share=0.4),
}
KNOWN = "true outline known"


def circle(radius: float) -> Shape:
    """A disk."""
    return Shape(f"disk {radius:g}", "round", polar(lambda t: np.full_like(t, radius)))


def shapes() -> list[Shape]:
    """Drawn shapes of every class, none of them a judge, and small cells."""
    small = [circle(6.0), circle(10.0), Shape("small ellipse", "round", ellipse(12.0, 5.0))]
    star = Shape("small star", "star", polar(lambda t: 18.0 * (1.0 + 0.4 * np.cos(4 * t))))
    return [*small, star, *(shape for shape in others() if shape.name not in _TRACED)]


def ring(shape: Shape, drawing: Drawing) -> shapely.LinearRing:
    """True outline in the mask's frame, (x, y)."""
    return shapely.LinearRing(drawing.places(shape.outline_yx)[:, ::-1])


def maps(cell: CellMesh, measures: dict[str, Measure], method: str) -> Iterator[DiskMap]:
    """Map of a cell by each measure."""
    parameters = MapToDiskParameters.of(method=method)
    for measure in measures.values():
        yield map_mesh(cell, angles_of_lengths(cell.outline, measure(cell.outline + cell.corner)), parameters)


def noisy(mask: BoolArray, seed: int) -> BoolArray:
    """The mask with noise at its edge."""
    return cd.simulate.flipped_masks(mask[None], _FLIPPED, seed)[0]


def under_noise(mask: BoolArray, measures: dict[str, Measure], seeds: int, windows: bool) -> FloatArray:
    """Mean squared shift along the edge (px²), share in the same window and steps, by measure."""
    depth = ndimage.distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1]
    near, inside = np.argwhere((depth > 1.9) & (depth < 3.6)), np.argwhere(depth > 1.0)
    inside = np.random.default_rng(1).permutation(inside)[:600]
    window_of = cd.polar_windows(10, 60).window_of
    px = edge_lengths(smooth_closed(trace_outline(mask), 1.0)).sum() / (2.0 * np.pi)
    clean = mesh_cell(mask, MapToDiskParameters.of())
    before = list(maps(clean, measures, "harmonic"))
    relaxed = list(maps(clean, measures, "newton")) if windows else []
    found = []
    for seed in range(seeds):
        changed = noisy(mask, seed)
        if changed.sum() < _LEAST_LEFT * mask.sum():
            continue
        other = mesh_cell(changed, MapToDiskParameters.of())
        held, kept = (places[changed[tuple(places.T)]].astype(float) for places in (near, inside))
        rows = np.full((len(measures), 3), np.nan)
        for row, one, two in zip(rows, before, maps(other, measures, "harmonic"), strict=True):
            (u, v), (u2, v2) = one.to_disk(held).T, two.to_disk(held).T
            row[0] = np.square(px * np.angle((u2 + 1j * v2) / (u + 1j * v))).mean()
        for row, one, two in zip(rows, relaxed, maps(other, measures, "newton"), strict=False):
            row[1:] = (window_of(one.to_disk(kept)) == window_of(two.to_disk(kept))).mean(), two.steps
        found.append(rows)
    return np.mean(found, axis=0) if found else np.full((len(measures), 3), np.nan)


def error_against_truth(measure: Measure) -> float:
    """Rms error of outline points' angles against their true share of length, in px; mean over shapes."""
    errors = []
    for shape in shapes():
        drawing = shape.drawn(PHASE)
        traced, true = trace_outline(drawing.mask), ring(shape, drawing)
        turn = 2.0 * np.pi * true.project(shapely.points(traced[:, ::-1]), normalized=True)
        # In (x, y) an outline from +x towards +y is counter-clockwise.
        off = np.exp(1j * (angles_of_lengths(traced, measure(traced)) - (turn if true.is_ccw else -turn)))
        errors.append(np.angle(off / off.mean()).std() * true.length / (2.0 * np.pi))
    return float(np.mean(errors))


def protrusion_share(measure: Measure) -> float:
    """Least share of the circle of a protrusion on a disk of 25 px over its true one, mean of directions."""
    least = np.inf
    for width in (2.0, 3.0, 4.0, 6.0):
        for length in (20.0, 40.0, 60.0):
            ratios = []
            for degrees in (0.0, 20.0, 45.0):
                angle = np.radians(degrees)
                shape = Shape("arm", "branched", branched(25.0, ((angle, length, width),)))
                drawing, ahead = shape.drawn(PHASE), np.array([np.sin(angle), np.cos(angle)])
                fine = shapely.get_coordinates(shapely.segmentize(shapely.LinearRing(shape.outline_yx), 0.05))
                true = (fine[:-1] @ ahead > 25.5) @ edge_lengths(fine[:-1]) / edge_lengths(fine[:-1]).sum()
                traced = trace_outline(drawing.mask)
                lengths, there = measure(traced), drawing.shape_points(traced) @ ahead > 25.5
                share = lengths @ (0.5 * there + 0.5 * np.roll(there, -1)) / lengths.sum()
                ratios.append(share / true)
            least = min(least, float(np.mean(ratios)))
    return least


def disk_error(measure: Measure) -> float:
    """Largest error of angle on disks of radius 5 to 60 px, in degrees."""
    worst = 0.0
    for radius in (5.0, 7.3, 10.0, 20.0, 60.0):
        drawing = circle(radius).drawn(PHASE)
        traced = trace_outline(drawing.mask)
        y, x = drawing.shape_points(traced).T
        off = np.angle(np.exp(1j * (angles_of_lengths(traced, measure(traced)) - np.arctan2(y, x))))
        worst = max(worst, float(np.degrees(np.abs(off).max())))
    return worst


def added_by_spike(measure: Measure, height: int) -> float:
    """Length that a spike of one pixel on a disk of 25 px adds to the outline, in px."""
    plain = cd.simulate.disk(25.0, margin=height + 8)
    column = plain.shape[1] // 2
    top = int(plain[:, column].argmax())
    spiked = plain.copy()
    spiked[top - height : top, column] = True
    with_spike, without = (measure(trace_outline(mask)).sum() for mask in (spiked, plain))
    return float(with_spike - without)


def arm_under_noise(width: int, seeds: int) -> tuple[float, float]:
    """How far noise moves the middle line of a straight arm, and changes its width, over 3 px along it."""
    moved, widened = [], []
    for seed in range(seeds):
        mask = np.zeros((200, width + 20), dtype=bool)
        mask[10:190, 10 : 10 + width] = True
        rows = noisy(mask, seed)[15:185]
        first, last = rows.argmax(axis=1), rows.shape[1] - rows[:, ::-1].argmax(axis=1)
        whole = rows.any(axis=1)
        moved.append(ndimage.gaussian_filter1d(0.5 * (first + last)[whole], 3.0).std())
        widened.append(ndimage.gaussian_filter1d((last - first)[whole].astype(float), 3.0).std())
    return float(np.mean(moved)), float(np.mean(widened))


def stays(mask: BoolArray, distance_px: float) -> float:
    """Share of places that are in the same of 10 × 60 windows of one map after a small move."""
    disk, window_of = cd.map_to_disk(mask), cd.polar_windows(10, 60).window_of
    places = np.argwhere(ndimage.distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1] > 1.0).astype(float)
    turn = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, len(places))
    moved = places + distance_px * np.column_stack([np.sin(turn), np.cos(turn)])
    return float((window_of(disk.to_disk(places)) == window_of(disk.to_disk(moved))).mean())


def print_measures(seeds: int, cells: int, windows: bool) -> None:
    """The table of measures."""
    drawn, real = [], []
    for shape in shapes():
        drawing = shape.drawn(PHASE)
        known = {KNOWN: partial(of_drawing, true=ring(shape, drawing))}
        drawn.append(under_noise(drawing.mask, MEASURES | known, seeds, windows))
    path = DATA / "osteosarcoma" / "masks.tif"
    for number in range(cells if path.exists() else 0):
        mask = np.pad(clean_mask(tifffile.imread(path, key=number))[0], 4)
        real.append(under_noise(mask, MEASURES, seeds, windows))
    table = pd.DataFrame(index=[*MEASURES, KNOWN])
    for name, noise in (("shapes", drawn), ("cells", real)):
        if noise:
            found = np.array(noise)
            shift = pd.DataFrame(np.sqrt(found[..., 0]), columns=table.index[: found.shape[1]])
            table[f"{name} px"] = shift.median()
            table[f"{name} ratio"] = np.exp(np.log(shift.div(shift[OLD], axis=0)).mean())
            if windows:
                table[[f"{name} window", f"{name} steps"]] = np.nan
                table.loc[shift.columns, [f"{name} window", f"{name} steps"]] = found[..., 1:].mean(axis=0)
    for name, judge in (("truth px", error_against_truth), ("arm", protrusion_share), ("disk °", disk_error)):
        table[name] = pd.Series({measure: judge(lengths) for measure, lengths in MEASURES.items()})
    print(f"{len(drawn)} shapes and {len(real)} cells, {seeds} noisy copies of each")
    print(table.to_string(float_format="%.3f", na_rep=""))


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seeds", type=int, default=2, help="noisy copies of each mask (default 2)")
    parser.add_argument(
        "--cells", type=int, default=0, help="osteosarcoma cells beside the shapes (default 0)"
    )
    parser.add_argument("--windows", action="store_true", help="also relax the maps, which takes longest")
    chosen = parser.parse_args()
    print_measures(chosen.seeds, chosen.cells, chosen.windows)
    heights = (1, 2, 3, 4, 6, 10, 20)
    print("\nlength added by a spike 1 px wide, of height " + ", ".join(map(str, heights)) + " px")
    for name in (OLD, "smoothed copy, 3 px", DEFAULT):
        print(
            f"{name:<24}" + "".join(f"{added_by_spike(MEASURES[name], height):>8.2f}" for height in heights)
        )
    print("\nnoise in a straight arm, over 3 px along it: middle line moved, width changed (px, rms)")
    for width in (4, 6, 8, 12):
        print(f"{width:>3} px wide" + "".join(f"{value:>8.2f}" for value in arm_under_noise(width, 10)))
    print("\nsame of 10 × 60 windows of one map after a move by 0.25, 0.5 px")
    for shape in shapes():
        mask = shape.drawn(PHASE).mask
        print(f"{shape.name:<24}{stays(mask, 0.25):>8.2f}{stays(mask, 0.5):>8.2f}")


if __name__ == "__main__":
    main()

"""Which measure of the outline's length sends the edge of a cell to the circle: noise, truth and thin parts.

Noise flips the pixels on both sides of the edge with probability 0.5. Prints for each measure how far it
moves places 2-4 px inside the edge (harmonic map, rms along the edge in px, and over that of the first
measure), the share of places in the same 10 × 60 window and the steps of the default method under it; the
error of angles against true arc length, in px along the edge; the least share of the circle that a thin
protrusion gets (2-6 px wide, 20-60 px long), over its true share; the largest error of angle on disks of
radius 5-60 px. Then the length that a spike of one pixel adds to an outline.
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

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.circle import angles_of_lengths, arc_lengths
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import CellMesh, map_mesh, mesh_cell
from cytodisk.disk.mapping_parameters import MapToDiskParameters
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.polygon import edge_lengths, smooth_closed
from cytodisk.simulate.cells import disk, ellipse, star
from cytodisk.simulate.drawing import half_covered
from cytodisk.windows.polar_windows import polar_windows

_DEFAULT_DATA = Path(__file__).parents[2] / "shared" / "data"
_FLIPPED = 0.5
_LEAST_LEFT = 0.8  # of a cell's area: where noise cuts off more, the shape is another one
Measure = Callable[[FloatArray], FloatArray]


def of_smoothed(outline_yx: FloatArray, sigma_px: float) -> FloatArray:
    """Length of each edge of a smoothed copy, at least a tenth of its own."""
    return np.maximum(edge_lengths(smooth_closed(outline_yx, sigma_px)), 0.1 * edge_lengths(outline_yx))


MEASURES: dict[str, Measure] = {
    "smoothed copy, 1 px": partial(of_smoothed, sigma_px=1.0),
    "smoothed copy, 2 px": partial(of_smoothed, sigma_px=2.0),
    "smoothed copy, 3 px": partial(of_smoothed, sigma_px=3.0),
    "smoothed copy, 5 px": partial(of_smoothed, sigma_px=5.0),
    "along its way, default": arc_lengths,
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


def turned(outline_yx: FloatArray, degrees: float) -> FloatArray:
    """Outline turned about the origin."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return outline_yx @ np.array([[c, s], [-s, c]])


def wavy(radius: float, waves: dict[int, float], squeeze: float = 1.0) -> FloatArray:
    """Outline whose distance from the centre is a sum of cosines around it, squeezed along y."""
    angle = np.linspace(0.0, 2.0 * np.pi, 1440, endpoint=False)
    away = radius * (1.0 + sum(size * np.cos(k * angle + k) for k, size in waves.items()))
    return np.column_stack([squeeze * away * np.sin(angle), away * np.cos(angle)])


def armed(radius: float, arms: tuple[tuple[float, float, float], ...]) -> FloatArray:
    """Outline of a disk with round-ended arms of (degrees, length, width)."""
    body = shapely.Point(0.0, 0.0).buffer(radius, 64)
    for degrees, length, width in arms:
        tip = (radius + length - 0.5 * width) * np.array(
            [np.cos(np.radians(degrees)), np.sin(np.radians(degrees))]
        )
        body = body.union(shapely.LineString([(0.0, 0.0), tuple(tip)]).buffer(0.5 * width, 16))
    return np.array(body.exterior.coords)[:-1, ::-1]


BOX = np.array([(-18.0, -40.0), (-18.0, 40.0), (18.0, 40.0), (18.0, -40.0)])
U = np.array([(0, 0), (0, 60), (50, 60), (50, 42), (18, 42), (18, 18), (50, 18), (50, 0)], dtype=float)
OUTLINES = {
    "disk 10": wavy(10.0, {}),
    "disk 40": wavy(40.0, {}),
    "ellipse 60 × 20": turned(wavy(60.0, {}, 1 / 3), 17.0),
    "ellipse 12 × 5": turned(wavy(12.0, {}, 5 / 12), 33.0),
    "waves, 25 px": wavy(25.0, {2: 0.15, 3: 0.12, 5: 0.08}),
    "waves, 45 px": wavy(45.0, {2: 0.1, 3: 0.15, 4: 0.1, 6: 0.06}),
    "three lobes": wavy(30.0, {3: 0.5}),
    "four lobes": turned(wavy(18.0, {4: 0.4}), 20.0),
    "box": turned(BOX, 30.0),
    "U": turned(U, 9.0),
    "three arms": armed(18.0, ((52.0, 40.0, 7.0), (155.0, 30.0, 5.0), (264.0, 50.0, 6.0))),
}


def raster(outline_yx: FloatArray, offset: float = 0.3) -> tuple[BoolArray, FloatArray]:
    """Mask of an outline, and the outline in the mask's frame."""
    placed = outline_yx - outline_yx.min(axis=0) + 8.0 + offset
    height, width = np.ceil(placed.max(axis=0)).astype(int) + 9
    return clean_mask(half_covered(placed, (height, width)))[0], placed


def flipped(mask: BoolArray, random: np.random.Generator) -> BoolArray:
    """The mask with pixels on both sides of its edge flipped at random, cleaned."""
    rim = (mask & ~ndimage.binary_erosion(mask)) | (ndimage.binary_dilation(mask) & ~mask)
    return clean_mask(mask ^ (rim & (random.random(mask.shape) < _FLIPPED)))[0]


def maps(cell: CellMesh, measures: dict[str, Measure], method: str) -> Iterator[DiskMap]:
    """Map of a cell by each measure."""
    parameters = MapToDiskParameters.of(method=method)
    for measure in measures.values():
        yield map_mesh(cell, angles_of_lengths(cell.outline, measure(cell.outline)), parameters)


def under_noise(mask: BoolArray, measures: dict[str, Measure], seeds: int, windows: bool) -> FloatArray:
    """Mean squared shift along the edge (px²), share in the same window and steps, by measure."""
    depth = ndimage.distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1]
    near, inside = np.argwhere((depth > 1.9) & (depth < 3.6)), np.argwhere(depth > 1.0)
    inside = inside[np.random.default_rng(1).permutation(len(inside))[:600]]
    grid, clean = polar_windows(10, 60), mesh_cell(mask, MapToDiskParameters.of())
    px = edge_lengths(smooth_closed(trace_outline(mask), 1.0)).sum() / (2.0 * np.pi)
    before = list(maps(clean, measures, "harmonic"))
    relaxed = list(maps(clean, measures, "newton")) if windows else []
    found = []
    for seed in range(seeds):
        noisy = flipped(mask, np.random.default_rng(seed))
        if noisy.sum() < _LEAST_LEFT * mask.sum():
            continue
        held, kept = (p[noisy[tuple(p.T)]].astype(float) for p in (near, inside))
        other = mesh_cell(noisy, MapToDiskParameters.of())
        rows = []
        for one, two in zip(before, maps(other, measures, "harmonic"), strict=True):
            (u, v), (u2, v2) = one.to_disk(held).T, two.to_disk(held).T
            rows.append([np.square(px * np.angle((u2 + 1j * v2) / (u + 1j * v))).mean(), np.nan, np.nan])
        for row, one, two in zip(
            rows, relaxed, maps(other, measures, "newton") if windows else (), strict=False
        ):
            row[1:] = (
                (grid.window_of(one.to_disk(kept)) == grid.window_of(two.to_disk(kept))).mean(),
                two.steps,
            )
        found.append(rows)
    return np.mean(found, axis=0) if found else np.full((len(measures), 3), np.nan)


def error_against_truth(outline_yx: FloatArray, measure: Measure) -> float:
    """Rms error of outline points' angles against their true share of length, in px along the edge."""
    errors = []
    for offset in (0.0, 0.37, 0.6):
        mask, placed = raster(outline_yx, offset)
        traced, true = trace_outline(mask), shapely.Polygon(placed).exterior
        share = np.array([true.project(shapely.Point(point)) for point in traced]) / true.length
        # In (y, x) a polygon that runs from +x towards +y is clockwise.
        turn = 2.0 * np.pi * (share if not true.is_ccw else -share)
        off = np.exp(1j * (angles_of_lengths(traced, measure(traced)) - turn))
        errors.append(np.angle(off / off.mean()).std() * true.length / (2.0 * np.pi))
    return float(np.mean(errors))


def protrusion_share(measure: Measure, width: float, length: float) -> float:
    """Share of the circle of a protrusion on a disk of 25 px over its true share; mean over directions."""
    ratios = []
    for degrees in (0.0, 20.0, 45.0):
        drawn = armed(25.0, ((degrees, length, width),))
        mask, placed = raster(drawn)
        ahead = np.array([np.sin(np.radians(degrees)), np.cos(np.radians(degrees))])
        start = (placed - drawn)[0]

        def on_arm(points: FloatArray, ahead: FloatArray = ahead, start: FloatArray = start) -> FloatArray:
            return (points - start) @ ahead > 25.5

        fine = shapely.segmentize(shapely.Polygon(placed).exterior, 0.05)
        points = np.array(fine.coords)[:-1]
        true = edge_lengths(points) @ on_arm(points) / fine.length
        traced = trace_outline(mask)
        lengths, there = measure(traced), on_arm(traced)
        ratios.append(lengths @ (0.5 * there + 0.5 * np.roll(there, -1)) / lengths.sum() / true)
    return float(np.mean(ratios))


def disk_error(measure: Measure) -> float:
    """Largest error of angle on disks of radius 5 to 60 px, in degrees."""
    worst = 0.0
    for radius in (5.0, 7.3, 10.0, 20.0, 60.0):
        mask, placed = raster(wavy(radius, {}))
        traced = trace_outline(mask)
        y, x = (traced - placed.mean(axis=0)).T
        off = np.angle(np.exp(1j * (angles_of_lengths(traced, measure(traced)) - np.arctan2(y, x))))
        worst = max(worst, float(np.degrees(np.abs(off).max())))
    return worst


def added_by_spike(measure: Measure, height: int) -> float:
    """Length that a spike of one pixel on a disk of 25 px adds to the outline, in px."""
    plain = disk(25.0, margin=height + 8)
    column = plain.shape[1] // 2
    top = int(plain[:, column].argmax())
    spiked = plain.copy()
    spiked[top - height : top, column] = True
    with_spike, without = (measure(trace_outline(mask)).sum() for mask in (spiked, plain))
    return float(with_spike - without)


def cells(data: Path, count: int) -> dict[str, BoolArray]:
    """Reference cells and simulated ones beside the outlines; osteosarcoma cells where they are there."""
    masks = {name: raster(outline)[0] for name, outline in OUTLINES.items()}
    masks |= {
        "simulated star": star(3, body_radius=22.0, arm_length=30.0),
        "simulated ellipse": ellipse((15, 45)),
    }
    path = data / "osteosarcoma" / "masks.tif"
    if count and path.exists():
        for number, image in enumerate(tifffile.imread(path, key=range(count))):
            masks[f"osteosarcoma {number}"] = np.pad(clean_mask(image)[0], 4)
    return masks


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=3, help="noisy copies of each mask (default 3)")
    parser.add_argument(
        "--cells", type=int, default=0, help="osteosarcoma cells beside the shapes (default 0)"
    )
    parser.add_argument(
        "--no-windows", action="store_true", help="leave out the relaxed maps, which take longest"
    )
    parser.add_argument("--data", type=Path, default=Path(os.environ.get("CYTODISK_DATA", _DEFAULT_DATA)))
    chosen = parser.parse_args()
    masks = cells(chosen.data, chosen.cells)
    noise = np.array(
        [under_noise(mask, MEASURES, chosen.seeds, not chosen.no_windows) for mask in masks.values()]
    )
    shift = np.sqrt(noise[..., 0])
    sizes = [(width, length) for width in (2.0, 3.0, 4.0, 6.0) for length in (20.0, 40.0, 60.0)]
    table = pd.DataFrame(
        {
            "shift px": np.nanmedian(shift, axis=0),
            "ratio": np.exp(np.nanmean(np.log(shift / shift[:, :1]), axis=0)),
            "truth px": [
                np.mean([error_against_truth(outline, measure) for outline in OUTLINES.values()])
                for measure in MEASURES.values()
            ],
            "arm": [min(protrusion_share(measure, *size) for size in sizes) for measure in MEASURES.values()],
            "disk °": [disk_error(measure) for measure in MEASURES.values()],
        },
        index=list(MEASURES),
    )
    if not chosen.no_windows:
        table["window"], table["steps"] = np.nanmean(noise[..., 1:], axis=0).T
    print(f"{len(masks)} masks, {chosen.seeds} noisy copies of each\n{table.to_string(float_format='%.3f')}")
    heights = (1, 2, 3, 4, 6, 10, 20)
    print("\nlength added by a spike 1 px wide, of height " + ", ".join(map(str, heights)) + " px")
    for name in ("smoothed copy, 1 px", "smoothed copy, 3 px", "along its way, default"):
        print(
            f"{name:<24}" + "".join(f"{added_by_spike(MEASURES[name], height):>8.2f}" for height in heights)
        )


if __name__ == "__main__":
    main()

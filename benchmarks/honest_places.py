"""Blocks of `honest.py` on places: depth of the outermost layer, and an inside that stands still."""

from collections.abc import Iterator

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.distance import pdist

from cytodisk.arrays import FloatArray
from cytodisk.disk.mapping import map_to_disk
from cytodisk.motion.map_movie import map_movie
from cytodisk.simulate import cell_with_cortex, movie
from cytodisk.simulate.signals import depth as pixel_depth
from cytodisk.windows.polar_windows import polar_windows
from cytodisk.windows.sample import sample
from figure import Figure
from honest_trials import Trials

RADII_UM = (4.0, 8.0, 12.0, 20.0)
DEPTHS_UM = (0.5, 1.0, 2.0)
GROWTH_FRAMES = 21
INTERIORS = ("still", "area")


def cortex_in_layers(job: tuple[float, int]) -> tuple[float, float]:
    """Mean of the outermost layer: of layers by depth, and of 20 layers of equal width in the disk."""
    radius, seed = job
    cell = cell_with_cortex(radius, seed)
    disk = map_to_disk(cell.mask, pixel_size_um=cell.signal.attrs["pixel_size_um"])
    means = []
    for grid in (polar_windows(sectors=24, depth_um=DEPTHS_UM), polar_windows(20, 24, spacing="radius")):
        found = sample(grid.on(disk), cell.signal.sel(channel="cortex"))["mean"]
        means.append(float(found.isel(layer=0).mean()))
    return means[0], means[1]


def depth(trials: Trials) -> Iterator[Figure]:
    """One cortex reads the same in cells of all sizes."""
    seeds = trials.seeds(6, 2)
    found = trials.run("depth", cortex_in_layers, [(radius, seed) for radius in RADII_UM for seed in seeds])
    means = np.array(found).reshape(len(RADII_UM), len(seeds), 2).mean(axis=1)
    sizes = ", ".join(f"{radius:g}" for radius in RADII_UM)
    for column, how in enumerate(("depth_um=(0.5, 1, 2)", "20 layers")):
        values = means[:, column]
        yield Figure(
            f"{how}: largest over smallest mean of the outermost layer",
            100.0 * float(values.max() / values.min() - 1.0),
            "%",
            most=None if column else 5.0,
            note=f"radius {sizes} µm: " + ", ".join(f"{value:.1f}" for value in values),
        )


def place_errors(job: tuple[str, int]) -> tuple[FloatArray, FloatArray, int]:
    """How far inner points have gone after 20 frames, in percent of the diameter; their depths; bad maps."""
    interior, seed = job
    truth = movie("lamellipodium", seed, frames=GROWTH_FRAMES, radius_px=35.0, signals=False)
    mapped = map_movie(truth.masks, interior=interior)
    deep = pixel_depth(truth.masks[0])[tuple(np.rint(truth.interior_yx[0]).astype(int).T)]
    points, deep = truth.interior_yx[0][deep > 1.0], deep[deep > 1.0]
    there = mapped[GROWTH_FRAMES - 1].to_cell(mapped[0].to_disk(points, outside="nearest"))
    diameter = np.mean([_diameter(truth.boundary_yx[frame]) for frame in (0, -1)])
    bad = sum(not mapped[frame].certificate.valid for frame in range(GROWTH_FRAMES))
    return 100.0 * np.hypot(*(there - points).T) / diameter, deep, bad


def _diameter(outline_yx: FloatArray) -> float:
    return float(pdist(outline_yx[ConvexHull(outline_yx).vertices]).max())


def interior(trials: Trials) -> Iterator[Figure]:
    """A lamellipodium grows 30 px on one side, and the inside stands still."""
    seeds = trials.seeds(4, 1)
    jobs = [(interior, seed) for interior in INTERIORS for seed in seeds]
    found = trials.run("interior", place_errors, jobs)
    for number, name in enumerate(INTERIORS):
        ours = found[number * len(seeds) : (number + 1) * len(seeds)]
        away, deep = (np.concatenate([one[k] for one in ours]) for k in (0, 1))
        judged = name == "still"
        inner = away[deep > 10.0]
        yield Figure(
            f'interior="{name}": median place error',
            float(np.median(away)),
            "%",
            most=1.0 if judged else None,
        )
        yield Figure(
            f'interior="{name}": 95th percentile',
            float(np.percentile(away, 95.0)),
            "%",
            most=7.0 if judged else None,
            note=f"deeper than 10 px: {np.median(inner):.2f} and {np.percentile(inner, 95.0):.2f} %",
        )
        yield Figure(f'interior="{name}": invalid maps', sum(one[2] for one in ours), most=0)

"""Shape features: cells a second, time by group, and how much the complexity score depends on its seed."""

import argparse
import os
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
import tifffile
from scipy.stats import spearmanr

import cytodisk as cd
from cytodisk.analysis.shape.cell_shape import crop_shape
from cytodisk.analysis.shape.features import GROUPS, SCALE_FREE
from cytodisk.arrays import BoolArray
from cytodisk.geometry.mask import clean_mask

_DEFAULT_DATA = Path(__file__).parents[2] / "shared" / "data"
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def restart_with_one_thread() -> None:
    """Start this script anew unless it is held to one thread: the libraries ask when they are loaded."""
    if any(os.environ.get(name) != "1" for name in _THREADS):
        os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | dict.fromkeys(_THREADS, "1"))


def seconds_by_group(masks: list[BoolArray]) -> dict[str, float]:
    """CPU seconds of each group over all cells; what groups share counts for the first one that needs it."""
    seconds = dict.fromkeys(["cleaning", *(group.name for group in GROUPS)], 0.0)
    for mask in masks:
        start = time.process_time()
        rows, columns = np.nonzero(mask)
        box = mask[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
        shape = crop_shape(clean_mask(box)[0])
        seconds["cleaning"] += time.process_time() - start
        for group in GROUPS:
            start = time.process_time()
            group.measure(shape)
            seconds[group.name] += time.process_time() - start
    return seconds


def compare_scores(features: pd.DataFrame, seeds: int) -> None:
    """Print how alike the scores of different seeds are, and what else they go with."""
    cd.complexity_score(features)  # compiles UMAP
    start = time.perf_counter()
    scores = [cd.complexity_score(features, seed=seed) for seed in range(seeds)]
    print(f"complexity_score: {(time.perf_counter() - start) / seeds:.2f} s for {len(features)} cells, warm")
    again = cd.complexity_score(features, seed=0)
    print(f"same seed, same bits: {again.equals(scores[0])}")
    values = np.array([score["complexity"] for score in scores])
    between = pd.DataFrame(values.T).corr("spearman").to_numpy()[np.triu_indices(seeds, 1)]
    print(
        f"rank correlation between {seeds} seeds: median {np.median(between):.3f}, least {between.min():.3f}"
    )
    share = [score.attrs["axis_share"] for score in scores]
    print(f"share of the plane's variance along its axis: {min(share):.2f} to {max(share):.2f}")
    first = [score.attrs["first_component"] for score in scores]
    print(f"rank correlation with the first principal component: {min(first):.3f} to {max(first):.3f}")
    for name in ("circularity", "solidity", "tips", "harmonic_area_error", "area"):
        print(f"rank correlation with {name}: {spearmanr(values[0], features[name]).statistic:+.2f}")
    for neighbors in (5, 30, 60):
        other = cd.complexity_score(features, n_neighbors=neighbors)["complexity"]
        print(f"with {neighbors} neighbours: rank correlation {spearmanr(values[0], other).statistic:.3f}")
    ranked = np.argsort(values[0], kind="stable")
    print(f"least complex cells: {ranked[:5].tolist()}; most complex: {ranked[-5:].tolist()}")


def print_drift() -> None:
    """Print how far scale-free features of blobs are from those of the same blobs drawn 240 px large.

    In standard deviations over the blobs: median and 90th percentile over blobs and features.
    """
    blobs = [(seed, roughness) for seed in range(6) for roughness in (0.15, 0.25, 0.4)]

    def draw(diameter: float) -> pd.DataFrame:
        masks = [cd.simulate.random_smooth(s, radius=diameter / 2, roughness=r) for s, r in blobs]
        return cd.shape_features(masks)[list(SCALE_FREE)]

    large = draw(240)
    print("drift of scale-free features with size, in sd between shapes (median, 90th percentile):")
    for diameter in (10, 20, 40, 60, 75, 120):
        drift = ((draw(diameter) - large) / large.std()).abs()
        named = ", ".join(f"{name} {drift[name].median():.2f}" for name in ("roughness", "curvature_sd"))
        middle, high = np.nanquantile(drift, (0.5, 0.9))
        print(f"  D about {diameter:>3} px: {middle:.2f}, {high:.2f}; {named}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("masks", nargs="?", type=Path, default=_DEFAULT_DATA / "osteosarcoma" / "masks.tif")
    parser.add_argument("--seeds", type=int, default=6)
    arguments = parser.parse_args()
    if arguments.seeds < 2:
        parser.error("--seeds must be at least 2, to compare them")
    restart_with_one_thread()
    masks = tifffile.imread(arguments.masks) > 0
    cd.shape_features(masks[:3])  # compiles
    start, cpu = time.perf_counter(), time.process_time()
    features = cd.shape_features(masks)
    wall, cpu = time.perf_counter() - start, time.process_time() - cpu
    ok = features["status"] == "ok"
    print(f"{len(features)} cells, {ok.sum()} measured, median {features['area'].median():.0f} px")
    print(
        f"{len(features) / cpu:.1f} cells/s of CPU on one core; {len(features) / wall:.1f} by the clock, "
        "which depends on what else runs"
    )
    for name, seconds in seconds_by_group(list(masks)).items():
        print(f"  {name:<11} {1e3 * seconds / len(masks):6.2f} ms a cell")
    compare_scores(features[ok], arguments.seeds)
    print_drift()


if __name__ == "__main__":
    main()

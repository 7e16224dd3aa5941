"""Block of `honest.py` on clusters of windows, in series without images."""

import warnings
from collections.abc import Iterator

import numpy as np

from cytodisk.analysis.correlation.clusters import correlation_clusters
from cytodisk.analysis.correlation.cross_correlation import cross_correlate
from cytodisk.analysis.correlation.peaks import peak_correlation
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import StationarityWarning
from cytodisk.simulate import coupled_series, independent_series
from figure import Figure
from honest_trials import Trials

LAYERS, SECTORS = 5, 36
FRAMES = (60, 120, 300)
JUDGED_FRAMES = 120
STRENGTH = 0.3
LAG = 3
MAX_LAG = 10
SURROGATES = 999
ALPHA = 0.05


def coupled_windows() -> BoolArray:
    """Two layers of a third of the edge."""
    coupled = np.zeros((LAYERS, SECTORS), dtype=bool)
    coupled[:2, : SECTORS // 3] = True
    return coupled


def clustered(job: tuple[str, int, int]) -> FloatArray:
    """Coupled windows found by clusters, and one by one; others in clusters; clusters that touch none."""
    kind, frames, seed = job
    warnings.simplefilter("ignore", StationarityWarning)
    on = coupled_windows()
    activity, velocity = coupled_series(
        "white", seed, frames, LAYERS, SECTORS, lag_frames=LAG, windows=on, strength=STRENGTH
    )
    if kind == "independent":
        activity, velocity = independent_series("ar1", seed, frames, LAYERS, SECTORS)
        on = np.zeros_like(on)
    found = cross_correlate(activity, velocity, MAX_LAG, surrogates=SURROGATES, seed=seed, clusters=True)
    member = correlation_clusters(found)["member"].transpose("cluster", "layer", "sector").to_numpy()
    alone = (peak_correlation(found)["q"].transpose("layer", "sector") < ALPHA).to_numpy()
    held = member.any(axis=0)
    false = [not (one & on).any() for one in member]
    shares = [held[on].mean(), alone[on].mean()] if on.any() else [np.nan, np.nan]
    return np.array([*shares, held[~on].mean(), float(any(false))])


def clusters(trials: Trials) -> Iterator[Figure]:
    """Coupled windows that are found together, and false clusters."""
    seeds = trials.seeds(100, 10)
    cases = [*(("coupled", frames) for frames in FRAMES), ("independent", JUDGED_FRAMES)]
    jobs = [(kind, frames, seed) for kind, frames in cases for seed in seeds]
    found = np.array(trials.run("clusters", clustered, jobs)).reshape(len(cases), len(seeds), 4)
    for (kind, frames), rows in zip(cases, found, strict=True):
        held, alone, beside, false = 100.0 * rows.mean(axis=0)
        judged = frames == JUDGED_FRAMES
        if kind == "coupled":
            yield Figure(
                f"windows coupled at r = {STRENGTH:g}, {frames} frames: found by clusters",
                held,
                "%",
                least=60.0 if judged else None,
                note=f"{len(seeds)} movies; {alone:.0f} % one by one; {beside:.1f} % of the others are in a "
                "cluster, too",
            )
        yield Figure(
            f"{kind} series, {frames} frames: movies with a false cluster",
            false,
            "%",
            most=5.0 if judged else None,
            note="" if kind == "independent" else "a cluster without any coupled window",
        )

"""Block of `honest.py` on independent series that fool a correlation."""

import warnings
from collections.abc import Iterator

from cytodisk.analysis.correlation.cross_correlation import cross_correlate
from cytodisk.analysis.correlation.peaks import peak_correlation
from cytodisk.analysis.stress.stress_marks import stress_marks
from cytodisk.errors import StationarityWarning
from cytodisk.simulate import independent_series
from figure import Figure
from honest_trials import Trials, percent

FRAMES, LAYERS, SECTORS = 100, 3, 24
MAX_LAG = 10
ALPHA = 0.05
FLAGS = {
    "pulse": "common pulse",
    "restless": "restless episode",
    "rising": "variance change",
    "steady": "steady oscillation",
    "heavy tails": "heavy tails",
}
CALM = ("white", "ar1", "slow", "smooth")
JUDGED_CALM = ("white", "ar1")


def stressed(job: tuple[str, int]) -> tuple[tuple[str, ...], float, float]:
    """Marks of a pair of independent series; share of windows at p <= .05, by value and by rank."""
    kind, seed = job
    warnings.simplefilter("ignore", StationarityWarning)
    activity, velocity = independent_series(kind, seed, FRAMES, LAYERS, SECTORS)  # type: ignore[arg-type]
    marks = stress_marks(activity, velocity, MAX_LAG, seed=seed)
    shares = []
    for statistic in ("pearson", "spearman"):
        found = cross_correlate(activity, velocity, MAX_LAG, surrogates=199, seed=seed, statistic=statistic)
        shares.append(float((peak_correlation(found)["p"] <= ALPHA).mean()))
    return () if marks is None else marks.found, shares[0], shares[1]


def stress(trials: Trials) -> Iterator[Figure]:
    """Series that fool a correlation are flagged, and others are not."""
    seeds = trials.seeds(200, 10)
    kinds = [*FLAGS, *CALM]
    found = trials.run("stress", stressed, [(kind, seed) for kind in kinds for seed in seeds])
    for number, kind in enumerate(kinds):
        rows = found[number * len(seeds) : (number + 1) * len(seeds)]
        by_value, by_rank = (percent([row[k] for row in rows]) for k in (1, 2))
        name = FLAGS.get(kind)
        right = "" if name is None else f"; `{name}` {percent([name in row[0] for row in rows]):.0f} %"
        yield Figure(
            f"{kind}: movies that are flagged",
            percent([bool(row[0]) for row in rows]),
            "%",
            least=95.0 if name else None,
            most=5.0 if kind in JUDGED_CALM else None,
            note=f"{len(seeds)} movies{right}; windows at p <= .05 {by_value:.0f} %, by rank {by_rank:.0f} %",
        )

"""Block of `honest.py` on QC flags of movies in which nothing is wrong."""

from collections import Counter
from collections.abc import Iterator

import numpy as np

from cytodisk.runs.correlate.run_correlate import run_correlate
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.simulate import MOVIE_KINDS, movie
from cytodisk.simulate.movie_kinds import MovieKind
from figure import Figure
from honest_trials import Trials, quiet_study

SMALLEST_PX2 = 10.0  # of the median window; files without a scale give areas in pixels
NOT_CLEAN = ("still", "dropping", "filopodium")
"""Kinds whose masks jitter, or are missing in some frames, or whose windows are distorted: an arm that
becomes three radii long raises "strong distortion", and that is right."""
KINDS: tuple[MovieKind, ...] = (
    *(kind for kind in MOVIE_KINDS if kind not in NOT_CLEAN),
    *("fluctuating",) * 6,
)
"""All but "fluctuating" move with a period or steadily, so they are not correlated: a flag would be right."""


def flags_of_movie(job: tuple[MovieKind, int]) -> list[str]:
    """Flags of a study of a clean movie; of one whose edge fluctuates, after correlating, too."""
    kind, seed = job
    truth = movie(kind, seed, frames=60 if kind == "fluctuating" else 40)
    assert truth.signal is not None
    channels = {name: truth.signal.sel(channel=name).to_numpy() for name in ("material", "edge")}
    with quiet_study(truth.masks, channels, layers=5, sectors=24) as study:
        if study.windows["area"].median() < SMALLEST_PX2:
            raise ValueError(f"windows of {kind}, seed {seed}, are smaller than {SMALLEST_PX2:g} px")
        if kind == "fluctuating":
            run_correlate(study, "edge", max_lag=12, surrogates=499, seed=seed)
        return [f"{flag.name} ({flag.what})" for flag in qc_flags(study)]


def flags(trials: Trials) -> Iterator[Figure]:
    """Flags are rare where nothing is wrong."""
    seeds = list(trials.seeds(50, 5))
    jobs = [(KINDS[number % len(KINDS)], seed) for number, seed in enumerate(seeds)]
    found = trials.run("flags", flags_of_movie, jobs)
    carry = np.array([bool(one) for one in found])
    names = Counter(flag for one in found for flag in {name.split(" (")[0] for name in one})
    which = "; ".join(f"{name} {count}×" for name, count in names.most_common())
    yield Figure(
        f"of {len(jobs)} clean movies with windows of at least 10 px: with any flag",
        int(carry.sum()),
        most=3.0 * len(jobs) / 50.0,
        note=which,
    )
    for (kind, seed), one in zip(jobs, found, strict=True):
        for name in one:
            yield Figure(f"{kind}, seed {seed}", 1, note=name)

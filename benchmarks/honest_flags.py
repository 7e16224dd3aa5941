"""Block of `honest.py` on QC flags of movies in which nothing is wrong."""

from collections import Counter
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from cytodisk.arrays import FloatArray
from cytodisk.runs.correlate.run_correlate import run_correlate
from cytodisk.runs.qc_flags.finest_grid import finest_grid
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.simulate import MOVIE_KINDS, SimulatedMovie, movie, passive_signal
from cytodisk.simulate.movie_kinds import MovieKind
from cytodisk.store.study import Study
from cytodisk.store.window_areas import areas_px
from figure import Figure
from honest_trials import Trials, quiet_study

SMALLEST_PX2 = 10.0  # of any window in any frame
MARGIN = 1.2  # areas of a coarser grid are interpolated
GRID: dict[str, Any] = {"layers": 5, "sectors": 24}
NOT_CLEAN = ("still", "dropping", "filopodium")
"""Kinds whose masks jitter, or are missing in some frames, or whose windows are distorted: an arm that
becomes three radii long raises "strong distortion", and that is right."""
KINDS: tuple[MovieKind, ...] = (
    *(kind for kind in MOVIE_KINDS if kind not in NOT_CLEAN),
    *("fluctuating",) * 6,
)
"""All but "fluctuating" move with a period or steadily, so they are not correlated: a flag would be right."""
EVEN, GAIN, DECAY_PX = 300.0, 80.0, 5.0
"""Mean of a coupled signal, what a velocity of 1 px/frame adds at the edge, and how that decays inwards."""
CORRELATED: dict[str, Any] = {"max_lag": 12, "surrogates": 499}


class Carried(NamedTuple):
    """Flags of one movie, and whether the same cell with a cortex has `geometry` (None: not correlated)."""

    flags: list[str]
    cortex: bool | None


def coupled_signal(truth: SimulatedMovie) -> FloatArray:
    """An even signal with camera noise that is brighter where the edge moves out: no cortex, no pattern."""
    signal = passive_signal("uniform", truth.masks, truth.seed, peak=EVEN, noise=EVEN**0.5).to_numpy()
    for frame, mask in enumerate(truth.masks):
        pixels = np.argwhere(mask)
        depth, nearest = cKDTree(truth.boundary_yx[frame]).query(pixels)
        velocity = truth.normal_displacement_px[min(frame, len(truth.masks) - 2)]
        signal[frame][mask] += GAIN * velocity[nearest] * np.exp(-depth / DECAY_PX)
    return signal


def grid_of(study: Study) -> dict[str, Any] | None:
    """A grid without windows that are too small, if the study has some."""
    if study.cells["smallest_window_px"].min() >= SMALLEST_PX2:
        return None
    frames = {(0, int(frame)) for frame in study.cells["frame"]}
    found = finest_grid(areas_px(study, frames), SMALLEST_PX2, MARGIN * SMALLEST_PX2)
    return None if found is None else dict(zip(("layers", "sectors"), found, strict=True))


def flags_of_movie(job: tuple[MovieKind, int]) -> Carried:
    """Flags of a study of a clean movie; of one whose edge fluctuates, after correlating, too."""
    kind, seed = job
    correlated = kind == "fluctuating"
    truth = movie(kind, seed, frames=60 if correlated else 40)
    assert truth.signal is not None
    channels = {name: truth.signal.sel(channel=name).to_numpy() for name in ("material", "edge")}
    if correlated:
        channels = {"coupled": coupled_signal(truth), "edge": channels["edge"]}
    with quiet_study(truth.masks, channels, **GRID) as study:
        if (coarser := grid_of(study)) is None:
            return _flags(study, seed, correlated)
    with quiet_study(truth.masks, channels, **coarser) as study:
        return _flags(study, seed, correlated)


def _flags(study: Study, seed: int, correlated: bool) -> Carried:
    smallest = study.cells["smallest_window_px"].min()
    if smallest < SMALLEST_PX2:
        raise ValueError(f"seed {seed}: a window has {smallest:.1f} px, fewer than {SMALLEST_PX2:g}")
    if correlated:
        run_correlate(study, "coupled", seed=seed, **CORRELATED)
    flags = [f"{flag.name} ({flag.what})" for flag in qc_flags(study)]
    if not correlated:
        return Carried(flags, None)
    run_correlate(study, "edge", seed=seed, **CORRELATED)
    geometry = [place.note for flag in qc_flags(study) if flag.name == "geometry" for place in flag.places]
    return Carried(flags, any(note.startswith("edge ") for note in geometry))


def flags(trials: Trials) -> Iterator[Figure]:
    """Flags are rare where nothing is wrong.

    A movie is clean if its masks are right, each window has 10 px or more in each frame (else it gets a
    coarser grid), and no correlated signal has a fixed cortex or a still pattern: there the flag `geometry`
    is right. How often a signal with cortex and coupling carries that flag is reported, not judged.
    """
    seeds = list(trials.seeds(50, 5))
    jobs = [(KINDS[number % len(KINDS)], seed) for number, seed in enumerate(seeds)]
    found = trials.run("flags", flags_of_movie, jobs)
    carry = np.array([bool(one.flags) for one in found])
    names = Counter(flag for one in found for flag in {name.split(" (")[0] for name in one.flags})
    which = "; ".join(f"{name} {count}×" for name, count in names.most_common())
    yield Figure(
        f"of {len(jobs)} clean movies with windows of at least 10 px: with any flag",
        int(carry.sum()),
        most=3.0 * len(jobs) / 50.0,
        note=which,
    )
    for (kind, seed), one in zip(jobs, found, strict=True):
        for name in one.flags:
            yield Figure(f"{kind}, seed {seed}", 1, note=name)
    cortex = [one.cortex for one in found if one.cortex is not None]
    if cortex:
        yield Figure(
            f"of {len(cortex)} movies whose signal has a cortex and follows the edge: with the flag geometry",
            sum(cortex),
            note="that flag is right there",
        )

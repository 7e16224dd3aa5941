"""Blocks of `honest.py` on what `waves` and `predict` say of movies without biology."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from cytodisk.runs.predict.prediction_verdict import directions
from cytodisk.runs.predict.run_predict import run_predict
from cytodisk.runs.qc_flags.wave_doubts import doubts_of, has_inside
from cytodisk.runs.waves.run_waves import run_waves
from cytodisk.simulate import movie, passive_signal
from figure import Figure
from honest_geometry import ALPHA, CASES, GRID, JUDGED, SMALL_CELL, SURROGATES
from honest_trials import Trials, percent, quiet_study

MOST_WAVES = 10.0  # percent, as for correlations
MOTION, NOT_TESTED = "waves of the cell's motion", "cell's motion not tested"
EDGE = "velocity"


class Waves(NamedTuple):
    """What `waves` said of one signal of one movie."""

    found: bool
    motion: bool
    not_tested: bool
    other: bool

    @property
    def fooled(self) -> bool:
        """Whether it calls a wave, and does not say that motion alone may have made it."""
        return self.found and not (self.motion or self.not_tested)


class Links(NamedTuple):
    """What `predict` said of one direction in one movie, of any layer: `clear` is what it calls a finding."""

    raw: bool
    partial: bool
    marked: bool
    clear: bool


def passive_channels(seed: int) -> tuple[Any, dict[str, Any]]:
    """Masks of a cell whose edge fluctuates by itself, and its signals without biology."""
    masks = movie("fluctuating", seed, **SMALL_CELL).masks
    return masks, {kind: passive_signal(kind, masks, seed).to_numpy() for kind in CASES}


def waves_of_movie(seed: int) -> dict[str, Waves]:
    """Waves in each signal, and in the velocity of the edge."""
    masks, channels = passive_channels(seed)
    found = {}
    with quiet_study(masks, channels, **GRID) as study:
        for name in (EDGE, *CASES):
            row = run_waves(study, name, seed=seed).cells.iloc[0]
            doubts = doubts_of(row)
            there = bool(row["kind"] != "none" or has_inside(row))
            motion, blind = MOTION in doubts, NOT_TESTED in doubts
            found[name] = Waves(there, motion, blind, bool(set(doubts) - {MOTION, NOT_TESTED}))
    return found


def no_waves(trials: Trials) -> Iterator[Figure]:
    """Movies in which a wave is found where none runs."""
    seeds = list(trials.seeds(100, 4))
    found = trials.run("no waves", waves_of_movie, seeds)
    for name in (EDGE, *CASES):
        rows = [one[name] for one in found]
        yield Figure(
            f"{name}: a wave, and no flag `{MOTION}`",
            percent([row.fooled for row in rows]),
            "%",
            most=MOST_WAVES if name in JUDGED else None,
            note=f"{len(rows)} movies; a wave {percent([row.found for row in rows]):.0f} %; flagged "
            f"{percent([row.motion for row in rows]):.0f} %, not tested "
            f"{percent([row.not_tested for row in rows]):.0f} %, another flag "
            f"{percent([row.other for row in rows]):.0f} %",
        )


def links_of_movie(seed: int) -> dict[str, Links]:
    """Links of each signal with the velocity of the edge, both ways."""
    masks, channels = passive_channels(seed)
    found = {}
    with quiet_study(masks, channels, **GRID) as study:
        for kind in CASES:
            prediction = run_predict(study, kind, EDGE, surrogates=SURROGATES, seed=seed)
            for way in directions(prediction, 0):
                partial = (way.rows["q_partial"] < ALPHA) & (way.rows["q"] < ALPHA)
                marked = any(one.lost or one.doubts for one in way.judged)
                found[f"{way.source} → {way.target}"] = Links(
                    bool(way.judged), bool(partial.any()), marked, bool(way.clear)
                )
    return found


def no_prediction(trials: Trials) -> Iterator[Figure]:
    """Movies whose signal has nothing to do with the edge but by geometry, and predicts it or follows it."""
    seeds = list(trials.seeds(100, 4))
    found = trials.run("no prediction", links_of_movie, seeds)
    for way in found[0]:
        rows = [one[way] for one in found]
        judged = any(name in way for name in JUDGED)
        table = 100.0 * np.array(rows, dtype=np.float64).mean(axis=0)
        yield Figure(
            f"{way}: any layer that is significant, without geometry too, and not flagged",
            percent([row.clear for row in rows]),
            "%",
            most=MOST_WAVES if judged else None,
            note=f"{len(rows)} movies; any layer at q < .05 {table[0]:.0f} %, and at q_partial < .05 "
            f"{table[1]:.0f} %; any flag {table[2]:.0f} %",
        )

"""QC flags of a study's waves: too few periods or frames, the cell's own motion, jitter, drift, left out."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pandas as pd

from cytodisk.analysis.waves.edge_waves import SIGNIFICANT
from cytodisk.number_words import counted, rounded
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag
from cytodisk.runs.qc_flags.wave_doubts import HIDING, doubts_of
from cytodisk.store.study import Study


@dataclass(frozen=True)
class _Said:
    """What a flag says: of how many waves, what it means, what to do, and the note of a place."""

    what: str
    meaning: str
    advice: str
    note: Callable[[Any], str]


_SAID: dict[str, _Said] = {
    "few periods": _Said(
        "the movie holds few periods of",
        "The period is near the longest that the movie can show: the true one may be longer, or a slow "
        "change passes for a wave.",
        "Take a longer movie.",
        lambda row: f"{rounded(row['periods'], 2)} periods",
    ),
    "few frames a period": _Said(
        "a period has few frames in",
        "The period is near the shortest that is looked for: the true one may be shorter, and speed and way "
        "are wrong where a crest goes more than half a wave from frame to frame.",
        "Take frames at shorter intervals.",
        lambda row: f"{rounded(row['period'], 2)} frames",
    ),
    "waves of the cell's motion": _Said(
        "the motion of the cell alone gives",
        "A long cell that turns, or one that moves over a pattern that stands still, looks like a wave in "
        "its sectors.",
        "Do not count them as waves; look at the movie.",
        lambda row: "; ".join(_with_and_without(row)),
    ),
    HIDING: _Said(
        "masks jitter where there are no waves beyond chance, in",
        "Noise of the outline moves the edge out and back in the next frame, and hides waves.",
        "Smooth the masks in time, or look at waves of a signal.",
        lambda row: f"{row['jitter']:.0%} of velocity's variance",
    ),
    "drifting waves": _Said(
        "the level of many series drifts in",
        "A slow trend passes for a wave that is longer than the movie.",
        "Compare with a part of the movie, with --frames.",
        lambda row: f"{row['drifting']:.0%} of the series",
    ),
    "waves over restarts": _Said(
        "tracking started anew within the frames of",
        "A sector need not be the same place of the edge before and after, which breaks a wave or bends it.",
        "Look at the stretches one by one, with --frames.",
        lambda row: counted(int(row["restarts"]), "restart"),
    ),
    "cell's motion not tested": _Said(
        "it is not known what the motion of the cell alone gives for",
        "A long cell that turns, or one that moves over a pattern that stands still, looks like a wave.",
        "Of a signal, put the images back to where it was measured; of velocity, follow the movie with "
        "registration. Then run cytodisk waves again.",
        lambda row: str(row["geometry_not_tested"]),
    ),
}


def _with_and_without(row: Any) -> Iterator[str]:
    """p of the layer's wave, and of that through all layers, with the cell's motion and without."""
    for what, p, left in (("", "p", "p_partial"), ("all layers: ", "p_inside", "p_inside_partial")):
        if row.get(left, math.nan) > SIGNIFICANT:
            yield f"{what}p = {row[p]:.2g}, without the cell's motion {row[left]:.2g}"


def wave_doubt_flags(study: Study) -> Iterator[QCFlag]:
    """All that speaks against the waves of a study, a flag for each kind of doubt."""
    rows = list(_rows(study))
    for name, said in _SAID.items():
        places = tuple(
            Place(int(row["cell"]), None, f"{title}: {said.note(row)}")
            for title, row in rows
            if name in doubts_of(row)
        )
        if places:
            what = f"{said.what} {counted(len(places), 'cell' if name == HIDING else 'wave')}"
            yield QCFlag(name, what, said.meaning, said.advice, places)


def without_waves(study: Study) -> Iterator[QCFlag]:
    """Cells in which waves could not be looked for."""
    places = tuple(
        Place(int(row["cell"]), None, f"{title}: {row['reason']}")
        for title, row in _rows(study)
        if row["status"] != "ok"
    )
    if places:
        yield QCFlag(
            "no waves looked for",
            f"waves could not be looked for in {counted(len(places), 'cell')}",
            "They are in the tables of windows, but not in those of waves.",
            "See the reason; a cell that is there for few frames holds no period.",
            places,
        )


def _rows(study: Study) -> Iterator[tuple[str, pd.Series[Any]]]:
    """Cells of all waves, with the name of what waves were looked for in."""
    for names in study.wave_signals:
        title = names[0] if len(names) == 1 else f"{names[0]} ({names[1]})"
        for _, row in study.waves(*names).cells.iterrows():
            yield title, row

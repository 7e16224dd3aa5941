"""What the study of a movie shows first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from cytodisk.analysis.top_speed import top_speed
from cytodisk.number_words import counted, rounded
from cytodisk.runs.channel_names import correlation_name
from cytodisk.runs.findings.correlation_finding import correlation_finding
from cytodisk.runs.findings.doubt_words import bearing_flags
from cytodisk.runs.findings.finding import Finding, listed
from cytodisk.runs.findings.layer_levels import WITHOUT_VALUES, LayerLevels, has_channel, layer_levels
from cytodisk.runs.findings.signal_sentences import signal_sentences
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.runs.qc_flags.remedy import correlate_command
from cytodisk.runs.qc_flags.study_flags import run_flags
from cytodisk.store.study import Study

NO_SIGNAL = "No signal was given, so there is none to compare with the edge."
_ORDER = ("found", "doubtful", "nothing")
_KINDS = {"found": "found", "doubtful": "in doubt", "nothing": "not beyond chance"}
_MOST_NAMED = 3
_NOISE = 1e-6  # of the error of a velocity


def movie_finding(study: Study, cell: int, flags: Sequence[QCFlag] | None = None) -> Finding:
    """What a movie's study shows of a cell: its strongest correlation, or else what was measured.

    Parameters
    ----------
    study : Study
    cell : int
    flags : sequence of QCFlag, optional
        Those of the study, where they are known already.

    Returns
    -------
    Finding
    """
    raised = bearing_flags(run_flags(study) if flags is None else flags, cell)
    found = [
        (names, finding)
        for names in study.correlations
        if (finding := correlation_finding(study, study.correlation(*names), cell, raised)) is not None
    ]
    if not found:
        return measured(study, cell, raised)
    ordered = sorted(found, key=lambda one: (_ORDER.index(one[1].kind), -one[1].size))
    (_, first), *others = ordered
    if not others:
        return first
    last = " ".join([*first.sentences[2:], others_words(others)])
    return Finding(first.kind, (*first.sentences[:2], last), first.command, first.size)


def others_words(others: Sequence[tuple[tuple[str, ...], Finding]]) -> str:
    """What other correlations came to, as "2 other correlations: 1 found (A with velocity), 1 in doubt."."""
    if len(others) == 1:
        ((names, other),) = others
        return f"The other correlation, {correlation_name(names)}: {_KINDS[other.kind]}."
    named = [correlation_name(names) for names, other in others if other.kind == "found"]
    kinds: list[str] = [other.kind for _, other in others]
    parts = [
        f"{len(named)} found ({listed(named[:_MOST_NAMED])}{', …' * (len(named) > _MOST_NAMED)})"
    ] * bool(named)
    parts += [f"{kinds.count(kind)} {_KINDS[kind]}" for kind in _ORDER[1:] if kind in kinds]
    return f"{counted(len(others), 'other correlation')}: {', '.join(parts)}."


def usual_cell(study: Study) -> int | None:
    """The cell with the most mapped frames, the first of several; None if nothing is mapped."""
    mapped = study.cells.loc[study.cells["status"] == "ok", "cell"]
    if mapped.empty:
        return None
    cells, counts = np.unique(mapped, return_counts=True)
    return int(cells[counts.argmax()])


def measured(study: Study, cell: int, flagged: Sequence[str] = ()) -> Finding:
    """What was measured of a cell: how its edge moves, how its area changes, where its signal is.

    Parameters
    ----------
    study : Study
        Of a movie.
    cell : int
    flagged : sequence of str
        Names of QC flags that bear on it.

    Returns
    -------
    Finding
    """
    levels = layer_levels(study, cell)
    words = list(_motion(study, cell))
    if flagged:
        words[-1] = f"{words[-1][:-1]}; but QC flags are raised that bear on this: {listed(list(flagged))}."
    words += _signals(study, cell, levels)
    command = "" if levels is None else correlate_command(study, levels.channels[0])
    return Finding("measured", tuple(words), command)


def _signals(study: Study, cell: int, levels: LayerLevels | None) -> Iterator[str]:
    if levels is None:
        yield WITHOUT_VALUES if has_channel(study) else NO_SIGNAL
        return
    yield from signal_sentences(study, levels, cell)


def _motion(study: Study, cell: int) -> Iterator[str]:
    """How the edge moves and the area changes."""
    rows = study.cells[(study.cells["cell"] == cell) & (study.cells["status"] == "ok")].sort_values("frame")
    edge = study.edge[study.edge["cell"] == cell]
    speed = edge["velocity"].dropna()
    frames = int(rows["frame"].iloc[-1] - rows["frame"].iloc[0]) if len(rows) else 0
    time = study.scale.shown_time(frames + 1)
    span = time.words(study.scale.time(float(frames)))
    if speed.empty:
        yield "No two mapped frames follow each other, so the edge has no velocity."
        return
    error = float(edge["velocity_error"].median())
    speed = speed.where(~(speed.abs() < _NOISE * error), 0.0)  # what sums leave of an edge that stands still
    unit, usual = (
        study.scale.shown_velocity(top_speed(speed.to_numpy()), frames + 1),
        float(speed.abs().median()),
    )
    noise = f", no more than the error of one sector ({unit.words(error, 2)})" if usual <= error else ""
    moving = (
        f"In {span} the edge moves at {unit.words(usual, 2)} in the median{noise}, and protrudes in "
        f"{_share(speed)} of sectors and frames"
    )
    yield f"{moving}; {_area(rows, study.cells.attrs['units']['area'])}."


def _share(speed: pd.Series[float]) -> str:
    return f"{float((speed > 0).mean()):.0%}".replace("%", " %")


def _area(rows: pd.DataFrame, unit: str) -> str:
    first, last = float(rows["area"].iloc[0]), float(rows["area"].iloc[-1])
    change = f"{100 * (last / first - 1):+.0f} %".replace("-", "−")
    return f"the area goes from {rounded(first)} to {rounded(last)} {unit} ({change})"

"""What a run over a movie tells at its end: how many frames were mapped, how the edge moved."""

import shlex
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from cytodisk.number_words import counted
from cytodisk.runs.told.nucleus_words import nucleus_ratio_words, nucleus_share_words
from cytodisk.scale import suited_velocity

if TYPE_CHECKING:
    from cytodisk.store.study import Study

_MOST_LINES = 10


def movie_lines(study: "Study") -> Iterator[str]:
    """How many frames were mapped, how steady the windows are, and how fast the edge moved.

    Parameters
    ----------
    study : Study
        Of a movie.
    """
    frames = study.cells
    mapped = frames[frames["status"] == "ok"]
    cells = counted(frames["cell"].nunique(), "cell")
    yield f"{len(mapped)} of {len(frames)} frames of {cells} mapped, each one to one"
    if len(mapped):
        yield _velocity_words(study)
        yield _consistency_words(study, mapped)
    yield from filter(None, (nucleus_ratio_words(mapped, "frame"), nucleus_share_words(mapped)))


def lost_frame_lines(study: "Study") -> Iterator[str]:
    """Why frames were not mapped."""
    for status in ("refused", "missing", "unreadable"):
        lost = study.cells[study.cells["status"] == status]
        for _, row in lost.head(_MOST_LINES).iterrows():
            yield f"cell {row['cell']}, frame {row['frame']} {status}: {row['reason']}"
        if len(lost) > _MOST_LINES:
            yield f"… and {len(lost) - _MOST_LINES} more {status}: column 'reason' of cells.parquet"


def movie_fault(study: "Study") -> str:
    """What went wrong with a run as a whole: nothing was mapped, or a frame is damaged; else empty."""
    frames = study.cells
    if not (frames["status"] == "ok").any():
        return f"no frame could be mapped: {frames['reason'].iloc[0]}"
    unreadable = int((frames["status"] == "unreadable").sum())
    return f"damaged frames of the input: {unreadable}; all others are in {study.path}" if unreadable else ""


def _consistency_words(study: "Study", mapped: Any) -> str:
    length = study.consistency.attrs["units"]["centroid_displacement"]
    correlation = study.consistency["correlation"].mean()
    alike = f"consecutive frames correlate by {correlation:.2f}; " if correlation == correlation else ""
    moved = study.consistency["centroid_displacement"].mean()
    still = f"window centroids move {moved:.3g} {length} a frame; " if moved == moved else ""
    return f"{still}{alike}empty windows {int(mapped['empty_windows'].sum())}"


def _velocity_words(study: "Study") -> str:
    speed, unit = study.edge["velocity"], study.edge.attrs["units"]["velocity"]
    if not speed.notna().any():
        return "edge velocity: none, as no two frames that follow each other were mapped"
    error = " ".join(["error of one sector", *_bounds(study.edge)])
    from cytodisk.analysis.top_speed import top_speed

    frames = study.cells["frame"].max() - study.cells["frame"].min() + 1
    shown = suited_velocity(top_speed(speed.to_numpy()), unit, study.scale.shown_time(frames))
    low, high, wrong = speed.min(), speed.max(), study.edge["velocity_error"].median()
    return f"edge velocity: {shown.number(low)} to {shown.words(high)}, {error} {shown.words(wrong, 2)}"


def finding_line(study: "Study") -> Iterator[str]:
    """What was measured of the cell with the most mapped frames, and the command that asks more."""
    from cytodisk.runs.findings.doubt_words import bearing_flags
    from cytodisk.runs.findings.movie_finding import measured, usual_cell
    from cytodisk.runs.qc_flags.remedy import shown_path
    from cytodisk.runs.qc_flags.study_flags import run_flags

    cell = usual_cell(study)
    if cell is None:
        return
    finding = measured(study, cell, bearing_flags(run_flags(study), cell))
    yield f"Finding, cell {cell}: {finding.words}"
    if finding.command:
        yield f"Does the signal rise before the edge moves? {finding.command}"
        path = shown_path(str(study.path))
        yield f"Does one of both predict the other? {shlex.join(['cytodisk', 'predict', path])}"
        yield f"Do waves run along the edge? {shlex.join(['cytodisk', 'waves', path])}"


def _bounds(edge: Any) -> list[str]:
    """The word "at least" or "at most" if the error of velocity is such a bound in most cells."""
    from cytodisk.motion.velocity_error import error_is

    words = []
    for _, of_cell in edge.groupby("cell"):
        by_frame = of_cell.pivot(index="frame", columns="sector", values="velocity")
        every = range(by_frame.index.min(), by_frame.index.max() + 1)
        words.append(error_is(by_frame.reindex(every).to_numpy(dtype=float)))
    most = max(set(words), key=words.count, default="")
    return [most] if most else []

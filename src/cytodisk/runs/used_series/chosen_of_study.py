"""What of a movie's study a command works on: its channels, some of its cells, frames that are there."""

from __future__ import annotations

from collections.abc import Sequence

from cytodisk.errors import ParameterError, StudyError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.used_series.used_parameters import UsedFramesParameters
from cytodisk.store.study import Study

_LONGEST_LAG = 20  # frames, unless the user asks for more


def channels_of(study: Study) -> list[str]:
    """Names of the channels that a movie's study has in its windows.

    Raises
    ------
    StudyError
        It is not that of a movie, or was made without a signal.
    """
    if not study.is_movie:
        raise StudyError(
            f"study {study.path} is not that of a movie: without time there are no series; use cytodisk movie"
        )
    activity = study.activity(int(study.cells["cell"].iloc[0]))
    if "mean" not in activity:
        raise StudyError(f"study {study.path} has no signal: run cytodisk movie with --signal")
    return [str(name) for name in activity["channel"].to_numpy()]


def chosen_cells(study: Study, cells: list[int] | None) -> list[int]:
    """Numbers of the cells that were asked for, or of all; raises ParameterError if one is not there."""
    there = sorted(int(cell) for cell in study.cells["cell"].unique())
    missing = [cell for cell in cells or [] if cell not in there]
    if missing:
        raise ParameterError(
            f"cells: study {study.path} has no cell {missing[0]}, it has {len(there)} from 0"
        )
    return sorted({int(cell) for cell in cells}) if cells else there


def refuse_velocity_channel(names: Sequence[str]) -> None:
    """Raise ParameterError if a channel is called as the velocity of the edge is."""
    clash = sorted(set(names) & set(VELOCITIES))
    if clash:
        raise ParameterError(
            f"the study has a channel called {clash[0]!r}, as the velocity of the edge is: run cytodisk "
            "movie again with --channels to name it otherwise"
        )


def check_frames(study: Study, options: UsedFramesParameters) -> None:
    """Raise ParameterError for frames beyond those of all cells; a cell that ends sooner is used as far."""
    there = study.cells["frame"]
    if options.frames is not None and options.frames[1] > there.max():
        first, last = options.frames
        raise ParameterError(
            f"frames {first}:{last} are not in the movie: it has {there.min()}:{there.max()}"
        )


def usual_lag(study: Study, cells: Sequence[int], min_pairs: int) -> int:
    """A quarter of the longest cell's frames, at most twenty, and what leaves enough pairs of frames."""
    there = study.cells
    frames = max(int((there["cell"] == cell).sum()) for cell in cells)
    return max(1, min(_LONGEST_LAG, frames // 4, frames - min_pairs))

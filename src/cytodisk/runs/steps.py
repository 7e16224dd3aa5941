"""What every run begins and ends with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from typing import TypeAlias

from cytodisk.errors import ParameterError, SignalError
from cytodisk.images.frames import FrameFile
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.store.study_folder import StudyFolder

Progress: TypeAlias = Callable[[int, int], None]
"""Called with (done, in all)."""


def silent(done: int, total: int) -> None:
    """Report nothing."""


def name_channels(signal: FrameFile | None, channels: tuple[str, ...] | None) -> FrameFile | None:
    """The signal with the names that were given to its channels, or else with its own.

    Parameters
    ----------
    signal : FrameFile or None
    channels : tuple of str, or None
        As `MapParameters` takes them.

    Returns
    -------
    FrameFile or None

    Raises
    ------
    ParameterError
        There is no signal, or it has more or fewer channels.
    SignalError
        A name in the file is one of the edge's velocity.
    """
    if channels is None:
        for name in VELOCITIES:
            if signal is not None and name in signal.channels:
                raise SignalError(
                    f"signal {signal.path} has a channel {name!r}, which is the name of the edge's velocity: "
                    f"pass other names for its {len(signal.channels)} channels, as --channels"
                )
        return signal
    given = ", ".join(map(repr, channels))
    if signal is None:
        raise ParameterError(f"channels are named ({given}), but there is no signal: pass it as --signal")
    if len(channels) != len(signal.channels):
        raise ParameterError(
            f"channels must be as many names as {signal.path} has channels, which are {len(signal.channels)} "
            f"({signal.axes} {signal.shape}), got {len(channels)} ({given})"
        )
    return replace(signal, channels=channels)


def finish_run(folder: StudyFolder, keys: Sequence[str], warnings: Sequence[str]) -> None:
    """Note warnings and the time, merge the tables and mark the study as complete.

    Parameters
    ----------
    folder : StudyFolder
    keys : sequence of str
        All parts of the run, in the order of the tables.
    warnings : sequence of str

    Raises
    ------
    StudyError
        A part is missing.
    """
    folder.note("warnings", list(warnings))
    folder.note("finished", datetime.now(UTC).isoformat(timespec="seconds"))
    folder.finish(list(keys))

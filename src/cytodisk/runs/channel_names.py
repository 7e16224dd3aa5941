"""Names of channels as they are shown, and as parts of file names."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from cytodisk.errors import ParameterError, SignalError
from cytodisk.images.chosen_channels import stem_of, with_names
from cytodisk.images.file_parameters import SignalFileParameters
from cytodisk.parameters import Parameters

if TYPE_CHECKING:
    from cytodisk.images.frame_file import FrameFile

ChannelSettings = TypeVar("ChannelSettings", bound=Parameters)

VELOCITIES = ("velocity", "velocity_cell_frame")  # of the edge: no channel can have such a name
_LONGEST = 24


def shown_name(name: str, longest: int = 0) -> str:
    """Name of a channel in words.

    Parameters
    ----------
    name : str
    longest : int
        Letters that there is room for; 0 for any number.

    Returns
    -------
    str
        As "VASP"; "channel 488" where the name is a number.

    Examples
    --------
    >>> from cytodisk.runs.channel_names import shown_name
    >>> shown_name("488"), shown_name("2026-11-03_cell-7_VASP-mCherry 2", longest=20)
    ('channel 488', '2026-11-03_…Cherry 2')
    """
    return shortened(f"channel {name}" if name.isdigit() else name, longest)


def shortened(name: str, longest: int) -> str:
    """A name that has room in its place: cut in the middle, as names of files often differ at their end."""
    if not longest or len(name) <= longest:
        return name
    end = 2 * (longest - 1) // 5 + 1
    return f"{name[: longest - 1 - end]}…{name[-end:]}"


def channels_words(signal: FrameFile) -> str:
    """Words for the channels of a signal, with the way to name those without a name.

    Parameters
    ----------
    signal : FrameFile

    Returns
    -------
    str
        As "channels Rac1, RhoA".
    """
    names = signal.channels
    if not signal.unnamed:
        return f"channel{'s' if len(names) > 1 else ''} {', '.join(names)}"
    given = ",".join(["Rac1", "RhoA", "Cdc42"][: len(names)]) + (",…" if len(names) > 3 else "")
    if len(names) == 1:
        return f"1 channel without a name: it is called {names[0]} (name it: --channels {given})"
    called = f"they are called {', '.join(names)} (name them: --channels {given})"
    return f"{len(names)} channels without names: {called}"


def common_signal_name(signals: Sequence[Path]) -> str:
    """What to call channels without a name in many files, so that all have one name.

    Parameters
    ----------
    signals : sequence of Path

    Returns
    -------
    str
        The words that all names of the files share, as "VASP" for "a_VASP.tif" and "b_VASP.tif"; or else the
        name of their folder, or "signal". Empty for a single file, which says it alone.
    """
    if len(signals) < 2:
        return ""
    words = [re.findall(r"[^\W_]+", stem_of(re.sub(r"[*?\[\]]", " ", path.name))) for path in signals]
    shared = [word for word in words[0] if all(word in other for other in words[1:])]
    folders = {path.parent.name for path in signals}
    name = "_".join(shared) or (folders.pop() if len(folders) == 1 else "") or "signal"
    return f"{name} signal" if name in VELOCITIES else name


def check_signal_given(signal: object, parameters: SignalFileParameters) -> None:
    """Raise ParameterError where something is said of a signal that is not there."""
    if signal is not None:
        return
    for name in ("signal_axes", "signal_channels"):
        if getattr(parameters, name) is not None:
            flag = "--" + name.replace("_", "-")
            raise ParameterError(
                f"{name} is given, but there is no signal: pass it as --signal, or take {flag} out"
            )


def with_common_name(
    signal: FrameFile | None, name: str, parameters: ChannelSettings
) -> tuple[FrameFile | None, ChannelSettings]:
    """A signal with a name that many share, if its file has none, and parameters that say so.

    Parameters
    ----------
    signal : FrameFile or None
    name : str
        Empty to change nothing.
    parameters : ChannelParameters

    Returns
    -------
    signal : FrameFile or None
    parameters : ChannelParameters
    """
    if signal is None or not signal.unnamed or not name:
        return signal, parameters
    named = with_names(signal, name)
    return named, parameters.changed(channels=named.channels)


def correlation_name(names: Sequence[str]) -> str:
    """Words for a correlation.

    Parameters
    ----------
    names : sequence of str
        Signal, what it was correlated with, and the name of a variant if it has one, as an item of
        `Study.correlations`.

    Returns
    -------
    str
        As "edge with velocity (early frames)".
    """
    signal, with_, *variant = names
    words = f"{shown_name(signal)} with {shown_name(with_)}"
    return f"{words} ({variant[0]})" if variant and variant[0] else words


def file_names(channels: Sequence[str]) -> list[str]:
    """Names of channels that can be part of a file's name.

    Parameters
    ----------
    channels : sequence of str

    Returns
    -------
    list of str
        All different, in upper and lower case too.
    """
    names: list[str] = []
    for number, channel in enumerate(channels):
        name = re.sub(r"[^\w-]+", "_", channel)[:_LONGEST].strip("_") or str(number)
        taken = name.casefold() in (other.casefold() for other in names)
        names.append(f"{name}_{number}" if taken else name)
    return names


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
        if signal is not None and signal.unnamed and set(VELOCITIES) & set(signal.channels):
            return with_names(signal, f"{signal.channels[0]} signal")
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
    return replace(signal, channels=channels, unnamed=False)

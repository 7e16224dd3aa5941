"""Parameters that say how files of masks and images are read."""

import os
from typing import Any, Literal, TypeAlias

from pydantic import field_validator

from cytodisk.images.frame_file import FileChoice
from cytodisk.parameters import Parameters, parameter

Kind: TypeAlias = Literal["auto", "mask", "stack", "labels"]
Fragments: TypeAlias = Literal["refuse", "largest"]

AXES = "TCZYX"
AXES_WORDS = "letters T (time), C (channel), Z, Y and X, one an axis, such as TYX"


def checked_axes(axes: str | None) -> str | None:
    """Axes in capital letters.

    Raises
    ------
    ValueError
        They are no axes of an image.
    """
    if axes is None:
        return None
    letters = axes.strip().upper()
    if not set(letters) <= set(AXES) or len(set(letters)) < len(letters) or not {"Y", "X"} <= set(letters):
        raise ValueError(f"must be {AXES_WORDS}, each once, Y and X among them")
    return letters


def number_as_text(value: Any) -> Any:
    """A whole number as a text, since names may be given as numbers."""
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else value


def path_as_text(value: Any) -> Any:
    """A path as a text."""
    return os.fspath(value) if isinstance(value, os.PathLike) else value


class ChoiceParameters(Parameters):
    """What to take of a file that holds more than one movie, or slices."""

    scene: str | None = parameter(
        None,
        "Scene (position, series, image) of a file with several: its number from 0, or its name.",
        words="a number from 0, or a name",
    )
    z: str | None = parameter(
        None,
        "Slice of a z-stack: its number from 0, or a projection: max or mean.",
        words="a number from 0, max or mean",
    )

    _texts = field_validator("scene", "z", mode="before")(number_as_text)

    @field_validator("z")
    @classmethod
    def _slice_or_projection(cls, z: str | None) -> str | None:
        if z is None or z in ("max", "mean") or (z.isascii() and z.isdecimal()):
            return z
        raise ValueError("must be a number from 0, max or mean")


class KindParameters(ChoiceParameters):
    """What a mask file holds."""

    kind: Kind = parameter(
        "auto",
        'What the mask file holds: "mask" is one cell, "stack" one cell a frame, "labels" one cell a label; '
        '"auto" looks at the values.',
    )
    axes: str | None = parameter(
        None,
        "Axes of the mask file, a letter each, such as TYX or YXT; overrules what the file says.",
        words=AXES_WORDS,
    )
    label: bool = parameter(
        False,
        "For several cells in one mask of 0 and 1: number its pieces; each is a cell. Cells that touch are "
        "one piece: split them first.",
    )
    fragments: Fragments = parameter(
        "refuse",
        'A mask whose second piece has 10 % of the largest or more: "refuse" it, as it holds several cells, '
        'or measure the "largest" piece alone. Smaller pieces are always dropped.',
    )

    mask_channel: str | None = parameter(
        None,
        "Channel that holds the masks, if their file has several channels: its name, or its number from 0.",
        words="a name, or a number from 0",
    )

    _axes = field_validator("axes")(checked_axes)
    _mask_channel = field_validator("mask_channel", mode="before")(number_as_text)

    @property
    def mask_choice(self) -> FileChoice:
        """What to take of a mask file."""
        channels = None if self.mask_channel is None else (self.mask_channel,)
        return FileChoice(self.axes, self.scene, self.z, channels)


class SignalFileParameters(ChoiceParameters):
    """How the file of a signal is read."""

    signal_axes: str | None = parameter(
        None,
        "Axes of the signal's file, a letter each, such as TCYX; overrules what the file says.",
        words=AXES_WORDS,
    )

    signal_channels: tuple[str, ...] | None = parameter(
        None,
        "Channels to take from the signal's file, in this order: names, or numbers from 0. Without it, all.",
        words="names, or numbers from 0",
    )

    _signal_axes = field_validator("signal_axes")(checked_axes)

    @field_validator("signal_channels")
    @classmethod
    def _different_channels(cls, channels: tuple[str, ...] | None) -> tuple[str, ...] | None:
        if channels is not None and (not all(channels) or len({*channels}) < max(1, len(channels))):
            raise ValueError("must name one channel at least, and each once")
        return channels

    @property
    def signal_choice(self) -> FileChoice:
        """What to take of the file of a signal."""
        return FileChoice(self.signal_axes, self.scene, self.z, self.signal_channels)


class MovieKindParameters(KindParameters):
    """What the mask file of a movie holds."""

    kind: Literal["auto", "stack", "labels"] = parameter(
        "auto",
        'What the mask file holds: "stack" is one cell through time, "labels" one cell a label; "auto" looks '
        "at the values.",
    )
    link: bool | None = parameter(
        None,
        "For labels that change from frame to frame: cells that overlap get one label through time. Without "
        "it, such labels are refused; --no-link takes them as they are.",
    )
    tracks: str | None = parameter(
        None,
        "File of tracks that say which label is which cell through time: XML of TrackMate, or a GEFF.",
        words="a path",
    )

    _tracks = field_validator("tracks", mode="before")(path_as_text)

"""Parameters that say how a file of nuclei is read."""

from __future__ import annotations

from typing import Literal

from pydantic import field_validator

from cytodisk.images.file_parameters import (
    AXES_WORDS,
    ChoiceParameters,
    KindParameters,
    checked_axes,
    number_as_text,
)
from cytodisk.images.frame_file import FileChoice
from cytodisk.parameters import parameter


class NucleiFileParameters(ChoiceParameters):
    """How the file of nuclei is read."""

    nuclei_kind: Literal["auto", "mask", "labels"] = parameter(
        "auto",
        'What the file of nuclei holds: "labels" is one nucleus a label; "mask" is 0 and 1, where each piece '
        'is a nucleus; "auto" looks at the values.',
    )
    nuclei_axes: str | None = parameter(
        None,
        "Axes of the file of nuclei, a letter each, such as TYX; overrules what the file says.",
        words=AXES_WORDS,
    )
    nuclei_channel: str | None = parameter(
        None,
        "Channel that holds the nuclei, if their file has several channels: its name, or its number from 0.",
        words="a name, or a number from 0",
    )

    _nuclei_axes = field_validator("nuclei_axes")(checked_axes)
    _nuclei_channel = field_validator("nuclei_channel", mode="before")(number_as_text)

    @property
    def nuclei_choice(self) -> FileChoice:
        """What to take of a file of nuclei."""
        channels = None if self.nuclei_channel is None else (self.nuclei_channel,)
        return FileChoice(self.nuclei_axes, self.scene, self.z, channels)

    def kind_of(self, n_frames: int) -> KindParameters:
        """The same as what is said of a file of masks."""
        kind = "stack" if self.nuclei_kind == "mask" and n_frames > 1 else self.nuclei_kind
        return KindParameters(kind=kind, fragments="largest")
